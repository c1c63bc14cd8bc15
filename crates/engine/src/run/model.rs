//! The running model: state, forces, motion and accounts.

use super::accounts::ledger_base;
use super::equilibrium::StaticState;
use super::recipe::{Laws, Recipe};
use super::{Families, Info, ModeShape, PointField, Simulation, SnapshotOptions};
use crate::body::{Body, Field, Layout};
use crate::condition::constraint::Constraint;
use crate::condition::driven::{Drive, Driven, Reaction};
use crate::condition::indenter::Indenter;
use crate::condition::load::Load;
use crate::condition::still::Still;
use crate::dynamics::verlet::Verlet;
use crate::error::{BuildError, RunError};
use crate::fracture::fragments::Fragments;
use crate::interaction::contact::Contact;
use crate::interaction::{BondState, Fault, Interaction, PointEnergies, Sweep};
use crate::observe::{Ledger, Snapshot};
use crate::space::Point;
use crate::spec::{ConditionSpec, IndenterSpec};
use crate::statics::{AnyLinearBody, SolveError, Solved};

/// A model in D dimensions.
pub struct Model<const D: usize> {
    pub(super) info: Info,
    pub(super) body: Body<D>,
    pub(super) interaction: Box<dyn Interaction<D>>,
    /// Repulsion between points that are not in each other's family.
    pub(super) contact: Option<Contact<D>>,
    pub(super) u: Field<D>,
    pub(super) v: Field<D>,
    pub(super) f: Field<D>,
    pub(super) verlet: Verlet,
    pub(super) loads: Vec<Load<D>>,
    pub(super) constraints: Vec<Constraint<D>>,
    pub(super) indenters: Vec<Indenter<D>>,
    pub(super) driven: Vec<Driven<D>>,
    pub(super) still: Still<D>,
    /// Shall the next force evaluation be watched, and what the last watched one saw.
    pub(super) watch: bool,
    pub(super) watched: Option<PointEnergies>,
    /// The same for the virial.
    pub(super) watch_virial: bool,
    pub(super) virial: Option<[f64; 6]>,
    /// Laws and constants, for what is computed pair by pair.
    pub(super) recipe: Recipe,
    /// Named sets of point ids.
    pub(super) sets: Vec<(String, Vec<u32>)>,
    pub(super) dt: f64,
    pub(super) step: u64,
    /// Step and time from which time is counted in whole steps.
    pub(super) origin: (u64, f64),
    /// Does `v` wait for the last half kick?
    pub(super) pending: bool,
    pub(super) broken: u64,
    pub(super) released: f64,
    /// Work of conditions that were replaced since.
    pub(super) past_work: [f64; 3],
    pub(super) initial_energy: Option<f64>,
    /// The last forces mean nothing.
    pub(super) fault: Option<Fault>,
    /// Steps are increments of load.
    pub(super) statics: Option<StaticState<D>>,
}

impl<const D: usize> Model<D> {
    /// Bytes held: body, bonds, and the state of nine numbers per slot in 3-D.
    pub(super) fn bytes(&self) -> usize {
        self.body.bytes()
            + self.interaction.bytes()
            + self.contact.as_ref().map_or(0, Contact::bytes)
            + 3 * D * 8 * self.body.len
    }

    pub(super) fn refresh_images(&mut self) {
        if !self.body.images.is_empty() {
            for c in &mut self.u {
                self.body.fill_images(c);
            }
        }
    }

    /// All forces at the current displacements, no bond breaking.
    pub(super) fn forces_held(&mut self) {
        self.refresh_images();
        let (body, u) = (&self.body, &self.u);
        self.interaction
            .forces(body, u, &mut self.f, Sweep::Hold, None);
        self.other_forces(0.0);
    }

    /// All forces at the current displacements; `dt` is 0 at the start of a run.
    pub(super) fn forces(&mut self, bonds: bool, dt: f64) {
        self.refresh_images();
        let mut watched = self.watched.take();
        watched = std::mem::take(&mut self.watch).then(|| watched.unwrap_or_default());
        self.virial = std::mem::take(&mut self.watch_virial).then(|| match bonds {
            true => self.virial_of_bonds(),
            false => [0.0; 6],
        });
        if bonds {
            let tally = self.interaction.forces(
                &self.body,
                &self.u,
                &mut self.f,
                Sweep::Evolve {
                    v: &self.v,
                    dt: self.dt,
                },
                watched.as_mut(),
            );
            self.fault = tally.fault;
            self.broken += tally.broken;
            self.released += tally.released;
        } else {
            self.f.iter_mut().for_each(|c| c.fill(0.0));
            if let Some(w) = &mut watched {
                w.zeros(self.body.len);
            }
        }
        self.watched = watched;
        self.other_forces(dt);
        if let Some(mut virial) = self.virial {
            self.add_virial_of_contact(&mut virial);
            self.virial = Some(virial);
        }
    }

    /// Forces of contact, indenters and loads, on top of those of bonds.
    fn other_forces(&mut self, dt: f64) {
        let t = self.time();
        if let Some(contact) = &mut self.contact {
            let (body, interaction) = (&self.body, &self.interaction);
            contact.add_forces(body, &self.u, &mut self.f, &|i, j| {
                interaction.in_family(body, i, j)
            });
            if let Some(watched) = &mut self.watched {
                contact.add_energy_density(body, &self.u, &mut watched.repulsion);
            }
        }
        for indenter in &mut self.indenters {
            indenter.add(&self.body, &self.u, &self.v, &mut self.f, dt);
        }
        for load in &mut self.loads {
            load.add(&self.body, &self.v, &mut self.f, t, dt);
        }
        for d in &mut self.driven {
            d.add(&self.body, &self.u, &self.v, &mut self.f, t, dt);
        }
    }

    /// Points may be anywhere now: whoever keeps track of what is near forgets it.
    fn look_again(&mut self) {
        if let Some(contact) = &mut self.contact {
            contact.look_again();
        }
        self.indenters.iter_mut().for_each(Indenter::look_again);
        for d in &mut self.driven {
            if let Driven::Indenter(i) = d {
                i.look_again();
            }
        }
    }

    /// Bring velocities to the whole step.
    pub(super) fn finish(&mut self) {
        if self.pending {
            self.verlet.kick(&self.body, &mut self.v, &self.f, self.dt);
            let (t, dt) = (self.time(), self.dt);
            for c in &self.constraints {
                c.settle(&mut self.v, t, dt);
            }
            self.still.settle(&mut self.v);
            self.pending = false;
        }
    }

    pub(super) fn by_id<T>(&self, value: impl Fn(usize) -> T) -> Vec<T> {
        self.body.slots.iter().map(|&s| value(s as usize)).collect()
    }

    fn vectors(&self, field: &Field<D>) -> Vec<Point> {
        self.by_id(|i| std::array::from_fn(|a| if a < D { field[a][i] } else { 0.0 }))
    }

    fn scatter(body: &Body<D>, field: &mut Field<D>, values: &[Point]) {
        for (x, &s) in values.iter().zip(&body.slots) {
            for a in 0..D {
                field[a][s as usize] = x[a];
            }
        }
    }

    /// Slots and reference positions of a set.
    pub(super) fn slots_of(
        &self,
        set: &str,
        sets: &[(String, Vec<u32>)],
    ) -> Result<(Vec<u32>, Vec<Point>), BuildError> {
        let slots: Vec<u32> = if set == "all" {
            self.body.slots.clone()
        } else {
            let Some((_, ids)) = sets.iter().find(|(n, _)| n == set) else {
                return Err(BuildError::new("", format!("there is no set `{set}`")));
            };
            ids.iter().map(|id| self.body.slots[*id as usize]).collect()
        };
        let points = slots
            .iter()
            .map(|s| self.body.position(*s as usize))
            .collect();
        Ok((slots, points))
    }
}

impl<const D: usize> Simulation for Model<D> {
    fn info(&self) -> &Info {
        &self.info
    }

    fn start(&mut self, bonds: bool) {
        self.finish();
        let (t, dt) = (self.time(), self.dt);
        self.look_again();
        if self.statics.is_some() {
            self.unloaded();
        } else {
            for c in &mut self.constraints {
                c.start(&mut self.u, &mut self.v, t, dt);
            }
            self.forces(bonds, 0.0);
        }
        // energy that came in from outside counts as initial
        let now = self.energy_now();
        self.initial_energy = Some(ledger_base(&now));
    }

    fn step(&mut self) -> Result<(), RunError> {
        if self.statics.is_some() {
            return self.increment();
        }
        let (t, dt) = (self.time(), self.dt);
        for c in &mut self.constraints {
            c.begin(&self.u, &mut self.v, &mut self.f, t, dt);
        }
        self.still.begin(&mut self.v, &mut self.f, !self.pending);
        // linear springs may go through each other: they know no distance that is too far for a step
        let limit = match self.recipe.laws {
            Laws::Springs(_) | Laws::Micromoduli(_) => f64::INFINITY,
            _ => self.body.spacing,
        };
        let fastest = self.verlet.advance(
            &self.body,
            &mut self.u,
            &mut self.v,
            &self.f,
            dt,
            self.pending,
            limit,
        );
        if !(fastest < limit * limit) {
            let error = self.refused(limit);
            self.verlet
                .retreat(&self.body, &mut self.u, &mut self.v, &self.f, dt, limit);
            self.pending = false;
            self.still.settle(&mut self.v);
            return Err(error);
        }
        self.step += 1;
        if let Some(contact) = &mut self.contact {
            contact.moved(fastest.sqrt());
        }
        let t = self.time();
        for c in &self.constraints {
            c.drift(&mut self.u, t, dt);
        }
        for load in &mut self.loads {
            load.begin(&self.body, &self.v, dt);
        }
        for indenter in &mut self.indenters {
            indenter.begin(&self.body, &self.v, t, dt, fastest.sqrt());
        }
        for d in &mut self.driven {
            d.begin(&self.body, &self.v, t, dt, fastest.sqrt());
        }
        self.forces(true, dt);
        if let Some(fault) = self.fault {
            let error = self.explained(fault);
            // back to the step before: where it was, and with the forces that were
            for &s in &self.body.slots {
                for a in 0..D {
                    self.u[a][s as usize] -= self.dt * self.v[a][s as usize];
                }
            }
            self.step -= 1;
            self.forces(true, 0.0);
            self.verlet
                .retreat(&self.body, &mut self.u, &mut self.v, &self.f, dt, 0.0);
            self.pending = false;
            return Err(error);
        }
        for c in &mut self.constraints {
            c.end(&self.body, &self.u, &self.f, t, dt);
        }
        self.pending = true;
        Ok(())
    }

    fn step_number(&self) -> u64 {
        self.step
    }

    fn time(&self) -> f64 {
        self.origin.1 + (self.step - self.origin.0) as f64 * self.dt
    }

    fn set_time(&mut self, step: u64, time: f64) {
        self.step = step;
        self.origin = (step, time);
    }

    fn set_time_step(&mut self, dt: f64) {
        self.finish();
        self.origin = (self.step, self.time());
        self.dt = dt;
        self.info.time_step = dt;
    }

    fn ledger(&mut self) -> Result<Ledger, RunError> {
        self.balance()
    }

    fn snapshot(&mut self, options: SnapshotOptions) -> Snapshot {
        self.finish();
        let mut snapshot = Snapshot {
            step: self.step,
            time: self.time(),
            dimension: D,
            spacing: self.body.spacing,
            reference: self.reference(),
            displacement: self.displacements(),
            velocity: self.vectors(&self.v),
            damage: self.damage(),
            mark: if self.body.mark.is_empty() {
                vec![0; self.body.points()]
            } else {
                self.body.mark.clone()
            },
            ..Snapshot::default()
        };
        if options.energies {
            self.refresh_images();
            let mut energies = PointEnergies::default();
            self.interaction.observe(&self.body, &self.u, &mut energies);
            snapshot.energy_density = self.by_id(|i| energies.strain[i] + energies.repulsion[i]);
            snapshot.dilatation = self.by_id(|i| energies.dilatation[i]);
        }
        if options.fragments {
            snapshot.fragment = Some(Fragments::of(&self.body, self.interaction.as_ref()).label);
        }
        if options.bonds {
            let mut id = vec![0u32; self.body.len];
            for (k, &s) in self.body.slots.iter().enumerate() {
                id[s as usize] = k as u32;
            }
            let mut bonds = vec![];
            self.interaction
                .each_bond(&self.body, &mut |i, j, _, state| {
                    if state == BondState::Whole {
                        let (a, b) = (id[i], id[j]);
                        bonds.push((a.min(b), a.max(b)));
                    }
                });
            snapshot.bonds = Some(bonds);
        }
        snapshot
    }

    fn broken(&self) -> u64 {
        self.broken
    }

    fn fragments(&self) -> u64 {
        Fragments::of(&self.body, self.interaction.as_ref()).count() as u64
    }

    fn displacements(&self) -> Vec<Point> {
        self.vectors(&self.u)
    }

    fn set_displacements(&mut self, u: &[Point]) {
        self.finish();
        self.virial = None;
        Self::scatter(&self.body, &mut self.u, u);
        self.refresh_images();
        self.look_again();
    }

    fn velocities(&mut self) -> Vec<Point> {
        self.finish();
        self.vectors(&self.v)
    }

    fn set_velocities(&mut self, v: &[Point]) {
        self.finish();
        Self::scatter(&self.body, &mut self.v, v);
    }

    fn force_densities(&self) -> Vec<Point> {
        self.vectors(&self.f)
    }

    fn reference(&self) -> Vec<Point> {
        self.by_id(|i| self.body.position(i))
    }

    fn members(&self, set: &str) -> Option<Vec<u32>> {
        if set == "all" {
            return Some((0..self.body.points() as u32).collect());
        }
        let named = self.sets.iter().find(|(name, _)| name == set);
        named.map(|(_, ids)| ids.clone())
    }

    fn volumes(&self) -> Vec<f64> {
        self.by_id(|i| self.body.volume.at(i))
    }

    fn densities(&self) -> Vec<f64> {
        self.by_id(|i| self.body.density.at(i))
    }

    fn damage(&self) -> Vec<f64> {
        let mut damage = vec![0.0; self.body.len];
        self.interaction.damage(&self.body, &mut damage);
        self.by_id(|i| damage[i])
    }

    fn dilatation(&self) -> Vec<f64> {
        let mut out = PointEnergies::default();
        self.interaction.observe(&self.body, &self.u, &mut out);
        self.by_id(|i| out.dilatation[i])
    }

    fn energy_density(&mut self) -> Vec<f64> {
        self.refresh_images();
        let mut out = PointEnergies::default();
        self.interaction.observe(&self.body, &self.u, &mut out);
        if let Some(pairs) = &mut self.contact {
            let (body, interaction) = (&self.body, &self.interaction);
            pairs.update(body, &self.u, &|i, j| interaction.in_family(body, i, j));
            pairs.add_energy_density(body, &self.u, &mut out.repulsion);
        }
        self.by_id(|i| out.strain[i] + out.repulsion[i])
    }

    fn critical_stretch(&self) -> Vec<f64> {
        self.by_id(|i| self.interaction.critical_stretch(i))
    }

    fn families(&self) -> Families {
        let mut volume = vec![0.0; self.body.len];
        let mut foreign = vec![false; self.body.len];
        let of = |i: usize| self.body.material.get(i).copied().unwrap_or(0);
        self.interaction
            .each_bond(&self.body, &mut |i, j, _, state| {
                if state == BondState::Whole {
                    volume[i] += self.body.volume.at(j);
                    volume[j] += self.body.volume.at(i);
                    let unlike = of(i) != of(j);
                    foreign[i] |= unlike;
                    foreign[j] |= unlike;
                }
            });
        Families {
            size: self.by_id(|i| self.interaction.family_size(&self.body, i) as u32),
            volume: self.by_id(|i| volume[i]),
            material: self.by_id(of),
            foreign: self.by_id(|i| foreign[i]),
        }
    }

    fn energy_under_strain(&self, strain: [[f64; 3]; 3]) -> Vec<f64> {
        // images of a grid have displacements of their own; a list knows none, so the jump of a homogeneous strain
        // lies somewhere in a periodic cloud: it is put in several places, and each point asked when it is far away
        let cut: [bool; D] = std::array::from_fn(|a| {
            matches!(self.body.layout, Layout::Cloud(_)) && self.body.period[a].is_some()
        });
        let reach = self.info.horizon * (1.0 + 1e-6);
        let period = |a: usize| self.body.period[a].unwrap_or(0.0);
        // so many places that every point is at least a horizon from one of them
        let places: [usize; D] = std::array::from_fn(|a| match cut[a] {
            true => (1.0 / (1.0 - 2.0 * reach / period(a)).max(1e-2)).ceil() as usize + 1,
            false => 1,
        });
        let mut energy = vec![0.0; self.body.points()];
        let mut u = self.body.at_rest();
        let mut out = PointEnergies::default();
        for n in 0..places.iter().product() {
            let mut rest: usize = n;
            let at: [f64; D] = std::array::from_fn(|a| {
                let k = rest % places[a];
                rest /= places[a];
                k as f64 / places[a] as f64 * period(a)
            });
            // position in the period that begins at the cut
            let unwrapped = |slot: usize| -> Point {
                let mut x = self.body.position(slot);
                for a in (0..D).filter(|a| cut[*a]) {
                    x[a] = (x[a] - at[a]).rem_euclid(period(a));
                }
                x
            };
            // images are periodic in displacement; a homogeneous strain is not: give each its own
            let images = self.body.images.iter().map(|(copy, _)| copy);
            for &s in self.body.slots.iter().chain(images) {
                let x = unwrapped(s as usize);
                for a in 0..D {
                    u[a][s as usize] = (0..D).map(|b| strain[a][b] * x[b]).sum();
                }
            }
            self.interaction.observe(&self.body, &u, &mut out);
            for (e, &s) in energy.iter_mut().zip(&self.body.slots) {
                let x = unwrapped(s as usize);
                if (0..D).all(|a| !cut[a] || (reach..=period(a) - reach).contains(&x[a])) {
                    *e = out.strain[s as usize];
                }
            }
        }
        energy
    }

    fn forces_under(&mut self, displacement: &[Point]) -> Vec<Point> {
        let mut u = self.body.at_rest();
        Self::scatter(&self.body, &mut u, displacement);
        for c in &mut u {
            self.body.fill_images(c);
        }
        let mut f = crate::body::zeros(self.body.len);
        self.interaction
            .forces(&self.body, &u, &mut f, Sweep::Hold, None);
        self.vectors(&f)
    }

    fn set_conditions(
        &mut self,
        conditions: &[ConditionSpec],
        sets: &[(String, Vec<u32>)],
        indenters: &[IndenterSpec],
    ) -> Result<(), BuildError> {
        let (loads, constraints) = self.loads_and_constraints(conditions, sets)?;
        self.finish();
        let now = self.energy_now();
        self.past_work = [now.dissipated, now.work_conditions, now.work_indenter];
        self.driven.clear();
        self.loads = loads;
        self.constraints = constraints;
        self.indenters = indenters.iter().map(Indenter::new).collect();
        Ok(())
    }

    fn read(&mut self, field: PointField, first: usize, out: &mut [f64]) {
        if matches!(field, PointField::Velocity(_)) {
            self.finish();
        }
        let body = &self.body;
        let vector = match field {
            PointField::Reference(a) => return body.coordinates(first, a, out),
            PointField::Displacement(a) => self.u.get(a),
            PointField::Velocity(a) => self.v.get(a),
            PointField::Force(a) => self.f.get(a),
            PointField::Volume | PointField::Density | PointField::CriticalStretch => None,
        };
        let points = out.iter_mut().zip(&body.slots[first..]);
        if let Some(component) = vector {
            return points.for_each(|(x, &s)| *x = component[s as usize]);
        }
        for (x, &s) in points {
            *x = match field {
                PointField::Volume => body.volume.at(s as usize),
                PointField::Density => body.density.at(s as usize),
                PointField::CriticalStretch => self.interaction.critical_stretch(s as usize),
                // of an axis that the body does not have
                _ => 0.0,
            };
        }
    }

    fn write(&mut self, field: PointField, first: usize, values: &[f64]) {
        self.finish();
        self.look_again();
        self.virial = None;
        let component = match field {
            PointField::Displacement(a) => self.u.get_mut(a),
            PointField::Velocity(a) => self.v.get_mut(a),
            _ => None,
        };
        let Some(component) = component else { return };
        for (value, &s) in values.iter().zip(&self.body.slots[first..]) {
            component[s as usize] = *value;
        }
    }

    fn watch_next(&mut self) {
        self.watch = true;
    }

    fn watched(&self) -> Option<(Vec<f64>, Vec<f64>)> {
        self.watched.as_ref().map(|w| {
            let energy = self.by_id(|i| w.strain[i] + w.repulsion[i]);
            (energy, self.by_id(|i| w.dilatation[i]))
        })
    }

    fn watch_virial_next(&mut self) {
        self.watch_virial = true;
    }

    fn virial(&mut self) -> [f64; 6] {
        match self.virial {
            Some(virial) => virial,
            None => self.virial_now(),
        }
    }

    fn set_driven(&mut self, driven: &[(Drive, Option<Vec<u32>>)]) {
        self.finish();
        let slot = |id: &u32| self.body.slots[*id as usize];
        let new = driven.iter().map(|(drive, ids)| {
            let slots = match ids {
                None => self.body.slots.clone(),
                Some(ids) => ids.iter().map(slot).collect(),
            };
            let at = |s: &u32| self.body.position(*s as usize);
            let points = slots.iter().map(at).collect();
            Driven::new(drive, slots, points)
        });
        let new: Vec<_> = new.collect();
        for old in std::mem::replace(&mut self.driven, new) {
            match old {
                Driven::Load(l) => self.past_work[1] += l.work,
                Driven::Indenter(i) => self.past_work[2] += i.work,
            }
        }
    }

    fn drive(&mut self, index: usize, value: &Drive) -> bool {
        self.driven.get_mut(index).is_some_and(|d| d.set(value))
    }

    fn reaction(&self, index: usize) -> Reaction {
        self.driven
            .get(index)
            .map_or_else(Reaction::default, Driven::reaction)
    }

    fn linear_body(&mut self) -> AnyLinearBody {
        AnyLinearBody::new(self.linear_now()).expect("there are three dimensions")
    }

    fn solved(&self) -> Option<Solved> {
        self.statics.as_ref().map(|s| s.solved)
    }

    fn modes(&mut self, count: usize) -> Result<Vec<ModeShape>, SolveError> {
        let found = self.lowest_modes(count)?;
        Ok(found
            .iter()
            .map(|m| ModeShape {
                square: m.square,
                frequency: m.frequency(),
                shape: Self::padded(&m.shape),
            })
            .collect())
    }

    fn set_still(&mut self, ids: &[u32]) {
        self.finish();
        let slots = ids.iter().map(|id| self.body.slots[*id as usize]);
        self.still = Still::new(slots.collect());
    }
}
