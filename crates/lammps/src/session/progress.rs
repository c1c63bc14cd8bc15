//! Simulation time and steps.

use std::time::Instant;

use crate::units::Units;
use crate::variable::functions::Clock;

/// Simulation time and steps.
#[derive(Debug, Clone)]
pub struct Progress {
    pub step: u64,
    /// First and last step of the current run.
    pub begin: u64,
    pub end: u64,
    /// First and last step of a `run ... every`, for functions of the step.
    pub whole: Option<(u64, u64)>,
    /// First step of the chain of runs (`elaplong`).
    pub first: u64,
    pub time_step: f64,
    /// Time at step `time_base.0`.
    pub time_base: (u64, f64),
    /// Wall clock at the start of the run, `None` before the first.
    pub started: Option<Instant>,
    /// Seconds in the time loops of all runs.
    pub stepping_seconds: f64,
    pub steps_done: u64,
    /// Atoms at the last set-up: those whose degrees of freedom a temperature counts, lost or not.
    pub counted: Option<usize>,
}

impl Default for Progress {
    fn default() -> Self {
        Progress {
            step: 0,
            begin: 0,
            end: 0,
            whole: None,
            first: 0,
            time_step: Units::Lj.time_step(),
            time_base: (0, 0.0),
            started: None,
            stepping_seconds: 0.0,
            steps_done: 0,
            counted: None,
        }
    }
}

impl Progress {
    pub fn clock(&self) -> Clock {
        let p = self;
        let (begin, end) = p.whole.unwrap_or((p.begin, p.end));
        Clock {
            step: p.step,
            begin,
            end,
            time_step: p.time_step,
        }
    }

    /// Simulated time.
    pub fn time(&self) -> f64 {
        let p = self;
        p.time_base.1 + (p.step - p.time_base.0.min(p.step)) as f64 * p.time_step
    }
}
