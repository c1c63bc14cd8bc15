//! What fields a deck asks for.

use peridyne_fields::{PairForce, Partition, Shape};

/// Fields of the running model.
#[derive(Debug, Clone)]
pub struct FieldsSpec {
    /// Folder inside that of the results.
    pub name: String,
    pub shape: Shape,
    /// S (length).
    pub width: f64,
    /// Axes that are averaged over; those beyond the dimension among them.
    pub averaged: [bool; 3],
    pub place: Place,
    /// Of peridynamic bodies `None`: those of their force states.
    pub choice: Option<Choice>,
    /// Steps between frames; `None`: the last state.
    pub every: Option<u64>,
    /// Frames to pass over first.
    pub skip: u64,
    /// Write each frame.
    pub each: bool,
    /// Write the pressure, too.
    pub pressure: bool,
    /// Points at which residuals are measured.
    pub residuals: usize,
}

/// Where fields are wanted.
#[derive(Debug, Clone, PartialEq)]
pub enum Place {
    Grid {
        counts: [usize; 3],
        /// Lower and upper; `None`: of the body.
        corners: Option<[[f64; 3]; 2]>,
    },
    Points(Vec<[f64; 3]>),
}

/// What is a choice with atoms.
#[derive(Debug, Clone, Default)]
pub struct Choice {
    pub partition: Partition,
    pub pair_force: PairForce,
    /// Keep parts of the potential apart.
    pub parts: bool,
}
