//! A bar fixed at its first point and free at its last: frequencies, and motion from uniform strain.
//!
//! `ρ ü_i = c A Σ_j s_ij (u_j − u_i)`, `u_1 = 0`: `ω² = 2E/(ρ m²Δ²) λ`, λ an eigenvalue of −S without its first row and column.
//! The last point's matter ends half a spacing beyond it: such a bar is `(N−½)Δ` long, not NΔ.

use super::stiffness_matrix::StiffnessMatrix;
use super::{Bar, BarError, Ends};
use peridyne_algebra::banded::{Banded, Factored};
use std::f64::consts::{FRAC_PI_2, PI};

/// A bar of classical elasticity, fixed at x = 0 and free at x = length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rod {
    /// (length)
    pub length: f64,
    /// Young's modulus (pressure).
    pub young: f64,
    /// (mass/volume)
    pub density: f64,
}

impl Rod {
    /// √(E/ρ)
    pub fn speed(&self) -> f64 {
        (self.young / self.density).sqrt()
    }

    /// Angular frequency n = 0, 1, …: `(2n+1)π/(2L) √(E/ρ)`.
    pub fn frequency(&self, n: usize) -> f64 {
        (2 * n + 1) as f64 * FRAC_PI_2 / self.length * self.speed()
    }

    /// The series (73), so many terms of it: displacement after uniform strain was let go at t = 0.
    pub fn series(&self, strain: f64, x: f64, t: f64, terms: usize) -> f64 {
        let term = |n: usize| {
            let k = (2 * n + 1) as f64;
            let sign = if n.is_multiple_of(2) { 1.0 } else { -1.0 };
            sign / (k * k)
                * libm::sin(k * FRAC_PI_2 * x / self.length)
                * libm::cos(self.frequency(n) * t)
        };
        8.0 * strain * self.length / (PI * PI) * (0..terms).map(term).sum::<f64>()
    }

    /// What the series sums to: `½ (U(x − ct) + U(x + ct))`, U the initial displacement continued as a wave of triangles.
    pub fn displacement(&self, strain: f64, x: f64, t: f64) -> f64 {
        let triangle = |x: f64| {
            let phase = (x / self.length + 1.0).rem_euclid(4.0);
            1.0 - (phase - 2.0).abs()
        };
        let way = self.speed() * t;
        0.5 * strain * self.length * (triangle(x - way) + triangle(x + way))
    }
}

/// The peridynamic bar.
#[derive(Debug, Clone)]
pub struct Vibration {
    stiffness: StiffnessMatrix<f64>,
    /// Δ
    pub spacing: f64,
    /// `2E/(ρ m²Δ²)`, turns eigenvalues into squares of frequencies.
    factor: f64,
    /// 0.8 √(ρΔδ/2E)
    paper_step: f64,
}

impl Vibration {
    /// E, ρ, Δ in any units that go together.
    ///
    /// # Errors
    /// Half-weight ends: their equations are not symmetric.
    pub fn new(bar: &Bar, young: f64, density: f64, spacing: f64) -> Result<Vibration, BarError> {
        if bar.ends == Ends::Half {
            return Err(BarError::NotSymmetric);
        }
        let horizon = bar.m as f64 * spacing;
        Ok(Vibration {
            stiffness: bar.stiffness(),
            spacing,
            factor: 2.0 * young / (density * horizon * horizon),
            paper_step: 0.8 * (density * spacing * horizon / (2.0 * young)).sqrt(),
        })
    }

    /// Points that move.
    fn size(&self) -> usize {
        self.stiffness.points() - 1
    }

    /// −S − shift of the points that move.
    fn shifted(&self, shift: f64) -> Option<Factored<f64>> {
        let s = &self.stiffness;
        let (m, last) = (s.m(), s.points() - 1);
        let inner = s.entry(m, m);
        let entry = |a: usize, b: usize| {
            let (i, j) = (a + 1, b + 1);
            match () {
                () if i != j => -s.bond(i, j),
                () if i >= m && i + m <= last => -inner - shift,
                () => -s.entry(i, i) - shift,
            }
        };
        Banded::from_rows(self.size(), m, entry).factor()
    }

    /// Bounds of eigenvalue k from below and above, as close as rounding lets them come.
    fn eigenvalue(&self, k: usize) -> [f64; 2] {
        // rows sum to 0 or less off the diagonal (Gershgorin)
        let diagonal = (0..=self.stiffness.m()).map(|i| -self.stiffness.entry(i, i));
        let (mut low, mut high) = (0.0, 2.0 * diagonal.fold(0.0, f64::max));
        loop {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high || high - low < 1e-15 * high {
                return [low, high];
            }
            // a pivot that is 0 is an eigenvalue of a part: a little further
            let shifted = self
                .shifted(middle)
                .or_else(|| self.shifted(middle * (1.0 + f64::EPSILON)));
            if shifted.is_some_and(|f| f.negative() <= k) {
                low = middle;
            } else {
                high = middle;
            }
        }
    }

    /// Angular frequency and shape (largest displacement 1, the fixed point first) of mode k = 0, 1, … N−2, slowest first.
    /// k beyond the last is the last.
    pub fn mode(&self, k: usize) -> (f64, Vec<f64>) {
        let [low, high] = self.eigenvalue(k.min(self.size() - 1));
        // beside the eigenvalue, so that the matrix has an inverse
        let shift = low - 1e-12 * high;
        let mut u: Vec<f64> = (0..self.size())
            .map(|i| libm::sin(1.7 * (i * i) as f64))
            .collect();
        if let Some(factored) = self.shifted(shift) {
            for _ in 0..4 {
                factored.solve(&mut u);
                let size = u
                    .iter()
                    .fold(0.0f64, |m, x| if x.abs() > m.abs() { *x } else { m });
                u.iter_mut().for_each(|x| *x /= size);
            }
        }
        u.insert(0, 0.0);
        // Rayleigh's quotient from differences keeps the digits that small eigenvalues lose in the matrix
        let s = &self.stiffness;
        let mut energy = 0.0;
        for i in 0..u.len() {
            for j in i + 1..u.len().min(i + s.m() + 1) {
                energy += s.bond(i, j) * (u[j] - u[i]).powi(2);
            }
        }
        let mass: f64 = u.iter().map(|x| x * x).sum();
        ((self.factor * energy / mass).sqrt(), u)
    }

    /// Angular frequency of mode k.
    pub fn frequency(&self, k: usize) -> f64 {
        self.mode(k).0
    }

    /// 2/ω of the fastest mode: the largest stable step of the leapfrog.
    pub fn stable_step(&self) -> f64 {
        let [_, high] = self.eigenvalue(self.size() - 1);
        2.0 / (self.factor * high).sqrt()
    }

    /// The step of the paper's example: `0.8 √(ρΔδ/2E)`.
    pub fn paper_step(&self) -> f64 {
        self.paper_step
    }

    /// Displacement of one point after 0, 1, …, `steps` steps of the leapfrog, let go from uniform strain at rest.
    pub fn run(&self, strain: f64, time_step: f64, steps: usize, point: usize) -> Vec<f64> {
        let points = self.stiffness.points();
        let mut u: Vec<f64> = (0..points)
            .map(|i| strain * self.spacing * i as f64)
            .collect();
        // displacements of one step
        let mut v = vec![0.0; points];
        let mut pull = vec![0.0; points];
        let mut seen = vec![u[point]];
        let kick = self.factor * time_step * time_step;
        for n in 0..steps {
            self.stiffness.apply(&u, &mut pull);
            let kick = if n == 0 { 0.5 * kick } else { kick };
            for i in 1..points {
                v[i] += kick * pull[i];
                u[i] += v[i];
            }
            seen.push(u[point]);
        }
        seen
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROD: Rod = Rod {
        length: 1.0,
        young: 2e11,
        density: 7850.0,
    };

    fn vibration(m: usize, points: usize, homogenized: bool, length: f64) -> Vibration {
        let bar = Bar::new(m, points, Ends::Full, homogenized).unwrap();
        Vibration::new(&bar, ROD.young, ROD.density, 1.0 / length).unwrap()
    }

    #[test]
    fn the_series_sums_to_triangles() {
        for (x, t) in [
            (0.5, 0.0),
            (0.5, 1.3e-4),
            (1.0, 2e-4),
            (0.2, 5e-3),
            (0.9, 4.9e-4),
        ] {
            let off = ROD.series(1e-3, x, t, 200_000) - ROD.displacement(1e-3, x, t);
            // the terms left out sum to 8εL/π² · 1/(4·2e5) at most
            assert!(off.abs() < 1.1e-9, "{x} {t}: {off}");
        }
        assert_eq!(ROD.displacement(1e-3, 0.25, 0.0), 0.25e-3);
    }

    /// m = 1 is the chain of springs: `ω = 2c/Δ sin((2n+1)π/(4N−2))`.
    #[test]
    fn nearest_neighbours_have_textbook_frequencies() {
        let n = 40;
        let chain = vibration(1, n, false, n as f64);
        let expected = |k: usize| {
            let angle = (2 * k + 1) as f64 * PI / (4 * n - 2) as f64;
            2.0 * ROD.speed() * n as f64 * angle.sin()
        };
        for k in [0, 1, 7, n - 2] {
            let off = chain.frequency(k) / expected(k) - 1.0;
            assert!(off.abs() < 1e-12, "{k}: {off}");
        }
        assert!((chain.stable_step() * expected(n - 2) / 2.0 - 1.0).abs() < 1e-12);
    }

    /// The leapfrog turns mode k by θ_k a step, sin(θ_k/2) = ω_k Δt/2.
    #[test]
    fn motion_is_the_sum_of_modes() {
        let (n, point) = (14, 7);
        let bar = vibration(3, n, true, 13.5);
        let dt = 0.9 * bar.stable_step();
        let seen = bar.run(1e-3, dt, 300, point);
        let modes: Vec<(f64, Vec<f64>)> = (0..n - 1).map(|k| bar.mode(k)).collect();
        for steps in [0, 1, 50, 300] {
            let mut sum = 0.0;
            for (omega, shape) in &modes {
                let theta = 2.0 * (0.5 * omega * dt).asin();
                let size: f64 = shape.iter().map(|x| x * x).sum();
                let part = (0..n).map(|i| shape[i] * 1e-3 * bar.spacing * i as f64);
                sum += part.sum::<f64>() / size * shape[point] * (theta * steps as f64).cos();
            }
            assert!(
                (seen[steps] - sum).abs() < 1e-14,
                "{steps}: {} {sum}",
                seen[steps]
            );
        }
    }

    /// With the true length the homogenized bar is nearer; with Δ = L/N the softness of the other's fixed end, 1/(2√2) of a
    /// spacing, cancels most of the half spacing that is counted too much, and it looks better at m = 2.
    #[test]
    fn the_convention_of_length_decides() {
        let n = 200;
        let off = |homogenized, length| {
            let bar = vibration(2, n, homogenized, length);
            (bar.frequency(0) / ROD.frequency(0) - 1.0).abs()
        };
        let (effective, counted) = (n as f64 - 0.5, n as f64);
        assert!(off(true, effective) < 0.01 * off(false, effective));
        assert!(off(false, counted) < 0.5 * off(true, counted));
    }

    #[test]
    fn homogenized_bars_need_shorter_steps() {
        for (m, most) in [(2, 0.98), (3, 0.86), (4, 0.78), (5, 0.70)] {
            let step = |homogenized| vibration(m, 100, homogenized, 100.0).stable_step();
            let part = step(true) / step(false);
            assert!(part < most && part > most - 0.01, "m = {m}: {part}");
        }
    }

    #[test]
    fn half_weights_are_refused() {
        let bar = Bar::new(2, 9, Ends::Half, true).unwrap();
        let told = Vibration::new(&bar, 1.0, 1.0, 1.0).unwrap_err();
        assert!(told.to_string().contains("take full ends"));
    }
}
