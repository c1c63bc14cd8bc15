//! Interatomic potentials as data: a name, and constants by their keys. What they do stands in
//! [`law::potential`](crate::law::potential), each in a file of its own.

use super::Parameters;

/// A potential, with the constants that one kind of atom, or a pair of kinds, has in it.
#[derive(Debug, Clone, PartialEq)]
pub struct PotentialSpec {
    pub name: String,
    /// Of pair potentials also how they end: `cutoff`, `end`, `smooth_from`.
    pub parameters: Parameters,
    /// Distance beyond which it says nothing (length), once the name was looked up; ∞: none.
    pub reach: f64,
}

impl PotentialSpec {
    /// Distance beyond which it says nothing (length); ∞: none.
    pub fn cut_off(&self) -> f64 {
        self.reach
    }
}

/// How a potential ends at its cut-off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum End {
    /// Energy and force jump to 0.
    Truncated,
    /// The energy goes to 0, the force jumps: `φ(r) − φ(rc)`.
    Shifted,
    /// Energy and force go to 0: `φ(r) − φ(rc) − (r − rc) φ′(rc)` (shifted force).
    ShiftedForce,
    /// Times `g((r − rn)/(rc − rn))`, `g = (1 − x)³ (1 + 3x + 6x²)`, from the distance rn (length) on: two derivatives are
    /// smooth (seleson2014 (3.9)).
    Smooth(f64),
}
