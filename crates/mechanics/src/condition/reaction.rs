//! What a condition gives back.

/// What a condition had at the last force evaluation, in sums over points of *densities* (as LAMMPS prints them).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Reaction {
    /// `Σ K (R − r)³ / 3` of an indenter.
    pub energy: f64,
    /// Of an indenter minus the sum of the force densities on the points; of a load the sum of the force densities on
    /// its points before it acted, without points that its list leaves alone.
    pub force: [f64; 3],
}
