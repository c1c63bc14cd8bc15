//! What forces are found for.

/// Which state forces are those of, and how it was come to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Evaluation {
    /// No step led here, and one so long (time) begins: a run starts, or a state was given, or is gone back to. What slides has slid before.
    Start { next: f64 },
    /// The end of an explicit step so long (time), with the velocities of its middle.
    StepEnd { dt: f64 },
    /// On the way of an increment of statics or an implicit step so long (time), or at its end, from where it departed.
    Trial { step: f64 },
}

impl Evaluation {
    /// What it is to somebody who departed with the others, or was put there since.
    pub fn of(self, departed: bool) -> Evaluation {
        match self {
            Evaluation::Trial { step } if !departed => Evaluation::Start { next: step },
            Evaluation::Start { .. } | Evaluation::StepEnd { .. } | Evaluation::Trial { .. } => {
                self
            }
        }
    }

    /// Where paths are measured from, if they are measured from there.
    pub fn since<T>(self, departure: &Option<T>) -> Option<&T> {
        match self {
            Evaluation::Trial { .. } => departure.as_ref(),
            Evaluation::Start { .. } | Evaluation::StepEnd { .. } => None,
        }
    }

    /// The step of any kind whose end this is, or may be (time); 0 where none led here.
    pub fn led_here(self) -> f64 {
        match self {
            Evaluation::StepEnd { dt } => dt,
            Evaluation::Trial { step } => step,
            Evaluation::Start { .. } => 0.0,
        }
    }

    /// The explicit step that ends (time); 0 where none does, and velocities are those of the state.
    pub fn ended(self) -> f64 {
        match self {
            Evaluation::StepEnd { dt } => dt,
            Evaluation::Start { .. } | Evaluation::Trial { .. } => 0.0,
        }
    }
}
