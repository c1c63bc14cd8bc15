//! What is done to a body: contact, initial values, conditions.

use super::{Cohesion, Convection, Force, Friction, Radiation, Shape, SpeciesExchange, StageName};
use crate::deck::units::Dim;
use crate::deck::value::{At, Components, Number, Or, Written};
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
    /// Coulomb friction between points that touch and have no whole bond, which stick and slip; a number or an expression of t; 0 when left out.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub friction: Option<At<Or<Written, Friction>>>,
    /// Attraction between points of different bodies; none when left out.
    pub cohesion: Option<At<Cohesion>>,
    /// Thermal contact conductance between points that were never bonded: heat per area, time and difference of temperature; contact
    /// conducts nothing when left out.
    #[schemars(extend("dimension" = Dim::HEAT_TRANSFER.name()))]
    pub conductance: Option<Number>,
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
    /// At t = 0, an expression of x, y, z; of [heat].
    #[schemars(extend("dimension" = Dim::TEMPERATURE.name()))]
    pub temperature: Option<Number>,
    /// At t = 0, an expression of x, y, z; of [species].
    #[schemars(extend("dimension" = Dim::CONCENTRATION.name()))]
    pub concentration: Option<Number>,
}

/// What is done to a set during the run, expressions of reference x, y, z and t.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Condition {
    /// A set, or a region; everything when both are left out.
    pub set: Option<At<String>>,
    /// Instead of a set.
    pub region: Option<At<Shape>>,
    /// Of a deck with [statics] and [run]: the one of both in which this acts, both when left out (without t, which begins at 0 in each).
    pub stage: Option<At<StageName>>,
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
    /// Area of the whole face that the set stands for, for what comes through it (traction, fluxes, exchange) and is spread over its points by
    /// volume. When left out that of a curve, surface or side set of the mesh; of a lattice that of the flat face across an axis of which the
    /// set is a layer, however deep; else it must be given.
    #[schemars(extend("dimension" = Dim::AREA.name()))]
    pub area: Option<Number>,
    /// Viscous force density / velocity.
    #[schemars(extend("dimension" = Dim::DAMPING.name()))]
    pub damping: Option<Number>,
    /// A force by its name, with its constants.
    pub force: Option<At<Force>>,
    /// Temperature held there, an expression of x, y, z, t; of [heat], as those that follow.
    #[schemars(extend("dimension" = Dim::TEMPERATURE.name()))]
    pub temperature: Option<Number>,
    /// Heat into the body through the surface of the set, an expression of x, y, z, t.
    #[schemars(extend("dimension" = Dim::HEAT_FLUX.name()))]
    pub heat_flux: Option<Number>,
    /// Heat made in the set, an expression of x, y, z, t.
    #[schemars(extend("dimension" = Dim::HEAT_SOURCE.name()))]
    pub heat_source: Option<Number>,
    /// Exchange of heat through the surface of the set with what flows around it.
    pub convection: Option<At<Convection>>,
    /// Radiation through the surface of the set.
    pub radiation: Option<At<Radiation>>,
    /// Concentration held there, an expression of x, y, z, t; of [species], as those that follow.
    #[schemars(extend("dimension" = Dim::CONCENTRATION.name()))]
    pub concentration: Option<Number>,
    /// Into the body through the surface of the set, an expression of x, y, z, t.
    #[schemars(extend("dimension" = Dim::SPECIES_FLUX.name()))]
    pub species_flux: Option<Number>,
    /// Made in the set, an expression of x, y, z, t.
    #[schemars(extend("dimension" = Dim::SPECIES_SOURCE.name()))]
    pub species_source: Option<Number>,
    /// Exchange through the surface of the set with what is around it.
    pub species_exchange: Option<At<SpeciesExchange>>,
}
