//! Potentials of an atom with its near neighbours (a fan): `U_i = Σ_j h(ξ_ij, ζ_ij)`, `ζ_ij = Σ_{k≠j} z(ξ_ij, ξ_ik, ξ_jk)`,
//! ξ = d²/2, with constants of the kinds of i, j and k.
//!
//! A fan is written once over any [`Number`], as functions of distances; forces, virial, tangents and terms follow by
//! differentiation of that text. It is one file, with its constants and what decks say of them ([`Described`]), and a line in
//! [`each`].

mod bulk;
mod described;
pub mod sites;
pub mod stillinger_weber;
pub mod table;
mod tangent;
pub mod tersoff;

pub use bulk::{bulk, pair};
pub(crate) use described::look_up;
pub use described::{Described, FILE, Kinds, is_known, of_kinds};
pub use table::Row;
pub use tangent::{second_derivatives, tangents};

use super::number::{Dual, Number, Over};
use super::slopes::Slopes;
use crate::execute::lane::Lane;
use table::Table;

/// All that come with the engine, a line each.
pub fn each(kinds: &mut impl Kinds) {
    kinds.many_body::<stillinger_weber::StillingerWeber>();
    kinds.many_body::<tersoff::Tersoff>();
}

/// A bond of the centre, as far as its own length says.
#[derive(Clone, Copy)]
pub struct Arm<N> {
    /// ξ = d²/2.
    pub xi: N,
    /// Length d, and 1/d.
    pub length: N,
    pub inverse: N,
    /// What the law wants to remember; 0 beyond its cut-off.
    pub weight: N,
}

impl<N: Number> Arm<N> {
    /// Without weight.
    #[inline(always)]
    pub fn new(xi: N) -> Self {
        let length = xi.times(2.0).sqrt();
        Arm {
            xi,
            length,
            inverse: length.recip(),
            weight: N::constant(0.0),
        }
    }

    /// Cosine of the angle between two arms, the ends of which are at `closing` = ξ_jk. Nothing is divided by what vanishes at any
    /// angle.
    #[inline(always)]
    pub fn cosine(&self, other: &Self, closing: N) -> N {
        (self.xi + other.xi - closing) * self.inverse * other.inverse
    }
}

impl<L: Lane> Arm<Dual<L>> {
    /// The same, where ξ is one of several variables.
    #[inline(always)]
    pub fn along<const C: usize>(&self, n: usize) -> Arm<Slopes<L, C>> {
        let of = |x: Dual<L>| Slopes::along(x.value, x.slope, n);
        Arm {
            xi: of(self.xi),
            length: of(self.length),
            inverse: of(self.inverse),
            weight: of(self.weight),
        }
    }
}

/// A many-body potential. Everything is 0 beyond its cut-offs, by itself: nobody else looks at distances.
pub trait ManyBody: Clone + Send + Sync + 'static {
    /// The multiple of ζ that `h` adds to a function of ξ, where `z` of j and k is that of k and j. Then terms are those of pairs and of
    /// triples, and each unordered pair j, k is evaluated once.
    const TRIPLES: Option<f64>;

    /// Its constants.
    fn table(&self) -> &Table;

    /// The distance beyond which nothing is said (length).
    fn cutoff(&self) -> f64;

    /// An arm i–j at `xi`, with constants of i, j, j.
    fn arm<L: Lane, N: Over<L>>(&self, xi: N, of: impl Row) -> Arm<N>;

    /// What the arm i–k adds to ζ of i–j, with constants of i, j, k.
    fn share<L: Lane, N: Over<L>>(&self, ij: &Arm<N>, ik: &Arm<N>, closing: N, of: impl Row) -> N;

    /// The same with its slopes by ξ of both arms and by `closing`. Who writes them out is tested against those of the text.
    #[inline(always)]
    fn share_slopes<L: Lane>(
        &self,
        ij: &Arm<Dual<L>>,
        ik: &Arm<Dual<L>>,
        closing: L,
        of: impl Row,
    ) -> Slopes<L, 3> {
        let closing = Slopes::nth(closing, 2);
        self.share::<L, _>(&ij.along(0), &ik.along(1), closing, of)
    }

    /// Energy h of the bond i–j at i (energy), with constants of i, j, j.
    fn bond<L: Lane, N: Over<L>>(&self, ij: &Arm<N>, zeta: N, of: impl Row) -> N;
}
