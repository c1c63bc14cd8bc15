//! How a run goes, and what it tells.

use super::{PreloadSpec, ProbeSpec, Schedule};

/// Steps and results of a run; the default: no steps, the usual columns, no probes.
#[derive(Debug, Clone, Default)]
pub struct RunSpec {
    /// Statics that the motion of the schedule begins from.
    pub preload: Option<PreloadSpec>,
    pub schedule: Schedule,
    /// Columns of points that the caller will ask for, by name; a name that does not exist is an error. `None`: what is usual.
    pub fields: Option<Vec<String>>,
    /// What is measured over time.
    pub probes: Vec<ProbeSpec>,
}
