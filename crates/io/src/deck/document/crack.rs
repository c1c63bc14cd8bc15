//! Cracks, and bonds with factors.

use super::{CrackName, StageName};
use crate::deck::quantity::{Length, Positive};
use crate::deck::units::Dim;
use crate::deck::value::{At, Number, Quantity, Vector};
use schemars::JsonSchema;
use serde::Deserialize;

/// A heterogeneous body, or a weak plane.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BondFactor {
    /// Expression of x, y, z; a bond gets the mean of both ends by the rule of `bond_mixing`. With crossing: a number.
    pub factor: Quantity,
    /// Only bonds that cross this shape.
    pub crossing: Option<At<FlatShape>>,
}

/// Toughness that depends on place, time and temperature: one of critical_stretch_factor, energy_factor, temperature, no_failure.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Toughness {
    /// Points whose bonds are meant; all by default. A bond breaks at the lower one of its ends' critical stretches.
    pub set: Option<At<String>>,
    /// Factor of the critical stretch, a number or an expression of x, y, z, t.
    pub critical_stretch_factor: Option<Quantity>,
    /// Factor of the fracture energy, a number or an expression of x, y, z, t: the critical stretch is multiplied with its root.
    pub energy_factor: Option<Quantity>,
    /// Rows [T, factor] of the critical stretch, T rising: lines between them, and the outer factors beyond. With [heat].
    #[schemars(extend("dimension" = Dim::TEMPERATURE.name()))]
    pub temperature: Option<At<Vec<Vec<Number>>>>,
    /// true: bonds of these points never break, whatever the strength of their other ends.
    pub no_failure: Option<At<bool>>,
}

/// Broken bonds that become intact again.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Healing {
    /// Both ends of the bond are of this set; all by default.
    pub set: Option<At<String>>,
    /// Size of the stretch below which a broken bond is intact again, a number or an expression of t; 0: none.
    pub below: Quantity,
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
    pub polygon: Option<At<Vec<Vector<Length>>>>,
    /// 1-D.
    pub point: Option<Quantity<Length>>,
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
    pub polygon: Option<At<Vec<Vector<Length>>>>,
    /// 1-D.
    pub point: Option<Quantity<Length>>,
    /// A surface of triangles, open or closed; 3-D.
    pub stl: Option<At<Stl>>,
    /// excluded (from the families; by default) or broken (at the start, counted as damage).
    pub kind: Option<CrackName>,
    /// Of a deck with [statics] and [run]: dynamics cuts the loaded body when motion begins, and its bonds are then broken; before statics by default.
    pub stage: Option<At<StageName>>,
}

/// A line in the plane from one place to another; in 2-D a crack.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Segment {
    /// One end.
    pub from: Vector<Length>,
    /// The other.
    pub to: Vector<Length>,
}

/// A flat round crack in space.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Disk {
    /// Its middle.
    pub center: Vector<Length>,
    /// Direction across it, of any length.
    pub normal: Vector,
    /// Radius.
    pub radius: Quantity<Positive<Length>>,
}

/// Triangles of a file.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stl {
    /// A binary or text file, relative to the deck.
    pub file: At<String>,
    /// What 1 in the file is; the deck's unit of length by default.
    pub unit: Option<Quantity<Positive<Length>>>,
}
