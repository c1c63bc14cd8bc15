//! Lennard-Jones: `φ = 4ε [(σ/r)¹² − (σ/r)⁶]` (Jones 1924; seleson2009 (5.1)).

use super::constants::{Constants, MOST, Same};
use super::cut::{self, Cut, Ends};
use super::{Described, KeptReach, Potential, Unlike};
use crate::columns::Dimension;
use crate::family::stencil::Stencil;
use crate::law::descriptor::{Bounds, Descriptor, Wrong};
use crate::law::number::Number;
use crate::spec::{Mixing, Parameters};

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LennardJones {
    /// Depth ε (energy).
    pub epsilon: f64,
    /// Distance σ of zero energy (length).
    pub sigma: f64,
}

impl Potential for LennardJones {
    fn length(&self) -> f64 {
        self.sigma
    }

    #[inline(always)]
    fn pair<N: Number>(&self, q: N) -> N {
        self.pair_of(Same(&self.constants()), q)
    }

    const CONSTANTS: usize = 2;

    #[inline(always)]
    fn constants(&self) -> [f64; MOST] {
        let mut all = [0.0; MOST];
        all[0] = self.sigma * self.sigma;
        all[1] = 4.0 * self.epsilon;
        all
    }

    #[inline(always)]
    fn pair_of<N: Number>(&self, of: impl Constants<N>, q: N) -> N {
        let s6 = of.times(q.recip(), 0).power(3);
        of.times(s6 * s6 - s6, 1)
    }
}

impl Described for LennardJones {
    const NAME: &'static str = "lennard_jones";
    type Made = Cut<Self>;

    fn descriptor() -> Descriptor {
        Descriptor::new(
            Self::NAME,
            "Atoms: 4ε [(σ/r)¹² − (σ/r)⁶]. Neighbours of atoms are the current ones, or with family = \"stencil\" those of the lattice.",
        )
        .source("Jones 1924")
        .example("{ epsilon = 1, sigma = 1, cutoff = 2.5 }")
        .number("epsilon", Dimension::ENERGY, Bounds::POSITIVE, "Depth ε.")
        .number("sigma", Dimension::LENGTH, Bounds::POSITIVE, "Distance σ of zero energy.")
        .keys(&cut::KEYS)
    }

    fn read(p: &Parameters) -> Result<Self, Wrong> {
        let [epsilon, sigma] = cut::numbers(p, ["epsilon", "sigma"])?;
        Ok(LennardJones { epsilon, sigma })
    }

    fn parameters(&self) -> Parameters {
        Parameters::numbers(&[("epsilon", self.epsilon), ("sigma", self.sigma)])
    }

    fn made(self, ends: Ends) -> Cut<Self> {
        Cut::new(self, ends)
    }

    const UNLIKE: Unlike = Unlike::Mixed;

    fn mixed(own: [(Self, Ends); 2], rule: Option<Mixing>) -> Result<Cut<Self>, Wrong> {
        let Some(rule) = rule else {
            return Err((String::new(), "no rule of mixing is given".into()));
        };
        let [(a, a_ends), (b, b_ends)] = own;
        let mixed = LennardJones {
            epsilon: rule.depth([a.epsilon, b.epsilon], [a.sigma, b.sigma]),
            sigma: rule.length(a.sigma, b.sigma),
        };
        Ok(Cut::new(mixed, a_ends.mixed(b_ends, rule)?))
    }

    /// seleson2009 (5.3): reduced σ̄ and ε̄ by the sums over the neighbours, in any dimension.
    fn keeping_reach(&self, kept: &KeptReach) -> Option<Self> {
        let sums = |stencil| (lattice_sum(stencil, 6), lattice_sum(stencil, 12));
        let ((a6, a12), (b6, b12)) = (sums(kept.fine), sums(kept.coarse));
        let mut lj = *self;
        lj.sigma *= kept.factor * libm::pow((b6 / b12) / (a6 / a12), 1.0 / 6.0);
        lj.epsilon *=
            kept.factor.powi(kept.dimension as i32) * (b12 / (b6 * b6)) / (a12 / (a6 * a6));
        Some(lj)
    }
}

/// Σ over neighbours of (distance/spacing)^−p.
fn lattice_sum(stencil: &Stencil, p: i32) -> f64 {
    let all = &stencil.offsets[0];
    all.iter()
        .map(|o| libm::pow(o.squared as f64 / 16.0, -0.5 * f64::from(p)))
        .sum()
}
