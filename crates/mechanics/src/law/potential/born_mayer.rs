//! Born-Mayer: `φ = A e^((σ − r)/ρ) − C / r⁶ + D / r⁸` (Born & Mayer 1932; Huggins & Mayer 1933; signs as LAMMPS's `born`).

use super::constants::{Constants, MOST, Same};
use super::cut::{self, Cut, Ends};
use super::{Described, Potential};
use crate::columns::Dimension;
use crate::law::descriptor::{Bounds, Descriptor, Wrong, number};
use crate::law::number::Number;
use crate::spec::Parameters;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BornMayer {
    /// Strength A of the repulsion at σ (energy).
    pub strength: f64,
    /// Distance σ (length).
    pub sigma: f64,
    /// Range ρ of the repulsion (length).
    pub range: f64,
    /// C (energy · length⁶).
    pub dispersion: f64,
    /// D (energy · length⁸).
    pub eighth: f64,
}

impl Potential for BornMayer {
    fn length(&self) -> f64 {
        self.sigma + 8.0 * self.range
    }

    #[inline(always)]
    fn pair<N: Number>(&self, q: N) -> N {
        self.pair_of(Same(&self.constants()), q)
    }

    const CONSTANTS: usize = 5;

    #[inline(always)]
    fn constants(&self) -> [f64; MOST] {
        let mut all = [0.0; MOST];
        all[0] = -self.sigma;
        all[1] = -1.0 / self.range;
        all[2] = self.strength;
        all[3] = -self.eighth;
        all[4] = self.dispersion;
        all
    }

    #[inline(always)]
    fn pair_of<N: Number>(&self, of: impl Constants<N>, q: N) -> N {
        let repulsion = of.times(of.plus(q.sqrt(), 0), 1).exp();
        let inverse = q.recip();
        let attraction = of.plus(of.times(inverse, 3), 4);
        of.times(repulsion, 2) - inverse.power(3) * attraction
    }
}

impl Described for BornMayer {
    const NAME: &'static str = "born_mayer";
    type Made = Cut<Self>;

    fn descriptor() -> Descriptor {
        let (sixth, eighth) = (Dimension([8, 1, -2, 0]), Dimension([10, 1, -2, 0]));
        let sigma = "Distance σ at which the repulsion is A.";
        let (c, d) = ("C, energy times length⁶.", "D, energy times length⁸.");
        Descriptor::new(Self::NAME, "Atoms: A e^((σ−r)/ρ) − C/r⁶ + D/r⁸.")
            .source("Born & Mayer 1932; Huggins & Mayer 1933")
            .example("{ strength = \"0.25 eV\", sigma = \"2.3 Å\", range = \"0.32 Å\", dispersion = \"1 eV*Å^6\", cutoff = \"8 Å\" }")
            .number("strength", Dimension::ENERGY, Bounds::POSITIVE, "A at σ.")
            .keys(&[number("sigma", Dimension::LENGTH, Bounds::NOT_NEGATIVE, sigma).or(0.0)])
            .number("range", Dimension::LENGTH, Bounds::POSITIVE, "Range ρ of the repulsion.")
            .keys(&[number("dispersion", sixth, Bounds::ANY, c).or(0.0)])
            .keys(&[number("eighth", eighth, Bounds::ANY, d).or(0.0)])
            .keys(&cut::KEYS)
    }

    fn read(p: &Parameters) -> Result<Self, Wrong> {
        let keys = ["strength", "sigma", "range", "dispersion", "eighth"];
        let [strength, sigma, range, dispersion, eighth] = cut::numbers(p, keys)?;
        Ok(BornMayer {
            strength,
            sigma,
            range,
            dispersion,
            eighth,
        })
    }

    fn parameters(&self) -> Parameters {
        Parameters::numbers(&[
            ("strength", self.strength),
            ("sigma", self.sigma),
            ("range", self.range),
            ("dispersion", self.dispersion),
            ("eighth", self.eighth),
        ])
    }

    fn made(self, ends: Ends) -> Cut<Self> {
        Cut::new(self, ends)
    }
}
