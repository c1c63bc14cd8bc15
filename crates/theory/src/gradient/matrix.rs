//! Long waves in two and three dimensions: the dynamical matrix along a direction as a power series.

use crate::crystal::Crystal;
use crate::dispersion::hermitian::Matrix;
use num_complex::Complex64;

impl<const D: usize> Crystal<D> {
    /// `D(k n) = Σ_q D_q k^q` for a unit vector n, q < `terms`; with one site per cell odd terms vanish and
    /// `ρV D_{2p} (−1)^{p+1}` are the gradient coefficients of waves along n.
    pub fn dynamical_series(&self, direction: [f64; D], terms: usize) -> Vec<Matrix> {
        let size = self.basis.len() * D;
        let mut series = vec![Matrix::zero(size); terms];
        let mut rows = vec![vec![vec![Complex64::ZERO; size]; terms]; self.basis.len()];
        for bond in &self.bonds {
            let phase = Complex64::new(0.0, (0..D).map(|a| direction[a] * bond.xi[a]).sum());
            let phi = bond.force_constants();
            let n = bond.direction();
            // (ik·ξ)^q/q!
            let mut wave = Complex64::ONE;
            for q in 0..terms {
                if q > 0 {
                    wave *= phase / q as f64;
                }
                for a in 0..D {
                    for b in 0..D {
                        let i = bond.from * D + a;
                        series[q].add(i, bond.to * D + b, -wave * phi[a][b]);
                        if q == 0 {
                            series[q].add(i, bond.from * D + b, phi[a][b].into());
                        }
                    }
                    rows[bond.from][q][bond.to * D + a] += wave * bond.share * n[a];
                    if q == 0 {
                        rows[bond.from][q][bond.from * D + a] -= bond.share * n[a];
                    }
                }
            }
        }
        for (row, curvature) in rows.iter().zip(&self.curvature) {
            for q in 0..terms {
                for p in 0..=q {
                    let (g, h) = (&row[p], &row[q - p]);
                    for i in 0..size {
                        for j in 0..size {
                            series[q].add(i, j, g[i].conj() * h[j] * *curvature);
                        }
                    }
                }
            }
        }
        for coupling in &self.couplings {
            // (ik n·x)^q/q!
            let mut factorial = 1.0;
            let rows: Vec<_> = (0..terms)
                .map(|q| {
                    factorial *= q.max(1) as f64;
                    coupling.rows(|x| {
                        let phase = (0..D).map(|a| direction[a] * x[a]).sum();
                        Complex64::new(0.0, phase).powu(q as u32) / factorial
                    })
                })
                .collect();
            for (q, sum) in series.iter_mut().enumerate() {
                for p in 0..=q {
                    coupling.add(&rows[p], &rows[q - p], sum);
                }
            }
        }
        for m in &mut series {
            for i in 0..size {
                for j in 0..size {
                    m.scale(i, j, 1.0 / (self.mass[i / D] * self.mass[j / D]).sqrt());
                }
            }
        }
        series
    }

    /// Gradient coefficients of waves along a direction, one site per cell: `[p][a][b]` of
    /// `ρ ü_a = Σ_p c_p[a][b] (n·∇)^{2p+2} u_b`; `None` for several sites.
    pub fn gradient_coefficients(
        &self,
        direction: [f64; D],
        terms: usize,
    ) -> Option<Vec<[[f64; D]; D]>> {
        if self.basis.len() != 1 {
            return None;
        }
        let series = self.dynamical_series(direction, 2 * terms + 1);
        Some(
            (1..=terms)
                .map(|p| {
                    let sign = if p % 2 == 1 { 1.0 } else { -1.0 };
                    let m = &series[2 * p];
                    std::array::from_fn(|a| {
                        std::array::from_fn(|b| sign * self.density() * m.get(a, b).re)
                    })
                })
                .collect(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::crystal::{LatticeSolid, dimer};
    use crate::gradient::linear::LinearChain;
    use peridyne::law::solid::eam_like::Solid;
    use peridyne::space::lattice::LatticeKind;
    use peridyne::spec::{Horizon, Influence};

    /// Series against matrix at one wave vector.
    fn sums_up<const D: usize>(crystal: &Crystal<D>, n: [f64; D]) {
        let series = crystal.dynamical_series(n, 24);
        let k = 0.9f64;
        let exact = crystal.dynamical_matrix(n.map(|x| x * k));
        for i in 0..exact.size() {
            for j in 0..exact.size() {
                let sum: Complex64 = series
                    .iter()
                    .enumerate()
                    .map(|(q, m)| m.get(i, j) * k.powi(q as i32))
                    .sum();
                assert!((sum - exact.get(i, j)).norm() < 1e-11);
            }
        }
    }

    #[test]
    fn the_series_sums_to_the_matrix() {
        sums_up(&dimer(), [1.0]);
        let solid = Solid::lps(3, 2.0, 1.0);
        for kind in [LatticeKind::Fcc, LatticeKind::Diamond] {
            let body = LatticeSolid::new(kind, 1.0, Horizon::Ratio(1));
            let crystal = body.state_based::<3>(solid).unwrap();
            sums_up(&crystal, [2.0 / 3.0, 1.0 / 3.0, -2.0 / 3.0]);
        }
    }

    #[test]
    fn in_one_dimension_it_is_the_chain() {
        let mut body = LatticeSolid::new(LatticeKind::Chain, 0.25, Horizon::Ratio(5));
        body.influence = Influence::Inverse;
        let solid = Solid {
            n: 3.0,
            kappa: 0.4,
            beta: 1.5,
        };
        let crystal = body.state_based::<1>(solid).unwrap();
        let found = crystal.gradient_coefficients([1.0], 4).unwrap();
        // structured EAM with p = 1 has ω = 1/r: k̄ = 2β, c̄ = 9κ
        let chain = LinearChain::structured_eam(3.0, 3.6, 1, 0.25, 5);
        for (a, b) in found.iter().zip(chain.coefficients(4)) {
            assert!((a[0][0] / b - 1.0).abs() < 1e-12, "{a:?} {b}");
        }
        let of_crystal = LinearChain::of_crystal(&crystal).unwrap().coefficients(4);
        for (a, b) in of_crystal.iter().zip(chain.coefficients(4)) {
            assert!((a / b - 1.0).abs() < 1e-12);
        }
    }
}
