//! Linear chains: any pair or EAM-like law about its reference state, in fractions where the law allows.
//!
//! `m ü_i = Σ_j K_j (u_{i+j} − 2u_i + u_{i−j}) + F″ Σ_j f_j (g_{i+j} − g_{i−j})`, `g_i = Σ_j f_j (u_{i+j} − u_{i−j})`, so that
//! `ρΔx ω² = Σ_j 2 K_j (1 − cos jkΔx) + F″ (2 Σ_j f_j sin jkΔx)²`, and with k² → −∂²
//! `ρ ü = Σ_p c_{2p+2} ∂^{2p+2} u`.

use super::Expansion;
use crate::crystal::Crystal;
use crate::exact::series::Series;
use crate::exact::{Field, Q, factorial, zeta};
use num_traits::{One, Zero};

/// A chain of points with spacing Δx, about its reference state.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearChain<F> {
    /// Δx (length).
    pub spacing: F,
    /// `K_j`, j = 1…: stiffness of the bond to the j-th neighbour (force / length).
    pub stiffness: Vec<F>,
    /// `f_j`: what its extension adds to the point scalar; may be empty.
    pub share: Vec<F>,
    /// `F″`: stiffness of the point scalar.
    pub curvature: F,
}

impl<F: Field> LinearChain<F> {
    /// Springs `K_j = K(N)/(jΔx)`, `K(N) = 2K₁/(N(N+1))` (seleson2009 (4.1), (A.2)). One neighbour: (4.5).
    pub fn springs(k1: F, spacing: F, neighbours: usize) -> Self {
        let n = neighbours as i64;
        let k = F::whole(2) * k1 / F::whole(n * (n + 1));
        LinearChain {
            stiffness: (1..=n)
                .map(|j| k.clone() / (F::whole(j) * spacing.clone()))
                .collect(),
            spacing,
            share: vec![],
            curvature: F::zero(),
        }
    }

    /// The structured embedded-atom model on a chain of unit section (seleson2014 (4.2)–(4.5) with v_a = Δx), from k̄, c̄
    /// (energy / volume) and the power p of the distance.
    pub fn structured_eam(pair: F, volume: F, p: i32, spacing: F, neighbours: usize) -> Self {
        let v = spacing.clone();
        let length = |j: i64| F::whole(j) * spacing.clone();
        let numbers = 1..=neighbours as i64;
        // ρ0/f0, both sides
        let density = numbers
            .clone()
            .fold(F::zero(), |s, j| s + length(j).to(2 - p))
            * F::whole(2)
            * v.clone();
        LinearChain {
            stiffness: numbers
                .clone()
                .map(|j| pair.clone() / density.clone() * v.clone() * v.clone() * length(j).to(-p))
                .collect(),
            share: numbers
                .map(|j| v.clone() * length(j).to(1 - p) / density.clone())
                .collect(),
            curvature: volume * v,
            spacing,
        }
    }

    /// Bond-based (PMB) bar of unit section, from the micromodulus c and the weights ων of the neighbours on one side:
    /// `K_j = c ων Δx²/(jΔx)`.
    pub fn bond_based(c: F, weights: &[F], spacing: F) -> Self {
        let stiffness = |(j, w): (i64, &F)| c.clone() * w.clone() * spacing.clone() / F::whole(j);
        LinearChain {
            stiffness: (1..).zip(weights).map(stiffness).collect(),
            share: vec![],
            curvature: F::zero(),
            spacing: spacing.clone(),
        }
    }

    /// EAM-like bar (LPS) of unit section, from n, κ, β of the engine's `eam_like::Solid` and the weights ων:
    /// `K_j = 2β ων Δx²/m`, `f_j = n ων jΔx²/m`, `F″ = κΔx`, `m = 2 Σ ων j² Δx³`.
    pub fn state_based([n, kappa, beta]: [F; 3], weights: &[F], spacing: F) -> Self {
        let square = spacing.clone() * spacing.clone();
        let numbered = || (1..).map(F::whole).zip(weights);
        let sum = numbered().fold(F::zero(), |s, (j, w)| s + w.clone() * j.clone() * j);
        let m = F::whole(2) * sum * square.clone() * spacing.clone();
        let scale = square / m;
        LinearChain {
            stiffness: numbered()
                .map(|(_, w)| F::whole(2) * beta.clone() * w.clone() * scale.clone())
                .collect(),
            share: numbered()
                .map(|(j, w)| n.clone() * w.clone() * j * scale.clone())
                .collect(),
            curvature: kappa * spacing.clone(),
            spacing,
        }
    }

    /// Bonds of power laws, `φ = Σ A_n r^{−n}` with `(n, A_n)`, about the unstretched chain: `K_j = φ″(jΔx)`.
    pub fn power_law(amplitudes: &[(i32, F)], spacing: F, neighbours: usize) -> Self {
        let stiffness = |j: i64| {
            let r = F::whole(j) * spacing.clone();
            amplitudes.iter().fold(F::zero(), |s, (n, a)| {
                let c = F::whole(*n as i64) * F::whole(*n as i64 + 1);
                s + a.clone() * c * r.to(-n - 2)
            })
        };
        LinearChain {
            stiffness: (1..=neighbours as i64).map(stiffness).collect(),
            spacing,
            share: vec![],
            curvature: F::zero(),
        }
    }

    /// `c_2, c_4, …` (force / length² times length^{2p}): `ρ ü = Σ c_{2p} ∂^{2p} u`.
    pub fn coefficients(&self, terms: usize) -> Vec<F> {
        let length = 2 * terms + 1;
        let wave = |j: usize| cos_sin(F::whole(j as i64) * self.spacing.clone(), length);
        let mut sum = Series::constant(length, F::zero());
        for (j, k) in self.stiffness.iter().enumerate() {
            let [cos, _] = wave(j + 1);
            let versine = Series::constant(length, F::one()).add(&cos.scale(&-F::one()));
            sum = sum.add(&versine.scale(&(F::whole(2) * k.clone())));
        }
        let mut g = Series::constant(length, F::zero());
        for (j, f) in self.share.iter().enumerate() {
            let [_, sin] = wave(j + 1);
            g = g.add(&sin.scale(&(F::whole(2) * f.clone())));
        }
        sum = sum.add(&g.mul(&g).scale(&self.curvature));
        (1..=terms)
            .map(|p| {
                let sign = if p % 2 == 1 { F::one() } else { -F::one() };
                sign * sum.0[2 * p].clone() / self.spacing.clone()
            })
            .collect()
    }

    /// The gradient equation to order 2 `terms`.
    pub fn expansion(&self, terms: usize) -> Expansion<F> {
        Expansion::linear(&self.coefficients(terms))
    }

    pub fn approximate(&self) -> LinearChain<f64> {
        let values = |v: &[F]| v.iter().map(F::value).collect();
        LinearChain {
            spacing: self.spacing.value(),
            stiffness: values(&self.stiffness),
            share: values(&self.share),
            curvature: self.curvature.value(),
        }
    }
}

/// Cosine and sine of kx as series in k.
fn cos_sin<F: Field>(x: F, terms: usize) -> [Series<F>; 2] {
    let mut series = [0, 1].map(|_| Series::constant(terms, F::zero()));
    let mut term = F::one();
    for n in 0..terms {
        if n > 0 {
            term = term * x.clone() / F::whole(n as i64);
        }
        let sign = if n % 4 < 2 { F::one() } else { -F::one() };
        series[n % 2].0[n] = sign * term.clone();
    }
    series
}

impl LinearChain<f64> {
    /// A chain crystal with one point per cell.
    pub fn of_crystal(crystal: &Crystal<1>) -> Option<Self> {
        if crystal.basis.len() != 1 || !crystal.couplings.is_empty() {
            return None;
        }
        let spacing = crystal.cell[0][0];
        let index = |x: f64| (x / spacing).round() as usize;
        let forward = || crystal.bonds.iter().filter(|b| b.xi[0] > 0.0);
        let far = forward().map(|b| index(b.xi[0])).max()?;
        let (mut stiffness, mut share) = (vec![0.0; far], vec![0.0; far]);
        for bond in forward() {
            let j = index(bond.xi[0]) - 1;
            stiffness[j] += bond.stiffness;
            share[j] += bond.share;
        }
        Some(LinearChain {
            spacing,
            stiffness,
            share,
            curvature: crystal.curvature[0],
        })
    }
}

/// Series of `ω²/(c²k²)` and of `ω/(ck)` in powers of k², c the long-wave speed; `None` if c² is not positive.
pub fn dispersion_series<F: Field + PartialOrd>(coefficients: &[F]) -> Option<[Series<F>; 2]> {
    let first = coefficients.first()?;
    if *first <= F::zero() {
        return None;
    }
    let mut sign = -F::one();
    let relative = coefficients
        .iter()
        .map(|c| {
            sign = -sign.clone();
            sign.clone() * c.clone() / first.clone()
        })
        .collect();
    let square = Series(relative);
    let root = square.sqrt()?;
    Some([square, root])
}

/// Coefficients of the spring integral (seleson2009 (4.3), (4.4)): `c_{2p+2} = K₁ · 4 δ^{2p}/((2p+2)(2p+2)!)`.
pub fn springs_continuum<F: Field>(k1: F, horizon: F, terms: usize) -> Vec<F> {
    (0..terms)
        .map(|p| {
            let n = 2 * p + 2;
            k1.clone() * F::whole(4) * horizon.to(2 * p as i32)
                / (F::whole(n as i64) * factorial::<F>(n))
        })
        .collect()
}

/// Coefficients of the springs with N neighbours in closed form: `K₁ · 4 S_{2p+1}(N) a^{2p}/(N(N+1)(2p+2)!)`,
/// `S_m = Σ j^m`. The papers' (4.2) keeps only the leading power of N.
pub fn springs_closed(k1: &Q, spacing: &Q, neighbours: usize, terms: usize) -> Vec<Q> {
    let n = neighbours as i64;
    (0..terms)
        .map(|p| {
            let s: Q = zeta(neighbours, -(2 * p as i32 + 1));
            k1 * Q::whole(4) * s * spacing.to(2 * p as i32)
                / (Q::whole(n * (n + 1)) * factorial::<Q>(2 * p + 2))
        })
        .collect()
}

/// The factor by which the continuum coefficient of order 2p + 2 differs from that of N neighbours at δ = NΔx, 1 + O(1/N).
pub fn springs_excess(neighbours: usize, terms: usize) -> Vec<Q> {
    let n = Q::whole(neighbours as i64);
    let exact = springs_closed(&Q::one(), &Q::one(), neighbours, terms);
    let limit = springs_continuum(Q::one(), n, terms);
    exact
        .iter()
        .zip(&limit)
        .filter(|(_, l)| !l.is_zero())
        .map(|(e, l)| e / l)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::q;

    #[test]
    fn seleson2009_4_4_and_4_9_as_fractions() {
        let c = springs_continuum(q(1, 1), q(1, 1), 4);
        assert_eq!(c, [q(1, 1), q(1, 24), q(1, 1080), q(1, 80640)]);
        let [square, root] = dispersion_series(&c).unwrap();
        assert_eq!(square.0[..3], [q(1, 1), q(-1, 24), q(1, 1080)]);
        assert_eq!(root.0[..3], [q(1, 1), q(-1, 48), q(17, 69120)]);
    }

    #[test]
    fn seleson2009_4_6_is_one_neighbour() {
        let c = LinearChain::springs(q(1, 1), q(1, 1), 1).coefficients(4);
        assert_eq!(c, [q(1, 1), q(1, 12), q(1, 360), q(1, 20160)]);
    }

    #[test]
    fn finite_chains_have_sums_of_powers() {
        let (k1, a) = (q(5, 3), q(2, 7));
        for n in [1, 2, 3, 8] {
            let found = LinearChain::springs(k1.clone(), a.clone(), n).coefficients(5);
            assert_eq!(found, springs_closed(&k1, &a, n, 5));
        }
        // order 4 at N: exactly 1 + 1/N of the limit
        assert_eq!(springs_excess(8, 3)[..2], [q(1, 1), q(9, 8)]);
    }

    #[test]
    fn structured_eam_on_a_chain() {
        // long waves: c2 = k̄/2 + c̄, whatever the family: W = ½ c̄ ε² + ¼ k̄ ε²
        for (n, p) in [(1, 1), (3, 1), (4, 2), (5, 0)] {
            let chain = LinearChain::structured_eam(q(3, 1), q(7, 2), p, q(1, 3), n);
            assert_eq!(chain.coefficients(1), [q(5, 1)]);
        }
        // one neighbour: k̄/(2Δx) versines and c̄ sin²/Δx
        let c = LinearChain::structured_eam(q(2, 1), q(1, 1), 1, q(1, 1), 1).coefficients(2);
        assert_eq!(c, [q(2, 1), q(1, 12) + q(1, 3)]);
    }

    #[test]
    fn peridynamic_bars() {
        // c = 2K1/δ² of the integral is 1 + 1/N too stiff; with it, the bar is the chain of springs
        let (n, a) = (4, q(1, 4));
        let weights = vec![q(1, 1); n];
        let bar = LinearChain::bond_based(q(2, 1), &weights, a.clone());
        assert_eq!(bar, LinearChain::springs(q(5, 4), a.clone(), n));
        // the structured embedded-atom model is the EAM-like bar with ω = r^{−p}, k̄ = 2β, c̄ = n²κ
        let weights: Vec<Q> = (1..=4).map(|j| (Q::whole(j) * &a).to(-2)).collect();
        let bar = LinearChain::state_based([q(3, 1), q(2, 5), q(7, 2)], &weights, a.clone());
        let eam = LinearChain::structured_eam(q(7, 1), q(18, 5), 2, a, n);
        assert_eq!(bar.coefficients(5), eam.coefficients(5));
    }

    #[test]
    fn lennard_jones_speed() {
        // σ⁶ = ½ a⁶ Z(6)/Z(12) is an equilibrium; c² = 72 ε̄/ρ
        let z = |n| zeta::<Q>(4, n);
        let s6 = z(6) / z(12) / q(2, 1);
        let e = q(1, 72) * z(12) / (z(6) * z(6));
        let amplitudes = [(12, q(4, 1) * &e * &s6 * &s6), (6, q(-4, 1) * &e * &s6)];
        let c = LinearChain::power_law(&amplitudes, q(1, 1), 4).coefficients(1);
        assert_eq!(c, [q(1, 1)]);
    }
}
