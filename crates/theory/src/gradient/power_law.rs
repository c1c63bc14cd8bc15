//! Chains whose bonds follow sums of power laws, `φ = Σ A_n r^{−n}`: the full nonlinear gradient equation.
//!
//! A point's force is `Σ_j φ′(y(x + jΔx) − y(x)) − φ′(y(x) − y(x − jΔx))`. With the Taylor series of y,
//! `r^{−n−1} = (jΔx y′)^{−n−1} (1 + Σ_{k≥2} (jΔx)^{k−1} y⁽ᵏ⁾/(k! y′))^{−n−1}`; the part odd in j stays, so that order
//! p carries `Z_N(n − 2p) Δx^{2p−n}` times a polynomial that knows nothing of the chain. For n = 12 and 6 this is
//! seleson2009 (5.2), (5.4).

use super::Expansion;
use crate::exact::polynomial::JetPolynomial;
use crate::exact::{Field, factorial, zeta};
use std::fmt;

/// A chain of points, every one bound to `neighbours` on each side.
#[derive(Debug, Clone, PartialEq)]
pub struct PowerLawChain<F> {
    /// `(n, A_n / Δx)`: `φ/Δx = Σ (A_n/Δx) r^{−n}` (energy per length times length^n).
    pub amplitudes: Vec<(i32, F)>,
    /// Δx (length).
    pub spacing: F,
    /// N
    pub neighbours: usize,
}

/// One gradient order of one power law: `Z_N(zeta) Δx^spacing · polynomial`, for any chain.
#[derive(Debug, Clone, PartialEq)]
pub struct SymbolicOrder<F> {
    /// Index of `Z_N(n) = Σ_{j≤N} j^{−n}`.
    pub zeta: i32,
    /// Power of Δx.
    pub spacing: i32,
    pub polynomial: JetPolynomial<F>,
}

impl<F: Field> SymbolicOrder<F> {
    pub(super) fn new(n: i32, p: usize, polynomial: JetPolynomial<F>) -> Self {
        let shift = 2 * p as i32;
        SymbolicOrder {
            zeta: n - shift,
            spacing: shift - n,
            polynomial,
        }
    }

    /// On a chain, with the amplitude `A_n/Δx`.
    pub fn on(&self, chain: &PowerLawChain<F>, amplitude: &F) -> JetPolynomial<F> {
        let z: F = zeta(chain.neighbours, self.zeta);
        self.polynomial
            .scale(&(amplitude.clone() * z * chain.spacing.to(self.spacing)))
    }
}

impl<F: Field + fmt::Display> fmt::Display for SymbolicOrder<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "Z({}) Δx^{} [{}]",
            self.zeta, self.spacing, self.polynomial
        )
    }
}

/// Force density of the part `r^{−n}` with amplitude 1, by gradient orders 2, 4, ….
pub fn orders<F: Field>(n: i32, terms: usize) -> Vec<SymbolicOrder<F>> {
    let exponent = -n - 1;
    let strain: Vec<JetPolynomial<F>> = (0..2 * terms)
        .map(|k| match k {
            0 => JetPolynomial::term(F::one(), &[]),
            k => JetPolynomial::derivative_of_order(k + 1, F::one() / factorial(k + 1))
                .mul(&JetPolynomial::term(F::one(), &[-1])),
        })
        .collect();
    let power = binomial(&strain, exponent);
    (0..terms)
        .map(|p| {
            let c = F::whole(-2 * n as i64);
            let polynomial = power[2 * p + 1].mul(&JetPolynomial::term(c, &[exponent]));
            SymbolicOrder::new(n, p, polynomial)
        })
        .collect()
}

/// `(1 + a_1 h + a_2 h² + …)^α`, by `n b_n = Σ_k (kα − (n − k)) a_k b_{n−k}`.
pub(super) fn binomial<F: Field>(a: &[JetPolynomial<F>], alpha: i32) -> Vec<JetPolynomial<F>> {
    let mut b = vec![JetPolynomial::term(F::one(), &[])];
    for n in 1..a.len() as i64 {
        let mut sum = JetPolynomial::zero();
        for k in 1..=n {
            let c = F::ratio(k * alpha as i64 - (n - k), n);
            sum = sum.add(&a[k as usize].mul(&b[(n - k) as usize]).scale(&c));
        }
        b.push(sum);
    }
    b
}

impl<F: Field> PowerLawChain<F> {
    /// Lennard-Jones molecular dynamics, seleson2009 (5.1): `φ = 4ε [σ¹²/r¹² − σ⁶/r⁶]`, from `σ⁶`.
    pub fn lennard_jones(epsilon: F, sigma6: F, spacing: F, neighbours: usize) -> Self {
        let depth = F::whole(4) * epsilon / spacing.clone();
        PowerLawChain {
            amplitudes: vec![
                (12, depth.clone() * sigma6.clone() * sigma6.clone()),
                (6, -(depth * sigma6)),
            ],
            spacing,
            neighbours,
        }
    }

    /// The upscaled model, seleson2009 (5.3), from ε̄ (energy / length) and `σ̄⁶` (–).
    pub fn lennard_jones_upscaled(epsilon: F, sigma6: F, spacing: F, neighbours: usize) -> Self {
        let depth = F::whole(4) * epsilon;
        let s6 = sigma6 * spacing.to(6);
        let z = |n| zeta::<F>(neighbours, n);
        PowerLawChain {
            amplitudes: vec![
                (12, depth.clone() * s6.clone() * s6.clone() / z(12)),
                (6, -(depth * s6 / z(6))),
            ],
            spacing,
            neighbours,
        }
    }

    /// ε̄ and `σ̄⁶` of (5.1) (seleson2009, below (5.2)): `ε̄ = Z_N(6)²/Z_N(12) ε/a`, `σ̄⁶ = Z_N(12)/Z_N(6) (σ/a)⁶`.
    pub fn upscaled_parameters(epsilon: F, sigma6: F, spacing: F, neighbours: usize) -> [F; 2] {
        let z = |n| zeta::<F>(neighbours, n);
        [
            z(6) * z(6) / z(12) * epsilon / spacing.clone(),
            z(12) / z(6) * sigma6 / spacing.to(6),
        ]
    }

    /// Gradient orders 2, 4, …, 2 `terms`.
    pub fn expansion(&self, terms: usize) -> Expansion<F> {
        let mut sum = vec![JetPolynomial::zero(); terms];
        for (n, amplitude) in &self.amplitudes {
            for (part, order) in sum.iter_mut().zip(orders(*n, terms)) {
                *part = part.add(&order.on(self, amplitude));
            }
        }
        Expansion { orders: sum }
    }

    /// Force density of the points themselves at `x`, exactly.
    pub fn force_density(&self, y: impl Fn(f64) -> f64, x: f64) -> f64 {
        let h = self.spacing.value();
        let slope = |r: f64| -> f64 {
            self.amplitudes
                .iter()
                .map(|(n, a)| -f64::from(*n) * a.value() * r.powi(-n - 1))
                .sum()
        };
        (1..=self.neighbours)
            .map(|j| {
                let d = j as f64 * h;
                slope(y(x + d) - y(x)) - slope(y(x) - y(x - d))
            })
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::{Q, q};

    /// The brace of (5.2) for one power, as printed: `1/(y′)^{n+2} { … }` with `C(n+1,1)`, …, and the two ratios of Z.
    fn printed(n: i64, z4: &Q, z6: &Q) -> Vec<JetPolynomial<Q>> {
        let binomial = |a: i64, b: i64| (0..b).fold(q(1, 1), |c, k| c * q(a - k, k + 1));
        let m = -(n as i32) - 2;
        let t = |c: Q, slope: i32, rest: &[i32]| {
            let mut powers = vec![m + slope];
            powers.extend(rest);
            JetPolynomial::term(c, &powers)
        };
        let b = [
            binomial(n + 1, 1),
            -binomial(n + 2, 2),
            binomial(n + 3, 3),
            -binomial(n + 4, 4),
            binomial(n + 5, 5),
        ];
        let second = t(&b[0] * q(1, 2), 0, &[1]);
        let fourth = t(&b[0] * q(1, 24), 0, &[0, 0, 1])
            .add(&t(&b[1] * q(1, 6), -1, &[1, 1]))
            .add(&t(&b[2] * q(1, 8), -2, &[3]));
        let sixth = t(&b[0] * q(1, 720), 0, &[0, 0, 0, 0, 1])
            .add(&t(&b[1] * q(1, 120), -1, &[1, 0, 0, 1]))
            .add(&t(&b[1] * q(1, 72), -1, &[0, 1, 1]))
            .add(&t(&b[2] * q(1, 32), -2, &[2, 0, 1]))
            .add(&t(&b[2] * q(1, 24), -2, &[1, 2]))
            .add(&t(&b[3] * q(1, 12), -3, &[3, 1]))
            .add(&t(&b[4] * q(1, 32), -4, &[5]));
        vec![second, fourth.scale(z4), sixth.scale(z6)]
    }

    #[test]
    fn seleson2009_5_2_as_printed() {
        let (epsilon, sigma6, a) = (q(3, 7), q(5, 11), q(4, 3));
        for neighbours in [1, 2, 4, 7] {
            let z = |n| zeta::<Q>(neighbours, n);
            let chain = PowerLawChain::lennard_jones(
                epsilon.clone(),
                sigma6.clone(),
                a.clone(),
                neighbours,
            );
            let [e, s6] = PowerLawChain::upscaled_parameters(
                epsilon.clone(),
                sigma6.clone(),
                a.clone(),
                neighbours,
            );
            let found = chain.expansion(3);
            let repulsion = printed(12, &(z(10) / z(12)), &(z(8) / z(12)));
            let attraction = printed(6, &(z(4) / z(6)), &(z(2) / z(6)));
            for p in 0..3 {
                let expected = repulsion[p]
                    .scale(&(q(12, 1) * &s6 * &s6))
                    .sub(&attraction[p].scale(&(q(6, 1) * &s6)))
                    .scale(&(q(8, 1) * &e * a.to(2 * p as i32)));
                assert_eq!(found.orders[p], expected, "order {p}, N = {neighbours}");
            }
            let upscaled = PowerLawChain::lennard_jones_upscaled(e, s6, a.clone(), neighbours);
            assert_eq!(upscaled, chain);
        }
    }

    #[test]
    fn the_equation_meets_the_points_to_the_next_order() {
        let jet = |x: f64| {
            let (c, s) = ((0.7 * x).cos(), (0.7 * x).sin());
            let mut d = vec![];
            for k in 1..=12i32 {
                let trig = [s, c, -s, -c][(k % 4) as usize];
                d.push(0.2 * 0.7f64.powi(k) * trig + if k == 1 { 1.0 } else { 0.0 });
            }
            d
        };
        let y = |x: f64| x + 0.2 * (0.7 * x).sin();
        for terms in 1..=4 {
            let error = |h: f64| {
                let chain = PowerLawChain::lennard_jones_upscaled(1.0 / 72.0, 0.5, h, 3);
                let e = chain.expansion(terms).at(&jet(0.4));
                (e - chain.force_density(y, 0.4)).abs()
            };
            let h = [0.02, 0.04, 0.08, 0.12][terms - 1];
            let order = (error(2.0 * h) / error(h)).log2();
            assert!(
                (order - 2.0 * terms as f64).abs() < 0.15,
                "{terms}: {order}"
            );
        }
    }

    #[test]
    fn squares_are_linear() {
        // φ = ½ r²: every order is y⁽²ᵖ⁺²⁾ with 2/(2p+2)! Z(−2p−2)
        for (p, order) in orders::<Q>(-2, 4).into_iter().enumerate() {
            let c = q(4, 1) / factorial::<Q>(2 * p + 2);
            let expected = JetPolynomial::derivative_of_order(2 * p + 2, c);
            assert_eq!(order.polynomial, expected);
        }
    }

    #[test]
    fn orders_print_with_their_sums() {
        let second = orders::<Q>(12, 2)[0].to_string();
        assert_eq!(second, "Z(12) Δx^-12 [(156) y'' y'^-14]");
        let fourth = orders::<Q>(6, 2)[1].to_string();
        assert!(fourth.starts_with("Z(4) Δx^-4 ["), "{fourth}");
    }
}
