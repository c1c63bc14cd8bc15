//! Inner expansion (Arndt & Griebel 2005; seleson2009 section 3.2): every bond's energy is expanded about its midpoint,
//! summed to an energy density of the derivatives of y, and varied.
//!
//! About its midpoint a bond of length jΔx is `r = jΔx y′ (1 + Σ_{k=3,5,…} (jΔx/2)^{k−1} y⁽ᵏ⁾/(k! y′))`; the equation of
//! motion is `ρ ÿ = Σ_k (−1)^{k+1} (d/dx)^k ∂W/∂y⁽ᵏ⁾`. Truncated energies are an energy's equation at any order.

use super::Expansion;
use super::power_law::{PowerLawChain, SymbolicOrder, binomial};
use crate::exact::polynomial::{Coefficient, JetPolynomial};
use crate::exact::{Field, factorial};

/// Energy density of `r^{−n}` with amplitude 1, by powers Δx⁰, Δx², ….
pub fn energy_orders<F: Field>(n: i32, terms: usize) -> Vec<SymbolicOrder<F>> {
    let strain: Vec<JetPolynomial<F>> = (0..terms)
        .map(|p| match 2 * p {
            0 => JetPolynomial::term(F::one(), &[]),
            even => JetPolynomial::derivative_of_order(
                even + 1,
                F::whole(2).to(-(even as i32)) / factorial(even + 1),
            )
            .mul(&JetPolynomial::term(F::one(), &[-1])),
        })
        .collect();
    binomial(&strain, -n)
        .into_iter()
        .map(|p| p.mul(&JetPolynomial::term(F::one(), &[-n])))
        .enumerate()
        .map(|(p, polynomial)| SymbolicOrder::new(n, p, polynomial))
        .collect()
}

/// `Σ_k (−1)^{k+1} (d/dx)^k ∂W/∂y⁽ᵏ⁾`.
pub fn variation<F: Coefficient>(energy: &JetPolynomial<F>) -> JetPolynomial<F> {
    let mut force = JetPolynomial::zero();
    // y′ may be in the coefficients only
    for k in 1..=energy.highest().max(1) {
        let derivative = (0..k).fold(energy.partial(k), |p, _| p.total());
        let sign = if k % 2 == 1 { F::one() } else { -F::one() };
        force = force.add(&derivative.scale(&sign));
    }
    force
}

/// Energy density of a smooth deformation, by powers Δx⁰, Δx², ….
pub fn energy<F: Field>(chain: &PowerLawChain<F>, terms: usize) -> Vec<JetPolynomial<F>> {
    let mut sum = vec![JetPolynomial::zero(); terms];
    for (n, amplitude) in &chain.amplitudes {
        for (part, order) in sum.iter_mut().zip(energy_orders(*n, terms)) {
            *part = part.add(&order.on(chain, amplitude));
        }
    }
    sum
}

/// The gradient equation by this route.
pub fn expansion<F: Field>(chain: &PowerLawChain<F>, terms: usize) -> Expansion<F> {
    Expansion {
        orders: energy(chain, terms).iter().map(variation).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::q;

    #[test]
    fn both_routes_give_one_equation() {
        let chain = PowerLawChain::lennard_jones(q(1, 72), q(2, 5), q(3, 2), 4);
        assert_eq!(expansion(&chain, 4), chain.expansion(4));
        let odd = PowerLawChain {
            amplitudes: vec![(-2, q(1, 2)), (1, q(-3, 1)), (9, q(1, 5))],
            spacing: q(2, 1),
            neighbours: 3,
        };
        assert_eq!(expansion(&odd, 4), odd.expansion(4));
    }

    #[test]
    fn a_homogeneous_deformation_has_the_bonds_energy() {
        let chain = PowerLawChain::lennard_jones(1.3, 0.4, 1.2, 3);
        let w: f64 = energy(&chain, 3).iter().map(|p| p.at(&[1.05])).sum();
        let bonds: f64 = (1..=3)
            .map(|j| {
                let s6 = 0.4 / (1.2 * 1.05 * j as f64).powi(6);
                4.0 * 1.3 * (s6 * s6 - s6) / 1.2
            })
            .sum();
        assert!((w - bonds).abs() < 1e-14);
    }
}
