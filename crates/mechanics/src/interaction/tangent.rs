//! What small changes do: the tangent of a law about a state, bond by bond. Statics assembles it.
//!
//! With `η` the change of `u_j − u_i`: `δf_i = Σ_j C_ij η + Σ_j (δp_i pull_ij + δp_j pull'_ij)`, `δp_i = gain_i Σ_j share_ij · η`.
//! The scalar p is the pressure of state-based solids, F′ of embedded atoms; pair laws have none. Laws whose points make more than one
//! number of their sums have a [`Channel`] for each sum.

use super::BondForce;
use crate::body::FieldView;
use crate::law::blocks::PairTangent;
use crate::law::jet::{self, Jet};
use crate::law::potential::Potential;
use crate::law::{BondFactors, Law};

/// What a bond does through a sum `S` of a point, with its gain: `δf_i = δS_i pull + δS_j pull'`, `δS_i = Σ_j share_ij · η`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Channel<const D: usize> {
    /// What the bond adds to the sum of i.
    pub share: [f64; D],
    /// What the sums of i and of j add to the force density on i.
    pub pull: [[f64; D]; 2],
}

/// A directed bond between two points.
#[derive(Debug, Clone, PartialEq)]
pub struct BondTangent<const D: usize> {
    /// Slots of points, images resolved.
    pub i: usize,
    pub j: usize,
    /// From i to j now (length).
    pub y: [f64; D],
    /// What of C acts across the bond as along it (force density / length): pull over length.
    pub tension: f64,
    /// C (force density / length).
    pub stiffness: [[f64; D]; D],
    /// What the bond adds to the scalar of i.
    pub share: [f64; D],
    /// What the scalars of i and of j add to the force density on i.
    pub pull: [[f64; D]; 2],
    /// Of laws with more than a scalar, as many for every bond; else none.
    pub channels: Vec<Channel<D>>,
}

/// A bond now.
pub(super) struct Stretched<const D: usize> {
    pub y: [f64; D],
    r0: f64,
    r: f64,
    /// `(r − r0)/r`
    g: f64,
}

impl<const D: usize> Stretched<D> {
    pub fn new(xi: [f64; D], eta: [f64; D]) -> Self {
        let y: [f64; D] = crate::array::from_fn(|a| xi[a] + eta[a]);
        let square = |x: &[f64; D]| x.iter().map(|c| c * c).sum::<f64>();
        let (r0, r) = (square(&xi).sqrt(), square(&y).sqrt());
        let longer: f64 = (0..D).map(|a| (xi[a] + y[a]) * eta[a]).sum();
        let g = longer / (r * (r + r0));
        Stretched { y, r0, r, g }
    }

    /// Coefficient of y in the force density on its first end.
    #[inline(always)]
    pub fn tension<W: Law>(
        &self,
        law: W,
        k: f64,
        factors: BondFactors<f64>,
        [p, q]: [[f64; 2]; 2],
    ) -> f64 {
        law.scaled_pull(k, self.g, p, q, factors)
    }

    /// The same, and that of the first end's own energy.
    pub fn tensions<W: Law>(
        &self,
        law: W,
        k: f64,
        factors: BondFactors<f64>,
        fields: [[f64; 2]; 2],
    ) -> [f64; 2] {
        let [p, q] = fields;
        [
            self.tension(law, k, factors, fields),
            law.own_pull(k, self.g, p, q, factors),
        ]
    }
}

impl<const D: usize> BondForce<D> {
    /// Along y, from the coefficients of the whole force and of that of its own force state.
    pub(super) fn central([i, j]: [usize; 2], y: [f64; D], [pull, own]: [f64; 2]) -> Self {
        BondForce {
            i,
            j,
            y,
            force: y.map(|c| pull * c),
            own: Some(y.map(|c| own * c)),
        }
    }
}

/// Visits directed bonds with their tangents.
pub type EachTangent<'a, const D: usize> = dyn FnMut(BondTangent<D>) + 'a;

impl<const D: usize> BondTangent<D> {
    /// Of a linear bond: without scalar and tension.
    pub fn direct(i: usize, j: usize, y: [f64; D], stiffness: [[f64; D]; D]) -> Self {
        BondTangent {
            i,
            j,
            y,
            tension: 0.0,
            stiffness,
            share: [0.0; D],
            pull: [[0.0; D]; 2],
            channels: vec![],
        }
    }

    /// What both ends of a pair of a potential have from a term of it: of the first, then of the second; of those that have a `volume` here.
    pub(super) fn both(
        volume: impl Fn(usize) -> Option<f64>,
        [i, j]: [usize; 2],
        pair: &PairTangent<D>,
    ) -> impl Iterator<Item = Self> {
        let turned = crate::array::from_fn(|a| crate::array::from_fn(|b| pair.block[b][a]));
        let ends = [
            (i, j, pair.y, pair.block),
            (j, i, pair.y.map(|y| -y), turned),
        ];
        let pull = pair.pull;
        ends.into_iter().filter_map(move |(i, j, y, block)| {
            let scale = 1.0 / volume(i)?;
            Some(BondTangent {
                tension: scale * pull,
                ..Self::direct(i, j, y, block.map(|row| row.map(|c| scale * c)))
            })
        })
    }

    /// What the point i of a central law gets from it.
    pub(super) fn force(&self) -> BondForce<D> {
        BondForce {
            i: self.i,
            j: self.j,
            y: self.y,
            force: self.y.map(|y| self.tension * y),
            own: None,
        }
    }

    /// The same of a potential of one kind of atom, from F′ of both ends: a pair's energy is in halves, embedding is the atom's own.
    pub(super) fn force_of_potential(&self, [own, other]: [f64; 2]) -> BondForce<D> {
        let force = self.force();
        let half = |a: usize| 0.5 * (force.force[a] + (own - other) * self.pull[0][a]);
        BondForce {
            own: Some(crate::array::from_fn(half)),
            ..force
        }
    }

    /// The same of a linear law, whose bonds store as much at either end.
    pub(super) fn linear_force(&self, u: FieldView<D>) -> BondForce<D> {
        let eta: [f64; D] = crate::array::from_fn(|a| u[a][self.j] - u[a][self.i]);
        let force = self
            .stiffness
            .map(|row| row.iter().zip(&eta).map(|(c, e)| c * e).sum());
        BondForce {
            i: self.i,
            j: self.j,
            y: self.y,
            force,
            own: Some(force.map(|f| 0.5 * f)),
        }
    }

    /// Of a peridynamic law with bond constant `k` and factors, at the relative displacement η of a bond ξ; `fields` of both ends.
    pub(super) fn of_law<W: Law>(
        law: W,
        [i, j]: [usize; 2],
        k: f64,
        factors: BondFactors<f64>,
        xi: [f64; D],
        eta: [f64; D],
        fields: [[f64; 2]; 2],
    ) -> Self {
        let b = Stretched::new(xi, eta);
        let Stretched { y, r0, r, g } = b;
        let [p, q] = fields;
        let tension = b.tension(law, k, factors, fields);
        // a law's pull is linear in g: its slope is a difference
        let slope = law.scaled_pull(k, 1.0, p, q, factors) - law.scaled_pull(k, 0.0, p, q, factors);
        let n = y.map(|c| c / r);
        let (mut share, mut pull) = ([0.0; D], [[0.0; D]; 2]);
        if W::SHARES {
            // without the other fields, beside which a scalar of 1 would be lost
            let of = |scalar: f64| law.pull(k, g, [scalar, 0.0], [0.0; 2]);
            let per_scalar = of(1.0) - of(0.0);
            share = n.map(|n| factors.own * k * r0 * n);
            pull = [factors.own, factors.other].map(|f| y.map(|y| f * per_scalar * y));
        }
        BondTangent {
            i,
            j,
            y,
            tension,
            stiffness: central(tension, slope * r0 / r, &n),
            share,
            pull,
            channels: vec![],
        }
    }

    /// Of a potential at the current vector y; `slopes` are F′_i and F′_j, `scale` two over the volume of i. Of `unlike` atoms what i
    /// adds at j is not what j adds at i.
    pub(super) fn of_potential<P: Potential>(
        potential: &P,
        [i, j]: [usize; 2],
        y: [f64; D],
        slopes: [f64; 2],
        scale: f64,
        unlike: bool,
    ) -> Self {
        let q: f64 = y.iter().map(|c| c * c).sum();
        let at = Jet::<3>::variable(q);
        let [_, mut first, mut second] = potential.pair(at).derivatives();
        let (mut share, mut pull) = ([0.0; D], [[0.0; D]; 2]);
        if P::EMBEDDED {
            let [_, f, curvature] = potential.density(at).derivatives();
            let mut other = f;
            if unlike {
                let [_, g, given] = potential.given(at).derivatives();
                first += slopes[0] * f + slopes[1] * g;
                second += slopes[0] * curvature + slopes[1] * given;
                other = g;
            } else {
                first += (slopes[0] + slopes[1]) * f;
                second += (slopes[0] + slopes[1]) * curvature;
            }
            share = y.map(|y| 2.0 * f * y);
            pull = [f, other].map(|f| y.map(|y| scale * f * y));
        }
        BondTangent {
            i,
            j,
            y,
            tension: scale * first,
            stiffness: central(scale * first, scale * 2.0 * second, &y),
            share,
            pull,
            channels: vec![],
        }
    }
}

/// `tension 1 + more n⊗n`
fn central<const D: usize>(tension: f64, more: f64, n: &[f64; D]) -> [[f64; D]; D] {
    crate::array::from_fn(|a| {
        crate::array::from_fn(|b| more * n[a] * n[b] + if a == b { tension } else { 0.0 })
    })
}

/// F″ of a potential.
pub(super) fn curvature<P: Potential>(potential: &P, density: f64) -> f64 {
    jet::embedding::<3>(potential, density)[2]
}
