//! The nonlinear gradient equation of every pair and embedded-atom law on a chain, before a law is put in.
//!
//! A bond of j spacings is `r = jΔx (y′ + Σ_{k≥1} (jΔx)ᵏ y⁽ᵏ⁺¹⁾/(k+1)!)` long to the one side; to the other Δx changes sign.
//! With `B_{s,m}` the part of `(Σ_k y⁽ᵏ⁺¹⁾/(k+1)!)ᵐ/m!` in which the k add up to s, and the sums P, R, F of [`Symbol`],
//!
//! - bonds: `P_p = 2 Σ_m B_{2p+1,m} P(m+1, m+2p+1)`;
//! - density at x: `ρ = Σ_{s even} Σ_m B_{s,m} R(m, m+s)`, and `G = F′(ρ)/Δx` by Taylor's series about R(0,0);
//! - embedding: a bond carries `(G(x) + G(x ± jΔx)) f′`, so that
//!   `P_p += Σ_{n+w+s=2p+1} (1 + δ_{n0})/n! (dⁿG_w/dxⁿ) Σ_m B_{s,m} R(m+1, m+s+n)`.
//!
//! The coefficients are the fractions in B; power laws turn every sum into a power of y′ (seleson2009 (5.2)).

use super::Expansion;
use super::law_sum::{LawSum, Symbol};
use crate::exact::polynomial::{Coefficient, JetPolynomial};
use crate::exact::{Field, factorial};

type Sum<F> = JetPolynomial<LawSum<F>>;

/// `[m][s]`: the part of weight s of `(Σ_s base_s)ᵐ/m!`; weights add up, `base_0 = 0`.
fn powers<C: Coefficient>(base: &[JetPolynomial<C>]) -> Vec<Vec<JetPolynomial<C>>> {
    let weights = base.len();
    let mut first = vec![JetPolynomial::zero(); weights];
    first[0] = JetPolynomial::term(C::one(), &[]);
    let mut all = vec![first];
    for m in 1..weights {
        let share = C::rational(1, m as i64);
        let next = (0..weights).map(|s| {
            let products = (1..=s).map(|k| base[k].mul(&all[m - 1][s - k]));
            products
                .fold(JetPolynomial::zero(), |sum, p| sum.add(&p))
                .scale(&share)
        });
        let next = next.collect();
        all.push(next);
    }
    all
}

/// `[m][s]`: B_{s,m}.
fn strains<F: Field>(weights: usize) -> Vec<Vec<JetPolynomial<F>>> {
    let base: Vec<JetPolynomial<F>> = (0..weights)
        .map(|k| match k {
            0 => JetPolynomial::zero(),
            k => JetPolynomial::derivative_of_order(k + 1, F::one() / factorial(k + 1)),
        })
        .collect();
    powers(&base)
}

/// `c Σ_m B_{s,m} symbol(m)`.
fn weighted<F: Field>(
    strains: &[Vec<JetPolynomial<F>>],
    s: usize,
    c: i64,
    symbol: impl Fn(usize) -> Symbol,
) -> Sum<F> {
    (0..=s).fold(Sum::zero(), |sum, m| {
        let with = |b: &F| LawSum::term(b.clone() * F::whole(c), &[symbol(m)]);
        sum.add(&strains[m][s].map(with))
    })
}

/// `F^(first)(ρ)/Δx` by weights; odd ones are 0.
fn embedding<F: Field>(strains: &[Vec<JetPolynomial<F>>], first: usize) -> Vec<Sum<F>> {
    let weights = strains.len();
    let density: Vec<Sum<F>> = (0..weights)
        .map(|s| match s % 2 == 0 && s > 0 {
            true => weighted(strains, s, 1, |m| Symbol::Density(m, m + s)),
            false => Sum::zero(),
        })
        .collect();
    let mut sum = vec![Sum::zero(); weights];
    for (k, power) in powers(&density).iter().enumerate() {
        let slope = LawSum::term(F::one(), &[Symbol::Embedding(first + k)]);
        for (part, p) in sum.iter_mut().zip(power) {
            *part = part.add(&p.scale(&slope));
        }
    }
    sum
}

/// Force density by gradient orders 2, 4, …, 2 `terms`; of pair laws unless `embedded`.
pub fn expansion<F: Field>(terms: usize, embedded: bool) -> Expansion<LawSum<F>> {
    let strains = strains::<F>(2 * terms);
    let pair = |p: usize| {
        let s = 2 * p + 1;
        weighted(&strains, s, 2, |m| Symbol::Pair(m + 1, m + s))
    };
    let mut orders: Vec<Sum<F>> = (0..terms).map(pair).collect();
    if embedded {
        for (w, part) in embedding(&strains, 1).into_iter().enumerate() {
            add_embedded(&mut orders, &strains, w, part);
        }
    }
    Expansion { orders }
}

/// What G's part of weight `w` adds.
fn add_embedded<F: Field>(
    orders: &mut [Sum<F>],
    strains: &[Vec<JetPolynomial<F>>],
    w: usize,
    mut g: Sum<F>,
) {
    // g is dⁿG_w/dxⁿ over n!
    for n in 0..strains.len() - w {
        if n > 0 {
            g = g.total().scale(&LawSum::rational(1, n as i64));
        }
        for (p, order) in orders.iter_mut().enumerate() {
            let Some(s) = (2 * p + 1).checked_sub(n + w) else {
                continue;
            };
            let twice = if n == 0 { 2 } else { 1 };
            let slope = weighted(strains, s, twice, |m| Symbol::Density(m + 1, m + s + n));
            *order = order.add(&g.mul(&slope));
        }
    }
}

/// Energy density by powers Δx⁰, Δx², …: `F(ρ)/Δx + Σ_j φ_j/Δx`, of which the force density is the variation.
pub fn energy<F: Field>(terms: usize, embedded: bool) -> Vec<Sum<F>> {
    let strains = strains::<F>(2 * terms);
    let points = match embedded {
        true => embedding(&strains, 0),
        false => vec![Sum::zero(); 2 * terms],
    };
    (0..terms)
        .map(|p| {
            let s = 2 * p;
            weighted(&strains, s, 1, |m| Symbol::Pair(m, m + s)).add(&points[s])
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::Q;
    use crate::gradient::inner::variation;

    #[test]
    fn the_first_orders_read_as_by_hand() {
        let pair = expansion::<Q>(2, false);
        assert_eq!(pair.orders[0].to_string(), "(P(2,2)) y''");
        assert_eq!(
            pair.orders[1].to_string(),
            "(1/12 P(2,4)) y(4) + (1/6 P(3,5)) y''' y'' + (1/24 P(4,6)) y''^3"
        );
        let embedded = expansion::<Q>(1, true);
        assert_eq!(
            embedded.orders[0].to_string(),
            "(F(1) R(2,2) + F(2) R(1,1) R(1,1) + P(2,2)) y''"
        );
    }

    #[test]
    fn force_is_the_variation_of_energy() {
        for (terms, embedded) in [(4, false), (3, true)] {
            let forces: Vec<Sum<Q>> = energy(terms, embedded).iter().map(variation).collect();
            assert_eq!(forces, expansion(terms, embedded).orders);
        }
    }

    #[test]
    fn a_longer_equation_begins_as_a_shorter() {
        let (long, short) = (expansion::<Q>(4, true), expansion::<Q>(2, true));
        assert_eq!(long.orders[..2], short.orders);
        // every term has the gradient order that it is filed under, and one F at most
        for (p, order) in long.orders.iter().enumerate() {
            for (m, c) in order.terms() {
                let weight: usize = (2..=m.highest())
                    .map(|k| (k - 1) * m.power(k) as usize)
                    .sum();
                assert_eq!(weight, 2 * p + 1);
                for (symbols, _) in c.terms() {
                    let slopes = symbols.iter().filter(|s| matches!(s, Symbol::Embedding(_)));
                    assert!(slopes.count() <= 1);
                }
            }
        }
    }
}
