//! Embedded-atom models from tables, as eam/alloy and eam files hold them (one element).

use super::Potential;
use crate::law::number::Number;
use crate::law::spline::{Spline, Twin};
use crate::spec::TableSpec;

/// F(ρ), f(r) and r φ(r) as piecewise cubics.
#[derive(Debug, Clone, PartialEq)]
pub struct Tabulated {
    embedding: Spline,
    /// f and r φ (energy · length).
    bonds: Twin,
    cutoff: f64,
}

impl Tabulated {
    /// Splines through the values. Beyond the last density F goes on as a straight line.
    ///
    /// # Panics
    /// If a table has fewer than five values, or f and r φ differ in number.
    pub fn new(table: &TableSpec) -> Tabulated {
        Tabulated {
            embedding: Spline::new(0.0, table.density_step, &table.embedding, true),
            bonds: Twin::new(
                &Spline::new(0.0, table.step, &table.density, false),
                &Spline::new(0.0, table.step, &table.pair, false),
            ),
            cutoff: table.cutoff,
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
