//! Several kinds of atoms in one body: every material is a kind, and its law is what its atoms have among themselves.

use super::PotentialSpec;

/// A potential besides those that are laws of materials. The energy of a body is the sum of all its potentials.
#[derive(Debug, Clone, PartialEq)]
pub struct ActingSpec {
    pub potential: PotentialSpec,
    pub on: Acting,
}

/// Which atoms a potential acts on.
#[derive(Debug, Clone, PartialEq)]
pub enum Acting {
    /// Pairs of atoms of these two materials, by their places in the spec; both may be the same. Unlike materials that have one
    /// are not mixed.
    Between([usize; 2]),
}

/// How the constants of a pair of unlike atoms follow from those of like ones, where no potential is given for them: ε is an energy,
/// σ any length (LAMMPS, `pair_modify mix`).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mixing {
    /// `σ = ½(σ_i + σ_j)`, `ε = √(ε_i ε_j)` (Lorentz & Berthelot).
    Arithmetic,
    /// `σ = √(σ_i σ_j)`, `ε = √(ε_i ε_j)`.
    Geometric,
    /// `σ⁶ = ½(σ_i⁶ + σ_j⁶)`, `ε = 2 √(ε_i ε_j) σ_i³ σ_j³ / (σ_i⁶ + σ_j⁶)` (Waldman & Hagler 1993).
    SixthPower,
}

impl Mixing {
    /// All of them.
    pub const ALL: [Mixing; 3] = [Mixing::Arithmetic, Mixing::Geometric, Mixing::SixthPower];

    /// As decks write it.
    pub fn name(self) -> &'static str {
        match self {
            Mixing::Arithmetic => "arithmetic",
            Mixing::Geometric => "geometric",
            Mixing::SixthPower => "sixthpower",
        }
    }

    /// A length of the pair.
    pub fn length(self, a: f64, b: f64) -> f64 {
        match self {
            Mixing::Arithmetic => 0.5 * (a + b),
            Mixing::Geometric => (a * b).sqrt(),
            Mixing::SixthPower => libm::pow(0.5 * (a.powi(6) + b.powi(6)), 1.0 / 6.0),
        }
    }

    /// The depth of atoms with these depths and sizes.
    pub fn depth(self, [a, b]: [f64; 2], [s, t]: [f64; 2]) -> f64 {
        let mean = (a * b).sqrt();
        match self {
            Mixing::Arithmetic | Mixing::Geometric => mean,
            Mixing::SixthPower => 2.0 * mean * s.powi(3) * t.powi(3) / (s.powi(6) + t.powi(6)),
        }
    }
}
