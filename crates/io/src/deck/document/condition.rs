//! What is done to a body: contact, initial values, conditions, indenters.

use super::Shape;
use crate::deck::value::{At, Components, Number, Vector};
use schemars::JsonSchema;
use serde::Deserialize;

/// Short-range repulsion.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// Fraction of the reference distance below which any pair repels; 0.9 when left out.
    pub bonded: Option<Number>,
    /// Range in spacings; 1.35 when left out.
    pub free: Option<Number>,
    /// Force / volume² / length; from the law when left out.
    pub stiffness: Option<Number>,
    /// Coulomb friction between points that were never bonded; 0 when left out.
    pub friction: Option<Number>,
}

/// Values at t = 0, expressions of x, y, z.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Initial {
    /// A set, or a region; everything when both are left out.
    pub set: Option<At<String>>,
    pub region: Option<At<Shape>>,
    pub displacement: Option<Components>,
    pub velocity: Option<Components>,
}

/// What is done to a set during the run, expressions of reference x, y, z and t.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Condition {
    /// A set, or a region; everything when both are left out.
    pub set: Option<At<String>>,
    pub region: Option<At<Shape>>,
    pub displacement: Option<Components>,
    pub velocity: Option<Components>,
    /// Force / volume.
    pub body_force: Option<Components>,
    /// Force / area.
    pub traction: Option<Components>,
    /// Area over which the traction is spread; one lattice face per point when left out.
    pub area: Option<Number>,
    /// Viscous force density / velocity.
    pub damping: Option<Number>,
}

/// A rigid sphere; moved as its centre (an expression of t) says, or free when it has a mass.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Indenter {
    /// Force density / length².
    pub stiffness: Number,
    pub radius: Number,
    pub center: Vector,
    pub velocity: Option<Vector>,
    pub mass: Option<Number>,
}
