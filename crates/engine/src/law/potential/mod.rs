//! Interatomic potentials: `E_i = F(ρ_i) + ½ Σ_j φ(r_ij)`, `ρ_i = Σ_j f(r_ij)` (seleson2014 (2.1), (2.2)).
//!
//! A potential is written once, as a function of `q = r²` over any [`Number`]; forces, elastic constants, dispersion
//! and gradient coefficients follow by differentiation of that one text. A pair potential is one file with `pair`.

pub mod lennard_jones;

use super::number::Number;

/// An interatomic potential of one kind of atom.
pub trait Potential: Send + Sync + 'static {
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

    /// Embedding energy F (energy) of the density ρ.
    fn embedding<N: Number>(&self, _density: N) -> N {
        N::constant(0.0)
    }
}
