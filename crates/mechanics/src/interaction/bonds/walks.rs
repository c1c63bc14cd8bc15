//! Bond by bond: who is bonded with whom, what is broken, and how much of every point's family.

use super::breaking::fibre_limit;
use super::family::{Family, Slots};
use super::state::{BondState, WholeBond, all_whole};
use crate::body::{Body, FieldView};
use crate::execute::lane::TILE;
use crate::interaction::{
    BondStatus, Crosses, EachBond, EachPair, Heals, PointEnergiesMut, history,
};
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
        self.family.counts(&self.counted, (group, k, l))
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
        self.of_each_point(|group, k, l| self.is_counted(group, k, l))
    }

    /// Those of these bonds, of points in the order of slots.
    fn of_each_point(
        &self,
        is: impl Fn(usize, usize, usize) -> bool + Copy,
    ) -> impl Iterator<Item = (usize, usize, usize)> {
        let mut points: Vec<_> = self.family.points().collect();
        points.sort_unstable_by_key(|(_, _, slot)| *slot);
        points.into_iter().flat_map(move |(group, l, _)| {
            let bonds = (0..self.family.bonds(group)).map(move |k| (group, k, l));
            bonds.filter(move |(group, k, l)| is(*group, *k, *l))
        })
    }

    fn status(&self, group: usize, k: usize, l: usize) -> BondStatus {
        if self.is_whole(group, k, l) {
            BondStatus::Whole
        } else if self.is_counted(group, k, l) {
            BondStatus::Broken
        } else {
            BondStatus::Absent
        }
    }

    /// Of those groups alone that may have lost a bond, from each of their points; one from a point to its own copy once.
    pub fn each_broken_of(
        &self,
        body: &Body<D>,
        damaged: impl Fn(usize) -> bool,
        visit: &mut EachPair<D>,
    ) {
        for (group, k, l) in self.lost(damaged) {
            let i = self.family.rows(group).slot(l);
            let end = self.family.ends(group, k).slot(l);
            let j = body.exchange.original(end);
            if i != j || end > i {
                visit(i, j, self.family.bond(group, k, l).0);
            }
        }
    }

    /// Of directed bonds one of each pair: group, bond and place, and both ends.
    pub fn each_half(
        &self,
        bonds: impl Iterator<Item = (usize, usize, usize)>,
        body: &Body<D>,
        visit: &mut dyn FnMut([usize; 3], [usize; 2]),
    ) {
        // of two ranks one counts a bond across their border
        let of_all = body.subdomain().map(|of| of.of_slots());
        for (group, k, l) in bonds {
            let i = self.family.rows(group).slot(l);
            let end = self.family.ends(group, k).slot(l);
            let j = body.exchange.original(end);
            // a bond between a point and its own copy counts from one side only
            let before = match of_all {
                Some(ids) if i != j => ids[i] < ids[j],
                _ => i < j,
            };
            if before || (i == j && end > i) {
                visit([group, k, l], [i, j]);
            }
        }
    }

    /// Every directed bond of the family that is not whole, those of absent cracks too, of groups that may have lost one: group, bond, place.
    pub(super) fn lost(
        &self,
        damaged: impl Fn(usize) -> bool,
    ) -> impl Iterator<Item = (usize, usize, usize)> {
        let groups = (0..self.family.groups()).filter(move |n| damaged(*n));
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

    /// Dilatations from `Σ ω ν V |ξ|² s` over the intact bonds: over the weighted volume of those that count, broken or not, where the law
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

/// Who is bonded with whom, as [`Interaction`](crate::interaction::Interaction) says it of any law.
pub trait Walks<const D: usize> {
    fn kind(&self) -> &'static str;
    fn directed_bonds(&self) -> u64;
    fn near_horizon(&self) -> u64;
    fn family_size(&self, slot: usize) -> usize;
    fn joins(&self, body: &Body<D>, i: usize, j: usize) -> bool;
    /// Bits of whole bonds and critical values, as they are laid out.
    fn memory(&self) -> (&[u8], &[f64]);
    fn each_bond(&self, body: &Body<D>, visit: &mut EachBond<D>);
    fn each_partner(&self, body: &Body<D>, visit: &mut EachBond<D>);
    fn each_broken(&self, body: &Body<D>, visit: &mut EachPair<D>);
    fn each_directed(&self, body: &Body<D>, visit: &mut EachPair<D>);
    fn damage(&self, body: &Body<D>, out: &mut [f64]);
    fn cut(&mut self, body: &Body<D>, kind: CrackKind, crosses: &Crosses<D>) -> u64;
    /// Those that damage counts, never what an absent crack took away; `None`: what they break by is of points.
    fn mend(&mut self, body: &Body<D>, u: FieldView<D>, heals: &Heals) -> Option<u64>;
}

impl<const D: usize, F: Family<D>> Walks<D> for BondState<D, F> {
    fn kind(&self) -> &'static str {
        self.kind
    }

    fn directed_bonds(&self) -> u64 {
        self.directed
    }

    fn near_horizon(&self) -> u64 {
        self.near_horizon
    }

    fn family_size(&self, slot: usize) -> usize {
        let Some((group, l)) = self.family.find(slot) else {
            return 0;
        };
        (0..self.family.bonds(group))
            .filter(|k| self.is_counted(group, *k, l))
            .count()
    }

    fn joins(&self, body: &Body<D>, i: usize, j: usize) -> bool {
        self.family.joins(body, i, j)
    }

    fn memory(&self) -> (&[u8], &[f64]) {
        (&self.alive, &self.critical)
    }

    fn each_bond(&self, body: &Body<D>, visit: &mut EachBond<D>) {
        self.each_half(self.pairs(), body, &mut |[group, k, l], [i, j]| {
            visit(
                i,
                j,
                self.family.bond(group, k, l).0,
                self.status(group, k, l),
            );
        });
    }

    fn each_partner(&self, body: &Body<D>, visit: &mut EachBond<D>) {
        for (group, k, l) in self.of_each_point(|group, k, l| self.family.is_bond(group, k, l)) {
            let i = self.family.rows(group).slot(l);
            let j = body.exchange.original(self.family.ends(group, k).slot(l));
            visit(
                i,
                j,
                self.family.bond(group, k, l).0,
                self.status(group, k, l),
            );
        }
    }

    fn each_broken(&self, body: &Body<D>, visit: &mut EachPair<D>) {
        self.each_broken_of(body, |_| true, visit);
    }

    fn each_directed(&self, body: &Body<D>, visit: &mut EachPair<D>) {
        self.each_partner(body, &mut |i, j, xi, status| {
            if status != BondStatus::Absent {
                visit(i, j, xi);
            }
        });
    }

    fn damage(&self, body: &Body<D>, out: &mut [f64]) {
        self.damage_of(body, |j| body.volume.at(j), out);
    }

    fn cut(&mut self, body: &Body<D>, kind: CrackKind, crosses: &Crosses<D>) -> u64 {
        // a bond through a periodic face is in two places, and either end must see the same
        let twice = body.period.iter().any(Option::is_some);
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
            if history::crossed(crosses, from, xi, twice.then(|| at(j))) {
                cut.push((self.family.byte(group, k), 1u8 << l));
            }
        }
        if kind == CrackKind::Excluded && self.counted.is_empty() && !cut.is_empty() {
            (self.counted, _) = all_whole(&self.family);
        }
        for (byte, bit) in &cut {
            self.alive[*byte] &= !bit;
            if kind == CrackKind::Excluded {
                self.counted[*byte] &= !bit;
            }
        }
        if kind == CrackKind::Excluded {
            self.directed -= cut.len() as u64;
        }
        if self.prepared {
            self.look(body);
        }
        cut.len() as u64
    }

    fn mend(&mut self, body: &Body<D>, u: FieldView<D>, heals: &Heals) -> Option<u64> {
        if !self.ends_by_bonds() {
            return None;
        }
        let mut mended = vec![];
        for (group, k, l) in self
            .lost(|_| true)
            .filter(|b| self.is_counted(b.0, b.1, b.2))
        {
            let i = self.family.rows(group).slot(l);
            let end = self.family.ends(group, k).slot(l);
            let xi = self.family.bond(group, k, l).0;
            let eta = self.plain_eta(u, [i, end], &xi);
            if heals(i, body.exchange.original(end), history::relative(&xi, eta)) {
                mended.push((group, k, l));
            }
        }
        // what points know of their families goes to all that have copies
        if !body.exchange.any(!mended.is_empty()) {
            return Some(0);
        }
        for &(group, k, l) in &mended {
            let byte = self.family.byte(group, k);
            history::set(&mut self.alive[byte], l, true);
        }
        self.renew(body, &mended);
        if self.prepared {
            self.look(body);
        }
        Some(mended.len() as u64)
    }
}
