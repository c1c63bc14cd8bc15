//! Bonds with two stiffnesses, along and across (after Gerstle, Sau & Silling 2007; Zhu & Ni 2017), in two and three dimensions:
//! `W = ½ Σ ω ν V |ξ| ½ (c s² + κ γ²)`, with the stretch s of `pmb` and the part of the deformation across the bond
//! `γ² = |y − Rξ|²/|ξ|² − s² = 2 (|y|/|ξ|) (1 − cos φ)`, `y = ξ+η`, φ the angle between the bond as it is and as the turned family would have it.
//!
//! R is the rotation of the point for which W is least. Since `Σ ω ν V |ξ| γ²` depends on R by `−2 tr(Rᵀ N)` alone, `N = Σ (ω ν V/|ξ|) y⊗ξ`, it is
//! the rotation of N = RU (Procrustes; Kabsch 1976). W does not change with R there, so the force state is the derivative at a fixed R,
//! `T⟨ξ⟩ = ½ ω (c s y/|y| + κ (y/|y| − Rξ/|ξ|))`; and since N Rᵀ is symmetric, no point has a moment: `Σ ω ν V y × T = 0`.
//!
//! With `⟨(n·εn)²⟩ = (tr²ε + 2 ε:ε)/(D(D+2))`, `⟨|εn|²⟩ = ε:ε/D` and `M1 = Σ ω ν V |ξ|` uniform strain has
//! `λ = M1 (c − κ)/(2D(D+2))` and `G = M1 (2c + Dκ)/(4D(D+2))`, λ of the D dimensions: `c = 2D (Dλ + 2G)/M1`, `κ = 4D (G − λ)/M1`.
//! κ ≥ 0 makes W a sum of squares, whatever bonds are whole: then ν is at most 1/4, in plane stress 1/3, where κ = 0 is `pmb`.
//! A point whose bonds do not span a plane has no rotation, and none of its bonds has a force state across.

use super::tensor::{self, Matrix};
use super::{Bond, End, Free, Material, ReferenceFamily, Site};
use crate::law::descriptor::{self, Descriptor, Given, MODULI, Registered};
use crate::law::number::Number;
use crate::spec::{LawSpec, Parameters, Plane};

/// Stiffnesses of one material (force / volume²).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BondRotationConstants {
    /// c, along bonds.
    pub along: f64,
    /// κ, across them.
    pub across: f64,
}

impl BondRotationConstants {
    /// From λ of the D dimensions, G and M1 (see the module).
    pub fn new(d: usize, lambda: f64, shear: f64, first_moment: f64) -> Self {
        let d = d as f64;
        BondRotationConstants {
            along: 2.0 * d * (d * lambda + 2.0 * shear) / first_moment,
            across: 4.0 * d * (shear - lambda) / first_moment,
        }
    }
}

/// See the module.
#[derive(Debug, Clone)]
pub struct BondRotation {
    /// Per material.
    pub materials: Vec<BondRotationConstants>,
}

/// Of the bonds as they were, `K = Σ (ω ν V/|ξ|) ξ⊗ξ`: `K/k − 1` with `k = tr K/D`, then 1/k and 1 where they span a plane.
type Form<N, const D: usize> = (Matrix<N, D>, [N; 2]);
/// R − 1, and 1 where there is one.
type Point<N, const D: usize> = (Matrix<N, D>, N);
type Ends<'a, N, const D: usize> = End<'a, [N; 2], Point<N, D>, [N; 0]>;

/// The part of its largest eigenvalue above which the second one of K counts.
const SPAN: f64 = 1e-2;
/// Volume of `½ (N + cof N)/k^D`, 1 at rest, below which a family has no rotation that could be told.
const FLAT: f64 = 1e-9;
/// Of Newton's method, from where [`SPAN`] lets it begin.
const STEPS: usize = 14;

/// `y − Rξ` and Rξ.
#[inline(always)]
fn rotated<N: Number, const D: usize>(bond: &Bond<N, D>, turn: &Matrix<N, D>) -> [[N; D]; 2] {
    let more = tensor::times(turn, &bond.xi);
    let (mut off, mut turned) = (bond.eta, bond.xi);
    for a in 0..D {
        off[a] = bond.eta[a] - more[a];
        turned[a] = bond.xi[a] + more[a];
    }
    [off, turned]
}

impl<const D: usize> Material<D> for BondRotation {
    /// ½c and ½κ
    type Constants<N: Number> = [N; 2];
    type Form<N: Number> = Form<N, D>;
    /// `Σ (ω/|ξ|) η⊗ξ`
    type Sum<N: Number> = Matrix<N, D>;
    type Point<N: Number> = Point<N, D>;
    type Past<N: Number> = [N; 0];
    type Memory<N: Number> = [N; 0];
    type State<N: Number> = Free<N, D>;
    const PASSES: usize = 1;
    const OF_BONDS: bool = true;
    const FORM_OF_WHOLE: bool = true;

    fn constants(&self, material: usize, _: f64) -> [f64; 2] {
        let m = &self.materials[material];
        [0.5 * m.along, 0.5 * m.across]
    }

    fn form(&self, _: usize, reference: ReferenceFamily<D>) -> Form<f64, D> {
        let mut k = tensor::zero::<f64, D>();
        reference.each(|p| {
            let length = p.xi.iter().map(|x| x * x).sum::<f64>().sqrt();
            let weight = p.omega * p.volume / length;
            for r in 0..D {
                for c in r..D {
                    k[r][c] += weight * (p.xi[r] * p.xi[c]);
                    // to the last digit: a body at rest is not turned
                    k[c][r] = k[r][c];
                }
            }
        });
        let mean = tensor::trace(&k) / D as f64;
        if !(mean > 0.0) {
            return (tensor::zero(), [0.0; 2]);
        }
        let (values, _) = tensor::eigen(k);
        let most = values.iter().fold(0.0f64, |m, x| m.max(*x));
        let spans = values.iter().filter(|x| **x > SPAN * most).count();
        for (r, row) in k.iter_mut().enumerate() {
            for (c, x) in row.iter_mut().enumerate() {
                *x = *x / mean - if r == c { 1.0 } else { 0.0 };
            }
        }
        // in the plane one direction has its rotation
        let known = if spans + 1 >= D { 1.0 } else { 0.0 };
        (k, [1.0 / mean, known])
    }

    #[inline(always)]
    fn pair_pass<N: Number>(&self, _: usize, bond: &Bond<N, D>, _: &Ends<N, D>) -> Matrix<N, D> {
        let mut sum = tensor::zero();
        let weight = bond.omega * bond.inv_length;
        for r in 0..D {
            for c in 0..D {
                sum[r][c] = weight * bond.eta[r] * bond.xi[c];
            }
        }
        sum
    }

    #[inline(always)]
    fn point_update<N: Number>(
        &self,
        _: usize,
        site: &Site<N, [N; 2], Form<N, D>, [N; 0]>,
        sum: Matrix<N, D>,
        point: &mut Point<N, D>,
    ) {
        let (shape, [per_mean, known]) = site.form;
        let (half, zero, one) = (N::constant(0.5), N::constant(0.0), N::constant(1.0));
        // K is symmetric: what turns is the sum's alone, and must not be lost beside K
        let (mut n, mut skew) = (*shape, *shape);
        for r in 0..D {
            for c in 0..D {
                n[r][c] = (half * *per_mean).fma(sum[r][c] + sum[c][r], shape[r][c]);
                skew[r][c] = (half * *per_mean) * (sum[r][c] - sum[c][r]);
            }
        }
        // N and its cofactors are turned alike; together they are so also where the family is flat
        let [cofactors, turned] = tensor::cofactor_apart(&n, &skew);
        for r in 0..D {
            for c in 0..D {
                n[r][c] = half * (n[r][c] + cofactors[r][c]);
                skew[r][c] = half * (skew[r][c] + turned[r][c]);
            }
        }
        let volume = (one + tensor::dilation_apart(&n, &skew)) * *known;
        for r in 0..D {
            for c in 0..D {
                n[r][c] = volume.below(FLAT, zero, n[r][c]);
                skew[r][c] = volume.below(FLAT, zero, skew[r][c]);
            }
        }
        *point = (
            tensor::rotation(&n, &skew, STEPS),
            volume.below(FLAT, zero, one),
        );
    }

    #[inline(always)]
    fn force_state<N: Number>(&self, bond: &Bond<N, D>, end: &Ends<N, D>) -> Free<N, D> {
        let (turn, known) = end.point;
        let [along, across] = *end.constants;
        let [off, turned] = rotated(bond, turn);
        let pull = along * bond.stretch;
        let (across, weight) = (across * *known, bond.omega * bond.inv_current);
        let mut t = bond.xi;
        for a in 0..D {
            // |y| (y/|y| − Rξ/|ξ|), without cancellation
            let beside = off[a] - bond.stretch * turned[a];
            t[a] = weight * pull.fma(bond.xi[a] + bond.eta[a], across * beside);
        }
        Free(t)
    }

    #[inline(always)]
    fn energy<N: Number>(&self, bond: &Bond<N, D>, end: &Ends<N, D>) -> N {
        let (turn, known) = end.point;
        let [along, across] = *end.constants;
        let [off, _] = rotated(bond, turn);
        let mut square = off[0] * off[0];
        for a in 1..D {
            square = off[a].fma(off[a], square);
        }
        let s = bond.stretch * bond.stretch;
        let beside = (square * bond.inv_length).fma(bond.inv_length, N::constant(0.0) - s);
        let stored = along.fma(s, across * *known * beside);
        N::constant(0.5) * bond.omega * bond.length * stored
    }
}

impl Registered for BondRotation {
    const TANGENTIAL_STIFFNESS: bool = true;

    fn descriptor() -> Descriptor {
        Descriptor::new(
            "bond_rotation",
            "Bonds with normal and tangential stiffness (against the rotation of their points): W = ¼ Σ ω ν V |ξ| (c s² + κ γ²), κ ≥ 0. Two of young, poisson, bulk, shear; Poisson's ratio at most 1/4, plane stress 1/3, where it is pmb.",
        )
        .source("Zhu & Ni 2017; Gerstle, Sau & Silling 2007")
        .example("{ young = \"30 GPa\", poisson = 0.15 }")
        .keys(&MODULI)
    }

    fn linear(parameters: &Parameters) -> Result<LawSpec, String> {
        descriptor::moduli(parameters).map(LawSpec::Lps)
    }

    fn make(d: usize, plane: Plane, materials: &[Given]) -> Result<Self, (usize, String)> {
        let of = |m: &Given| {
            let moduli = descriptor::moduli(m.parameters)?;
            let lambda = moduli.lame_of(d, plane);
            let mut made = BondRotationConstants::new(d, lambda, moduli.shear(), m.first_moment);
            // what rounding of a quarter or a third leaves
            if made.across.abs() < 1e-12 * made.along {
                made.across = 0.0;
            }
            if made.across < 0.0 {
                let (most, what) = match (d, plane) {
                    (2, Plane::Stress) => ("1/3", "plane stress"),
                    (2, Plane::Strain) => ("1/4", "plane strain"),
                    _ => ("1/4", "three dimensions"),
                };
                return Err(format!(
                    "a Poisson's ratio of {} needs a negative tangential stiffness, and damaged families of such bonds are not stable: in {what} it is at most {most}; take lps for more",
                    crate::quantity::rounded(moduli.poisson, 6)
                ));
            }
            Ok(made)
        };
        let materials = descriptor::each(materials, of)?;
        Ok(BondRotation { materials })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    type Neighbour<const D: usize> = ([f64; D], f64, f64);

    /// Bonds of a square or cubic lattice of spacing 1, their lengths and volume fractions, in D axes.
    fn family<const D: usize>(m: i32) -> Vec<Neighbour<D>> {
        let mut all = vec![];
        let side = 2 * m + 1;
        for n in 0..side.pow(D as u32) {
            let xi: [f64; D] =
                crate::array::from_fn(|a| f64::from(n / side.pow(a as u32) % side - m));
            let r = xi.iter().map(|x| x * x).sum::<f64>().sqrt();
            if r > 0.0 && r < f64::from(m) + 1e-9 {
                all.push((xi, r, (f64::from(m) + 0.5 - r).min(1.0)));
            }
        }
        all
    }

    /// Least eigenvalue over waves of the acoustic tensor
    /// `Σ (ν/|ξ|)(1 − cos k·ξ)((c − κ) n⊗n + κ 1) − κ (D/4M1)(q² 1 − q⊗q)`, `q = Σ (ν/|ξ|) ξ sin k·ξ`, over `Σ (ν/|ξ|)(1 − cos k·ξ)`: the last
    /// part is what the rotations of the points take.
    fn least<const D: usize>(family: &[Neighbour<D>], c: &BondRotationConstants) -> f64 {
        const PARTS: usize = 8;
        let (d, along, across) = (D as f64, c.along, c.across);
        let first: f64 = family.iter().map(|(_, r, v)| r * v).sum();
        let mut least = f64::INFINITY;
        for n in 1..(PARTS + 1).pow(D as u32) {
            let k: [f64; D] = crate::array::from_fn(|a| {
                PI / PARTS as f64 * (n / (PARTS + 1).pow(a as u32) % (PARTS + 1)) as f64
            });
            let mut tensor = [[0.0; D]; D];
            let (mut q, mut sum) = ([0.0; D], 0.0);
            for (xi, r, v) in family {
                let phase: f64 = (0..D).map(|a| k[a] * xi[a]).sum();
                let w = v / r * (1.0 - phase.cos());
                sum += w;
                for a in 0..D {
                    q[a] += v / r * xi[a] * phase.sin();
                    tensor[a][a] += across * w;
                    for b in 0..D {
                        tensor[a][b] += (along - across) * w * xi[a] * xi[b] / (r * r);
                    }
                }
            }
            let part = across * d / (4.0 * first);
            for a in 0..D {
                for b in 0..D {
                    tensor[a][b] += part * q[a] * q[b];
                    if a == b {
                        tensor[a][a] -= part * q.iter().map(|x| x * x).sum::<f64>();
                    }
                }
            }
            let (values, _) = super::tensor::eigen(tensor);
            least = values.iter().fold(least, |m, x| m.min(x / sum));
        }
        least
    }

    fn limit<const D: usize>(m: i32) -> f64 {
        let family = family::<D>(m);
        let first: f64 = family.iter().map(|(_, r, v)| r * v).sum();
        let at = |poisson: f64| {
            let young = 1.0;
            let moduli = crate::spec::Moduli { young, poisson };
            let lambda = moduli.lame_of(D, Plane::Strain);
            let c = BondRotationConstants::new(D, lambda, moduli.shear(), first);
            assert_eq!(c.across > -1e-12 * c.along, poisson <= 0.25);
            least(&family, &c)
        };
        for sound in [-0.9, -0.5, 0.0, 0.2, 0.25] {
            assert!(at(sound) > 0.0, "{sound}: {}", at(sound));
        }
        let (mut low, mut high) = (0.25, 0.49);
        assert!(at(high) < 0.0);
        for _ in 0..30 {
            let middle = 0.5 * (low + high);
            if at(middle) > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }

    /// Uniform strain is stable up to ½; waves are not.
    #[test]
    fn waves_are_stable_to_a_ratio_near_a_third() {
        for most in [limit::<2>(2), limit::<2>(3), limit::<3>(2), limit::<3>(3)] {
            println!("stable up to {most:.4}");
            assert!((0.34..0.37).contains(&most), "{most}");
        }
    }
}
