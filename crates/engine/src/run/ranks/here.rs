//! Which points, of lists of those of all ranks, a rank has.

/// Places of the points that are here, in lists of those of all ranks.
#[derive(Debug, Clone, Default)]
pub(super) struct Here {
    /// Of those that are carried.
    pub carried: Vec<usize>,
    /// Of each driven condition.
    pub driven: Vec<Vec<usize>>,
}
