//! What is done to a body: contact, initial values, conditions.

use super::{Cohesion, Convection, Force, Friction, Radiation, Shape, SpeciesExchange, StageName};
use crate::deck::quantity::{
    Area, Concentration, ContactStiffness, Damping, ForceDensity, HeatFlux, HeatSource,
    HeatTransfer, Length, Positive, Pressure, SpeciesFlux, SpeciesSource, Temperature, Velocity,
};
use crate::deck::value::{At, Components, Measured, Or, Quantity};
use schemars::JsonSchema;
use serde::Deserialize;

/// Short-range repulsion.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// The contact distance of two points is min(reference_fraction × their reference distance, spacing_multiple × the spacing): a bonded pair repels below this fraction; 0.9 by default.
    pub reference_fraction: Option<Quantity<Positive>>,
    /// The contact distance in spacings, of pairs that are farther apart in the reference; 1.35 by default.
    pub spacing_multiple: Option<Quantity<Positive>>,
    /// Force / volume² / length; from the law by default.
    pub stiffness: Option<Quantity<Positive<ContactStiffness>>>,
    /// Coulomb friction between points that touch and have no intact bond, which stick and slip; a number or an expression of t; 0 by default.
    pub friction: Option<At<Or<Measured<Positive>, Friction>>>,
    /// Attraction between points of different bodies; none by default.
    pub cohesion: Option<At<Cohesion>>,
    /// Thermal contact conductance between points that were never bonded: heat per area, time and difference of temperature; contact
    /// conducts nothing by default.
    pub conductance: Option<Quantity<Positive<HeatTransfer>>>,
}

/// Values at t = 0, expressions of x, y, z.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Initial {
    /// A set, or a region; everything by default.
    pub set: Option<At<String>>,
    /// Instead of a set.
    pub region: Option<At<Shape>>,
    /// At t = 0, expressions of x, y, z.
    pub displacement: Option<Components<Length>>,
    /// At t = 0, expressions of x, y, z.
    pub velocity: Option<Components<Velocity>>,
    /// At t = 0, an expression of x, y, z; of [heat].
    pub temperature: Option<Quantity<Temperature>>,
    /// At t = 0, an expression of x, y, z; of [species].
    pub concentration: Option<Quantity<Concentration>>,
}

/// What is done to a set during the run, expressions of reference x, y, z and t.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Condition {
    /// A set, or a region; everything by default.
    pub set: Option<At<String>>,
    /// Instead of a set.
    pub region: Option<At<Shape>>,
    /// Of a deck with [statics] and [run]: the one of both in which this acts, both by default (without t, which begins at 0 in each).
    pub stage: Option<At<StageName>>,
    /// Held there: expressions of x, y, z, t; an axis that is left out is free.
    pub displacement: Option<Components<Length>>,
    /// Moved with it from where it is, instead of a displacement.
    pub velocity: Option<Components<Velocity>>,
    /// Force / volume.
    pub body_force: Option<Components<ForceDensity>>,
    /// Force / area.
    pub traction: Option<Components<Pressure>>,
    /// Area of the whole face that the set stands for, for what comes through it (traction, fluxes, exchange) and is spread over its points by
    /// volume. By default that of a curve, surface or side set of the mesh; of a lattice that of the flat face across an axis of which the
    /// set is a layer, however deep; else it must be given.
    pub area: Option<Quantity<Positive<Area>>>,
    /// Viscous force density / velocity.
    pub damping: Option<Quantity<Damping>>,
    /// A force by its name, with its constants.
    pub force: Option<At<Force>>,
    /// Temperature held there, an expression of x, y, z, t; of [heat], as those that follow.
    pub temperature: Option<Quantity<Temperature>>,
    /// Heat into the body through the surface of the set, an expression of x, y, z, t.
    pub heat_flux: Option<Quantity<HeatFlux>>,
    /// Heat made in the set, an expression of x, y, z, t.
    pub heat_source: Option<Quantity<HeatSource>>,
    /// Exchange of heat through the surface of the set with what flows around it.
    pub convection: Option<At<Convection>>,
    /// Radiation through the surface of the set.
    pub radiation: Option<At<Radiation>>,
    /// Concentration held there, an expression of x, y, z, t; of [species], as those that follow.
    pub concentration: Option<Quantity<Concentration>>,
    /// Into the body through the surface of the set, an expression of x, y, z, t.
    pub species_flux: Option<Quantity<SpeciesFlux>>,
    /// Made in the set, an expression of x, y, z, t.
    pub species_source: Option<Quantity<SpeciesSource>>,
    /// Exchange through the surface of the set with what is around it.
    pub species_exchange: Option<At<SpeciesExchange>>,
}
