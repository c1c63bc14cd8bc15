//! What spreads through the bonds, as written: heat, a species.

use super::TransferName;
use crate::deck::units::Dim;
use crate::deck::value::{At, Number};
use schemars::JsonSchema;
use serde::Deserialize;

/// Heat that the bonds conduct. Materials say how ([material] heat), [[initial]] temperature where it begins, [[condition]] what
/// is done to it.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Heat {
    /// How temperatures go on in time; explicit when left out.
    pub method: Option<At<TransferName>>,
    /// explicit: part of its own stable step, above 0, at most 1; 0.9 when left out. A step of the run is divided into as many
    /// equal parts as that asks for.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub safety: Option<Number>,
    /// Of the other methods: what is left of their equations; 1e-12 when left out.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub tolerance: Option<Number>,
    /// Temperature at which bonds have their reference lengths, and at the start where [[initial]] says none; 0 when left out.
    #[schemars(extend("dimension" = Dim::TEMPERATURE.name()))]
    pub reference: Option<Number>,
    /// Bonds that break go on conducting (those that a pre-crack cut never do); false when left out.
    #[serde(default)]
    pub across_broken: bool,
    /// Deformation makes and takes heat, −T α tr σ̇ per volume (temperatures from absolute zero, capacities at constant strain); false when
    /// left out. Not where points stand still.
    #[serde(default)]
    pub deformation: bool,
}

/// A species that diffuses through the bonds. Materials say how ([material] species), [[initial]] concentration where it begins,
/// [[condition]] what is done to it.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Species {
    /// How concentrations go on in time; explicit when left out.
    pub method: Option<At<TransferName>>,
    /// explicit: part of its own stable step, above 0, at most 1; 0.9 when left out. A step of the run is divided into as many
    /// equal parts as that asks for.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub safety: Option<Number>,
    /// Of the other methods: what is left of their equations; 1e-12 when left out.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub tolerance: Option<Number>,
    /// Concentration at which bonds have their reference lengths, and at the start where [[initial]] says none; 0 when left out.
    #[schemars(extend("dimension" = Dim::CONCENTRATION.name()))]
    pub reference: Option<Number>,
    /// Bonds that break go on conducting (those that a pre-crack cut never do); false when left out.
    #[serde(default)]
    pub across_broken: bool,
}

/// What a material does with heat.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HeatMaterial {
    /// Thermal conductivity k.
    #[schemars(extend("dimension" = Dim::CONDUCTIVITY.name()))]
    pub conductivity: Number,
    /// Heat capacity per mass c.
    #[schemars(extend("dimension" = Dim::HEAT_CAPACITY.name()))]
    pub capacity: Number,
    /// Linear thermal expansion: strain per temperature; 0 when left out.
    #[schemars(extend("dimension" = Dim::EXPANSION.name()))]
    pub expansion: Option<Number>,
}

/// What a material does with a species.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpeciesMaterial {
    /// Diffusivity D.
    #[schemars(extend("dimension" = Dim::DIFFUSIVITY.name()))]
    pub diffusivity: Number,
    /// Swelling: linear strain per concentration; 0 when left out.
    #[schemars(extend("dimension" = Dim::VOLUME.name()))]
    pub swelling: Option<Number>,
}

/// Exchange of heat with something around the body: `h (ambient − T)` per area.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Convection {
    /// Heat transfer coefficient h; an expression of x, y, z, t.
    #[schemars(extend("dimension" = Dim::HEAT_TRANSFER.name()))]
    pub coefficient: Number,
    /// Temperature around; an expression of x, y, z, t.
    #[schemars(extend("dimension" = Dim::TEMPERATURE.name()))]
    pub ambient: Number,
}

/// Radiation: `ε σ (ambient⁴ − T⁴)` per area, temperatures from absolute zero.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Radiation {
    /// ε, from 0 to 1.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub emissivity: Number,
    /// Temperature around; an expression of x, y, z, t.
    #[schemars(extend("dimension" = Dim::TEMPERATURE.name()))]
    pub ambient: Number,
}

/// Exchange of a species with something around the body: `coefficient (ambient − c)` per area.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpeciesExchange {
    /// Mass transfer coefficient; an expression of x, y, z, t.
    #[schemars(extend("dimension" = Dim::VELOCITY.name()))]
    pub coefficient: Number,
    /// Concentration around; an expression of x, y, z, t.
    #[schemars(extend("dimension" = Dim::CONCENTRATION.name()))]
    pub ambient: Number,
}
