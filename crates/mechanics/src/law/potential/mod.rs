//! Interatomic potentials: `E_i = F(ρ_i) + ½ Σ_j φ(r_ij)`, `ρ_i = Σ_j f(r_ij)` (seleson2014 (2.1), (2.2)).
//!
//! A potential is written once, as a function of `q = r²` over any [`Number`]; forces, elastic constants, dispersion
//! and gradient coefficients follow by differentiation of that one text. It is one file, with its constants and what decks say of
//! them ([`Described`]), and a line in [`each`].

pub mod born_mayer;
pub mod buckingham;
pub mod bulk;
pub mod constants;
pub mod cut;
mod described;
pub mod lennard_jones;
pub mod mei;
pub mod mixture;
pub mod morse;
pub mod no_potential;
pub mod tabulated;

pub use described::{Described, KeptReach, Kinds, Unlike, Visitor};
pub(crate) use described::{look_up, make};

use super::number::Number;
use constants::{Constants, MOST};
use std::sync::Arc;

/// All that come with the engine, a line each.
pub fn each(kinds: &mut impl Kinds) {
    kinds.kind::<lennard_jones::LennardJones>();
    kinds.kind::<morse::Morse>();
    kinds.kind::<buckingham::Buckingham>();
    kinds.kind::<born_mayer::BornMayer>();
    kinds.kind::<tabulated::Eam>();
    kinds.kind::<mei::EamForm>();
    kinds.kind::<no_potential::NoPotential>();
}

/// An interatomic potential of one kind of atom, or of a pair of kinds ([`mixture`]).
pub trait Potential: Clone + Send + Sync + 'static {
    /// Is there a density f and an embedding energy F?
    const EMBEDDED: bool = false;

    /// The distance beyond which nothing is said (length); ∞: none.
    fn cutoff(&self) -> f64 {
        f64::INFINITY
    }

    /// A length in the order of the nearest distance of its crystals.
    fn length(&self) -> f64 {
        0.5 * self.cutoff()
    }

    /// The nearest distance of the crystal that it is made for, if it says nothing far from there (length).
    fn made_for(&self) -> Option<f64> {
        None
    }

    /// Pair energy φ (energy) of `q = r²`.
    fn pair<N: Number>(&self, q: N) -> N;

    /// How many constants the pair energy has, if it is written as a function of them ([`Potential::pair_of`]): then pairs of several kinds
    /// are evaluated side by side.
    const CONSTANTS: usize = 0;

    /// Its constants, in an order of its own; 0 beyond.
    fn constants(&self) -> [f64; MOST] {
        [0.0; MOST]
    }

    /// φ with these constants in place of its own.
    #[inline(always)]
    fn pair_of<N: Number>(&self, _of: impl Constants<N>, q: N) -> N {
        self.pair(q)
    }

    /// Does it differ from another in constants alone?
    fn is_alike(&self, _other: &Self) -> bool {
        Self::CONSTANTS > 0
    }

    /// Density f that an atom adds at the distance `√q`.
    fn density<N: Number>(&self, _q: N) -> N {
        N::constant(0.0)
    }

    /// φ and f, where both are wanted and share work.
    #[inline(always)]
    fn both<N: Number>(&self, q: N) -> [N; 2] {
        [self.pair(q), self.density(q)]
    }

    /// Density that the first of a pair of unlike atoms adds at the second, as f is what the second adds at the first.
    #[inline(always)]
    fn given<N: Number>(&self, q: N) -> N {
        self.density(q)
    }

    /// Embedding energy F (energy) of the density ρ.
    fn embedding<N: Number>(&self, _density: N) -> N {
        N::constant(0.0)
    }

    /// F has no meaning at this density or below.
    fn least_density(&self) -> f64 {
        f64::NEG_INFINITY
    }
}

impl<P: Potential> Potential for Arc<P> {
    const EMBEDDED: bool = P::EMBEDDED;
    fn cutoff(&self) -> f64 {
        (**self).cutoff()
    }
    fn length(&self) -> f64 {
        (**self).length()
    }
    fn made_for(&self) -> Option<f64> {
        (**self).made_for()
    }
    #[inline(always)]
    fn pair<N: Number>(&self, q: N) -> N {
        (**self).pair(q)
    }
    #[inline(always)]
    fn density<N: Number>(&self, q: N) -> N {
        (**self).density(q)
    }
    #[inline(always)]
    fn both<N: Number>(&self, q: N) -> [N; 2] {
        (**self).both(q)
    }
    #[inline(always)]
    fn given<N: Number>(&self, q: N) -> N {
        (**self).given(q)
    }
    #[inline(always)]
    fn embedding<N: Number>(&self, density: N) -> N {
        (**self).embedding(density)
    }
    fn least_density(&self) -> f64 {
        (**self).least_density()
    }
}
