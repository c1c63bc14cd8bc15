//! Spin of points and couples on them: those of the rigid body that a point and the partners of its whole bonds would be.
//!
//! `ω_i = I⁻¹ Σ m_k d_k × v_k`, `I = Σ m_k (d_k² 1 − d_k ⊗ d_k)`, over the point and its partners of its own body, `d_k` (length) from their
//! centre of mass, `m_k` their masses; a couple C on the point is the forces `m_k (I⁻¹ C) × d_k`. These have no resultant, their moment is
//! C, and their power is `C · ω_i`: spin and couple are dual. A family in a row has no moment of inertia about it: `I⁻¹` is the generalised inverse, and
//! `P = I I⁻¹` is what of a couple the point can take; nothing of a point without whole bonds.
//!
//! Of a couple M on two points i takes `P_i Q M` and j takes `P_j Q M`, `Q = (P_i + P_j)⁻¹`: half each where both can, all where one can. What
//! none can take (`M − (P_i + P_j) Q M`) is left out. Dual to it both turn with `Q (ω_i + ω_j)`.

use super::{BondStatus, Interaction};
use crate::body::{Body, Field};
use crate::law::material::tensor::{Matrix, inverse_within, product, times};
use crate::space::{Point, cross, dot, full};
use bytemuck::{Pod, Zeroable};
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// The part of the largest moment of inertia below which a family is a row: forces with shorter arms would be great, and stiff.
const ROW: f64 = 0.02;

/// The other end of a bond.
#[derive(Debug, Clone)]
struct Partner<const D: usize> {
    id: u32,
    slot: u32,
    /// ξ
    xi: [f64; D],
    /// The last evaluation at which the bond was found broken.
    broken_at: u64,
}

/// A point with its family.
#[derive(Debug, Clone)]
struct Known<const D: usize> {
    id: u32,
    slot: u32,
    /// In order of ids.
    partners: Vec<Partner<D>>,
    /// The evaluation that all below is of.
    seen: u64,
    /// Centre of mass, from the point.
    centre: [f64; D],
    /// `I⁻¹`
    inverse: Matrix<f64, 3>,
    /// P
    takes: Matrix<f64, 3>,
    /// ω of the velocities, and the same of the displacements since the step began.
    turns: [Point; 2],
    couple: Point,
}

/// What a point takes of couples, and how it turns: of velocities, and of displacements since the step began.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Spin {
    pub takes: Matrix<f64, 3>,
    pub turns: [Point; 2],
}

/// How two points turn together.
#[derive(Debug, Clone, Copy)]
pub(super) struct PairRotation {
    share: Matrix<f64, 3>,
    /// Of velocities, and of displacements since the step began.
    pub turns: [Point; 2],
}

/// Families of points that touch: of those of this rank, and which of its points are in those of others.
#[derive(Debug, Clone, Default)]
pub(super) struct Families<const D: usize> {
    /// By id, in their order.
    known: Vec<Known<D>>,
    /// Of points of other ranks by id: this rank's points in their families, ξ from there.
    others: BTreeMap<u32, Vec<Partner<D>>>,
    /// Number of this evaluation.
    now: u64,
}

/// A couple on a point, as its family has it: where the point and its centre are, and what it turns all by.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
struct Turned {
    id: u64,
    u: [f64; 3],
    centre: [f64; 3],
    rate: [f64; 3],
}

// SAFETY, both: numbers without gaps between them, and all bits are some
unsafe impl Zeroable for Turned {}
unsafe impl Pod for Turned {}

impl<const D: usize> Known<D> {
    fn new(id: u32, slot: u32) -> Self {
        Known {
            id,
            slot,
            partners: vec![],
            seen: 0,
            centre: [0.0; D],
            inverse: [[0.0; 3]; 3],
            takes: [[0.0; 3]; 3],
            turns: [[0.0; 3]; 2],
            couple: [0.0; 3],
        }
    }

    /// Visits the point and the partners of its whole bonds, with their place from `centre`.
    fn each_whole(&self, now: u64, u: &Field<D>, mut visit: impl FnMut(usize, [f64; D])) {
        let (i, centre) = (self.slot as usize, &self.centre);
        visit(i, centre.map(|c| -c));
        for partner in self.partners.iter().filter(|p| p.broken_at != now) {
            let k = partner.slot as usize;
            let d = |a: usize| partner.xi[a] + (u[a][k] - u[a][i]) - centre[a];
            visit(k, crate::array::from_fn(d));
        }
    }

    /// Moments of inertia and spins of now; of velocities, and of displacements since `from`.
    fn measure(
        &mut self,
        now: u64,
        body: &Body<D>,
        [u, v]: [&Field<D>; 2],
        from: Option<&Field<D>>,
    ) {
        (self.seen, self.couple, self.centre) = (now, [0.0; 3], [0.0; D]);
        let mass = |k: usize| body.density.at(k) * body.volume.at(k);
        let (mut all, mut first) = (0.0, [0.0; D]);
        self.each_whole(now, u, |k, d| {
            all += mass(k);
            (0..D).for_each(|a| first[a] += mass(k) * d[a]);
        });
        self.centre = first.map(|c| c / all);
        let (mut inertia, mut momenta) = ([[0.0; 3]; 3], [[0.0; 3]; 2]);
        self.each_whole(now, u, |k, d| {
            let (m, d) = (mass(k), full(&d));
            let square = dot(&d, &d);
            for a in 0..3 {
                inertia[a][a] += m * square;
                (0..3).for_each(|b| inertia[a][b] -= m * d[a] * d[b]);
            }
            let rate = full::<D>(&crate::array::from_fn(|a| v[a][k]));
            let way = from.map_or([0.0; 3], |from| {
                full::<D>(&crate::array::from_fn(|a| u[a][k] - from[a][k]))
            });
            for (sum, moved) in momenta.iter_mut().zip([rate, way]) {
                let turned = cross(&d, &moved);
                (0..3).for_each(|a| sum[a] += m * turned[a]);
            }
        });
        (self.inverse, _) = inverse_within(inertia, ROW);
        self.takes = product(&inertia, &self.inverse);
        self.turns = momenta.map(|l| times(&self.inverse, &l));
    }
}

impl Spin {
    /// How two points turn together; `None`: neither has a whole bond.
    pub fn together([a, b]: [&Spin; 2]) -> Option<PairRotation> {
        let none = [[0.0; 3]; 3];
        if a.takes == none && b.takes == none {
            return None;
        }
        let takes = std::array::from_fn(|m| std::array::from_fn(|n| a.takes[m][n] + b.takes[m][n]));
        let (share, _) = inverse_within(takes, ROW);
        let turns =
            [0, 1].map(|n| times(&share, &[0, 1, 2].map(|m| a.turns[n][m] + b.turns[n][m])));
        Some(PairRotation { share, turns })
    }
}

/// Of vectors, component by component.
pub(super) fn in_order<const D: usize>(a: &[f64; D], b: &[f64; D]) -> Ordering {
    // −0 is 0: one end sees it so, the other so
    let each = a
        .iter()
        .zip(b)
        .map(|(a, b)| (a + 0.0).total_cmp(&(b + 0.0)));
    each.fold(Ordering::Equal, Ordering::then)
}

/// Of such partners that nearest to ξ is not bonded now: a point may be a partner more than once, by its images.
fn mark<const D: usize>(
    partners: &mut [Partner<D>],
    such: impl Fn(&Partner<D>) -> bool,
    xi: &[f64; D],
    now: u64,
) {
    let apart = |p: &Partner<D>| -> f64 { (0..D).map(|a| (p.xi[a] - xi[a]).powi(2)).sum() };
    let same = partners.iter_mut().filter(|p| such(p));
    if let Some(partner) = same.min_by(|p, q| apart(p).total_cmp(&apart(q))) {
        partner.broken_at = now;
    }
}

impl<const D: usize> Families<D> {
    /// Another evaluation begins: all bonds count as whole that [`Families::tear`] is not told of.
    pub fn begin(&mut self) {
        self.now += 1;
    }

    /// The bond ξ from a point of this rank to another is broken now: slot and id of the first, id of the second.
    pub fn tear(&mut self, (slot, id): (usize, u32), other: u32, xi: &[f64; D]) {
        let now = self.now;
        if let Some(known) = self.place(id) {
            mark(&mut self.known[known].partners, |p| p.id == other, xi, now);
        }
        if let Some(members) = self.others.get_mut(&other) {
            let back = xi.map(|x| -x);
            mark(members, |p| p.slot as usize == slot, &back, now);
        }
    }

    fn place(&self, id: u32) -> Option<usize> {
        self.known.binary_search_by_key(&id, |k| k.id).ok()
    }

    /// Are families of a point known, or who here is in that of one of another rank?
    pub fn knows(&self, id: u32) -> bool {
        self.place(id).is_some() || self.others.contains_key(&id)
    }

    /// Points of which it knows (ids).
    pub fn ids(&self) -> impl Iterator<Item = u32> {
        let known = self.known.iter().map(|k| k.id);
        known.chain(self.others.keys().copied())
    }

    /// Finds the families of these points (ids) in place of those that it knew; `by_slot` says who is in each slot.
    pub fn learn(
        &mut self,
        interaction: &dyn Interaction<D>,
        body: &Body<D>,
        by_slot: &[u32],
        mut ids: Vec<u32>,
    ) {
        ids.sort_unstable();
        ids.dedup();
        let whose = body.whose();
        self.known.clear();
        self.others.clear();
        for wanted in ids {
            match whose.place(wanted) {
                Some(n) => self.known.push(Known::new(wanted, body.slots[n])),
                None => drop(self.others.insert(wanted, vec![])),
            }
        }
        // atoms have neighbours, not families
        if interaction.is_potential() {
            return;
        }
        let mut place = vec![0u32; body.len];
        for (n, known) in self.known.iter().enumerate() {
            place[known.slot as usize] = n as u32 + 1;
        }
        let (known, others, now) = (&mut self.known, &mut self.others, self.now);
        interaction.each_partner(body, &mut |i, j, xi, state| {
            // what an interface holds is another body
            if i == j || body.piece_of(i) != body.piece_of(j) {
                return;
            }
            let broken_at = if state == BondStatus::Whole { 0 } else { now };
            let partner = |slot: usize, xi| Partner {
                id: by_slot[slot],
                slot: slot as u32,
                xi,
                broken_at,
            };
            if let Some(own) = (place[i] as usize).checked_sub(1) {
                known[own].partners.push(partner(j, xi));
            }
            if let Some(members) = others.get_mut(&by_slot[j]) {
                members.push(partner(i, xi.map(|x| -x)));
            }
        });
        let all = known.iter_mut().map(|k| &mut k.partners);
        all.chain(others.values_mut()).for_each(|partners| {
            partners.sort_by(|a, b| a.id.cmp(&b.id).then_with(|| in_order(&a.xi, &b.xi)));
        });
    }

    /// The spin of a point of this rank at displacements u and velocities v, and since displacements `from`.
    pub fn spin(
        &mut self,
        body: &Body<D>,
        state: [&Field<D>; 2],
        from: Option<&Field<D>>,
        id: u32,
    ) -> Spin {
        let Some(place) = self.place(id) else {
            return Spin::default();
        };
        let known = &mut self.known[place];
        if known.seen != self.now {
            known.measure(self.now, body, state, from);
        }
        Spin {
            takes: known.takes,
            turns: known.turns,
        }
    }

    /// A couple on two points of which [`Spin::together`] said how they turn, of those of this rank.
    pub fn turn(&mut self, together: &PairRotation, ends: [u32; 2], couple: &Point) {
        let couple = times(&together.share, couple);
        for id in ends {
            if let Some(place) = self.place(id) {
                let sum = &mut self.known[place].couple;
                (0..3).for_each(|a| sum[a] += couple[a]);
            }
        }
    }

    /// Adds the force densities that the couples of this evaluation are, of those on points of all ranks. All come here at once.
    pub fn add(&self, body: &Body<D>, u: &Field<D>, force: &mut Field<D>) {
        let turned = self
            .known
            .iter()
            .filter(|k| k.seen == self.now && k.couple != [0.0; 3]);
        let turned = turned.map(|known| Turned {
            id: u64::from(known.id),
            u: full::<D>(&crate::array::from_fn(|a| u[a][known.slot as usize])),
            centre: full(&known.centre),
            rate: times(&known.inverse, &known.couple),
        });
        let mut all = body.all_of(&turned.collect::<Vec<_>>()).concat();
        all.sort_unstable_by_key(|t| t.id);
        let whose = body.whose();
        for t in &all {
            let id = t.id as u32;
            let mut push = |k: usize, xi: &[f64; D]| {
                let d: [f64; D] =
                    crate::array::from_fn(|a| xi[a] + (u[a][k] - t.u[a]) - t.centre[a]);
                let push = cross(&t.rate, &full(&d));
                (0..D).for_each(|a| force[a][k] += body.density.at(k) * push[a]);
            };
            let members = match self.place(id) {
                Some(known) => {
                    let known = &self.known[known];
                    push(known.slot as usize, &[0.0; D]);
                    &known.partners
                }
                None => match self.others.get(&id) {
                    Some(members) => members,
                    None => continue,
                },
            };
            let whole = members.iter().filter(|p| p.broken_at != self.now);
            for p in whole.filter(|p| whose.place(p.id).is_some()) {
                push(p.slot as usize, &p.xi);
            }
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let partners = self.known.iter().map(|k| &k.partners);
        let partners = partners.chain(self.others.values()).map(Vec::capacity);
        size_of::<Known<D>>() * self.known.capacity()
            + size_of::<Partner<D>>() * partners.sum::<usize>()
    }
}
