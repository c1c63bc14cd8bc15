//! Cracks, and bonds with factors.

use super::{CrackName, StageName};
use crate::deck::units::Dim;
use crate::deck::value::{At, Number, Vector};
use schemars::JsonSchema;
use serde::Deserialize;

/// A heterogeneous body, or a weak plane.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BondFactor {
    /// Expression of x, y, z; a bond gets the mean of both ends by the rule of `interface`. With crossing: a number.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub value: Number,
    /// Only bonds that cross this shape.
    pub crossing: Option<At<FlatShape>>,
}

/// Toughness that depends on place, time and temperature: one of stretch_factor, energy_factor, temperature, no_failure.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Toughness {
    /// Points whose bonds are meant; all when left out. A bond breaks at the lower one of its ends' critical stretches.
    pub set: Option<At<String>>,
    /// Factor of the critical stretch, a number or an expression of x, y, z, t.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub stretch_factor: Option<Number>,
    /// Factor of the fracture energy, a number or an expression of x, y, z, t: the critical stretch is multiplied with its root.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub energy_factor: Option<Number>,
    /// Rows [T, factor] of the critical stretch, T rising: lines between them, and the outer factors beyond. With [heat].
    #[schemars(extend("dimension" = Dim::TEMPERATURE.name()))]
    pub temperature: Option<At<Vec<Vec<Number>>>>,
    /// true: bonds of these points never break, whatever their other ends bear.
    pub no_failure: Option<At<bool>>,
}

/// Broken bonds that become whole again.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Healing {
    /// Both ends of the bond are of this set; all when left out.
    pub set: Option<At<String>>,
    /// Size of the stretch below which a broken bond is whole again, a number or an expression of t; 0: none.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub below: Number,
}

/// One of segment, disk, polygon, point.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FlatShape {
    /// 2-D, or endless along z.
    pub segment: Option<Segment>,
    /// 3-D.
    pub disk: Option<Disk>,
    /// Three or more corners.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub polygon: Option<At<Vec<Vector>>>,
    /// 1-D.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub point: Option<Number>,
}

/// One of segment, disk, polygon, point, stl.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Precrack {
    /// 2-D, or endless along z.
    pub segment: Option<Segment>,
    /// 3-D.
    pub disk: Option<Disk>,
    /// Three or more corners.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub polygon: Option<At<Vec<Vector>>>,
    /// 1-D.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub point: Option<Number>,
    /// A surface of triangles, open or closed; 3-D.
    pub stl: Option<At<Stl>>,
    /// absent (never there; when left out) or broken (counted as damage).
    pub kind: Option<CrackName>,
    /// Of a deck with [statics] and [run]: motion cuts the loaded body when motion begins, and its bonds are then broken; before statics when
    /// left out.
    pub stage: Option<At<StageName>>,
}

#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Segment {
    /// One end.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub from: Vector,
    /// The other.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub to: Vector,
}

#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Disk {
    /// Its middle.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub center: Vector,
    /// Direction across it, of any length.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub normal: Vector,
    /// Radius.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub radius: Number,
}

/// Triangles of a file.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stl {
    /// A binary or text file, relative to the deck.
    pub file: At<String>,
    /// What 1 in the file is; the deck's unit of length when left out.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub unit: Option<Number>,
}
