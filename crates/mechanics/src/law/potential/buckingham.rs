//! Buckingham: `φ = A e^(−r/ρ) − C / r⁶` (Buckingham 1938). It falls to −∞ at r = 0.

use super::constants::{Constants, MOST, Same};
use super::cut::{self, Cut, Ends};
use super::{Described, Potential};
use crate::columns::Dimension;
use crate::law::descriptor::{Bounds, Descriptor, Wrong};
use crate::law::number::Number;
use crate::spec::Parameters;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Buckingham {
    /// Strength A of the repulsion (energy).
    pub strength: f64,
    /// Its range ρ (length).
    pub range: f64,
    /// Dispersion constant C (energy · length⁶).
    pub dispersion: f64,
}

impl Potential for Buckingham {
    /// Repulsion over attraction balances at several ranges.
    fn length(&self) -> f64 {
        8.0 * self.range
    }

    #[inline(always)]
    fn pair<N: Number>(&self, q: N) -> N {
        self.pair_of(Same(&self.constants()), q)
    }

    const CONSTANTS: usize = 3;

    #[inline(always)]
    fn constants(&self) -> [f64; MOST] {
        let mut all = [0.0; MOST];
        all[0] = -1.0 / self.range;
        all[1] = self.strength;
        all[2] = self.dispersion;
        all
    }

    #[inline(always)]
    fn pair_of<N: Number>(&self, of: impl Constants<N>, q: N) -> N {
        let repulsion = of.times(q.sqrt(), 0).exp();
        of.times(repulsion, 1) - of.times(q.recip().power(3), 2)
    }
}

impl Described for Buckingham {
    const NAME: &'static str = "buckingham";
    type Made = Cut<Self>;

    fn descriptor() -> Descriptor {
        let dispersion = Dimension([8, 1, -2, 0]);
        Descriptor::new(Self::NAME, "Atoms: A e^(−r/ρ) − C/r⁶.")
            .source("Buckingham 1938")
            .example("{ strength = \"1000 eV\", range = \"0.3 Å\", dispersion = \"10 eV*Å^6\", cutoff = \"8 Å\" }")
            .number("strength", Dimension::ENERGY, Bounds::POSITIVE, "Strength A of the repulsion.")
            .number("range", Dimension::LENGTH, Bounds::POSITIVE, "Its range ρ.")
            .number("dispersion", dispersion, Bounds::ANY, "C, energy times length⁶.")
            .keys(&cut::KEYS)
    }

    fn read(p: &Parameters) -> Result<Self, Wrong> {
        let [strength, range, dispersion] = cut::numbers(p, ["strength", "range", "dispersion"])?;
        Ok(Buckingham {
            strength,
            range,
            dispersion,
        })
    }

    fn parameters(&self) -> Parameters {
        let (range, dispersion) = (self.range, self.dispersion);
        let strength = self.strength;
        Parameters::numbers(&[
            ("strength", strength),
            ("range", range),
            ("dispersion", dispersion),
        ])
    }

    fn made(self, ends: Ends) -> Cut<Self> {
        Cut::new(self, ends)
    }
}
