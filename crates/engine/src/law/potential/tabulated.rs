//! Embedded-atom models from tables, as eam/alloy and eam files hold them (one element).

use super::Potential;
use crate::law::number::Number;
use crate::law::spline::{Spline, Twin};

/// F(ρ), f(r) and r φ(r) as piecewise cubics.
#[derive(Debug, Clone, PartialEq)]
pub struct Tabulated {
    embedding: Spline,
    /// f and r φ (energy · length).
    bonds: Twin,
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
            bonds: Twin::new(
                &Spline::new(0.0, step, density, false),
                &Spline::new(0.0, step, pair, false),
            ),
            cutoff,
        }
    }

    /// The same model with lengths times `length` and energies times `energy`.
    pub fn scaled(&self, length: f64, energy: f64) -> Tabulated {
        Tabulated {
            embedding: self.embedding.scaled(1.0, energy),
            bonds: Twin::new(
                &self.bonds.part(0).scaled(length, 1.0),
                &self.bonds.part(1).scaled(length, energy * length),
            ),
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
        r.of_twin(&self.bonds, 1) * r.recip()
    }

    #[inline(always)]
    fn density<N: Number>(&self, q: N) -> N {
        q.sqrt().of_twin(&self.bonds, 0)
    }

    #[inline(always)]
    fn both<N: Number>(&self, q: N) -> [N; 2] {
        let r = q.sqrt();
        let [density, pair] = r.twin(&self.bonds);
        [pair * r.recip(), density]
    }

    #[inline(always)]
    fn embedding<N: Number>(&self, density: N) -> N {
        density.table(&self.embedding)
    }
}
