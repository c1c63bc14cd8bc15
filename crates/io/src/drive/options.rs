//! What a deck asks of files that a run writes.

use crate::write::space_time::Window;
use std::path::PathBuf;

/// An Exodus file of all frames.
#[derive(Debug, Clone, Default)]
pub struct ExodusPlan {
    /// In the folder of the results.
    pub path: PathBuf,
    pub materials: Vec<String>,
    /// Names of several bodies; none of one.
    pub bodies: Vec<String>,
    /// Sets that become node sets.
    pub sets: Vec<String>,
}

/// A field over place and time.
#[derive(Debug, Clone)]
pub struct SpaceTimeOptions {
    /// [`DENSITY`](crate::write::space_time::DENSITY) or a field of points.
    pub field: String,
    pub component: Option<String>,
    /// Ends of the colours.
    pub range: Option<[f64; 2]>,
    pub window: Window,
    /// After which the body repeats.
    pub period: Option<f64>,
}
