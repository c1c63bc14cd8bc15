//! A bond of a reference family, as laws are told of it.

/// A bond of a reference family.
#[derive(Debug, Clone, Copy)]
pub struct Partner<const D: usize> {
    /// ξ (length).
    pub xi: [f64; D],
    /// Influence function ω(|ξ|).
    pub omega: f64,
    /// `ν V_j`
    pub volume: f64,
}
