//! Morse: `φ = D [e^(−2α(r−r0)) − 2 e^(−α(r−r0))]` (Morse 1929).

use super::constants::{Constants, MOST, Same};
use super::cut::{self, Cut, Ends};
use super::{Described, Potential};
use crate::columns::Dimension;
use crate::law::descriptor::{Bounds, Descriptor, Wrong};
use crate::law::number::Number;
use crate::spec::Parameters;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Morse {
    /// Depth D (energy).
    pub depth: f64,
    /// Stiffness α of the well (1 / length).
    pub alpha: f64,
    /// Distance r0 of least energy (length).
    pub distance: f64,
}

impl Potential for Morse {
    fn length(&self) -> f64 {
        self.distance
    }

    #[inline(always)]
    fn pair<N: Number>(&self, q: N) -> N {
        self.pair_of(Same(&self.constants()), q)
    }

    const CONSTANTS: usize = 3;

    #[inline(always)]
    fn constants(&self) -> [f64; MOST] {
        let mut all = [0.0; MOST];
        all[0] = -self.distance;
        all[1] = -self.alpha;
        all[2] = self.depth;
        all
    }

    #[inline(always)]
    fn pair_of<N: Number>(&self, of: impl Constants<N>, q: N) -> N {
        let e = of.times(of.plus(q.sqrt(), 0), 1).exp();
        of.times(e * e - e.times(2.0), 2)
    }
}

impl Described for Morse {
    const NAME: &'static str = "morse";
    type Made = Cut<Self>;

    fn descriptor() -> Descriptor {
        let inverse = Dimension::INVERSE_LENGTH;
        Descriptor::new(Self::NAME, "Atoms: D [e^(−2α(r−r0)) − 2 e^(−α(r−r0))].")
            .source("Morse 1929")
            .example("{ depth = \"0.34 eV\", alpha = \"1.36/Å\", distance = \"2.87 Å\", cutoff = \"8 Å\" }")
            .number("depth", Dimension::ENERGY, Bounds::POSITIVE, "Depth D.")
            .number("alpha", inverse, Bounds::POSITIVE, "Stiffness α of the well.")
            .number("distance", Dimension::LENGTH, Bounds::POSITIVE, "Distance r0 of least energy.")
            .keys(&cut::KEYS)
    }

    fn read(p: &Parameters) -> Result<Self, Wrong> {
        let [depth, alpha, distance] = cut::numbers(p, ["depth", "alpha", "distance"])?;
        Ok(Morse {
            depth,
            alpha,
            distance,
        })
    }

    fn parameters(&self) -> Parameters {
        let (alpha, distance) = (self.alpha, self.distance);
        Parameters::numbers(&[
            ("depth", self.depth),
            ("alpha", alpha),
            ("distance", distance),
        ])
    }

    fn made(self, ends: Ends) -> Cut<Self> {
        Cut::new(self, ends)
    }
}
