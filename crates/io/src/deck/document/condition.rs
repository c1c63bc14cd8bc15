//! What is done to a body: contact, initial values, conditions, indenters.

use super::Shape;
use crate::deck::units::Dim;
use crate::deck::value::{At, Components, Number, Vector};
use schemars::JsonSchema;
use serde::Deserialize;

/// Short-range repulsion.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// Fraction of the reference distance below which any pair repels; 0.9 when left out.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub bonded: Option<Number>,
    /// Range in spacings; 1.35 when left out.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub free: Option<Number>,
    /// Force / volume² / length; from the law when left out.
    #[schemars(extend("dimension" = Dim::CONTACT_STIFFNESS.name()))]
    pub stiffness: Option<Number>,
    /// Coulomb friction between points that were never bonded; 0 when left out.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub friction: Option<Number>,
}

/// Values at t = 0, expressions of x, y, z.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Initial {
    /// A set, or a region; everything when both are left out.
    pub set: Option<At<String>>,
    /// Instead of a set.
    pub region: Option<At<Shape>>,
    /// At t = 0, expressions of x, y, z.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub displacement: Option<Components>,
    /// At t = 0, expressions of x, y, z.
    #[schemars(extend("dimension" = Dim::VELOCITY.name()))]
    pub velocity: Option<Components>,
}

/// What is done to a set during the run, expressions of reference x, y, z and t.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Condition {
    /// A set, or a region; everything when both are left out.
    pub set: Option<At<String>>,
    /// Instead of a set.
    pub region: Option<At<Shape>>,
    /// Held there: expressions of x, y, z, t; an axis that is left out is free.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub displacement: Option<Components>,
    /// Moved with it from where it is, instead of a displacement.
    #[schemars(extend("dimension" = Dim::VELOCITY.name()))]
    pub velocity: Option<Components>,
    /// Force / volume.
    #[schemars(extend("dimension" = Dim::FORCE_DENSITY.name()))]
    pub body_force: Option<Components>,
    /// Force / area.
    #[schemars(extend("dimension" = Dim::PRESSURE.name()))]
    pub traction: Option<Components>,
    /// Area over which the traction is spread; one lattice face per point when left out.
    #[schemars(extend("dimension" = Dim::AREA.name()))]
    pub area: Option<Number>,
    /// Viscous force density / velocity.
    #[schemars(extend("dimension" = Dim::DAMPING.name()))]
    pub damping: Option<Number>,
}

/// A rigid sphere; moved as its centre (an expression of t) says, or free when it has a mass.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Indenter {
    /// Force density / length².
    #[schemars(extend("dimension" = Dim::INDENTER_STIFFNESS.name()))]
    pub stiffness: Number,
    /// Radius.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub radius: Number,
    /// Its centre: of a driven one expressions of t, of a free one where it begins.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub center: Vector,
    /// Of a free one at the start; of a driven one always. 0 when left out.
    #[schemars(extend("dimension" = Dim::VELOCITY.name()))]
    pub velocity: Option<Vector>,
    /// With a mass it moves by the forces on it; without one it is driven.
    #[schemars(extend("dimension" = Dim::MASS.name()))]
    pub mass: Option<Number>,
}
