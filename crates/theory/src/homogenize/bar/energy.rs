//! Strain energy density of each point.

use super::{Bar, Ends};
use crate::exact::Field;

impl Bar {
    /// `Σ_j α_ij ξ_ij s_ij² V_j` of every point, ξ in Δ and V in AΔ, for the given strains of the N−1 interspaces: four times the
    /// strain energy density (75) over c. Far from the ends it is m² in unit strain: (75) is then Eε²/2.
    pub fn energy<F: Field>(&self, strains: &[F]) -> Vec<F> {
        let s = self.stiffness::<F>();
        let mut u = vec![F::zero()];
        for e in strains {
            u.push(u[u.len() - 1].clone() + e.clone());
        }
        let point = |i: usize| {
            (i.saturating_sub(self.m)..(i + self.m + 1).min(self.points))
                .filter(|j| *j != i)
                .fold(F::zero(), |sum, j| {
                    // α ξ V (η/ξ)² with α V/ξ the coefficient
                    let eta = u[j].clone() - u[i].clone();
                    sum + s.bond(i, j) * eta.clone() * eta
                })
        };
        (0..self.points).map(point).collect()
    }

    /// The same of points 1…m+1 in unit strain: Fig. 9 and Appendix B. From point m+1 on it is m².
    pub fn end_energy<F: Field>(&self) -> Vec<F> {
        let short = Bar {
            points: 4 * self.m + 1,
            ..*self
        };
        let mut all = short.energy(&vec![F::one(); short.points - 1]);
        all.truncate(self.m + 1);
        all
    }

    /// Volume of a point in AΔ.
    pub fn volume<F: Field>(&self, i: usize) -> F {
        if self.ends == Ends::Half && (i == 0 || i + 1 == self.points) {
            F::ratio(1, 2)
        } else {
            F::one()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::{Q, q};

    #[test]
    fn ends_have_the_energies_of_appendix_b() {
        let bar = |m| Bar::new(m, 2 * m + 1, Ends::Full, true).unwrap();
        let energies = |m| bar(m).end_energy::<Q>();
        assert_eq!(energies(2), [q(5, 2), q(7, 2), q(4, 1)]);
        assert_eq!(energies(3), [q(7, 1), q(7, 1), q(17, 2), q(9, 1)]);
        assert_eq!(
            energies(4),
            [q(15, 1), q(23, 2), q(14, 1), q(31, 2), q(16, 1)]
        );
    }

    /// The work of the loads, `σ · elongation · A/2`, is the energy, points weighed by their volume.
    #[test]
    fn energy_is_the_work_of_the_loads() {
        for (m, homogenized) in [(1, false), (2, true), (3, false), (6, true)] {
            let bar = Bar::new(m, 3 * m + 2, Ends::Full, homogenized).unwrap();
            let strains = bar.strains::<Q>();
            let all = bar.energy(&strains).into_iter().fold(q(0, 1), |s, w| s + w);
            let elongation = strains.into_iter().fold(q(0, 1), |s, e| s + e);
            // ½ Σ_ij of the bonds is half of the sum; c/4 · Σ V = ½ σ A ΔL
            assert_eq!(all, elongation * q((m * m) as i64, 1), "m = {m}");
        }
    }

    #[test]
    fn half_weight_ends_break_it() {
        let bar = Bar::new(2, 9, Ends::Half, true).unwrap();
        let strains = bar.strains::<Q>();
        let energies = bar.energy(&strains);
        let all = (0..9).fold(q(0, 1), |s, i| s + bar.volume::<Q>(i) * energies[i].clone());
        let elongation = strains.into_iter().fold(q(0, 1), |s, e| s + e);
        assert_ne!(all, elongation * q(4, 1));
    }
}
