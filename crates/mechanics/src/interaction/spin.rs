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

/// The part of the largest moment of inertia below which a family is a row: forces with shorter arms would be great, and stiff.
const ROW: f64 = 0.02;

/// The other end of a bond.
#[derive(Debug, Clone)]
struct Partner<const D: usize> {
    slot: u32,
    /// ξ
    xi: [f64; D],
    /// The last evaluation at which the bond was found broken.
    torn: u64,
}

/// A point with its family.
#[derive(Debug, Clone)]
struct Known<const D: usize> {
    slot: u32,
    /// In order of slots.
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

/// How two points turn together.
#[derive(Debug, Clone, Copy)]
pub(super) struct Together {
    share: Matrix<f64, 3>,
    /// Of velocities, and of displacements since the step began.
    pub turns: [Point; 2],
}

/// Families of points that touch.
#[derive(Debug, Clone, Default)]
pub(super) struct Families<const D: usize> {
    /// `[slots]`: place in `known` and one more; 0: none.
    place: Vec<u32>,
    /// In order of slots.
    known: Vec<Known<D>>,
    /// Number of this evaluation.
    now: u64,
}

impl<const D: usize> Known<D> {
    fn new(slot: u32) -> Self {
        Known {
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
        for partner in self.partners.iter().filter(|p| p.torn != now) {
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

impl<const D: usize> Families<D> {
    /// Another evaluation begins: all bonds count as whole that [`Families::tear`] is not told of.
    pub fn begin(&mut self) {
        self.now += 1;
    }

    /// The bond ξ from i to j is broken now.
    pub fn tear(&mut self, i: usize, j: usize, xi: &[f64; D]) {
        for (from, to, way) in [(i, j, 1.0), (j, i, -1.0)] {
            let Some(known) = self.place(from) else {
                continue;
            };
            let partners = &mut self.known[known].partners;
            let first = partners.partition_point(|p| (p.slot as usize) < to);
            let same = partners[first..]
                .iter_mut()
                .take_while(|p| p.slot as usize == to);
            // a point may be a partner more than once, by its images
            let apart = |p: &Partner<D>| -> f64 {
                let square = |c: f64| c * c;
                (0..D).map(|a| square(p.xi[a] - way * xi[a])).sum()
            };
            if let Some(partner) = same.min_by(|p, q| apart(p).total_cmp(&apart(q))) {
                partner.torn = self.now;
            }
        }
    }

    fn place(&self, slot: usize) -> Option<usize> {
        let place = self.place.get(slot).copied().unwrap_or(0);
        (place as usize).checked_sub(1)
    }

    pub fn knows(&self, slot: usize) -> bool {
        self.place(slot).is_some()
    }

    /// Points whose families are known (slots).
    pub fn slots(&self) -> impl Iterator<Item = u32> {
        self.known.iter().map(|k| k.slot)
    }

    /// Finds the families of these points (slots) in place of those that it knew.
    pub fn learn(&mut self, interaction: &dyn Interaction<D>, body: &Body<D>, mut slots: Vec<u32>) {
        slots.sort_unstable();
        slots.dedup();
        self.place.clear();
        self.place.resize(body.len, 0);
        for (n, &slot) in slots.iter().enumerate() {
            self.place[slot as usize] = n as u32 + 1;
        }
        self.known = slots.into_iter().map(Known::new).collect();
        // atoms have neighbours, not families
        if interaction.is_potential() {
            return;
        }
        let (place, known, now) = (&self.place, &mut self.known, self.now);
        interaction.each_bond(body, &mut |i, j, xi, state| {
            let wanted = place[i] > 0 || place[j] > 0;
            // what an interface holds is another body
            if !wanted || i == j || body.piece_of(i) != body.piece_of(j) {
                return;
            }
            let torn = if state == BondStatus::Whole { 0 } else { now };
            for (from, to, way) in [(i, j, 1.0), (j, i, -1.0)] {
                if let Some(own) = (place[from] as usize).checked_sub(1) {
                    known[own].partners.push(Partner {
                        slot: to as u32,
                        xi: xi.map(|c| way * c),
                        torn,
                    });
                }
            }
        });
        for known in &mut self.known {
            known.partners.sort_by_key(|p| p.slot);
        }
    }

    /// How two points turn together at displacements u and velocities v, and since displacements `from`; `None`: neither has a whole bond.
    pub fn together(
        &mut self,
        body: &Body<D>,
        state: [&Field<D>; 2],
        from: Option<&Field<D>>,
        ends: [usize; 2],
    ) -> Option<Together> {
        let mut takes = [[0.0; 3]; 3];
        let mut turns = [[0.0; 3]; 2];
        let mut any = false;
        for slot in ends {
            let Some(place) = self.place(slot) else {
                continue;
            };
            let known = &mut self.known[place];
            if known.seen != self.now {
                known.measure(self.now, body, state, from);
            }
            any |= known.takes != [[0.0; 3]; 3];
            for a in 0..3 {
                (0..3).for_each(|b| takes[a][b] += known.takes[a][b]);
                (0..2).for_each(|n| turns[n][a] += known.turns[n][a]);
            }
        }
        let (share, _) = any.then(|| inverse_within(takes, ROW))?;
        Some(Together {
            share,
            turns: turns.map(|turn| times(&share, &turn)),
        })
    }

    /// A couple on two points of which [`Families::together`] said how they turn.
    pub fn turn(&mut self, together: &Together, ends: [usize; 2], couple: &Point) {
        let couple = times(&together.share, couple);
        for slot in ends {
            if let Some(place) = self.place(slot) {
                let sum = &mut self.known[place].couple;
                (0..3).for_each(|a| sum[a] += couple[a]);
            }
        }
    }

    /// Adds the force densities that the couples of this evaluation are.
    pub fn add(&self, body: &Body<D>, u: &Field<D>, force: &mut Field<D>) {
        for known in self.known.iter().filter(|k| k.seen == self.now) {
            let rate = times(&known.inverse, &known.couple);
            known.each_whole(self.now, u, |k, d| {
                let push = cross(&rate, &full(&d));
                (0..D).for_each(|a| force[a][k] += body.density.at(k) * push[a]);
            });
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let partners: usize = self.known.iter().map(|k| k.partners.capacity()).sum();
        size_of::<u32>() * self.place.capacity()
            + size_of::<Known<D>>() * self.known.capacity()
            + size_of::<Partner<D>>() * partners
    }
}
