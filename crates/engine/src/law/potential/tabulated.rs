//! Embedded-atom models from tables, as eam/alloy and eam files hold them (one element).

use super::Potential;
use crate::law::number::Number;
use crate::law::spline::Spline;

/// F(ρ), f(r) and r φ(r) as piecewise cubics.
#[derive(Debug, Clone, PartialEq)]
pub struct Tabulated {
    embedding: Spline,
    density: Spline,
    /// r φ (energy · length).
    pair: Spline,
    cutoff: f64,
}

impl Tabulated {
    /// From values at `m Δρ` (F) and `m Δr` (f and r φ), m = 0, 1, …, at least five each, and the cut-off (length). Beyond
    /// the last density F goes on as a straight line.
    pub fn new(
        density_step: f64,
        embedding: &[f64],
        step: f64,
        density: &[f64],
        pair: &[f64],
        cutoff: f64,
    ) -> Tabulated {
        Tabulated {
            embedding: Spline::new(0.0, density_step, embedding, true),
            density: Spline::new(0.0, step, density, false),
            pair: Spline::new(0.0, step, pair, false),
            cutoff,
        }
    }

    /// The same model with lengths times `length` and energies times `energy`.
    pub fn scaled(&self, length: f64, energy: f64) -> Tabulated {
        Tabulated {
            embedding: self.embedding.scaled(1.0, energy),
            density: self.density.scaled(length, 1.0),
            pair: self.pair.scaled(length, energy * length),
            cutoff: self.cutoff * length,
        }
    }
}

impl Potential for Tabulated {
    const EMBEDDED: bool = true;

    fn cutoff(&self) -> f64 {
        self.cutoff
    }

    #[inline(always)]
    fn pair<N: Number>(&self, q: N) -> N {
        let r = q.sqrt();
        r.table(&self.pair) * r.recip()
    }

    #[inline(always)]
    fn density<N: Number>(&self, q: N) -> N {
        q.sqrt().table(&self.density)
    }

    #[inline(always)]
    fn embedding<N: Number>(&self, density: N) -> N {
        density.table(&self.embedding)
    }
}
