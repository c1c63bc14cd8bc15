//! Bond by bond: who is bonded with whom, what is broken, and how much of every point's family.

use super::breaking::fibre_limit;
use super::family::{Family, Slots};
use super::law::PointLaw;
use super::state::{BondState, WholeBond, all_whole};
use crate::body::Body;
use crate::execute::lane::TILE;
use crate::interaction::history::Crosses;
use crate::interaction::{BondStatus, PointEnergiesMut, history};
use crate::spec::CrackKind;

impl<const D: usize, F: Family<D>> BondState<D, F> {
    /// Every directed bond of the family that damage counts: group, bond, place.
    pub(super) fn counted(&self) -> impl Iterator<Item = (usize, usize, usize)> {
        self.family.points().flat_map(move |(group, l, _)| {
            let bonds = (0..self.family.bonds(group)).map(move |k| (group, k, l));
            bonds.filter(|(group, k, l)| self.is_counted(*group, *k, *l))
        })
    }

    /// Every directed bond that the family ever had, pre-cracks included: group, bond, place.
    pub fn pairs(&self) -> impl Iterator<Item = (usize, usize, usize)> {
        self.family.points().flat_map(move |(group, l, _)| {
            let bonds = (0..self.family.bonds(group)).map(move |k| (group, k, l));
            bonds.filter(|(group, k, l)| self.family.is_bond(*group, *k, *l))
        })
    }

    pub fn is_whole(&self, group: usize, k: usize, l: usize) -> bool {
        self.alive[self.family.byte(group, k)] >> l & 1 == 1
    }

    pub(super) fn is_counted(&self, group: usize, k: usize, l: usize) -> bool {
        match self.counted.get(self.family.byte(group, k)) {
            Some(bits) => bits >> l & 1 == 1,
            None => self.family.is_bond(group, k, l),
        }
    }

    /// The whole bonds of a point.
    pub fn bonds_of(&self, group: usize, l: usize) -> Vec<WholeBond<D>> {
        let mut all = vec![];
        for k in (0..self.family.bonds(group)).filter(|k| self.is_whole(group, *k, l)) {
            let r = self.family.plain(group, k, l);
            all.push((k, r.xi, r.omega, r.weight));
        }
        all
    }

    /// Directed bonds of the reference family, in order of slots: group, bond and lane.
    pub fn directed(&self) -> impl Iterator<Item = (usize, usize, usize)> {
        let mut points: Vec<_> = self.family.points().collect();
        points.sort_unstable_by_key(|(_, _, slot)| *slot);
        points.into_iter().flat_map(move |(group, l, _)| {
            let bonds = (0..self.family.bonds(group)).map(move |k| (group, k, l));
            bonds.filter(|(group, k, l)| self.is_counted(*group, *k, *l))
        })
    }

    /// [`each_directed`](crate::interaction::Interaction::each_directed)
    pub fn each_directed(&self, body: &Body<D>, visit: &mut dyn FnMut(usize, usize, [f64; D])) {
        for (group, k, l) in self.directed() {
            let i = self.family.rows(group).slot(l);
            let j = body.exchange.original(self.family.ends(group, k).slot(l));
            visit(i, j, self.family.bond(group, k, l).0);
        }
    }

    /// [`each_bond`](crate::interaction::Interaction::each_bond)
    pub fn each_bond(
        &self,
        body: &Body<D>,
        visit: &mut dyn FnMut(usize, usize, [f64; D], BondStatus),
    ) {
        self.each_of(self.counted(), body, visit);
    }

    /// The same of every bond that the family ever had: those of absent cracks are broken, too.
    pub fn each_pair(
        &self,
        body: &Body<D>,
        visit: &mut dyn FnMut(usize, usize, [f64; D], BondStatus),
    ) {
        self.each_of(self.pairs(), body, visit);
    }

    fn each_of(
        &self,
        bonds: impl Iterator<Item = (usize, usize, usize)>,
        body: &Body<D>,
        visit: &mut dyn FnMut(usize, usize, [f64; D], BondStatus),
    ) {
        self.each_half_of(bonds, body, &mut |[group, k, l], [i, j], status| {
            visit(i, j, self.family.bond(group, k, l).0, status);
        });
    }

    /// Every undirected bond that damage counts: group, bond and place, and both ends.
    pub fn each_half(
        &self,
        body: &Body<D>,
        visit: &mut dyn FnMut([usize; 3], [usize; 2], BondStatus),
    ) {
        self.each_half_of(self.counted(), body, visit);
    }

    fn each_half_of(
        &self,
        bonds: impl Iterator<Item = (usize, usize, usize)>,
        body: &Body<D>,
        visit: &mut dyn FnMut([usize; 3], [usize; 2], BondStatus),
    ) {
        for (group, k, l) in bonds {
            let i = self.family.rows(group).slot(l);
            let end = self.family.ends(group, k).slot(l);
            let j = body.exchange.original(end);
            // a bond between a point and its own image counts from one side only
            if i < j || (i == j && end > i) {
                let status = BondStatus::of(self.is_whole(group, k, l));
                visit([group, k, l], [i, j], status);
            }
        }
    }

    /// [`each_broken`](crate::interaction::Interaction::each_broken)
    pub fn each_broken(&self, body: &Body<D>, visit: &mut dyn FnMut(usize, usize, [f64; D])) {
        self.each_broken_of(body, |_| true, visit);
    }

    /// Of those groups alone that may have lost a bond.
    pub fn each_broken_of(
        &self,
        body: &Body<D>,
        torn: impl Fn(usize) -> bool,
        visit: &mut dyn FnMut(usize, usize, [f64; D]),
    ) {
        self.each_half_of(self.lost(torn), body, &mut |[group, k, l], [i, j], _| {
            visit(i, j, self.family.bond(group, k, l).0);
        });
    }

    /// Every directed bond of the family that is not whole, those of absent cracks too, of groups that may have lost one: group, bond, place.
    pub(super) fn lost(
        &self,
        torn: impl Fn(usize) -> bool,
    ) -> impl Iterator<Item = (usize, usize, usize)> {
        let groups = (0..self.family.groups()).filter(move |n| torn(*n));
        groups.flat_map(move |group| {
            let bits = self.family.bits(&self.alive, group).iter().enumerate();
            // most are whole
            let lost = bits.filter(|(_, bits)| **bits != 0xff);
            lost.flat_map(move |(k, bits)| {
                let lanes = (0..TILE).filter(move |l| bits >> l & 1 == 0);
                let there = move |l: &usize| {
                    self.family.is_point(group, *l) && self.family.is_bond(group, k, *l)
                };
                lanes.filter(there).map(move |l| (group, k, l))
            })
        })
    }

    /// [`bond_limit`](crate::interaction::Interaction::bond_limit), where there are fibres.
    pub fn bond_limit(&self, ends: [usize; 2], xi: &[f64; D], critical: [f64; 2]) -> f64 {
        let of = |n: usize| match self.law.fibres.get(self.material_at(ends[n])) {
            Some(f) => fibre_limit(&f.direction, f.critical, critical[n], xi),
            None => critical[n],
        };
        history::limit(of(0), of(1))
    }

    /// Damage `1 − Σ V_j (whole) / Σ V_j (family)` per slot.
    pub fn damage(&self, body: &Body<D>, out: &mut [f64]) {
        self.damage_of(body, |j| body.volume.at(j), out);
    }

    /// The same with what bonds to a point count for.
    pub fn damage_of(&self, body: &Body<D>, counts: impl Fn(usize) -> f64, out: &mut [f64]) {
        out.fill(0.0);
        for (group, l, i) in self.family.points() {
            // most groups have lost nothing
            let bits = self.family.bits(&self.alive, group);
            if bits.iter().all(|b| *b == 0xff) {
                continue;
            }
            let [mut family, mut whole] = [0.0; 2];
            for k in (0..bits.len()).filter(|k| self.is_counted(group, *k, l)) {
                let one = counts(body.exchange.original(self.family.ends(group, k).slot(l)));
                family += one;
                if bits[k] >> l & 1 == 1 {
                    whole += one;
                }
            }
            out[i] = history::damage(whole, family);
        }
    }

    /// [`cut`](crate::interaction::Interaction::cut). A bond through a periodic face is in two places, and either end must see the same: `twice` of an end and its
    /// original says which bonds are looked at from both.
    pub fn cut(
        &mut self,
        body: &Body<D>,
        kind: CrackKind,
        crosses: &Crosses<D>,
        twice: impl Fn(usize, usize) -> bool,
        law: &dyn PointLaw<D>,
    ) -> u64 {
        let mut cut = vec![];
        for (group, k, l) in self.counted().filter(|b| self.is_whole(b.0, b.1, b.2)) {
            let (xi, _) = self.family.bond(group, k, l);
            let at = |slot: usize| -> [f64; D] {
                let x = body.position(slot);
                crate::array::from_fn(|a| x[a])
            };
            let from = at(self.family.rows(group).slot(l));
            let end = self.family.ends(group, k).slot(l);
            let j = body.exchange.original(end);
            if history::crossed(crosses, from, xi, twice(end, j).then(|| at(j))) {
                cut.push((self.family.byte(group, k), 1u8 << l));
            }
        }
        if kind == CrackKind::Absent && self.counted.is_empty() && !cut.is_empty() {
            (self.counted, _) = all_whole(&self.family);
        }
        for (byte, bit) in &cut {
            self.alive[*byte] &= !bit;
            if kind == CrackKind::Absent {
                self.counted[*byte] &= !bit;
            }
        }
        if kind == CrackKind::Absent {
            self.directed -= cut.len() as u64;
        }
        if self.prepared {
            self.look(body, law);
        }
        cut.len() as u64
    }

    pub fn family_size(&self, slot: usize) -> usize {
        let Some((group, l)) = self.family.find(slot) else {
            return 0;
        };
        (0..self.family.bonds(group))
            .filter(|k| self.is_counted(group, *k, l))
            .count()
    }

    /// Dilatations from `Σ ω ν V |ξ|² s` over the whole bonds: over the weighted volume of those that count, broken or not, where the law
    /// takes it so, else over that of the whole ones; and what part of it is whole, or how much.
    pub fn dilate(&self, out: &mut PointEnergiesMut) {
        let of_family = self.law.passes > 0 && !self.law.form_of_whole;
        for (group, l, i) in self.family.points() {
            let whole = out.whole[i];
            let weight = if of_family {
                let gone = |k: &usize| {
                    let byte = self.family.byte(group, *k);
                    (self.counted[byte] & !self.alive[byte]) >> l & 1 == 1
                };
                let of_bond = |k: usize| {
                    let r = self.family.plain(group, k, l);
                    r.omega * r.weight * (r.length * r.length)
                };
                let bonds = 0..self.family.bonds(group);
                whole + bonds.filter(gone).map(of_bond).sum::<f64>()
            } else {
                whole
            };
            if weight > 0.0 {
                out.dilatation[i] *= D as f64 / weight;
            }
            if of_family && weight > 0.0 {
                out.whole[i] /= weight;
            }
        }
    }

    /// What bonds of originals remember, to those of their copies.
    pub fn fill_memory(&mut self, body: &Body<D>) {
        let count = self.law.memory;
        if count > 0 {
            self.family
                .fill_memory(&body.exchange, &mut self.memory, count);
        }
    }
}
