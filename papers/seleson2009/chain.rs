//! The chains of section 4: K(N) = 2 K1 / (N (N+1)), and the path of refinement (4.13).

/// A chain of points with N neighbours on each side, of density ρ and modulus K1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chain {
    /// Number of points.
    pub points: u32,
    /// Neighbours on each side.
    pub neighbours: u32,
    /// Distance of points.
    pub spacing: f64,
    pub density: f64,
    pub k1: f64,
}

impl Chain {
    /// On [0, 1000] with ρ = K1 = 1.
    pub fn thousand(points: u32, neighbours: u32) -> Chain {
        Chain {
            points,
            neighbours,
            spacing: 1000.0 / f64::from(points - 1),
            density: 1.0,
            k1: 1.0,
        }
    }

    /// K(N), appendix A.1.
    pub fn stiffness(&self) -> f64 {
        let n = f64::from(self.neighbours);
        2.0 * self.k1 / (n * (n + 1.0))
    }

    /// Δt of (4.13): `safety` times the bound (4.12).
    pub fn time_step(&self, safety: f64) -> f64 {
        let harmonic: f64 = (1..=self.neighbours).map(|i| 1.0 / f64::from(i)).sum();
        safety * (self.density / (self.stiffness() * harmonic)).sqrt() * self.spacing
    }

    /// Changes of a deck that make its chain this one, with the step of (4.13) until `end`.
    pub fn changes(&self, safety: f64, end: f64) -> Vec<(&'static str, String)> {
        vec![
            ("constants.intervals", (self.points - 1).to_string()),
            ("constants.N", self.neighbours.to_string()),
            ("constants.dt", format!("{:?}", self.time_step(safety))),
            ("run.steps", self.steps(safety, end).to_string()),
        ]
    }

    /// Whole steps until `end`.
    pub fn steps(&self, safety: f64, end: f64) -> u32 {
        (end / self.time_step(safety)).floor() as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_neighbour_gives_the_classical_limit() {
        // ω_max = 2 √(K1/ρ) / Δx: the step is Δx √(ρ/K1)
        let chain = Chain::thousand(1001, 1);
        assert_eq!((chain.stiffness(), chain.spacing), (1.0, 1.0));
        assert_eq!(chain.time_step(1.0), 1.0);
        // the frame "t = 150.45" of Fig. 4.5 is step 177 of 0.85
        assert!((177.0 * chain.time_step(0.85) - 150.45).abs() < 1e-12);
    }
}
