//! What may be seen of a model: its columns by name, and the state that observables look at.

use super::model::Model;
use super::system::System;
use crate::body::view;
use crate::columns::{Declaration, Life, On};
use crate::constitutive::Registry;
use crate::error::BuildError;
use crate::expression::nearest;
use crate::fracture::fragments::Fragments;
use crate::interaction::history;
use crate::interaction::{BondForce, BondStatus};
use crate::observe::observables::{Needs, Observable};
use crate::observe::{Column, FamilyBond, Observed, PointForce, Snapshot, State, Values};
use crate::space::{Point, full};

/// The state of a model, and what was computed of it already.
pub(super) struct View<'a, const D: usize> {
    system: &'a mut System<D>,
    registry: &'a Registry,
    /// Boltzmann's constant (energy / temperature).
    boltzmann: f64,
    /// Id of every slot of a point.
    id: Vec<u32>,
    seen: Option<Observed>,
}

impl<'a, const D: usize> View<'a, D> {
    pub fn of(system: &'a mut System<D>, registry: &'a Registry, boltzmann: f64) -> Self {
        View {
            system,
            registry,
            boltzmann,
            id: vec![],
            seen: None,
        }
    }

    fn slot(&self, id: usize) -> usize {
        self.system.body.slots()[id] as usize
    }

    fn ids(&mut self) {
        if self.id.is_empty() {
            self.id = self.system.body.ids_by_slot();
        }
    }
}

impl<const D: usize> State for View<'_, D> {
    fn dimension(&self) -> usize {
        D
    }

    fn points(&self) -> usize {
        self.system.body.points()
    }

    fn reference(&self, id: usize) -> Point {
        self.system.body.position(self.slot(id))
    }

    fn displacement(&self, id: usize) -> Point {
        let s = self.slot(id);
        full(&crate::array::from_fn::<_, D, _>(|a| self.system.u[a][s]))
    }

    fn velocity(&self, id: usize) -> Point {
        let s = self.slot(id);
        full(&crate::array::from_fn::<_, D, _>(|a| self.system.v[a][s]))
    }

    fn force_density(&self, id: usize) -> Point {
        let s = self.slot(id);
        full(&crate::array::from_fn::<_, D, _>(|a| self.system.f[a][s]))
    }

    fn volume(&self, id: usize) -> f64 {
        self.system.body.volume().at(self.slot(id))
    }

    fn density(&self, id: usize) -> f64 {
        self.system.body.density().at(self.slot(id))
    }

    fn material(&self, id: usize) -> usize {
        self.system.body.material_of(self.slot(id))
    }

    fn mark(&self, id: usize) -> i32 {
        self.system.body.marks().get(id).copied().unwrap_or(0)
    }

    fn bodies(&self) -> usize {
        self.system.body.pieces().len().max(1)
    }

    fn body(&self, id: usize) -> usize {
        match self.system.body.pieces() {
            [] => 0,
            _ => self.system.body.piece_of(self.slot(id)),
        }
    }

    fn is_atomic(&self) -> bool {
        self.system.interaction.is_potential()
    }

    fn boltzmann(&self) -> f64 {
        self.boltzmann
    }

    fn energies(&mut self) -> &Observed {
        let system = &mut *self.system;
        self.seen.get_or_insert_with(|| system.observed())
    }

    fn kinetic_energy_density(&mut self) -> Vec<f64> {
        let (body, v) = (&self.system.body, &self.system.v);
        let dot = |x: &[f64; D], y: &[f64; D]| (0..D).map(|a| x[a] * y[a]).sum::<f64>();
        let Some(inertia) = &self.system.inertia else {
            return body.by_id(|i| {
                let v = crate::array::from_fn(|a| v[a][i]);
                0.5 * body.density().at(i) * dot(&v, &v)
            });
        };
        let v = body.values(v);
        let momentum = inertia.masses.times(body, &v);
        let volume = body.by_id(|i| body.volume().at(i));
        let each = v.iter().zip(&momentum).zip(volume);
        each.map(|((v, p), volume)| 0.5 * dot(v, p) / volume)
            .collect()
    }

    fn damage(&mut self) -> Vec<f64> {
        let mut damage = vec![0.0; self.system.body.len()];
        self.system
            .interaction
            .damage(&self.system.body, &mut damage);
        self.system.body.by_id(|i| damage[i])
    }

    fn fragments(&mut self) -> Vec<u32> {
        Fragments::of(&self.system.body, self.system.interaction.as_ref()).label
    }

    fn each_bond(&mut self, visit: &mut dyn FnMut(FamilyBond)) {
        self.ids();
        let (system, id) = (&*self.system, &self.id);
        let (body, u) = (&system.body, &system.u);
        system
            .interaction
            .each_partner(body, &mut |i, j, xi, state| {
                if state == BondStatus::Absent {
                    return;
                }
                let r0 = xi.iter().map(|x| x * x).sum::<f64>().sqrt();
                let eta: [f64; D] = crate::array::from_fn(|a| u[a][j] - u[a][i]);
                visit(FamilyBond {
                    id: id[i] as usize,
                    xi: full(&xi),
                    eta: full(&eta),
                    weight: system.constitutive.at(body, i).weight(&xi, r0),
                    volume: body.volume().at(j),
                    whole: state == BondStatus::Whole,
                });
            });
    }

    fn each_force(&mut self, visit: &mut dyn FnMut(PointForce)) -> bool {
        self.ids();
        let (id, called) = (&self.id, self.system.body.id_of());
        self.system.each_pair_force(&mut |bond| {
            visit(PointForce {
                id: id[bond.i] as usize,
                partner: called(bond.j) as usize,
                y: full(&bond.y),
                force: full(&bond.force),
                own: bond.own.as_ref().map(full),
            });
        })
    }
}

impl<const D: usize> Model<D> {
    /// A look at the model as it stands.
    pub(super) fn look(&mut self) -> View<'_, D> {
        View::of(&mut self.system, &self.names.registry, self.boltzmann)
    }

    /// A look with velocities and images up to date.
    pub(super) fn view(&mut self) -> View<'_, D> {
        self.finish();
        self.system.refresh_images();
        self.look()
    }

    /// Columns by name, in this order; what does not exist is left out.
    pub(super) fn columns_of<'a>(&mut self, names: impl Iterator<Item = &'a str>) -> Vec<Column> {
        let mut view = self.view();
        names.filter_map(|name| view.column(name)).collect()
    }

    /// Sets a persistent column of the law, by point id or in the order of its bonds; what follows from it is found anew.
    pub(super) fn store(&mut self, name: &str, values: &[f64]) -> bool {
        // velocities belong to the forces of before
        self.finish();
        if self.system.set_transferred(name, values) {
            self.stale = true;
            return true;
        }
        let mut declared = self.system.interaction.columns().into_iter();
        let Some(column) = declared.find(|c| c.name == name && c.life == Life::Persistent) else {
            return false;
        };
        let broken = (name == history::WHOLE).then(|| self.system.count_broken());
        let written = match column.on {
            On::Bonds => self
                .system
                .interaction
                .write_column(&self.system.body, name, values),
            On::Points => {
                let n = column.shape.stored(D);
                if values.len() != n * self.system.body.points() {
                    return false;
                }
                let mut stored = vec![0.0; n * self.system.body.len()];
                for (value, &s) in values.chunks_exact(n).zip(self.system.body.slots()) {
                    stored[n * s as usize..n * (s as usize + 1)].copy_from_slice(value);
                }
                self.system
                    .interaction
                    .write_column(&self.system.body, name, &stored)
            }
        };
        if let Some(before) = broken.filter(|_| written) {
            let broken = self.system.accounts.swept.broken + self.system.count_broken();
            self.system.accounts.swept.broken = broken.saturating_sub(before);
            self.system.break_diffusions();
        }
        self.stale |= written;
        written
    }

    pub(super) fn record(&mut self, fields: &[&str], bonds: bool) -> Snapshot {
        let first = ["displacement"].into_iter();
        let others = fields.iter().copied().filter(|f| *f != "displacement");
        let columns = self.columns_of(first.chain(others));
        let load_may_fall = self.system.regime.load_may_fall;
        Snapshot {
            step: self.system.clock.step(),
            time: self.system.clock.of_frame(load_may_fall),
            dimension: D,
            spacing: self.system.body.spacing(),
            reference: self.system.body.by_id(|i| self.system.body.position(i)),
            columns,
            bonds: bonds.then(|| self.system.whole_bonds()),
        }
    }
}

impl<const D: usize> System<D> {
    /// Energies and dilatation of all points now, contact too.
    pub(super) fn observed(&mut self) -> Observed {
        self.refresh_images();
        let mut out = self.seen_now();
        if let Some(pairs) = &mut self.contact {
            pairs.find(&self.body, &self.u, self.interaction.as_ref());
            let repulsion = &mut out.repulsion;
            pairs
                .central
                .add_energy_density(&self.body, &self.u, repulsion);
        }
        self.observed_of(&out)
    }

    /// Forces of bonds, of repulsion inside families and of contact, from each of their points. Those of the linear body where that
    /// is what the state stands for. False: a law has no forces of single bonds.
    pub(super) fn each_pair_force(&mut self, visit: &mut dyn FnMut(BondForce<D>)) -> bool {
        if self.is_linear() {
            let (u, small) = self.made_small();
            return self
                .interaction
                .each_force(&self.body, view(&u), &mut |bond| {
                    visit(BondForce {
                        force: bond.force.map(|f| f / small),
                        own: bond.own.map(|own| own.map(|f| f / small)),
                        ..bond
                    });
                });
        }
        let bonds = &mut self.interaction;
        let known = bonds.each_force(&self.body, view(&self.u), visit);
        if let Some(contact) = &mut self.contact {
            contact.each_force(bonds.as_ref(), &self.body, &self.u, visit);
        }
        known
    }

    /// Directed bonds of the family that are broken.
    fn count_broken(&self) -> u64 {
        let mut broken = 0;
        self.interaction
            .each_bond(&self.body, &mut |_, _, _, state| {
                broken += 2 * u64::from(state == BondStatus::Broken);
            });
        broken
    }

    /// Ids of the ends of whole bonds, the lower first.
    fn whole_bonds(&self) -> Vec<(u32, u32)> {
        let (id, mut bonds) = (self.body.id_of(), vec![]);
        self.interaction
            .each_bond(&self.body, &mut |i, j, _, state| {
                if state == BondStatus::Whole {
                    let (a, b) = (id(i), id(j));
                    bonds.push((a.min(b), a.max(b)));
                }
            });
        bonds
    }
}

impl<const D: usize> View<'_, D> {
    /// Has the model what an observable needs, as far as that can be said without a look at its forces?
    fn may(&self, of: &Observable) -> bool {
        let atomic = self.system.interaction.is_potential();
        match of.needs {
            Needs::Nothing | Needs::Forces => true,
            Needs::Bodies => self.system.body.pieces().len() > 1,
            Needs::Atoms => atomic,
            Needs::Family => !atomic,
        }
    }

    /// Why there is no column of this observable here; `None`: there is one.
    fn lacking(&mut self, of: &Observable) -> Option<&'static str> {
        let mut there = self.may(of);
        if there && of.needs == Needs::Forces {
            there = self.look_forces();
        }
        (!there).then(|| of.needs.missing())
    }

    /// What points make of their bonds is that of now. False: a law has no forces of single bonds.
    fn look_forces(&mut self) -> bool {
        let system = &mut *self.system;
        system.refresh_images();
        let (body, u) = (&system.body, view(&system.u));
        system.interaction.each_force(body, u, &mut |_| {})
    }

    /// Is there a column of each of these names?
    pub(super) fn check_fields(&mut self, names: &[String]) -> Result<(), BuildError> {
        for (n, name) in names.iter().enumerate() {
            let path = format!("output.fields[{n}]");
            self.check_column(name, &path)?;
        }
        Ok(())
    }

    /// The declaration of a column of points; `path` is what asks for it.
    pub(super) fn check_column(
        &mut self,
        name: &str,
        path: &str,
    ) -> Result<Declaration, BuildError> {
        if let Some(found) = self
            .system
            .diffusion_columns()
            .into_iter()
            .find(|c| c.name == name)
        {
            return Ok(found);
        }
        if let Some(observable) = self.registry.observable(name) {
            return match self.lacking(observable) {
                None => Ok(observable.declaration.clone()),
                Some(why) => Err(BuildError::unsupported(
                    path,
                    format!("there is no {name} here: {why}"),
                )),
            };
        }
        let known = self.declared();
        match known.iter().find(|c| c.name == name) {
            Some(column) if column.on == On::Points => Ok(column.clone()),
            Some(_) => Err(BuildError::invalid(
                path,
                format!("`{name}` is a column of bonds, not of points"),
            )),
            None => {
                let of_points = known.iter().filter(|c| c.on == On::Points);
                let names: Vec<&str> = of_points.map(|c| &*c.name).collect();
                let help = match nearest(name, names.iter().copied()) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => format!("known are {}", names.join(", ")),
                };
                Err(BuildError::unknown(path, name, format!("unknown field `{name}`")).help(help))
            }
        }
    }

    /// Everything that has a name and values.
    pub(super) fn declared(&mut self) -> Vec<Declaration> {
        let mut all = self.system.diffusion_columns();
        for observable in self.registry.observables().to_vec() {
            if self.lacking(observable).is_none()
                && !all.iter().any(|c| c.name == observable.declaration.name)
            {
                all.push(observable.declaration.clone());
            }
        }
        for column in self.system.interaction.columns() {
            if !all.iter().any(|c| c.name == column.name) {
                all.push(column);
            }
        }
        all
    }

    fn column(&mut self, name: &str) -> Option<Column> {
        if let Some(values) = self.system.transferred(name) {
            let mut declared = self.system.diffusion_columns().into_iter();
            return Some(Column {
                declaration: declared.find(|c| c.name == name)?,
                values: Values::Scalars(values),
            });
        }
        match self.registry.observable(name) {
            Some(observable) if !self.may(observable) => None,
            Some(observable) => Some(Column {
                declaration: observable.declaration.clone(),
                values: (observable.of)(self)?,
            }),
            None => self.of_law(name),
        }
    }

    /// A column that the law declares.
    fn of_law(&mut self, name: &str) -> Option<Column> {
        let mut declared = self.system.interaction.columns().into_iter();
        let declaration = declared.find(|c| c.name == name)?;
        if declaration.life == Life::Derived && declaration.on == On::Points {
            // of the last evaluation of forces, which may have been another state's
            self.look_forces();
        }
        let system = &*self.system;
        let (body, mut stored) = (&system.body, vec![]);
        if !system
            .interaction
            .read_column(body, view(&system.u), name, &mut stored)
        {
            return None;
        }
        if declaration.on == On::Points {
            let n = declaration.shape.stored(D);
            let of = |s: &u32| &stored[n * *s as usize..n * (*s as usize + 1)];
            stored = body.slots().iter().flat_map(of).copied().collect();
        }
        Some(Column {
            values: Values::unpacked(declaration.shape, D, &stored),
            declaration,
        })
    }
}
