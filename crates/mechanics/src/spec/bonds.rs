//! Which bonds points have, and what they weigh.

use super::{
    Calibration, CrackShape, FamilyChoice, Horizon, Influence, SmoothSpec, SurfaceFactors,
};
use crate::expression::Expression;

/// The bonds of the reference; the default: a horizon of one spacing, no influence function, no volume scaling, free
/// surfaces, constants of the discrete family.
#[derive(Debug, Clone, Default)]
pub struct BondsSpec {
    pub horizon: Horizon,
    /// Horizon of each point of a cloud (length), an expression of x, y, z, at most `horizon`; `None`: all have that.
    pub variable_horizon: Option<Expression>,
    /// Scale the partner's volume linearly where its cell straddles the horizon (`lammps-peri` item 3).
    pub partial_volume_correction: bool,
    /// Calibrate stiffness constants to the discrete bulk family, or use the continuum integrals.
    pub calibration: Calibration,
    /// Influence function ω.
    pub influence: Influence,
    /// Factors of bonds near the surface; `None`: all 1.
    pub surface: Option<SurfaceFactors>,
    /// Factors of bonds anywhere; all that concern a bond are multiplied.
    pub factors: Vec<BondFactorSpec>,
    /// Which family enumerates the bonds; `Auto` takes the stencil for lattice bodies, the list otherwise.
    pub family: FamilyChoice,
    /// Nodes that carry the atoms of a reference family along; `None`: the atoms move.
    pub smooth: Option<SmoothSpec>,
}

/// A factor of the stiffness of bonds: heterogeneous bodies, weak planes.
#[derive(Debug, Clone)]
pub enum BondFactorSpec {
    /// Every bond gets the mean, by [`InteractionsSpec::interface`](super::InteractionsSpec::interface), of the factors at
    /// its ends' reference positions.
    Field(Expression),
    /// Bonds that cross this shape.
    Crossing { shape: CrackShape, factor: f64 },
}
