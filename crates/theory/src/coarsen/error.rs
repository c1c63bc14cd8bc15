//! What can be wrong with a request to coarsen, and what to do about it.

/// Why there is no coarse body. Points are those of the body below.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CoarsenError {
    #[error(
        "no point is retained: mark at least one, or take a smaller spacing of retained points"
    )]
    Empty,
    #[error(
        "point {index} is to be retained, but the body has {points} points: give indices below {points}"
    )]
    OutOfRange { index: u32, points: usize },
    #[error("point {0} is to be retained twice: list every retained point once")]
    Twice(u32),
    #[error("the body is not finite at point {0}: check its positions, volumes and micromoduli")]
    NotFinite(usize),
    #[error(
        "the radius of balls {radius} is below the longest bond {range} of the body below (two horizons for state-based laws): use {range} or more"
    )]
    Range { radius: f64, range: f64 },
    #[error("the radius of balls must be a positive number, not {0}")]
    Radius(f64),
    #[error("the tolerance on the effective modulus must be between 0 and 1, not {0}")]
    Tolerance(f64),
    #[error(
        "the ball of radius {radius} about retained point {point} holds no other retained point: retain more points or use a larger radius"
    )]
    Alone { point: usize, radius: f64 },
    #[error(
        "removed point {point} lies in no ball of radius {radius} about a retained point: retain more points or use a larger radius"
    )]
    Uncovered { point: usize, radius: f64 },
    #[error(
        "a part of {points} points that are bonded to no others (point {point} is one) has no retained point: retain at least one of it, or delete it"
    )]
    Unrepresented { point: usize, points: usize },
    #[error(
        "retained points {a} and {b} are connected by bonds below, but not in the coarse body: use a larger radius or retain more points"
    )]
    Disconnected { a: usize, b: usize },
    #[error(
        "the removed points of the ball of radius {radius} about point {point} have no stable equilibrium (indefinite or singular operator): the body below is unstable there, or the ball cuts its state-based bonds; use the energy scheme, a larger radius or the Schur complement, or repair the body below"
    )]
    Indefinite { point: usize, radius: f64 },
    #[error(
        "the equations of the removed points of the ball of radius {radius} about point {point} are singular: some motion of them meets no force; use the energy scheme, a larger radius or the Schur complement, or retain more points"
    )]
    Singular { point: usize, radius: f64 },
    #[error(
        "the factors of the {unknowns} equations of the ball about point {point} do not fit into memory: use a smaller radius or the energy scheme"
    )]
    BallTooLarge { point: usize, unknowns: usize },
    #[error(
        "the removed points have no stable equilibrium (indefinite or singular operator): the body below is unstable, or a removed point is held by too few bonds; retain such points or repair the body below"
    )]
    IndefiniteBody,
    #[error(
        "the equations of the ball about point {point} were not solved in {iterations} iterations (relative residual {residual:.1e}): stiffness contrast is extreme; use the Schur complement"
    )]
    Unsolved {
        point: usize,
        iterations: usize,
        residual: f64,
    },
    #[error(
        "the coarse body has unstable modes: its stiffness has an eigenvalue below {low:.1e} of its largest; use the energy scheme, a larger radius, or the Schur complement"
    )]
    Unstable { low: f64 },
    #[error(
        "the coarse body, whose rows are not symmetric, has unstable modes: an eigenvalue of its stiffness over its mass has a real part of {low:.1e} of its largest; use the energy scheme, a larger radius, or the Schur complement"
    )]
    Repelled { low: f64 },
    #[error(
        "action is not reaction in the body below (by {0:.1e} of its largest micromodulus), and the energy scheme needs an energy: use the row scheme, or symmetrise the body below"
    )]
    Unsymmetric(f64),
    #[error(
        "a rigid rotation of the coarse body meets forces ({found:.1e} of its stiffness, allowed {allowed:.1e}): use the energy scheme, a larger radius, or the Schur complement"
    )]
    Rotation { found: f64, allowed: f64 },
    #[error(
        "the exact elimination has {removed} removed and {retained} retained unknowns, more than the {limit} numbers it may hold: coarsen by balls, or raise the limit"
    )]
    TooLarge {
        removed: usize,
        retained: usize,
        limit: usize,
    },
    #[error(
        "the exact elimination passes {loads} components of loads on to {retained} unknowns, more than the {limit} numbers it may hold: coarsen by balls, or load fewer points"
    )]
    LoadsTooLarge {
        loads: usize,
        retained: usize,
        limit: usize,
    },
    #[error(
        "points do not lie on a lattice along axis {axis} (point {point} is off by {off:.1e} of the spacing): choose by blue noise or mark points"
    )]
    NotLattice { axis: usize, point: usize, off: f64 },
    #[error("every 0-th point cannot be retained along axis {axis}: use 1 to retain all")]
    EveryZero { axis: usize },
    #[error("the spacing of retained points must be a positive number, not {0}")]
    Spacing(f64),
    #[error("{count} points cannot be retained of {points}: ask for 1 to {points}")]
    Count { count: usize, points: usize },
}
