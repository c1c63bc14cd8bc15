//! Interatomic potentials: `E_i = F(ρ_i) + ½ Σ_j φ(r_ij)`, `ρ_i = Σ_j f(r_ij)` (seleson2014 (2.1), (2.2)).
//!
//! A potential is written once, as a function of `q = r²` over any [`Number`]; forces, elastic constants, dispersion
//! and gradient coefficients follow by differentiation of that one text. A pair potential is one file with `pair`.

pub mod buckingham;
pub mod bulk;
pub mod cut;
pub mod lennard_jones;
pub mod mei;
pub mod morse;
pub mod tabulated;

use super::number::Number;
use crate::spec::{Form, PotentialSpec};
use std::sync::Arc;

/// An interatomic potential of one kind of atom.
pub trait Potential: Clone + Send + Sync + 'static {
    /// Is there a density f and an embedding energy F?
    const EMBEDDED: bool = false;

    /// The distance beyond which nothing is said (length); ∞: none.
    fn cutoff(&self) -> f64;

    /// Pair energy φ (energy) of `q = r²`.
    fn pair<N: Number>(&self, q: N) -> N;

    /// Density f that an atom adds at the distance `√q`.
    fn density<N: Number>(&self, _q: N) -> N {
        N::constant(0.0)
    }

    /// φ and f, where both are wanted and share work.
    #[inline(always)]
    fn both<N: Number>(&self, q: N) -> [N; 2] {
        [self.pair(q), self.density(q)]
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

/// What is done with a potential of a known kind.
pub trait Visitor {
    type Out;
    fn visit<P: Potential>(self, potential: P) -> Self::Out;
}

impl PotentialSpec {
    pub fn name(&self) -> &'static str {
        match &self.form {
            Form::LennardJones(_) => "lennard_jones",
            Form::Morse(_) => "morse",
            Form::Buckingham(_) => "buckingham",
            Form::Mei(_) => "mei",
            Form::Tabulated(_) => "eam",
        }
    }

    /// Distance beyond which it says nothing (length); ∞: none.
    pub fn cut_off(&self) -> f64 {
        struct CutOff;
        impl Visitor for CutOff {
            type Out = f64;
            fn visit<P: Potential>(self, potential: P) -> f64 {
                potential.cutoff()
            }
        }
        self.apply(CutOff)
    }

    /// The only match on the form.
    pub fn apply<V: Visitor>(&self, visitor: V) -> V::Out {
        use cut::Cut;
        let (cutoff, end) = (self.cutoff, self.end);
        match &self.form {
            Form::LennardJones(p) => visitor.visit(Cut::new(*p, cutoff, end)),
            Form::Morse(p) => visitor.visit(Cut::new(*p, cutoff, end)),
            Form::Buckingham(p) => visitor.visit(Cut::new(*p, cutoff, end)),
            Form::Mei(p) => visitor.visit(mei::Mei::new((**p).clone())),
            Form::Tabulated(p) => visitor.visit(Arc::new(tabulated::Tabulated::new(p))),
        }
    }
}

impl<P: Potential> Potential for Arc<P> {
    const EMBEDDED: bool = P::EMBEDDED;
    fn cutoff(&self) -> f64 {
        (**self).cutoff()
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
    fn embedding<N: Number>(&self, density: N) -> N {
        (**self).embedding(density)
    }
    fn least_density(&self) -> f64 {
        (**self).least_density()
    }
}
