//! What a solver did.

use crate::state::words;

/// What a solver did.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Solved {
    pub iterations: usize,
    /// Residual force over that of the start.
    pub residual: f64,
}

words!([] Solved { iterations: usize, residual: f64 });
