//! (5.2) as it is printed, term by term.

use peridyne_theory::exact::polynomial::JetPolynomial;
use peridyne_theory::exact::{Field, Q, q, zeta};

/// C(n, k)
fn binomial(n: i64, k: i64) -> Q {
    (0..k).fold(q(1, 1), |c, i| c * q(n - i, i + 1))
}

/// One brace with the factor before it: `1/(y′)^{n+2} { C(n+1, 1)(…) − 1/y′ C(n+2, 2)(…) + … }`, by powers a⁰, a², a⁴ without
/// the ratios of Z. A term is its factor, the number of 1/y′ before it, and the powers of y″, y‴, y⁗, ….
fn brace(n: i64) -> [JetPolynomial<Q>; 3] {
    let term = |c: Q, divided: i32, powers: &[i32]| {
        let mut all = vec![-(n as i32) - 2 - divided];
        all.extend(powers);
        JetPolynomial::term(c, &all)
    };
    let [b1, b2, b3, b4, b5] = [1, 2, 3, 4, 5].map(|k| binomial(n + k, k));
    let second = term(b1.clone() * q(1, 2), 0, &[1]);
    let fourth = [
        term(b1.clone() * q(1, 24), 0, &[0, 0, 1]),
        term(-b2.clone() * q(1, 6), 1, &[1, 1]),
        term(b3.clone() * q(1, 8), 2, &[3]),
    ];
    let sixth = [
        term(b1 * q(1, 720), 0, &[0, 0, 0, 0, 1]),
        term(-b2.clone() * q(1, 120), 1, &[1, 0, 0, 1]),
        term(-b2 * q(1, 72), 1, &[0, 1, 1]),
        term(b3.clone() * q(1, 32), 2, &[2, 0, 1]),
        term(b3 * q(1, 24), 2, &[1, 2]),
        term(-b4 * q(1, 12), 3, &[3, 1]),
        term(b5 * q(1, 32), 4, &[5]),
    ];
    let sum =
        |terms: &[JetPolynomial<Q>]| terms.iter().fold(JetPolynomial::zero(), |s, t| s.add(t));
    [second, sum(&fourth), sum(&sixth)]
}

/// The right side of (5.2) for N neighbours: `8ε̄ [12σ̄¹² {…} − 6σ̄⁶ {…}]`, by gradient orders 2, 4, 6.
pub fn gradient_equation(epsilon: &Q, sigma6: &Q, a: &Q, n: usize) -> Vec<JetPolynomial<Q>> {
    let z = |m: i32| zeta::<Q>(n, m);
    let repulsion = brace(12);
    let attraction = brace(6);
    // Z_N(12 − 2p)/Z_N(12), Z_N(6 − 2p)/Z_N(6)
    (0..3)
        .map(|p| {
            let down = 2 * p as i32;
            let factor = q(8, 1) * epsilon * a.to(down);
            let strong = q(12, 1) * sigma6 * sigma6 * z(12 - down) / z(12);
            let weak = q(6, 1) * sigma6 * z(6 - down) / z(6);
            let right = repulsion[p].scale(&strong).sub(&attraction[p].scale(&weak));
            right.scale(&factor)
        })
        .collect()
}
