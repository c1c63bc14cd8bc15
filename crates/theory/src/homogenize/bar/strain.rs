//! Strains and displacements of a bar pulled at its ends.
//!
//! Unknown are not the displacements but the strains of the N−1 interspaces. What the bonds across an interspace carry is
//! the same force F everywhere: `Σ_b G_ab e_b = F`, `G_ab` the sum of the coefficients of the bonds that span both a and b.
//! For bonds to an end point it is the coefficient in the other point's row, so that these are sums of rows 2…N−1, which
//! carry no load; the row of the end then gives F. G is symmetric with m−1 diagonals above the main one, and its eigenvalues
//! lie between ½ (bonds of nearest neighbours alone) and m²: a million points lose no digits.

use super::stiffness_matrix::StiffnessMatrix;
use super::{Bar, Ends};
use crate::exact::Field;
use peridyne_algebra::banded::Banded;

impl<F: Field> StiffnessMatrix<F> {
    /// G_ab of two interspaces 0…N−2.
    pub fn cut(&self, a: usize, b: usize) -> F {
        let (low, high) = (a.min(b), a.max(b));
        let mut sum = F::zero();
        for d in high - low + 1..=self.m() {
            // bonds from i to i + d with i ≤ low and i + d > high
            let (first, last) = ((high + 1).saturating_sub(d), low.min(self.points() - 1 - d));
            if first > last {
                continue;
            }
            let ends = usize::from(first == 0) + usize::from(last + d + 1 == self.points());
            let inner = last + 1 - first - ends;
            let k = d - 1;
            sum = sum
                + F::whole(inner as i64) * self.inner()[k].clone()
                + F::whole(ends as i64) * self.to_end()[k].clone();
        }
        sum
    }

    /// Interspaces whose row of G is that of an endless bar.
    pub fn inside(&self) -> std::ops::Range<usize> {
        self.m() - 1..self.points() - self.m()
    }
}

impl Bar {
    /// m²/2: the force across every interspace of an endless bar in unit strain.
    pub(super) fn unit_force<F: Field>(&self) -> F {
        F::ratio((self.m * self.m) as i64, 2)
    }

    /// Strains of the N−1 interspaces over σ/E; O(N m²).
    pub fn strains<F: Field>(&self) -> Vec<F> {
        let s = self.stiffness::<F>();
        let (size, width) = (self.points - 1, self.m - 1);
        let whole: Vec<F> = (0..self.m).map(|k| s.cut(width, width + k)).collect();
        let inside = s.inside();
        let matrix = Banded::from_rows(size, width, |a, b| {
            if inside.contains(&a) {
                whole[b - a].clone()
            } else {
                s.cut(a, b)
            }
        });
        let factored = matrix
            .factor()
            .expect("nearest neighbours make it positive definite");
        let mut strains = vec![self.unit_force::<F>(); size];
        factored.solve(&mut strains);
        let part = self.load::<F>() / end_pull(&s, &strains);
        for e in &mut strains {
            *e = e.clone() * part.clone();
        }
        strains
    }

    /// What the row of an end must carry: m²/2, of half-weight ends m².
    pub fn load<F: Field>(&self) -> F {
        match self.ends {
            Ends::Full => self.unit_force(),
            Ends::Half => F::whole(2) * self.unit_force(),
        }
    }

    /// Displacements of the N points over Δσ/E, 0 in the middle.
    pub fn displacements<F: Field>(&self) -> Vec<F> {
        let mut u = vec![F::zero()];
        let mut sum = F::zero();
        for e in self.strains::<F>() {
            sum = sum + e;
            u.push(sum.clone());
        }
        let middle = sum / F::whole(2);
        u.into_iter().map(|x| x - middle.clone()).collect()
    }

    /// f(N): the elongation over `(N−1)Δ σ/E`, by solving for all strains; [`Bar::f`] is the fraction.
    pub fn f_by_strains<F: Field>(&self) -> F {
        let sum = (self.strains().into_iter()).fold(F::zero(), |s, e: F| s + e);
        sum / F::whole(self.points as i64 - 1)
    }
}

/// Row of an end point, from the strains next to it.
fn end_pull<F: Field>(s: &StiffnessMatrix<F>, strains: &[F]) -> F {
    let (mut sum, mut u) = (F::zero(), F::zero());
    for (k, coefficient) in s.of_end().iter().enumerate() {
        u = u + strains[k].clone();
        sum = sum + coefficient.clone() * u.clone();
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::{Q, q};

    /// The equations as they are written, with the solution put in.
    #[test]
    fn strains_solve_the_rows() {
        for m in 1..=5usize {
            for points in [2 * m + 1, 2 * m + 2, 3 * m + 5] {
                for (ends, homogenized) in [
                    (Ends::Full, false),
                    (Ends::Full, true),
                    (Ends::Half, false),
                    (Ends::Half, true),
                ] {
                    let bar = Bar::new(m, points, ends, homogenized).unwrap();
                    let (u, s) = (bar.displacements::<Q>(), bar.stiffness::<Q>());
                    let load = bar.load::<Q>();
                    for i in 0..points {
                        let expected = match i {
                            0 => load.clone(),
                            i if i + 1 == points => -load.clone(),
                            _ => q(0, 1),
                        };
                        assert_eq!(s.pull(i, &u), expected, "{bar:?} row {i}");
                        assert_eq!(u[i], -u[points - 1 - i].clone());
                    }
                }
            }
        }
    }

    #[test]
    fn cuts_count_the_bonds_that_span_both() {
        for (m, ends) in [(1, Ends::Half), (3, Ends::Half), (4, Ends::Full)] {
            let bar = Bar::new(m, 2 * m + 2, ends, true).unwrap();
            let s = bar.stiffness::<Q>();
            let n = bar.points();
            for a in 0..n - 1 {
                for b in 0..n - 1 {
                    let mut sum = q(0, 1);
                    for i in 0..=a.min(b) {
                        for j in a.max(b) + 1..n {
                            // seen by the point that is no end
                            sum += if i == 0 { s.bond(j, i) } else { s.bond(i, j) };
                        }
                    }
                    assert_eq!(s.cut(a, b), sum);
                }
            }
        }
    }

    #[test]
    fn a_million_points_keep_their_digits() {
        let bar = |n, homogenized| Bar::new(3, n, Ends::Full, homogenized).unwrap();
        let strains = bar(1_000_000, true).strains::<f64>();
        assert!(strains.iter().all(|e| (e - 1.0).abs() < 1e-14));
        // the ends' excess strain is the same for any length that is long enough
        let excess = |n| {
            let strains = bar(n, false).strains::<f64>();
            strains.iter().map(|e| e - 1.0).sum::<f64>()
        };
        assert!((excess(1_000_000) - excess(200)).abs() < 1e-9);
    }
}
