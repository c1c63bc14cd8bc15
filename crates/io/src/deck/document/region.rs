//! Regions, sets of points, and periods.

use super::AxisName;
use crate::deck::units::Dim;
use crate::deck::value::{At, Number, Or, Vector};
use schemars::JsonSchema;
use serde::Deserialize;

/// A region of space; its boundary belongs to it.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Shape {
    /// All of space.
    Everything,
    /// A box along the axes.
    Block {
        /// Lowest corner; an axis may be -inf.
        #[schemars(extend("dimension" = Dim::LENGTH.name()))]
        low: Vector,
        /// Highest corner; an axis may be inf.
        #[schemars(extend("dimension" = Dim::LENGTH.name()))]
        high: Vector,
    },
    /// A cylinder along an axis.
    Cylinder {
        /// Axis along which it lies.
        axis: AxisName,
        /// A point on its axis; the origin when left out.
        #[schemars(extend("dimension" = Dim::LENGTH.name()))]
        center: Option<Vector>,
        /// Radius.
        #[schemars(extend("dimension" = Dim::LENGTH.name()))]
        radius: Number,
        /// Where it begins along its axis; endless when left out.
        #[schemars(extend("dimension" = Dim::LENGTH.name()))]
        low: Option<Number>,
        /// Where it ends; endless when left out.
        #[schemars(extend("dimension" = Dim::LENGTH.name()))]
        high: Option<Number>,
    },
    /// In 2-D a disk.
    Sphere {
        /// Its middle; the origin when left out.
        #[schemars(extend("dimension" = Dim::LENGTH.name()))]
        center: Option<Vector>,
        /// Radius.
        #[schemars(extend("dimension" = Dim::LENGTH.name()))]
        radius: Number,
    },
    /// Where normal · (x − point) ≤ 0.
    HalfSpace {
        /// A point on its boundary.
        #[schemars(extend("dimension" = Dim::LENGTH.name()))]
        point: Vector,
        /// Points out of it; of any length.
        #[schemars(extend("dimension" = Dim::NUMBER.name()))]
        normal: Vector,
    },
    /// Where any of them is.
    Union(Vec<At<Shape>>),
    /// One region without others.
    Difference {
        /// The region.
        from: Box<At<Shape>>,
        /// What is taken away, a list.
        minus: Vec<At<Shape>>,
    },
    /// Where all of them are.
    Intersection(Vec<At<Shape>>),
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Set {
    /// Only points of this one of several bodies; marks are those of its file.
    pub body: Option<At<String>>,
    /// Points in this region.
    pub region: Option<At<Shape>>,
    /// Number or name of a mark in the file.
    pub mark: Option<At<Mark>>,
    /// Points where this expression of x, y, z is not 0, such as "noise(x/l, y/l, 0) > 0.2".
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub r#where: Option<Number>,
    /// Points of a lattice on these sites of its cell, counted from 1: of bcc the corner and the middle; of fcc the corner and the
    /// middles of the faces x, y and z; of diamond those four, then the same moved by a quarter.
    pub basis: Option<At<Vec<At<usize>>>>,
    /// Points drawn at random.
    pub random: Option<At<Drawn>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Drawn {
    /// How many of all points, from 0 to 1; the nearest whole number of them.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub part: Number,
    /// The same number draws the same points.
    pub seed: u64,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Mark {
    Number(i32),
    Name(String),
}

/// Axes whose period is the region, or the period of each.
pub type Periodic = Or<Vec<At<AxisName>>, Periods>;

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Periods {
    /// Period along x.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub x: Option<Number>,
    /// Period along y.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub y: Option<Number>,
    /// Period along z.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub z: Option<Number>,
}
