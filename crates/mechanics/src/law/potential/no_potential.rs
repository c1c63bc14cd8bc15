//! No potential: atoms that do not feel each other in pairs.

use super::cut::Ends;
use super::{Described, Potential};
use crate::law::descriptor::{Descriptor, Wrong};
use crate::law::number::Number;
use crate::spec::Parameters;

/// `φ = 0`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoPotential;

impl Potential for NoPotential {
    fn cutoff(&self) -> f64 {
        0.0
    }

    fn length(&self) -> f64 {
        1.0
    }

    #[inline(always)]
    fn pair<N: Number>(&self, _: N) -> N {
        N::constant(0.0)
    }
}

impl Described for NoPotential {
    const NAME: &'static str = "no_potential";
    type Made = Self;

    fn descriptor() -> Descriptor {
        Descriptor::new(
            Self::NAME,
            "Atoms: no potential, of a kind or of a pair of kinds that does not interact.",
        )
        .example("{}")
    }

    fn read(_: &Parameters) -> Result<Self, Wrong> {
        Ok(NoPotential)
    }

    fn parameters(&self) -> Parameters {
        Parameters::default()
    }

    fn made(self, _: Ends) -> Self {
        self
    }

    fn reach(&self) -> f64 {
        0.0
    }
}
