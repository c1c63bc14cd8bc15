//! Is one model an upscaling of another? The test of seleson2009 section 3: expand both to gradient equations, compare
//! order by order.

use crate::exact::Field;
use crate::exact::polynomial::JetPolynomial;
use crate::gradient::Expansion;
use peridyne::quantity::rounded;
use std::fmt;

/// One gradient order of two models.
#[derive(Debug, Clone, PartialEq)]
pub struct Row<F> {
    /// Gradient order: 2, 4, ….
    pub order: usize,
    pub left: JetPolynomial<F>,
    pub right: JetPolynomial<F>,
    /// Largest difference of coefficients over the largest coefficient; 0 where they are the same.
    pub relative: f64,
    pub equal: bool,
}

/// Two gradient equations side by side.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison<F> {
    pub rows: Vec<Row<F>>,
}

/// To which gradient order two models are upscalings of each other.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    /// The order to which all coefficients are equal; 0: not even long waves are alike.
    pub order: usize,
    /// The last order compared.
    pub compared: usize,
    /// The first order that differs, and by what part of its largest coefficient.
    pub difference: Option<(usize, f64)>,
    /// Are all orders equal in the limit of many neighbours within one horizon? Both are sums over the points of one integral there.
    pub limit: bool,
}

impl Verdict {
    /// Of relative differences by order, which are equal up to `tolerance`; of several of one order the largest counts.
    pub fn of(differences: &[(usize, f64)], tolerance: f64, limit: bool) -> Verdict {
        let mut orders: Vec<usize> = differences.iter().map(|(order, _)| *order).collect();
        orders.sort_unstable();
        orders.dedup();
        let largest = |order: usize| {
            let of = differences.iter().filter(|(o, _)| *o == order);
            of.map(|(_, d)| *d).fold(0.0, f64::max)
        };
        let apart = |order: &&usize| largest(**order) > tolerance;
        let first = orders.iter().find(apart);
        let before = |order: usize| orders.iter().rev().find(|o| **o < order);
        Verdict {
            order: match first {
                Some(first) => before(*first).copied().unwrap_or(0),
                None => orders.last().copied().unwrap_or(0),
            },
            compared: orders.last().copied().unwrap_or(0),
            difference: first.map(|order| (*order, largest(*order))),
            limit,
        }
    }

    /// As "equal to order 2 (in the limit of many neighbours: all)".
    pub fn equal(&self) -> String {
        let limit = match self.limit {
            true if self.difference.is_some() => " (in the limit of many neighbours: all)",
            _ => "",
        };
        match self.order {
            0 => format!("equal to no order{limit}"),
            n if self.difference.is_none() => format!("equal to order {n}, the last compared"),
            n => format!("equal to order {n}{limit}"),
        }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.equal())?;
        match self.difference {
            None => Ok(()),
            Some((2, d)) => write!(f, "; long waves differ by {} %", rounded(100.0 * d, 4)),
            Some((n, d)) => write!(f, "; order {n} differs by {} %", rounded(100.0 * d, 4)),
        }
    }
}

/// Relative differences by order of coefficients in any number of dimensions, `[p][component]` of order 2p + 2: the largest over the largest
/// coefficient of that order.
pub fn differences(left: &[Vec<f64>], right: &[Vec<f64>]) -> Vec<(usize, f64)> {
    let size = |c: &[f64]| c.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let orders = left.iter().zip(right).enumerate();
    let relative = |(p, (l, r)): (usize, (&Vec<f64>, &Vec<f64>))| {
        let apart: Vec<f64> = l.iter().zip(r).map(|(l, r)| l - r).collect();
        let scale = size(l).max(size(r));
        // where neither has this order they are equal in it
        let part = if scale == 0.0 {
            0.0
        } else {
            size(&apart) / scale
        };
        (2 * p + 2, part)
    };
    orders.map(relative).collect()
}

/// Compare order by order. `tolerance` is relative; 0 asks for equality, which fractions can meet.
pub fn compare<F: Field>(
    left: &Expansion<F>,
    right: &Expansion<F>,
    tolerance: f64,
) -> Comparison<F> {
    let rows = left.orders.iter().zip(&right.orders).enumerate();
    Comparison {
        rows: rows
            .map(|(p, (l, r))| {
                let difference = largest(&l.sub(r));
                let scale = largest(l).max(largest(r));
                // equality is decided in the field, not in its rounding
                let equal = l == r || (tolerance > 0.0 && difference <= tolerance * scale);
                Row {
                    order: 2 * p + 2,
                    left: l.clone(),
                    right: r.clone(),
                    relative: if l == r { 0.0 } else { difference / scale },
                    equal,
                }
            })
            .collect(),
    }
}

fn largest<F: Field>(p: &JetPolynomial<F>) -> f64 {
    p.terms().map(|(_, c)| c.value().abs()).fold(0.0, f64::max)
}

impl<F> Comparison<F> {
    /// Relative differences by order.
    pub fn differences(&self) -> Vec<(usize, f64)> {
        self.rows.iter().map(|r| (r.order, r.relative)).collect()
    }

    /// The gradient order to which the models agree: 0 if not even in long waves.
    pub fn equal_to_order(&self) -> usize {
        self.rows
            .iter()
            .take_while(|r| r.equal)
            .last()
            .map_or(0, |r| r.order)
    }

    /// The first order in which they differ; `None` if in none of those compared.
    pub fn first_difference(&self) -> Option<&Row<F>> {
        self.rows.iter().find(|r| !r.equal)
    }
}

impl<F: Field + fmt::Display> fmt::Display for Comparison<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for row in &self.rows {
            if row.equal {
                writeln!(f, "order {}: equal: {}", row.order, row.left)?;
            } else {
                writeln!(
                    f,
                    "order {}: different by {}: {} against {}",
                    row.order,
                    rounded(row.relative, 4),
                    row.left,
                    row.right
                )?;
            }
        }
        match (self.equal_to_order(), self.rows.last()) {
            (0, _) => write!(f, "no upscaling: long waves already differ"),
            (n, Some(last)) if n == last.order => {
                write!(
                    f,
                    "upscalings of each other to order {n}, the last compared"
                )
            }
            (n, _) => write!(f, "upscalings of each other to order {n}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::crystal::{Crystal, Reach};
    use crate::exact::{Q, q};
    use crate::gradient::linear::{LinearChain, springs_continuum};
    use crate::gradient::power_law::PowerLawChain;
    use peridyne::law::number::Number;
    use peridyne::law::potential::Potential;
    use peridyne::space::lattice::LatticeKind;

    #[test]
    fn springs_at_one_horizon_differ_by_one_over_n() {
        // MD with N = 8 at a = 1 and the discretised integral with M = 16 at Δx = ½
        let expansion = |n: i64| LinearChain::springs(q(1, 1), q(8, n), n as usize).expansion(4);
        let c = compare(&expansion(8), &expansion(16), 0.0);
        assert_eq!(c.equal_to_order(), 2);
        let row = c.first_difference().unwrap();
        assert_eq!(row.left.coefficient(&[0, 0, 0, 1]), q(64, 24) * q(9, 8));
        assert_eq!(row.right.coefficient(&[0, 0, 0, 1]), q(64, 24) * q(17, 16));
        // the difference to the integral halves when N doubles, in every order
        let limit = Expansion::linear(&springs_continuum(q(1, 1), q(8, 1), 4));
        for p in 1..4 {
            let d = |n| compare(&expansion(n), &limit, 0.0).rows[p].relative;
            assert!(
                (d(512) / d(1024) - 2.0).abs() < 0.02,
                "{}",
                d(512) / d(1024)
            );
        }
    }

    #[test]
    fn a_verdict_is_the_order_before_the_first_that_differs() {
        let rows = [(2, 1e-14), (4, 0.1), (2, 3e-13), (4, 0.75), (6, 0.0)];
        let v = Verdict::of(&rows, 1e-9, true);
        assert_eq!((v.order, v.compared, v.difference), (2, 6, Some((4, 0.75))));
        assert_eq!(
            v.to_string(),
            "equal to order 2 (in the limit of many neighbours: all); order 4 differs by 75 %"
        );
        let v = Verdict::of(&[(2, 0.02), (4, 0.0)], 1e-9, false);
        assert_eq!(
            (v.order, v.to_string().as_str()),
            (0, "equal to no order; long waves differ by 2 %")
        );
        let v = Verdict::of(&[(2, 0.0), (4, 0.0)], 1e-9, true);
        assert_eq!(v.to_string(), "equal to order 4, the last compared");
        // of two components of order 4 one differs by 1 of 8
        let [l, r] = [
            [vec![1.0, 0.0], vec![8.0, 2.0]],
            [vec![1.0, 0.0], vec![8.0, 3.0]],
        ];
        assert_eq!(differences(&l, &r), [(2, 0.0), (4, 0.125)]);
    }

    #[test]
    fn the_limits_are_equal_to_all_orders() {
        // (4.2) with Na = δ is (4.4): one closed form
        let md = Expansion::linear(&springs_continuum(q(3, 2), q(5, 1) * q(2, 1), 8));
        let pd = Expansion::linear(&springs_continuum(q(3, 2), q(10, 1), 8));
        let c = compare(&md, &pd, 0.0);
        assert_eq!((c.equal_to_order(), c.first_difference()), (16, None));
    }

    #[test]
    fn a_local_model_agrees_in_long_waves_only() {
        let local = LinearChain::springs(q(1, 1), q(1, 1), 1).expansion(3);
        let nonlocal = LinearChain::springs(q(1, 1), q(1, 1), 5).expansion(3);
        let c = compare(&local, &nonlocal, 0.0);
        assert_eq!(c.first_difference().map(|r| r.order), Some(4));
        assert!(
            c.to_string()
                .ends_with("upscalings of each other to order 2")
        );
    }

    /// An embedded-atom potential with lengths in units of `h` and energies per volume of a point kept (seleson2014
    /// section 3): f = e^{−r/h}, F = −h√ρ, φ = 3h e^{−4r/h}.
    #[derive(Clone)]
    struct Metal {
        h: f64,
    }
    impl Potential for Metal {
        const EMBEDDED: bool = true;
        fn cutoff(&self) -> f64 {
            4.5 * self.h
        }
        fn pair<N: Number>(&self, q: N) -> N {
            q.sqrt().times(-4.0 / self.h).exp().times(3.0 * self.h)
        }
        fn density<N: Number>(&self, q: N) -> N {
            q.sqrt().times(-1.0 / self.h).exp()
        }
        fn embedding<N: Number>(&self, density: N) -> N {
            density.sqrt().times(-self.h)
        }
    }

    #[test]
    fn a_coarse_embedded_atom_chain_is_an_upscaling_in_long_waves_only() {
        let expansion = |h: f64| {
            let (crystal, _) =
                Crystal::<1>::of_potential(&Metal { h }, LatticeKind::Chain, h, h, Reach::Cutoff)
                    .unwrap();
            LinearChain::of_crystal(&crystal).unwrap().expansion(3)
        };
        let (fine, coarse) = (expansion(1.0), expansion(2.0));
        let c = compare(&fine, &coarse, 1e-12);
        assert_eq!(c.equal_to_order(), 2);
        // the coarse chain is the fine one in other units of length: order 2p + 2 grows with h^2p, exactly
        for (p, row) in c.rows.iter().enumerate() {
            let scaled = row.left.scale(&4f64.powi(p as i32));
            let rest = row.right.sub(&scaled);
            assert!(largest(&rest) <= 1e-13 * largest(&row.right));
        }
    }

    #[test]
    fn lennard_jones_is_its_own_upscaling_at_one_resolution_only() {
        let (e, s6, a, n) = (q(1, 72), q(1, 2), q(1, 1), 4);
        let parameters = || [e.clone(), s6.clone(), a.clone()];
        let [e1, s1, a1] = parameters();
        let md = PowerLawChain::lennard_jones(e1, s1, a1, n).expansion(4);
        let [e1, s1, a1] = parameters();
        let [eb, sb] = PowerLawChain::upscaled_parameters(e1, s1, a1, n);
        let pd = |coarse: i64| {
            let [e, s] = [eb.clone(), sb.clone()];
            PowerLawChain::lennard_jones_upscaled(e, s, q(coarse, 1), n / coarse as usize)
                .expansion(4)
        };
        let same: Comparison<Q> = compare(&md, &pd(1), 0.0);
        assert_eq!((same.equal_to_order(), same.first_difference()), (8, None));
        for coarse in [2, 4] {
            let c = compare(&md, &pd(coarse), 0.0);
            assert_eq!(c.equal_to_order(), 2);
            assert_eq!(c.first_difference().map(|r| r.order), Some(4));
        }
    }
}
