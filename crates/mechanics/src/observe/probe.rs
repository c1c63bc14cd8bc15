//! Columns of a history.

use crate::columns::Dimension;

/// What a probe writes.
#[derive(Debug, Clone, PartialEq)]
pub struct ProbeColumn {
    pub name: String,
    pub dimension: Dimension,
    /// The number is the square root of one of this dimension.
    pub rooted: bool,
    /// A force times a length that is no energy.
    pub moment: bool,
    /// It is how far something has come, whose speed a history has beside it.
    pub speed: Option<SpeedColumn>,
}

/// The speed of something that comes along by jumps from point to point: a mean over the last part of its way.
#[derive(Debug, Clone, PartialEq)]
pub struct SpeedColumn {
    pub name: String,
    /// That part (length).
    pub over: f64,
}

impl ProbeColumn {
    pub fn new(name: String, dimension: Dimension) -> ProbeColumn {
        ProbeColumn {
            name,
            dimension,
            rooted: false,
            moment: false,
            speed: None,
        }
    }

    #[must_use]
    pub fn rooted(mut self) -> ProbeColumn {
        self.rooted = true;
        self
    }

    #[must_use]
    pub fn with_speed(mut self, name: String, over: f64) -> ProbeColumn {
        self.speed = Some(SpeedColumn { name, over });
        self
    }

    #[must_use]
    pub fn moment(mut self) -> ProbeColumn {
        self.moment = true;
        self
    }
}
