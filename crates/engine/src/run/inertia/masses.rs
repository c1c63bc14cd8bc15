//! Masses that couple points of all ranks: their matrix is on the first, as that of equilibria.

use crate::body::Body;
use crate::run::equilibrium::whole::{part_of_vectors, whole_vectors};
use crate::statics::Masses;

/// What masses do to the points that are here. All ranks ask at once.
#[derive(Debug)]
pub(in crate::run) struct CoupledMasses<const D: usize> {
    first: Option<Masses<D>>,
}

impl<const D: usize> CoupledMasses<D> {
    pub fn new(body: &Body<D>, masses: Masses<D>) -> Self {
        let first = body.is_first().then_some(masses);
        CoupledMasses { first }
    }

    /// Those of all points, on the first rank.
    pub fn whole(&self) -> Option<&Masses<D>> {
        self.first.as_ref()
    }

    /// `M x`
    pub fn times(&self, body: &Body<D>, x: &[[f64; D]]) -> Vec<[f64; D]> {
        let all = self.whole().zip(whole_vectors(body, x));
        part_of_vectors(body, all.map(|(masses, x)| masses.times(&x)))
    }

    /// `x · M y`
    pub fn dot(&self, body: &Body<D>, x: &[[f64; D]], y: &[[f64; D]]) -> f64 {
        let [x, y] = [x, y].map(|own| whole_vectors(body, own));
        let all = self.whole().zip(x.zip(y));
        body.told(all.map(|(masses, (x, y))| masses.dot(&x, &y)))
    }
}
