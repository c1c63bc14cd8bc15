//! The running model: state, forces, motion and accounts.

use super::recipe::Recipe;
use super::{Families, Info, PointField, Simulation, SnapshotOptions};
use crate::body::{Body, Field, Layout};
use crate::condition::Program;
use crate::condition::constraint::{Constraint, Prescribed};
use crate::condition::driven::{Drive, Driven, Reaction};
use crate::condition::indenter::Indenter;
use crate::condition::load::{Load, LoadKind};
use crate::condition::still::Still;
use crate::dynamics::verlet::Verlet;
use crate::error::{BuildError, RunError};
use crate::fracture::fragments::Fragments;
use crate::interaction::contact::Contact;
use crate::interaction::{BondState, Interaction, PointEnergies, Sweep};
use crate::observe::{Ledger, Snapshot};
use crate::space::Point;
use crate::spec::{ConditionKind, ConditionSpec, IndenterSpec};

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

    /// All forces at the current displacements; `dt` is 0 at the start of a run.
    fn forces(&mut self, bonds: bool, dt: f64) {
        self.refresh_images();
        let t = self.time();
        self.watched = std::mem::take(&mut self.watch).then(|| self.energies_of_bonds(bonds));
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
            );
            self.broken += tally.broken;
            self.released += tally.released;
        } else {
            self.f.iter_mut().for_each(|c| c.fill(0.0));
        }
        if let Some(contact) = &mut self.contact {
            let (body, interaction) = (&self.body, &self.interaction);
            contact.add_forces(body, &self.u, &mut self.f, &|i, j| {
                interaction.in_family(body, i, j)
            });
            if let Some(watched) = &mut self.watched {
                contact.add_energy_density(body, &self.u, &mut watched.repulsion);
            }
        }
        if let Some(mut virial) = self.virial {
            self.add_virial_of_contact(&mut virial);
            self.virial = Some(virial);
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

    fn energies_of_bonds(&self, bonds: bool) -> PointEnergies {
        let mut out = PointEnergies::default();
        if bonds {
            self.interaction.observe(&self.body, &self.u, &mut out);
        } else {
            let zeros = || vec![0.0; self.body.len];
            (out.strain, out.repulsion, out.dilatation) = (zeros(), zeros(), zeros());
        }
        out
    }

    /// Bring velocities to the whole step.
    fn finish(&mut self) {
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

    fn energy_now(&mut self) -> Ledger {
        self.finish();
        self.refresh_images();
        let [strain, mut contact] = self.interaction.energy(&self.body, &self.u);
        if let Some(pairs) = &mut self.contact {
            let (body, interaction) = (&self.body, &self.interaction);
            pairs.update(body, &self.u, &|i, j| interaction.in_family(body, i, j));
            contact += pairs.energy(body, &self.u);
        }
        let mut ledger = Ledger {
            strain,
            contact,
            released: self.released,
            dissipated: self.past_work[0],
            work_conditions: self.past_work[1],
            work_indenter: self.past_work[2],
            ..Ledger::default()
        };
        for &s in &self.body.slots {
            let i = s as usize;
            let volume = self.body.volume.at(i);
            let v2: f64 = (0..D).map(|a| self.v[a][i] * self.v[a][i]).sum();
            ledger.kinetic += 0.5 * self.body.density.at(i) * volume * v2;
        }
        for load in &self.loads {
            if load.is_damping() {
                ledger.dissipated -= load.work
            } else {
                ledger.work_conditions += load.work
            }
        }
        ledger.work_conditions += self.constraints.iter().map(|c| c.work).sum::<f64>();
        ledger.work_indenter += self.indenters.iter().map(|i| i.work).sum::<f64>();
        for d in &self.driven {
            match d {
                Driven::Indenter(i) => ledger.work_indenter += i.work,
                Driven::Load(l) => ledger.work_conditions += l.work,
            }
        }
        ledger.initial = self.initial_energy.unwrap_or(0.0);
        ledger
    }

    /// Kinetic energy that the last half kick gave, point by point and never less than 0. A force that acts for the
    /// first time has done no work yet: what it gave is no sign of instability.
    fn last_kick(&self) -> f64 {
        let mut energy = 0.0;
        for &s in &self.body.slots {
            let i = s as usize;
            let (rho, volume) = (self.body.density.at(i), self.body.volume.at(i));
            let (mut now, mut before) = (0.0, 0.0);
            for a in 0..D {
                let v = self.v[a][i];
                now += v * v;
                before += (v - 0.5 * self.dt / rho * self.f[a][i]).powi(2);
            }
            energy += 0.5 * rho * volume * f64::max(now - before, 0.0);
        }
        energy
    }

    /// Which point the pass refused, and why: one that is nowhere, else the one that went furthest.
    fn refused(&self, limit: f64) -> RunError {
        let step = self.step + 1;
        let path = |i: usize| {
            let square = (0..D).map(|a| (self.dt * self.v[a][i]).powi(2));
            square.sum::<f64>().sqrt()
        };
        // what is not a number is furthest
        let far = |i: usize| {
            if path(i).is_nan() {
                f64::INFINITY
            } else {
                path(i)
            }
        };
        let nowhere = |i: usize| (0..D).any(|a| !self.u[a][i].is_finite());
        let slots = || self.body.slots.iter().map(|s| *s as usize).enumerate();
        let found = slots()
            .find(|(_, i)| nowhere(*i))
            .or_else(|| slots().max_by(|a, b| far(a.1).total_cmp(&far(b.1))));
        let (id, i) = found.expect("a body has points");
        let x = self.body.position(i);
        let position = std::array::from_fn(|a| if a < D { x[a] + self.u[a][i] } else { 0.0 });
        let (id, path) = (id as u64 + 1, path(i));
        if nowhere(i) || !path.is_finite() {
            return RunError::NotFinite { step, id, position };
        }
        RunError::TooFast {
            step,
            id,
            position,
            path,
            spacing: limit,
        }
    }

    fn by_id<T>(&self, value: impl Fn(usize) -> T) -> Vec<T> {
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
    pub(super) fn members(
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

    fn crossed_chain(&self) -> Option<(u64, u64)> {
        if D != 1 {
            return None;
        }
        let mut crossed = None;
        self.interaction
            .each_bond(&self.body, &mut |i, j, xi, state| {
                if crossed.is_none()
                    && state == BondState::Whole
                    && xi[0].abs() < 1.5 * self.body.spacing
                    && (xi[0] + self.u[0][j] - self.u[0][i]) * xi[0] <= 0.0
                {
                    crossed = Some((i, j));
                }
            });
        let id = |slot: usize| {
            self.body
                .slots
                .iter()
                .position(|s| *s as usize == slot)
                .map_or(0, |i| i as u64 + 1)
        };
        crossed.map(|(i, j)| (id(i), id(j)))
    }
}

impl<const D: usize> Simulation for Model<D> {
    fn info(&self) -> &Info {
        &self.info
    }

    fn start(&mut self, bonds: bool) {
        self.finish();
        let (t, dt) = (self.time(), self.dt);
        for c in &mut self.constraints {
            c.start(&mut self.u, &mut self.v, t, dt);
        }
        if let Some(contact) = &mut self.contact {
            contact.look_again();
        }
        self.indenters.iter_mut().for_each(Indenter::look_again);
        for d in &mut self.driven {
            if let Driven::Indenter(i) = d {
                i.look_again();
            }
        }
        self.forces(bonds, 0.0);
        // energy that came in from outside counts as initial
        let now = self.energy_now();
        self.initial_energy = Some(ledger_base(&now));
    }

    fn step(&mut self) -> Result<(), RunError> {
        let (t, dt) = (self.time(), self.dt);
        for c in &mut self.constraints {
            c.begin(&self.u, &mut self.v, &mut self.f, t, dt);
        }
        self.still.begin(&mut self.v, &mut self.f, !self.pending);
        let limit = self.body.spacing;
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
        let ledger = self.energy_now();
        if let Some((i, j)) = self.crossed_chain() {
            return Err(RunError::Crossing {
                step: self.step,
                i,
                j,
            });
        }
        let before =
            ledger.initial.abs() + ledger.work_conditions.abs() + ledger.work_indenter.abs();
        let after = ledger.kinetic - self.last_kick()
            + ledger.strain
            + ledger.contact
            + ledger.released
            + ledger.dissipated;
        if !(after <= 10.0 * before + f64::MIN_POSITIVE) && self.step > self.origin.0 {
            return Err(RunError::Unstable {
                step: self.step,
                before,
                after,
                time_step: self.dt,
            });
        }
        Ok(ledger)
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
            size: self.by_id(|i| self.interaction.family_size(i) as u32),
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
        self.interaction.forces(&self.body, &u, &mut f, Sweep::Hold);
        self.vectors(&f)
    }

    fn set_conditions(
        &mut self,
        conditions: &[ConditionSpec],
        sets: &[(String, Vec<u32>)],
        indenters: &[IndenterSpec],
    ) -> Result<(), BuildError> {
        let (mut loads, mut constraints) = (vec![], vec![]);
        for (n, c) in conditions.iter().enumerate() {
            let (slots, points) = self.members(&c.set, sets).map_err(|e| BuildError {
                path: format!("conditions[{n}].set"),
                ..e
            })?;
            let load = |kind| Load::new(kind, slots.clone(), points.clone());
            match &c.kind {
                ConditionKind::BodyForce(e) => {
                    loads.push(load(LoadKind::Body(Program::new(e, &points))))
                }
                ConditionKind::SetForce(e) => {
                    loads.push(load(LoadKind::Replace(Program::new(e, &points))))
                }
                ConditionKind::Damping(e) => loads.push(load(LoadKind::Damping(Program::new(
                    &[Some(e.clone()), None, None],
                    &points,
                )))),
                ConditionKind::Traction { value, area } => {
                    let volume: f64 = slots.iter().map(|s| self.body.volume.at(*s as usize)).sum();
                    let face = self
                        .body
                        .volume
                        .at(slots.first().map_or(0, |s| *s as usize))
                        / self.body.spacing;
                    let area = area.unwrap_or(face * slots.len() as f64);
                    loads.push(load(LoadKind::Body(
                        Program::new(value, &points).scaled(area / volume),
                    )));
                }
                ConditionKind::Displacement(e) => constraints.push(Constraint::new(
                    Prescribed::Displacement,
                    Program::new(e, &points),
                    slots,
                    points,
                )),
                ConditionKind::Velocity(e) => constraints.push(Constraint::new(
                    Prescribed::Velocity,
                    Program::new(e, &points),
                    slots,
                    points,
                )),
            }
        }
        // damping looks at what was added, and a replaced force is replaced whatever else there is
        loads.sort_by_key(|l: &Load<D>| match l.kind {
            LoadKind::Body(_) => 0,
            LoadKind::Damping(_) => 1,
            LoadKind::Replace(_) => 2,
        });
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
        let component = |x: &Field<D>, a: usize, i: usize| x.get(a).map_or(0.0, |c| c[i]);
        let body = &self.body;
        for (value, &s) in out.iter_mut().zip(&body.slots[first..]) {
            let i = s as usize;
            *value = match field {
                PointField::Reference(a) => body.position(i)[a],
                PointField::Displacement(a) => component(&self.u, a, i),
                PointField::Velocity(a) => component(&self.v, a, i),
                PointField::Force(a) => component(&self.f, a, i),
                PointField::Volume => body.volume.at(i),
                PointField::Density => body.density.at(i),
                PointField::CriticalStretch => self.interaction.critical_stretch(i),
            };
        }
    }

    fn write(&mut self, field: PointField, first: usize, values: &[f64]) {
        self.finish();
        self.virial = None;
        let component = match field {
            PointField::Displacement(a) => self.u.get_mut(a),
            PointField::Velocity(a) => self.v.get_mut(a),
            _ => None,
        };
        let Some(component) = component else { return };
        if let Some(contact) = &mut self.contact {
            contact.look_again();
        }
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

    fn set_still(&mut self, ids: &[u32]) {
        self.finish();
        let slots = ids.iter().map(|id| self.body.slots[*id as usize]);
        self.still = Still::new(slots.collect());
    }
}

/// The part of the balance that must stay as it is from now on.
fn ledger_base(l: &Ledger) -> f64 {
    l.kinetic + l.strain + l.contact + l.released + l.dissipated
        - l.work_conditions
        - l.work_indenter
}
