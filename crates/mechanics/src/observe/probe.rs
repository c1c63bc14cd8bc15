//! Columns of a history.

use crate::columns::Dimension;

/// What a probe writes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ProbeColumn {
    pub name: String,
    pub dimension: Dimension,
    /// The number is the square root of one of this dimension.
    pub rooted: bool,
    /// A force times a length that is no energy.
    pub moment: bool,
}

impl ProbeColumn {
    pub fn new(name: String, dimension: Dimension) -> ProbeColumn {
        ProbeColumn {
            name,
            dimension,
            rooted: false,
            moment: false,
        }
    }

    #[must_use]
    pub fn rooted(mut self) -> ProbeColumn {
        self.rooted = true;
        self
    }

    #[must_use]
    pub fn moment(mut self) -> ProbeColumn {
        self.moment = true;
        self
    }
}
