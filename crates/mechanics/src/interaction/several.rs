//! Interactions of several bodies side by side: each sweeps over its own bonds and its own part of the columns, and interfaces over
//! bonds between two.

mod columns;

use super::interface::{Interface, has_bonds};
use super::{
    BondFatigue, BondForce, BondStatus, BondTangent, Crosses, EachBond, EachForce, EachPair,
    EachTangent, FactorsOf, Gradient, Heals, Interaction, PointEnergiesMut, Sweep, Tally, history,
};
use crate::body::several::Piece;
use crate::body::{Body, FieldView, FieldViewMut, Identity, Layout, view, view_mut};
use crate::columns::{Declaration, On};
use crate::error::BuildError;
use crate::law::BondFactors;
use crate::spec::{CrackKind, Cycles};
use crate::state::Archive;

/// One body's bonds.
struct Own<const D: usize> {
    /// First slot.
    first: usize,
    /// `None`: loose points.
    bonds: Option<Box<dyn Interaction<D>>>,
}

/// Interactions of several bodies, in their order.
pub struct MultiBodyInteraction<const D: usize> {
    body: Identity,
    own: Vec<Own<D>>,
    /// Where their slots end: behind them are copies.
    end: usize,
    interfaces: Vec<Interface<D>>,
    /// Family of those that have bonds.
    family: &'static str,
}

/// A sweep as the bonds of one body see it.
fn of_piece<'a, const D: usize>(p: &Piece<D>, sweep: Sweep<'a, D>) -> Sweep<'a, D> {
    match sweep {
        Sweep::Evolve { v, steps, breakage } => Sweep::Evolve {
            v: p.part(v),
            steps,
            breakage,
        },
        Sweep::Hold => Sweep::Hold,
    }
}

impl<const D: usize> MultiBodyInteraction<D> {
    /// One interaction for each body that `body` is made of, `None` for loose points, and those between two.
    pub fn new(
        body: &Body<D>,
        bonds: Vec<Option<Box<dyn Interaction<D>>>>,
        interfaces: Vec<Interface<D>>,
    ) -> Self {
        let mut kinds = bonds.iter().flatten().map(|i| i.family());
        let family = match kinds.next() {
            None => "none",
            Some(first) if kinds.all(|k| k == first) => first,
            Some(_) => "stencil and list",
        };
        let end = pieces(body).last().map_or(0, |p| p.range().end);
        let own = pieces(body).iter().zip(bonds).map(|(p, bonds)| Own {
            first: p.first,
            bonds,
        });
        MultiBodyInteraction {
            body: body.identity,
            own: own.collect(),
            end,
            interfaces,
            family,
        }
    }

    /// The bonds of all bodies.
    fn all(&self) -> impl Iterator<Item = &dyn Interaction<D>> {
        self.own.iter().filter_map(|own| own.bonds.as_deref())
    }

    /// Bonds of bodies, and of interfaces.
    fn all_mut(&mut self) -> impl Iterator<Item = &mut Box<dyn Interaction<D>>> {
        let own = self.own.iter_mut().filter_map(|own| own.bonds.as_mut());
        own.chain(self.interfaces.iter_mut().map(|i| &mut i.bonds))
    }

    /// Bodies with bonds, to be changed.
    fn each_mut<'a>(
        &'a mut self,
        body: &'a Body<D>,
    ) -> impl Iterator<Item = (&'a Piece<D>, &'a mut Box<dyn Interaction<D>>)> {
        let all = pieces(body).iter().zip(&mut self.own);
        all.filter_map(|(p, own)| own.bonds.as_mut().map(|bonds| (p, bonds)))
    }

    /// Bodies with bonds.
    fn each<'a>(
        &'a self,
        body: &'a Body<D>,
    ) -> impl Iterator<Item = (&'a Piece<D>, &'a dyn Interaction<D>)> {
        let all = pieces(body).iter().zip(&self.own);
        all.filter_map(|(p, own)| own.bonds.as_deref().map(|bonds| (p, bonds)))
    }

    /// The body of a slot, and the slot in it; `None`: a copy of a point whose bonds are not here.
    fn place(&self, slot: usize) -> Option<(usize, usize)> {
        let n = self.own.partition_point(|o| o.first <= slot) - 1;
        (slot < self.end).then(|| (n, slot - self.own[n].first))
    }

    /// What the interaction of a slot's body says of it; `None`: a loose point.
    fn at<T>(&self, slot: usize, of: impl Fn(&dyn Interaction<D>, usize, usize) -> T) -> Option<T> {
        let (n, own) = self.place(slot)?;
        self.own[n].bonds.as_deref().map(|bonds| of(bonds, n, own))
    }
}

fn pieces<const D: usize>(body: &Body<D>) -> &[Piece<D>] {
    match &body.layout {
        Layout::Several(pieces) => pieces,
        Layout::Grid(_) | Layout::Cloud(_) => unreachable!("made for several bodies"),
    }
}

impl<const D: usize> Interaction<D> for MultiBodyInteraction<D> {
    fn made_for(&self) -> Identity {
        self.body
    }

    fn family(&self) -> &'static str {
        self.family
    }

    fn begin_forces(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        mut f: FieldViewMut<D>,
        sweep: Sweep<D>,
    ) {
        self.check(body, &[u, view(&f)]);
        for (p, own) in pieces(body).iter().zip(&mut self.own) {
            if let Some(bonds) = &mut own.bonds {
                let into = p.part_mut(view_mut(&mut f));
                bonds.begin_forces(&p.body, p.part(u), into, of_piece(p, sweep));
            }
        }
    }

    fn meanwhile(&self) -> [usize; 2] {
        // one message has the motion of all; who cannot begin waits for it
        let all = self.all().map(|bonds| bonds.meanwhile());
        all.reduce(|[a, b], [c, d]| [a.min(c), b.min(d)])
            .unwrap_or_default()
    }

    unsafe fn forces_unchecked(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        mut f: FieldViewMut<D>,
        sweep: Sweep<D>,
        mut seen: Option<&mut PointEnergiesMut>,
    ) -> Tally {
        if let Some(seen) = &mut seen {
            seen.zeros(body.len);
        }
        let mut total = Tally::default();
        for (p, own) in pieces(body).iter().zip(&mut self.own) {
            let Some(bonds) = &mut own.bonds else {
                for a in 0..D {
                    f[a][p.range()].fill(0.0);
                }
                continue;
            };
            let sweep = of_piece(p, sweep);
            let mut watch = seen.as_deref_mut().map(|seen| seen.part(p.range()));
            let into = p.part_mut(view_mut(&mut f));
            let mut tally = bonds.forces(&p.body, p.part(u), into, sweep, watch.as_mut());
            tally.fault = tally.fault.map(|fault| fault.at(|s| s + p.first));
            total += tally;
        }
        for interface in &mut self.interfaces {
            total += interface.forces(u, view_mut(&mut f), sweep, seen.as_deref_mut());
        }
        total
    }

    fn last(&mut self, step: f64) {
        self.all_mut().for_each(|bonds| bonds.last(step));
    }

    fn begin_steps(&mut self, body: &Body<D>) {
        self.check(body, &[]);
        for (p, bonds) in self.each_mut(body) {
            bonds.begin_steps(&p.body);
        }
    }

    fn warm(&mut self, body: &Body<D>, above: &[f64]) -> bool {
        self.check(body, &[]);
        let mut any = false;
        for (p, bonds) in self.each_mut(body) {
            any |= bonds.warm(&p.body, &above[p.range()]);
        }
        any
    }

    fn expand(&mut self, body: &Body<D>, strain: &[f64]) -> bool {
        self.check(body, &[]);
        let mut all = true;
        for (p, bonds) in self.each_mut(body) {
            all &= bonds.expand(&p.body, &strain[p.range()]);
        }
        for interface in &mut self.interfaces {
            all &= interface.expand(strain);
        }
        all
    }

    fn fatigue_of_bonds(
        &self,
        body: &Body<D>,
        u: FieldView<D>,
        load: &Cycles,
    ) -> Option<Vec<BondFatigue>> {
        self.check(body, &[u]);
        let all = self.each(body);
        let each = all.filter_map(|(p, bonds)| bonds.fatigue_of_bonds(&p.body, p.part(u), load));
        let between = { self.interfaces.iter() }.filter_map(|i| i.fatigue_of_bonds(u, load));
        each.chain(between).reduce(|mut all, more| {
            all.extend(more);
            all
        })
    }

    fn accumulate_fatigue(&mut self, bonds: &mut dyn Iterator<Item = BondFatigue>, cycles: f64) {
        self.all_mut()
            .for_each(|own| own.accumulate_fatigue(bonds, cycles));
    }

    /// That of the worst.
    fn asymmetry(&self) -> f64 {
        self.all().map(|b| b.asymmetry()).fold(0.0, f64::max)
    }

    /// Of potentials alone: beside them, and in interfaces, may be bonds of solids.
    fn is_potential(&self) -> bool {
        let mut all = self.all().peekable();
        self.interfaces.is_empty() && all.peek().is_some() && all.all(|b| b.is_potential())
    }

    fn has_many_body(&self) -> bool {
        self.all().any(|b| b.has_many_body())
    }

    fn add_stress_across(&mut self, body: &Body<D>, u: FieldView<D>, trace: &mut [f64]) -> bool {
        self.check(body, &[u]);
        let mut all = true;
        for (p, bonds) in self.each_mut(body) {
            all &= bonds.add_stress_across(&p.body, p.part(u), &mut trace[p.range()]);
        }
        all
    }

    fn read_warmth(&self, body: &Body<D>, above: &mut [f64]) {
        self.check(body, &[]);
        for (p, bonds) in self.each(body) {
            bonds.read_warmth(&p.body, &mut above[p.range()]);
        }
    }

    fn shortest(&mut self, body: &Body<D>, u: FieldView<D>) -> f64 {
        self.check(body, &[u]);
        let mut least = 1.0f64;
        for (p, bonds) in self.each_mut(body) {
            least = least.min(bonds.shortest(&p.body, p.part(u)));
        }
        least
    }

    unsafe fn energy_unchecked(&mut self, body: &Body<D>, u: FieldView<D>) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for (p, bonds) in self.each_mut(body) {
            let [strain, repulsion] = bonds.energy(&p.body, p.part(u));
            sum = [sum[0] + strain, sum[1] + repulsion];
        }
        for interface in &mut self.interfaces {
            let [strain, repulsion] = interface.energy(u);
            sum = [sum[0] + strain, sum[1] + repulsion];
        }
        sum
    }

    unsafe fn observe_unchecked(
        &self,
        body: &Body<D>,
        u: FieldView<D>,
        out: &mut PointEnergiesMut,
    ) {
        out.zeros(body.len);
        for (p, bonds) in self.each(body) {
            bonds.observe(&p.body, p.part(u), &mut out.part(p.range()));
        }
        for interface in &self.interfaces {
            interface.observe(u, out);
        }
    }

    fn observe_gradient(&self, body: &Body<D>, gradient: &Gradient<D>, out: &mut PointEnergiesMut) {
        self.check(body, &[]);
        out.zeros(body.len);
        for (p, bonds) in self.each(body) {
            bonds.observe_gradient(&p.body, gradient, &mut out.part(p.range()));
        }
        for interface in &self.interfaces {
            interface.observe_gradient(gradient, out);
        }
    }

    unsafe fn tangents_unchecked(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        visit: &mut EachTangent<D>,
    ) {
        for (p, bonds) in self.each_mut(body) {
            bonds.tangents(&p.body, p.part(u), &mut |bond| {
                visit(BondTangent {
                    i: bond.i + p.first,
                    j: bond.j + p.first,
                    ..bond
                });
            });
        }
        for interface in &mut self.interfaces {
            interface.tangents(u, visit);
        }
    }

    fn each_force(&mut self, body: &Body<D>, u: FieldView<D>, visit: &mut EachForce<D>) -> bool {
        let mut all = true;
        for (p, bonds) in self.each_mut(body) {
            all &= bonds.each_force(&p.body, p.part(u), &mut |bond| {
                visit(BondForce {
                    i: bond.i + p.first,
                    j: bond.j + p.first,
                    ..bond
                });
            });
        }
        for interface in &mut self.interfaces {
            all &= interface.each_force(u, visit);
        }
        all
    }

    fn columns(&self) -> Vec<Declaration> {
        let mut all: Vec<Declaration> = vec![];
        // points of interfaces are those of bodies; their bonds are their own
        let of_bonds = |c: &Declaration| c.on == On::Bonds;
        let between = self.interfaces.iter().flat_map(|i| i.bonds.columns());
        let own = self.all().flat_map(|bonds| bonds.columns());
        for column in own.chain(between.filter(of_bonds)) {
            if !all.iter().any(|c| c.name == column.name) {
                all.push(column);
            }
        }
        all
    }

    fn criticals_between(&self) -> Vec<Vec<f64>> {
        self.interfaces.iter().map(|i| i.criticals()).collect()
    }

    fn read_column(&self, body: &Body<D>, u: FieldView<D>, name: &str, out: &mut Vec<f64>) -> bool {
        self.read_named(body, u, name, out)
    }

    fn write_column(&mut self, body: &Body<D>, name: &str, values: &[f64]) -> bool {
        self.write_named(body, name, values)
    }

    fn each_directed(&self, body: &Body<D>, name: &str, visit: &mut EachPair<D>) {
        for (p, bonds) in self.each(body).filter(|(_, bonds)| has_bonds(*bonds, name)) {
            bonds.each_directed(&p.body, name, &mut |i, j, xi| {
                visit(i + p.first, j + p.first, xi);
            });
        }
        for interface in &self.interfaces {
            interface.each_directed(name, visit);
        }
    }

    fn gain(&self, slot: usize) -> f64 {
        self.at(slot, |bonds, _, s| bonds.gain(s)).unwrap_or(0.0)
    }

    fn each_bond(&self, body: &Body<D>, visit: &mut EachBond<D>) {
        for (p, bonds) in self.each(body) {
            bonds.each_bond(&p.body, &mut |i, j, xi, state| {
                visit(i + p.first, j + p.first, xi, state);
            });
        }
        for interface in &self.interfaces {
            interface.each_bond(visit);
        }
    }

    fn each_partner(&self, body: &Body<D>, visit: &mut EachBond<D>) {
        for (p, bonds) in self.each(body) {
            bonds.each_partner(&p.body, &mut |i, j, xi, state| {
                visit(i + p.first, j + p.first, xi, state);
            });
        }
        for interface in &self.interfaces {
            interface.each_partner(visit);
        }
    }

    fn mend(&mut self, body: &Body<D>, u: FieldView<D>, heals: &Heals) -> Option<u64> {
        let mut sum = None;
        // springs and micromoduli beside them have no bonds that break
        for (p, bonds) in self.each_mut(body) {
            if has_bonds(bonds.as_ref(), history::WHOLE) {
                let heals = |i: usize, j: usize, e: f64| heals(i + p.first, j + p.first, e);
                let mended = bonds.mend(&p.body, p.part(u), &heals)?;
                sum = Some(sum.unwrap_or(0) + mended);
            }
        }
        for interface in &mut self.interfaces {
            let mended = interface.mend(u, heals)?;
            sum = Some(sum.unwrap_or(0) + mended);
        }
        sum
    }

    fn each_broken(&self, body: &Body<D>, visit: &mut EachPair<D>) {
        for (p, bonds) in self.each(body) {
            bonds.each_broken(&p.body, &mut |i, j, xi| visit(i + p.first, j + p.first, xi));
        }
    }

    fn work_borne(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        visit: &mut dyn FnMut(usize, usize, [f64; D], f64),
    ) -> bool {
        let mut any = false;
        for (p, bonds) in self.each_mut(body) {
            any |= bonds.work_borne(&p.body, p.part(u), &mut |i, j, xi, part| {
                visit(i + p.first, j + p.first, xi, part);
            });
        }
        for interface in &mut self.interfaces {
            any |= interface.work_borne(u, visit);
        }
        any
    }

    fn stress_borne(&mut self, body: &Body<D>, u: FieldView<D>) -> Option<Vec<f64>> {
        self.check(body, &[u]);
        let mut all = None;
        for (p, bonds) in self.each_mut(body) {
            if let Some(of) = bonds.stress_borne(&p.body, p.part(u)) {
                let all = all.get_or_insert_with(|| vec![f64::NAN; body.len]);
                all[p.range()].copy_from_slice(&of);
            }
        }
        all
    }

    fn bond_limit(&self, ends: [usize; 2], xi: &[f64; D], critical: [f64; 2]) -> f64 {
        let of = |slot: usize| self.place(slot).map(|(n, _)| n);
        let own = of(ends[0]).filter(|n| of(ends[1]) == Some(*n));
        let own = own.map(|n| &self.own[n]);
        match own.and_then(|own| Some((own.first, own.bonds.as_ref()?))) {
            Some((first, bonds)) => bonds.bond_limit(ends.map(|s| s - first), xi, critical),
            // of an interface
            None => history::limit(critical[0], critical[1]),
        }
    }

    fn damage(&self, body: &Body<D>, out: &mut [f64]) {
        out.fill(0.0);
        for (p, bonds) in self.each(body) {
            bonds.damage(&p.body, &mut out[p.range()]);
        }
        if self.interfaces.is_empty() {
            return;
        }
        // of points in interfaces, all bonds together
        let mut joined = vec![false; body.len];
        for interface in &self.interfaces {
            interface.each_partner(&mut |i, _, _, state| {
                joined[i] |= state != BondStatus::Absent;
            });
        }
        let mut family = vec![[0.0; 2]; body.len];
        self.each_partner(body, &mut |i, j, _, state| {
            if state == BondStatus::Absent {
                return;
            }
            let volume = body.volume.at(j);
            family[i][0] += volume;
            if state == BondStatus::Broken {
                family[i][1] += volume;
            }
        });
        for (s, [all, broken]) in family.into_iter().enumerate() {
            if joined[s] {
                out[s] = broken / all;
            }
        }
    }

    fn cut(&mut self, body: &Body<D>, kind: CrackKind, crosses: &Crosses<D>) -> u64 {
        let all = self.each_mut(body);
        let inside: u64 = all.map(|(p, b)| b.cut(&p.body, kind, crosses)).sum();
        let between = self.interfaces.iter_mut().map(|i| i.cut(kind, crosses));
        inside + between.sum::<u64>()
    }

    fn scale_bonds(&mut self, body: &Body<D>, factors: &FactorsOf<D>) -> Result<(), BuildError> {
        for (p, bonds) in self.each_mut(body) {
            let of = |i: usize, j: usize, c| factors(i + p.first, j + p.first, c);
            bonds.scale_bonds(&p.body, &of)?;
        }
        let mut between = self.interfaces.iter_mut();
        between.try_for_each(|i| i.scale_bonds(factors))
    }

    fn reached(&self, body: &Body<D>, i: usize, xi: [f64; D]) -> Option<(f64, BondFactors<f64>)> {
        self.at(i, |bonds, n, s| bonds.reached(&pieces(body)[n].body, s, xi))?
    }

    fn prepare(&mut self, body: &Body<D>) {
        self.check(body, &[]);
        for (p, bonds) in self.each_mut(body) {
            bonds.prepare(&p.body);
        }
        self.interfaces.iter_mut().for_each(Interface::prepare);
    }

    fn directed_bonds(&self) -> u64 {
        let all = self.all();
        let between = self.interfaces.iter().map(Interface::directed_bonds);
        all.map(|b| b.directed_bonds()).chain(between).sum()
    }

    fn family_size(&self, body: &Body<D>, slot: usize) -> usize {
        let size =
            |bonds: &dyn Interaction<D>, n: usize, s| bonds.family_size(&pieces(body)[n].body, s);
        let between = self.interfaces.iter().map(|i| i.family_size(slot));
        self.at(slot, size).unwrap_or(0) + between.sum::<usize>()
    }

    fn near_horizon(&self) -> u64 {
        self.all().map(|b| b.near_horizon()).sum()
    }

    fn in_family(&self, body: &Body<D>, i: usize, j: usize) -> bool {
        let (Some((n, i)), Some((m, j))) = (self.place(i), self.place(j)) else {
            return false;
        };
        let bonds = self.own[n].bonds.as_deref();
        n == m && bonds.is_some_and(|b| b.in_family(&pieces(body)[n].body, i, j))
    }

    fn memory(&self) -> (&[u8], &[f64]) {
        (&[], &[])
    }

    fn archive(&mut self, body: &Body<D>, archive: &mut Archive<'_>) {
        for (p, own) in pieces(body).iter().zip(&mut self.own) {
            archive.given("body", &mut own.bonds, |bonds, archive| {
                bonds.archive(&p.body, archive);
            });
        }
        for interface in &mut self.interfaces {
            archive.within("interface", |archive| interface.archive_bonds(archive));
        }
    }

    fn bytes(&self) -> usize {
        let all = self.all();
        let between = self.interfaces.iter().map(Interface::bytes);
        all.map(|b| b.bytes()).chain(between).sum()
    }
}

#[cfg(test)]
mod tests;
