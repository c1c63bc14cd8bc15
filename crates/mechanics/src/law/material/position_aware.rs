//! The position-aware linear solid (Mitchell, Silling & Littlewood 2015), in D dimensions: `W = ½ κ θ² + μ Σ σ ε²`, `θ = Σ ω |ξ| e`,
//! `ε = e − θ|ξ|/D`, κ the bulk modulus of those dimensions.
//!
//! Every point has influence functions of its own, so near surfaces too θ is the trace of any strain, and the deviatoric energy is
//! `μ d:d` of the deviators of the strains H_K that probe it: one for each pair of axes, `e_i⊗e_i` and `e_i⊗e_j + e_j⊗e_i`. With the extensions
//! `e_K = ξ·H_K ξ/|ξ|` and their deviators ε_K, `ω = ω₀ + Σ λ_K |ξ| e_K`, `σ = σ₀ + Σ τ_K ε_K²`: nearest to trial functions ω₀ and σ₀, in
//! the norm of sums over the family, of those that give `Σ ω |ξ| e_K = tr H_K` and `Σ σ ε_K² = d_K:d_K`. The trial functions are the
//! influence function of the body, scaled so that they are right in an isotropic family, where this is the linear peridynamic solid.
//!
//! `T⟨ξ⟩ = (κθ − (2μ/D) Σ σ ε |ξ|) ω|ξ| + 2μ σ ε`, over intact bonds: new surfaces are seen, too. A family whose probes do not tell its
//! multipliers apart has those of least size.
//!
//! Nothing in that keeps σ from being negative, and with it the energy. A whole family is as they have it. Of one that has lost bonds the
//! τ_K are made smaller together until no σ is below 0: breaking may only take energy away, and could not from what is below 0.

use super::tensor;
use super::{Along, Bond, End, Material, ReferenceFamily, Site};
use crate::columns::Dimension;
use crate::law::descriptor::{self, Bounds, Descriptor, Given, MODULI, Need, Registered};
use crate::law::number::Number;
use crate::spec::{Influence, LawSpec, Parameters, Plane};

/// Constants of one material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PositionAwareConstants {
    /// κ and μ (pressure).
    pub bulk: f64,
    pub shear: f64,
    /// Of what the trial functions are so many influence functions (1 / length² volume); `None`: what is right in an isotropic family.
    pub trial: Option<f64>,
}

/// See the module.
#[derive(Debug, Clone)]
pub struct PositionAware {
    /// Per material.
    pub materials: Vec<PositionAwareConstants>,
}

/// Pairs of axes, a probe each: D(D + 1)/2 of them are used.
const PROBES: usize = 6;
const AXES: [[usize; 2]; PROBES] = [[0, 0], [1, 1], [0, 1], [2, 2], [0, 2], [1, 2]];

const fn probes(d: usize) -> usize {
    d * (d + 1) / 2
}

/// Of how many influence functions ω₀ and σ₀ are, multipliers λ_K and τ_K.
type Multipliers<N> = ([N; 2], [[N; PROBES]; 2]);
/// And `Σ σ |ξ|²`.
type Form<N> = (Multipliers<N>, N);
/// `Σ ω₀|ξ|e` and `Σ σ₀|ξ|e` of trial functions that are the influence function, then `Σ |ξ| e_K |ξ| e` and `Σ ε_K² |ξ| e`.
type Sum<N> = (N, [[N; PROBES]; 2]);
/// What bonds of both ends read: θ and p, and multipliers.
type Point<N> = ([N; 2], Multipliers<N>);
const DILATION: usize = 0;

type Ends<'a, N> = End<'a, [N; 2], Point<N>, [N; 0]>;

/// `|ξ| e_K` of a bond.
#[inline(always)]
fn extensions<N: Number, const D: usize>(xi: &[N; D]) -> [N; PROBES] {
    let mut all = [N::constant(0.0); PROBES];
    for k in 0..probes(D) {
        let [a, b] = AXES[k];
        let product = xi[a] * xi[b];
        all[k] = if a == b { product } else { product + product };
    }
    all
}

/// `ε_K²` of the same.
#[inline(always)]
fn deviators<N: Number, const D: usize>(
    all: &[N; PROBES],
    length: N,
    inv_length: N,
) -> [N; PROBES] {
    let mut out = *all;
    let mean = length.times(1.0 / D as f64);
    for k in 0..probes(D) {
        let [a, b] = AXES[k];
        let mut e = all[k] * inv_length;
        if a == b {
            e = e - mean;
        }
        out[k] = e * e;
    }
    out
}

/// ω and σ of a bond; 0 where it is not whole.
#[inline(always)]
fn influences<N: Number, const D: usize>(bond: &Bond<N, D>, of: &Multipliers<N>) -> [N; 2] {
    let (trial, [lambda, tau]) = of;
    let along = extensions(&bond.xi);
    let square = deviators::<N, D>(&along, bond.length, bond.inv_length);
    let (mut omega, mut sigma) = (trial[0] * bond.omega, trial[1] * bond.omega);
    for k in 0..probes(D) {
        omega = lambda[k].fma(along[k], omega);
        sigma = tau[k].fma(square[k], sigma);
    }
    let zero = N::constant(0.0);
    [
        zero.choose(bond.omega, omega, zero),
        zero.choose(bond.omega, sigma, zero),
    ]
}

/// The multipliers of a family.
fn multipliers<const D: usize>(reference: &ReferenceFamily<D>, trial: Option<f64>) -> Form<f64> {
    let d = D as f64;
    let m = tensor::trace(&reference.shape());
    if !(m > 0.0) {
        return (([0.0; 2], [[0.0; PROBES]; 2]), 0.0);
    }
    let scale = match trial {
        Some(trial) => [trial; 2],
        None => [d / m, d * (d + 2.0) / (2.0 * m)],
    };
    // Gram's matrices of the probes, and what the trial functions leave of what they ought to give
    let mut gram = [[[0.0; PROBES]; PROBES]; 2];
    let mut left = [[0.0; PROBES]; 2];
    for k in 0..probes(D) {
        let [a, b] = AXES[k];
        left[0][k] = if a == b { 1.0 } else { 0.0 };
        left[1][k] = if a == b { 1.0 - 1.0 / d } else { 2.0 };
    }
    reference.each(|p| {
        if !(p.omega > 0.0) {
            return;
        }
        let length = p.xi.iter().map(|x| x * x).sum::<f64>().sqrt();
        let along = extensions(&p.xi);
        let square = deviators::<f64, D>(&along, length, 1.0 / length);
        for (n, of) in [along, square].iter().enumerate() {
            for r in 0..PROBES {
                left[n][r] -= scale[n] * p.omega * p.volume * of[r];
                for c in 0..PROBES {
                    gram[n][r][c] += p.volume * of[r] * of[c];
                }
            }
        }
    });
    let mut found = [[0.0; PROBES]; 2];
    for n in 0..2 {
        let (inverse, _) = tensor::inverse_within(gram[n], SINGULAR);
        found[n] = tensor::times(&inverse, &left[n]);
    }
    if reference.damaged {
        // energies of shear may be of either sign where weights are
        let mut part = 1.0f64;
        reference.each(|p| {
            let bond = Bond::new(p.xi, [0.0; D], p.omega);
            let [_, trial] = influences(&bond, &(scale, [[0.0; PROBES]; 2]));
            let [_, sigma] = influences(&bond, &(scale, found));
            if sigma < 0.0 {
                part = part.min(trial / (trial - sigma));
            }
        });
        found[1] = found[1].map(|tau| part * tau);
    }
    let own = (scale, found);
    let mut square = 0.0;
    reference.each(|p| {
        let bond = Bond::new(p.xi, [0.0; D], p.omega);
        let [_, sigma] = influences(&bond, &own);
        square += sigma * p.volume * bond.length * bond.length;
    });
    (own, square)
}

/// What of the eigenvalues of Gram's matrix is no direction of its family, but rounding.
const SINGULAR: f64 = 1e-11;

impl<const D: usize> Material<D> for PositionAware {
    /// κ and μ
    type Constants<N: Number> = [N; 2];
    type Form<N: Number> = Form<N>;
    type Sum<N: Number> = Sum<N>;
    type Point<N: Number> = Point<N>;
    type Past<N: Number> = [N; 0];
    type Memory<N: Number> = [N; 0];
    type State<N: Number> = Along<N>;
    const PASSES: usize = 1;
    const FORM_OF_WHOLE: bool = true;
    const STIFFENS_DAMAGED: bool = true;

    fn constants(&self, material: usize, _: f64) -> [f64; 2] {
        let m = &self.materials[material];
        [m.bulk, m.shear]
    }

    fn form(&self, material: usize, reference: ReferenceFamily<D>) -> Form<f64> {
        multipliers(&reference, self.materials[material].trial)
    }

    /// `θ² ≤ A Σ ω₀ ν V e²` with `A = Σ ν V (ω|ξ|)²/ω₀` of the influence function ω₀, and `Σ σ ε² ≤ 2 Σ |σ| (e² + θ²|ξ|²/D²)`.
    fn stiffness(&self, material: usize, reference: ReferenceFamily<D>) -> f64 {
        let m = &self.materials[material];
        let (own, _) = multipliers(&reference, m.trial);
        let (mut spread, mut most, mut square) = (0.0, 0.0f64, 0.0);
        reference.each(|p| {
            if p.omega > 0.0 {
                let bond = Bond::new(p.xi, [0.0; D], p.omega);
                let [omega, sigma] = influences(&bond, &own);
                let length = bond.length * bond.length;
                spread += p.volume * omega * omega * length / p.omega;
                most = most.max(sigma.abs() / p.omega);
                square += p.volume * sigma.abs() * length;
            }
        });
        let part = 1.0 / D as f64;
        spread * (0.5 * m.bulk + 2.0 * m.shear * part * part * square) + 2.0 * m.shear * most
    }

    #[inline(always)]
    fn pair_pass<N: Number>(&self, _: usize, bond: &Bond<N, D>, _: &Ends<N>) -> Sum<N> {
        let zero = N::constant(0.0);
        let e = zero.choose(bond.omega, bond.extension(), zero);
        let pull = bond.length * e;
        let mut along = extensions(&bond.xi);
        let mut square = deviators::<N, D>(&along, bond.length, bond.inv_length);
        for k in 0..probes(D) {
            along[k] = along[k] * e * bond.length;
            square[k] = square[k] * pull;
        }
        (bond.omega * pull, [along, square])
    }

    #[inline(always)]
    fn point_update<N: Number>(
        &self,
        _: usize,
        site: &Site<N, [N; 2], Form<N>, [N; 0]>,
        (trial, [along, square]): Sum<N>,
        point: &mut Point<N>,
    ) {
        let [bulk, shear] = *site.constants;
        let (own, whole) = site.form;
        let (scale, [lambda, tau]) = own;
        let (mut theta, mut pull) = (scale[0] * trial, scale[1] * trial);
        for k in 0..probes(D) {
            theta = lambda[k].fma(along[k], theta);
            pull = tau[k].fma(square[k], pull);
        }
        // Σ σ ε |ξ|
        let part = N::constant(1.0 / D as f64);
        let deviator = pull - part * theta * *whole;
        let pressure = bulk * theta - (part + part) * shear * deviator;
        *point = ([theta, pressure], *own);
    }

    #[inline(always)]
    fn force_state<N: Number>(&self, bond: &Bond<N, D>, end: &Ends<N>) -> Along<N> {
        let ([theta, pressure], own) = end.point;
        let [omega, sigma] = influences(bond, own);
        let mean = theta.times(1.0 / D as f64);
        let deviator = (bond.stretch - mean) * bond.length;
        let shear = end.constants[1];
        let t = (*pressure * bond.length).fma(omega, (shear + shear) * sigma * deviator);
        Along(t * bond.inv_current)
    }

    #[inline(always)]
    fn energy<N: Number>(&self, bond: &Bond<N, D>, end: &Ends<N>) -> N {
        let ([theta, _], own) = end.point;
        let [_, sigma] = influences(bond, own);
        let mean = theta.times(1.0 / D as f64);
        let deviator = (bond.stretch - mean) * bond.length;
        end.constants[1] * sigma * deviator * deviator
    }

    #[inline(always)]
    fn point_energy<N: Number>(
        &self,
        site: &Site<N, [N; 2], Form<N>, [N; 0]>,
        _: Sum<N>,
        point: &Point<N>,
    ) -> N {
        let theta = point.0[DILATION];
        N::constant(0.5) * site.constants[0] * theta * theta
    }
}

impl Registered for PositionAware {
    fn descriptor() -> Descriptor {
        Descriptor::new(
            "pals",
            "Linear peridynamic solid whose points near surfaces weigh their bonds so that dilatation and shear are those of any uniform strain: W = ½ K θ² + μ Σ σ ε². Two of young, poisson, bulk, shear.",
        )
        .source("Mitchell, Silling & Littlewood 2015")
        .example("{ young = \"72 GPa\", poisson = 0.22 }")
        .influence(Influence::Constant)
        .keys(&MODULI)
        .keys(&[descriptor::number(
            "trial",
            Dimension([-5, 0, 0, 0]),
            Bounds::POSITIVE,
            "How many times the influence function the trial functions ω₀ and σ₀ are, which the weights of bonds are nearest to; by default n/m and n(n + 2)/(2m), as is right in an isotropic family.",
        )
        .need(Need::Optional)])
    }

    fn linear(parameters: &Parameters) -> Result<LawSpec, String> {
        descriptor::moduli(parameters).map(LawSpec::Lps)
    }

    fn of_one_horizon(_: &Parameters) -> Option<&'static str> {
        Some(
            "this law corrects the weights of whole cells: where a horizon passed a point, its stiffness would jump",
        )
    }

    fn make(d: usize, plane: Plane, materials: &[Given]) -> Result<Self, (usize, String)> {
        let of = |m: &Given| {
            let moduli = descriptor::moduli(m.parameters)?;
            Ok(PositionAwareConstants {
                bulk: moduli.lame_of(d, plane) + 2.0 / d as f64 * moduli.shear(),
                shear: moduli.shear(),
                trial: m.parameters.number("trial"),
            })
        };
        let materials = descriptor::each(materials, of)?;
        Ok(PositionAware { materials })
    }
}

#[cfg(test)]
mod tests {
    use super::super::Partner;
    use super::*;

    /// Bonds of a corner, intact and damaged: traces of all strains are exact, and so is the shear energy of the probes.
    #[test]
    fn probes_are_met_at_a_corner() {
        let mut bonds = vec![];
        for z in 0..=2 {
            for y in 0..=2 {
                for x in -1..=2 {
                    let xi = [f64::from(x), f64::from(y) * 1.1, f64::from(z) - 0.3];
                    let length = xi.iter().map(|x| x * x).sum::<f64>().sqrt();
                    if (x, y, z) != (0, 0, 0) && length < 2.3 {
                        bonds.push(Partner {
                            xi,
                            omega: 1.0 / length,
                            volume: 0.7 + 0.1 * f64::from(x),
                        });
                    }
                }
            }
        }
        for trial in [None, Some(0.3)] {
            let each = |visit: &mut dyn FnMut(&Partner<3>)| bonds.iter().for_each(visit);
            let (own, _) = multipliers(&ReferenceFamily::new(&each), trial);
            let h = [[0.3, -0.2, 0.5], [-0.2, 0.1, 0.4], [0.5, 0.4, -0.7]];
            let mut theta = 0.0;
            let mut energies = [0.0; PROBES];
            for p in &bonds {
                let bond = Bond::new(p.xi, [0.0; 3], p.omega);
                let [omega, sigma] = influences(&bond, &own);
                let hx = tensor::times(&h, &p.xi);
                theta += omega * p.volume * (0..3).map(|a| hx[a] * p.xi[a]).sum::<f64>();
                let along = extensions(&p.xi);
                let square = deviators::<f64, 3>(&along, bond.length, bond.inv_length);
                for k in 0..PROBES {
                    energies[k] += sigma * p.volume * square[k];
                }
            }
            assert!((theta - (0.3 + 0.1 - 0.7)).abs() < 1e-12, "{theta}");
            for (k, energy) in energies.iter().enumerate() {
                let [a, b] = AXES[k];
                let exact = if a == b { 2.0 / 3.0 } else { 2.0 };
                assert!((energy - exact).abs() < 1e-11, "{k}: {energy}");
            }
        }
    }

    /// 14 of the 32 bonds of a cubic family have negative weights of shear among them, unless the others broke.
    #[test]
    fn torn_families_have_no_negative_weights() {
        let mut bonds = vec![];
        for z in -2i32..=2 {
            for y in -2i32..=2 {
                for x in -2i32..=2 {
                    let before = x > 0 || (x == 0 && y > 0);
                    if x * x + y * y + z * z <= 4 && before {
                        bonds.push(Partner {
                            xi: [x, y, z].map(f64::from),
                            omega: 1.0,
                            volume: 1.0,
                        });
                    }
                }
            }
        }
        let each = |visit: &mut dyn FnMut(&Partner<3>)| bonds.iter().for_each(visit);
        let least = |damaged: bool| {
            let (own, _) = multipliers(&ReferenceFamily::new(&each).damaged(damaged), None);
            let of = |p: &Partner<3>| influences(&Bond::new(p.xi, [0.0; 3], p.omega), &own);
            let all: Vec<[f64; 2]> = bonds.iter().map(of).collect();
            let theta = |k: usize| {
                let along = |(w, p): (&[f64; 2], &Partner<3>)| w[0] * extensions(&p.xi)[k];
                all.iter().zip(&bonds).map(along).sum::<f64>()
            };
            assert!((theta(0) - 1.0).abs() < 1e-12 && theta(2).abs() < 1e-12);
            all.iter().fold(f64::INFINITY, |least, w| least.min(w[1]))
        };
        assert!(least(false) < 0.0, "{}", least(false));
        let damaged = least(true);
        assert!(damaged.abs() < 1e-12, "{damaged}");
    }
}
