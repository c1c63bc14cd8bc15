//! What can be wrong with a request to coarsen, and what to do about it.

use peridyne::message;
use peridyne::quantity::{Dimension, Message, rounded};

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
        "{}", too_small(*.radius, *.range)
    )]
    Range { radius: f64, range: f64 },
    #[error("{}", not_positive("radius of balls", *.0))]
    Radius(f64),
    #[error("the tolerance on the effective modulus must be between 0 and 1, not {0}")]
    Tolerance(f64),
    #[error(
        "{}", alone(*.point, *.radius)
    )]
    Alone { point: usize, radius: f64 },
    #[error(
        "{}", uncovered(*.point, *.radius)
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
        "{}", indefinite(*.point, *.radius)
    )]
    Indefinite { point: usize, radius: f64 },
    #[error(
        "{}", singular(*.point, *.radius)
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
        "the equations of the ball about point {point} were not solved in {iterations} iterations (relative residual {}): stiffness contrast is extreme; use the Schur complement", rounded(*.residual, 2)
    )]
    Unsolved {
        point: usize,
        iterations: usize,
        residual: f64,
    },
    #[error(
        "the coarse body has unstable modes: its stiffness has an eigenvalue below {} of its largest; use the energy scheme, a larger radius, or the Schur complement", rounded(*.low, 2)
    )]
    Unstable { low: f64 },
    #[error(
        "the coarse body, whose rows are not symmetric, has unstable modes: an eigenvalue of its stiffness over its mass has a real part of {} of its largest; use the energy scheme, a larger radius, or the Schur complement", rounded(*.low, 2)
    )]
    Repelled { low: f64 },
    #[error(
        "action is not reaction in the body below (by {} of its largest micromodulus), and the energy scheme needs an energy: use the row scheme, or symmetrise the body below", rounded(*.0, 2)
    )]
    Unsymmetric(f64),
    #[error(
        "a rigid rotation of the coarse body meets forces ({} of its stiffness, allowed {}): use the energy scheme, a larger radius, or the Schur complement", rounded(*.found, 2), rounded(*.allowed, 2)
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
        "the exact elimination has {removed} removed and {retained} retained unknowns, and the masses that go with it need more than the {limit} numbers it may hold: coarsen by balls, or take lumped masses (--mass lumped)"
    )]
    ShapesTooLarge {
        removed: usize,
        retained: usize,
        limit: usize,
    },
    #[error(
        "points do not lie on a lattice along axis {axis} (point {point} is off by {} of the spacing): choose by blue noise or mark points", rounded(*.off, 2)
    )]
    NotLattice { axis: usize, point: usize, off: f64 },
    #[error("every 0-th point cannot be retained along axis {axis}: use 1 to retain all")]
    EveryZero { axis: usize },
    #[error("{}", not_positive("spacing of retained points", *.0))]
    Spacing(f64),
    #[error("{count} points cannot be retained of {points}: ask for 1 to {points}")]
    Count { count: usize, points: usize },
}

impl CoarsenError {
    /// What it says, its numbers with what they measure.
    pub fn message(&self) -> Message {
        match self {
            CoarsenError::Range { radius, range } => too_small(*radius, *range),
            CoarsenError::Radius(radius) => not_positive("radius of balls", *radius),
            CoarsenError::Alone { point, radius } => alone(*point, *radius),
            CoarsenError::Uncovered { point, radius } => uncovered(*point, *radius),
            CoarsenError::Indefinite { point, radius } => indefinite(*point, *radius),
            CoarsenError::Singular { point, radius } => singular(*point, *radius),
            CoarsenError::Spacing(spacing) => not_positive("spacing of retained points", *spacing),
            other => other.to_string().into(),
        }
    }
}

fn length(x: f64) -> Message {
    message![Dimension::LENGTH.of(x)]
}

fn too_small(radius: f64, range: f64) -> Message {
    message![
        "the radius of balls ",
        length(radius),
        " is below the longest bond ",
        length(range),
        " of the body below (two horizons for state-based laws): use ",
        length(range),
        " or more",
    ]
}

fn not_positive(what: &str, x: f64) -> Message {
    message![
        format!("the {what} must be a positive number, not "),
        length(x)
    ]
}

fn alone(point: usize, radius: f64) -> Message {
    message![
        "the ball of radius ",
        length(radius),
        format!(
            " about retained point {point} holds no other retained point: retain more points or use a larger radius"
        ),
    ]
}

fn uncovered(point: usize, radius: f64) -> Message {
    message![
        format!("removed point {point} lies in no ball of radius "),
        length(radius),
        " about a retained point: retain more points or use a larger radius",
    ]
}

fn indefinite(point: usize, radius: f64) -> Message {
    message![
        "the removed points of the ball of radius ",
        length(radius),
        format!(
            " about point {point} have no stable equilibrium (indefinite or singular operator): the body below is unstable there, or the ball cuts its state-based bonds; use the energy scheme, a larger radius or the Schur complement, or repair the body below"
        ),
    ]
}

fn singular(point: usize, radius: f64) -> Message {
    message![
        "the equations of the removed points of the ball of radius ",
        length(radius),
        format!(
            " about point {point} are singular: some motion of them meets no force; use the energy scheme, a larger radius or the Schur complement, or retain more points"
        ),
    ]
}
