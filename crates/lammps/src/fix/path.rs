//! Where `fix move` takes its atoms.

use super::input::Input;

/// A motion from where the atoms were when the fix was made; numbers are in box units, `None` on an axis: forces move it.
#[derive(Debug, Clone, PartialEq)]
pub enum Path {
    /// Velocity.
    Linear([Option<f64>; 3]),
    /// Amplitude, period: `A sin(2π t/T)`.
    Wiggle([Option<f64>; 3], f64),
    /// About the axis (a unit vector) through a point, period.
    Rotate {
        point: [f64; 3],
        axis: [f64; 3],
        period: f64,
    },
    /// Displacement and velocity by variables.
    Variable([Option<Input>; 3], [Option<Input>; 3]),
}

/// When and where a motion began.
#[derive(Debug, Clone, PartialEq)]
pub struct Start {
    pub step: u64,
    /// Unwrapped, of all atoms, in order of id when the fix was made.
    pub places: Vec<[f64; 3]>,
    /// Ids of these.
    pub ids: Vec<u64>,
}
