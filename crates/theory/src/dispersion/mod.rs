//! Plane waves: dynamical matrix, frequencies, polarisations, group velocities of any crystal.
//!
//! `u_s = (v_s/√m_s) e^{i(k·x_s − ωt)}`: `D_st = (δ_st Σ_b Φ_b − Σ_{b: s→t} Φ_b e^{ik·ξ} + Σ_r F″_r G_r† G_r + Σ_pq k_pq Y_p† Y_q)/√(m_s m_t)`,
//! Φ_b the bond's force constants, `G_r = Σ_{b of r} share n (e^{ik·ξ} at `to` − 1 at r)` the row of the point scalar,
//! Y_p that of `y·η` of a span of a fan.
//! Phases go by positions, so that D is smooth in k and D(−k) is its conjugate.

pub mod agreement;
pub mod chain;
pub mod hermitian;
pub mod zone;

use crate::crystal::Crystal;
use hermitian::{Matrix, eigen};
use num_complex::Complex64;

/// A plane wave of a crystal.
#[derive(Debug, Clone, PartialEq)]
pub struct Mode {
    /// ω² (1 / time²); negative: the reference state is unstable against this wave.
    pub squared: f64,
    /// `[site·D + axis]`: polarisation `√m u`, of unit length.
    pub vector: Vec<Complex64>,
}

impl Mode {
    /// ω; `None` if imaginary.
    pub fn frequency(&self) -> Option<f64> {
        (self.squared >= 0.0).then(|| self.squared.sqrt())
    }
}

/// Waves of negative ω² among those tried.
#[derive(Debug, Clone, PartialEq)]
pub struct Instability<const D: usize> {
    /// Part of all modes of the zone that are unstable.
    pub part: f64,
    /// The most negative ω², its wave vector, and the growth rate √−ω².
    pub squared: f64,
    pub wave: [f64; D],
    pub growth: f64,
}

/// A dynamical matrix, or its derivative by one component of k.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Part {
    Value,
    Slope(usize),
}

impl<const D: usize> Crystal<D> {
    /// The dynamical matrix (1 / time²).
    pub fn dynamical_matrix(&self, k: [f64; D]) -> Matrix {
        self.matrix(k, Part::Value)
    }

    /// Its derivative by the component `axis` of k.
    pub fn dynamical_slope(&self, k: [f64; D], axis: usize) -> Matrix {
        self.matrix(k, Part::Slope(axis))
    }

    fn matrix(&self, k: [f64; D], part: Part) -> Matrix {
        let n = self.basis.len() * D;
        let mut m = Matrix::zero(n);
        // rows of the point scalars and of their derivatives
        let mut rows = vec![vec![Complex64::ZERO; n]; self.basis.len()];
        let mut slopes = rows.clone();
        for bond in &self.bonds {
            let phase: f64 = (0..D).map(|a| k[a] * bond.xi[a]).sum();
            let wave = Complex64::from_polar(1.0, phase);
            let factor = match part {
                Part::Value => wave,
                Part::Slope(a) => wave * Complex64::new(0.0, bond.xi[a]),
            };
            let phi = bond.force_constants();
            let direction = bond.direction();
            for a in 0..D {
                for b in 0..D {
                    let (i, j) = (bond.from * D + a, bond.to * D + b);
                    m.add(i, j, -factor * phi[a][b]);
                    if part == Part::Value {
                        m.add(i, bond.from * D + b, phi[a][b].into());
                    }
                }
                let share = bond.share * direction[a];
                rows[bond.from][bond.to * D + a] += wave * share;
                rows[bond.from][bond.from * D + a] -= share;
                if let Part::Slope(_) = part {
                    slopes[bond.from][bond.to * D + a] += factor * share;
                }
            }
        }
        for (s, curvature) in self.curvature.iter().enumerate() {
            if *curvature == 0.0 {
                continue;
            }
            let (g, dg) = (&rows[s], &slopes[s]);
            for i in 0..n {
                for j in 0..n {
                    let c = match part {
                        Part::Value => g[i].conj() * g[j],
                        Part::Slope(_) => dg[i].conj() * g[j] + g[i].conj() * dg[j],
                    };
                    m.add(i, j, c * *curvature);
                }
            }
        }
        for coupling in &self.couplings {
            let wave = |x: &[f64; D]| Complex64::from_polar(1.0, (0..D).map(|a| k[a] * x[a]).sum());
            let rows = coupling.rows(wave);
            match part {
                Part::Value => coupling.add(&rows, &rows, &mut m),
                Part::Slope(a) => {
                    let slopes = coupling.rows(|x| wave(x) * Complex64::new(0.0, x[a]));
                    coupling.add(&slopes, &rows, &mut m);
                    coupling.add(&rows, &slopes, &mut m);
                }
            }
        }
        for i in 0..n {
            for j in 0..n {
                m.scale(i, j, 1.0 / (self.mass[i / D] * self.mass[j / D]).sqrt());
            }
        }
        m
    }

    /// All waves of wave vector k, by rising ω².
    pub fn modes(&self, k: [f64; D]) -> Vec<Mode> {
        let (values, vectors) = eigen(&self.dynamical_matrix(k));
        values
            .into_iter()
            .zip(vectors)
            .map(|(squared, vector)| Mode { squared, vector })
            .collect()
    }

    /// ω² of all waves of wave vector k, rising.
    pub fn squares(&self, k: [f64; D]) -> Vec<f64> {
        eigen(&self.dynamical_matrix(k)).0
    }

    /// `∂ω²/∂k` of one wave (Hellmann & Feynman); of a degenerate wave, that of its polarisation.
    pub fn slope(&self, k: [f64; D], mode: &Mode) -> [f64; D] {
        std::array::from_fn(|a| self.dynamical_slope(k, a).expectation(&mode.vector))
    }

    /// Group velocity `∂ω/∂k`; `None` where ω² ≤ 0.
    pub fn group_velocity(&self, k: [f64; D], mode: &Mode) -> Option<[f64; D]> {
        let omega = mode.frequency().filter(|w| *w > 0.0)?;
        Some(self.slope(k, mode).map(|s| s / (2.0 * omega)))
    }

    /// ω² and its derivative along a unit direction, branch by branch; degenerate branches are told apart by their
    /// slopes.
    pub fn slopes_along(&self, k: [f64; D], direction: [f64; D]) -> Vec<[f64; 2]> {
        let modes = self.modes(k);
        let n = modes.len();
        let mut slope = Matrix::zero(n);
        for (a, c) in direction.iter().enumerate() {
            let part = self.dynamical_slope(k, a);
            for i in 0..n {
                for j in 0..n {
                    slope.add(i, j, part.get(i, j) * *c);
                }
            }
        }
        let scale = modes.iter().map(|m| m.squared.abs()).fold(0.0, f64::max);
        let mut out = vec![];
        let mut first = 0;
        while first < n {
            let mut last = first + 1;
            while last < n && modes[last].squared - modes[last - 1].squared <= 1e-9 * scale {
                last += 1;
            }
            let mut block = Matrix::zero(last - first);
            for i in first..last {
                for j in first..last {
                    let c = slope.between(&modes[i].vector, &modes[j].vector);
                    block.add(i - first, j - first, c);
                }
            }
            for (i, s) in eigen(&block).0.into_iter().enumerate() {
                out.push([modes[first + i].squared, s]);
            }
            first = last;
        }
        out
    }

    /// Waves on a grid of `per_axis` points along every reciprocal vector; `None` if all are stable to round-off.
    pub fn instability(&self, per_axis: usize) -> Option<Instability<D>> {
        let mut worst = (0.0, [0.0; D]);
        let (mut unstable, mut all) = (0usize, 0usize);
        let mut scale: f64 = 0.0;
        let mut found = vec![];
        zone::grid(self, per_axis, |k| {
            let squares = self.squares(k);
            all += squares.len();
            scale = squares.iter().fold(scale, |s, w| s.max(w.abs()));
            found.extend(squares.iter().copied().filter(|w| *w < 0.0));
            if squares[0] < worst.0 {
                worst = (squares[0], k);
            }
        });
        unstable += found.iter().filter(|w| **w < -1e-11 * scale).count();
        (unstable > 0).then(|| Instability {
            part: unstable as f64 / all as f64,
            squared: worst.0,
            wave: worst.1,
            growth: (-worst.0).sqrt(),
        })
    }
}

/// The frequency that velocity Verlet gives a wave of frequency ω: `ω_Δt = (2/Δt) asin(ωΔt/2)`; `None` if unstable.
pub fn verlet_frequency(omega: f64, dt: f64) -> Option<f64> {
    let x = 0.5 * omega * dt;
    (x.abs() <= 1.0).then(|| 2.0 / dt * libm::asin(x))
}

#[cfg(test)]
mod tests;
