//! What spreads through the bonds, as written: heat, a species.

use super::DiffusionName;
use crate::deck::quantity::{
    Concentration, Conductivity, Diffusivity, Expansion, Fraction, HeatCapacity, HeatTransfer,
    NotNegative, Positive, Temperature, Velocity, Volume,
};
use crate::deck::value::{At, Quantity};
use schemars::JsonSchema;
use serde::Deserialize;

/// Heat that the bonds conduct. Materials say how ([material] heat), [[initial]] temperature where it begins, [[boundary_condition]] what
/// is done to it.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Heat {
    /// How temperatures go on in time; explicit by default.
    pub method: Option<At<DiffusionName>>,
    /// explicit: part of its own stable step, above 0, at most 1; 0.9 by default. A step of the run is divided into as many
    /// equal parts as that asks for.
    pub safety: Option<Quantity<Positive>>,
    /// Of the other methods: what is left of their equations; 1e-12 by default.
    pub tolerance: Option<Quantity<Positive>>,
    /// Temperature at which bonds have their reference lengths, and at the start where [[initial]] says none; 0 by default.
    pub reference: Option<Quantity<Temperature>>,
    /// Bonds that break go on conducting (those that a pre-crack cut never do); false by default.
    #[serde(default)]
    pub across_broken: bool,
    /// Deformation makes and takes heat, −T α tr σ̇ per volume (temperatures from absolute zero, capacities at constant strain); false by default. Not where points stand still.
    #[serde(default)]
    pub deformation: bool,
}

/// A species that diffuses through the bonds. Materials say how ([material] species), [[initial]] concentration where it begins,
/// [[boundary_condition]] what is done to it.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Species {
    /// How concentrations go on in time; explicit by default.
    pub method: Option<At<DiffusionName>>,
    /// explicit: part of its own stable step, above 0, at most 1; 0.9 by default. A step of the run is divided into as many
    /// equal parts as that asks for.
    pub safety: Option<Quantity<Positive>>,
    /// Of the other methods: what is left of their equations; 1e-12 by default.
    pub tolerance: Option<Quantity<Positive>>,
    /// Concentration at which bonds have their reference lengths, and at the start where [[initial]] says none; 0 by default.
    pub reference: Option<Quantity<Concentration>>,
    /// Bonds that break go on conducting (those that a pre-crack cut never do); false by default.
    #[serde(default)]
    pub across_broken: bool,
}

/// What a material does with heat.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HeatMaterial {
    /// Thermal conductivity k.
    pub conductivity: Quantity<Positive<Conductivity>>,
    /// Heat capacity per mass c.
    pub capacity: Quantity<Positive<HeatCapacity>>,
    /// Linear thermal expansion: strain per temperature; 0 by default.
    pub expansion: Option<Quantity<Expansion>>,
}

/// What a material does with a species.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpeciesMaterial {
    /// Diffusivity D.
    pub diffusivity: Quantity<Positive<Diffusivity>>,
    /// Swelling: linear strain per concentration; 0 by default.
    pub swelling: Option<Quantity<Volume>>,
}

/// Exchange of heat with something around the body: `h (ambient − T)` per area.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Convection {
    /// Heat transfer coefficient h; an expression of x, y, z, t.
    pub coefficient: Quantity<NotNegative<HeatTransfer>>,
    /// Temperature around; an expression of x, y, z, t.
    pub ambient: Quantity<Temperature>,
}

/// Radiation: `ε σ (ambient⁴ − T⁴)` per area, temperatures from absolute zero.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Radiation {
    /// ε, from 0 to 1.
    pub emissivity: Quantity<Fraction>,
    /// Temperature around; an expression of x, y, z, t.
    pub ambient: Quantity<Temperature>,
}

/// Exchange of a species with something around the body: `coefficient (ambient − c)` per area.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpeciesExchange {
    /// Mass transfer coefficient; an expression of x, y, z, t.
    pub coefficient: Quantity<NotNegative<Velocity>>,
    /// Concentration around; an expression of x, y, z, t.
    pub ambient: Quantity<Concentration>,
}
