//! f(∞) to any number of digits, with a bound of the error that is proved and not observed.
//!
//! In a long bar the strains tend to 1 (in unit force) away from the ends, exponentially. Half-weight ends break action and
//! reaction on the bonds (1, m+1) and (N−m, N), so that the row of an end is `2F − (1/2m)(e_1 + … + e_m)`, F = m²/2, and
//! must be m²: `f(∞) = 2m³/(2m³ − (e_1 + … + e_m))`. For full ends it is 1.
//!
//! The strains of the half-endless bar come from `f64` solutions for the residual of the strains found so far; that
//! residual is computed in whole numbers, without rounding. G is a sum over bonds of positive terms, those of nearest
//! neighbours alone at least ½: `‖e − e_found‖ ≤ 2 ‖residual‖`.

use super::stiffness_matrix::{StiffnessMatrix, common_denominator};
use super::{Bar, Ends};
use crate::exact::{Field, Q};
use num_bigint::{BigInt, Sign};
use num_traits::{FromPrimitive, One, Signed, ToPrimitive, Zero};
use peridyne_algebra::banded::Banded;

/// A number and how far it may be off.
#[derive(Debug, Clone, PartialEq)]
pub struct Limit {
    pub value: Q,
    pub error: f64,
}

impl Bar {
    /// f(N) for N → ∞, at most 1e-40 off.
    pub fn f_limit(&self) -> Limit {
        if self.ends == Ends::Full {
            let value = Q::one();
            return Limit { value, error: 0.0 };
        }
        let cube = Q::whole(2 * (self.m * self.m) as i64) * Q::whole(self.m as i64);
        if self.homogenized {
            let value = &cube / (&cube - Q::whole(self.m as i64));
            return Limit { value, error: 0.0 };
        }
        let Limit { value, error } = self.first_strains(1e-42);
        let end = &cube - value;
        // d/dS of 2m³/(2m³ − S); S ≤ 2m², far from 2m³ for m > 1
        let slope = cube.value() / (end.value() * end.value());
        Limit {
            value: cube / end,
            error: 1.01 * slope * error,
        }
    }

    /// Sum of the first m strains of a half-endless bar in unit force, and a bound of its error below `tolerance`.
    fn first_strains(&self, tolerance: f64) -> Limit {
        let mut size = 64 * self.m;
        loop {
            let found = self.refined(size);
            if found.error < tolerance {
                return found;
            }
            size *= 2;
        }
    }

    /// With `size` unknown strains, and 1 beyond.
    fn refined(&self, size: usize) -> Limit {
        let m = self.m;
        // twice as long, so that the other end is not seen
        let long = Bar {
            points: 2 * size + 4 * m,
            ..*self
        };
        let (exact, float) = (long.stiffness::<Q>(), long.stiffness::<f64>());
        let matrix = Banded::from_rows(size, m - 1, |a, b| float.cut(a, b));
        let factored = matrix
            .factor()
            .expect("nearest neighbours make it positive definite");
        let rows = Rows::new(&exact, size + m);
        let one = BigInt::one() << BITS;
        let mut strains = vec![one; size + 2 * m];
        let mut error = f64::INFINITY;
        loop {
            let residual = rows.residual(&strains);
            let norm = residual.iter().map(|r| r * r).sum::<f64>().sqrt();
            let bound = 2.02 * norm * (m as f64).sqrt();
            // no more digits are there to gain
            if bound >= 0.5 * error {
                let sum = strains[..m].iter().sum::<BigInt>();
                let value = Q::new(sum, BigInt::one() << BITS);
                return Limit {
                    value,
                    error: error.max(bound),
                };
            }
            error = bound;
            let mut correction = residual[..size].to_vec();
            factored.solve(&mut correction);
            for (e, c) in strains.iter_mut().zip(&correction) {
                // too small to matter where it is none
                *e += BigInt::from_f64(c * SCALE).unwrap_or_default();
            }
        }
    }
}

/// Binary digits after the point.
const BITS: u32 = 200;
/// 2^BITS
const SCALE: f64 = 1.606_938_044_258_990_3e60;

/// The first rows of G and m²/2 in whole numbers.
struct Rows {
    /// Of row a: from column `max(a − m + 1, 0)`; the last of them is repeated.
    rows: Vec<Vec<BigInt>>,
    count: usize,
    force: BigInt,
    scale: BigInt,
}

impl Rows {
    fn new(s: &StiffnessMatrix<Q>, count: usize) -> Rows {
        let m = s.m();
        let row = |a: usize| (0..a + m).map(|b| s.cut(a, b)).collect();
        let rows: Vec<Vec<Q>> = (0..m).map(row).collect();
        let scale: BigInt = common_denominator(rows.iter().flatten()) * 2;
        let whole = |c: &Q| (c * Q::from_integer(scale.clone())).to_integer();
        Rows {
            rows: rows.iter().map(|r| r.iter().map(whole).collect()).collect(),
            count,
            force: (&scale * BigInt::from(m * m) / 2) << BITS,
            scale,
        }
    }

    /// `F − G e`, computed without rounding, then rounded to the nearest `f64`.
    fn residual(&self, strains: &[BigInt]) -> Vec<f64> {
        let m = self.rows.len();
        let size = self.scale.to_f64().unwrap_or(f64::INFINITY);
        let row = |a: usize| {
            let first = (a + 1).saturating_sub(m);
            let pairs = self.rows[a.min(m - 1)].iter().zip(&strains[first..]);
            let pull = pairs.fold(BigInt::zero(), |t, (c, e)| t + c * e);
            let left = &self.force - pull;
            left.to_f64().unwrap_or(f64::INFINITY) / size / SCALE
        };
        (0..self.count).map(row).collect()
    }
}

/// The number rounded to so many decimals, without zeros at the end.
pub fn decimals(x: &Q, digits: u32) -> String {
    let ten = BigInt::from(10).pow(digits);
    let scaled = (x * Q::from_integer(ten.clone())).round().to_integer();
    let sign = if scaled.sign() == Sign::Minus {
        "-"
    } else {
        ""
    };
    let (whole, part) = (scaled.abs() / &ten, scaled.abs() % &ten);
    let part = format!("{part:0>width$}", width = digits as usize);
    match part.trim_end_matches('0') {
        "" => format!("{sign}{whole}"),
        part => format!("{sign}{whole}.{part}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::q;

    fn limit(m: usize) -> Limit {
        let bar = Bar::new(m, 2 * m + 1, Ends::Half, false).unwrap();
        bar.f_limit()
    }

    #[test]
    fn two_spacings_have_a_closed_form() {
        // 8/(5+√2) = (40 − 8√2)/23, √2 to fifty digits as the root of a whole number
        let root = (BigInt::from(2) * BigInt::from(10).pow(100)).sqrt();
        let root = Q::new(root, BigInt::from(10).pow(50));
        let closed = (q(40, 1) - q(8, 1) * root) / q(23, 1);
        let found = limit(2);
        assert!(found.error < 1e-40);
        assert!((found.value.clone() - closed).value().abs() < 1e-40);
        assert_eq!(
            decimals(&found.value, 30),
            "1.247230065261532156938543052449"
        );
    }

    #[test]
    fn limits_are_not_those_of_table_1() {
        for (m, printed) in [(2, 1.25), (3, 1.125), (4, 1.082)] {
            let f = limit(m).value.value();
            assert!((f - printed).abs() > 5e-4, "m = {m}: {f}");
        }
    }

    /// f(N) (N−1) grows by f(∞) from point to point, once the ends do not feel each other.
    #[test]
    fn long_bars_tend_to_it() {
        for m in [1, 2, 3, 5] {
            for (ends, homogenized) in
                [(Ends::Half, false), (Ends::Full, false), (Ends::Half, true)]
            {
                let long = |n: usize| {
                    let bar = Bar::new(m, n, ends, homogenized).unwrap();
                    bar.f() * Q::whole(n as i64 - 1)
                };
                let n = 100 * m;
                let bar = Bar::new(m, n, ends, homogenized).unwrap();
                let off = long(n + 1) - long(n) - bar.f_limit().value;
                assert!(off.value().abs() < 1e-38, "{bar:?}: {}", off.value());
            }
        }
    }

    #[test]
    fn numbers_are_rounded() {
        let text = |n, d| decimals(&q(n, d), 3);
        assert_eq!(text(-2, 3), "-0.667");
        assert_eq!(text(9999, 10000), "1");
        assert_eq!(text(5, 4), "1.25");
        assert_eq!(text(1, 16), "0.063");
        assert_eq!(text(1, 10000), "0");
    }
}
