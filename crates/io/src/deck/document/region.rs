//! Regions, sets of points, and periods.

use super::AxisName;
use crate::deck::value::{At, Number, Or, Vector};
use schemars::JsonSchema;
use serde::Deserialize;

/// A region of space; its boundary belongs to it.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Shape {
    Everything,
    Block {
        low: Vector,
        high: Vector,
    },
    Cylinder {
        axis: AxisName,
        center: Option<Vector>,
        radius: Number,
        low: Option<Number>,
        high: Option<Number>,
    },
    /// In 2-D a disk.
    Sphere {
        center: Option<Vector>,
        radius: Number,
    },
    /// Where normal · (x − point) ≤ 0.
    HalfSpace {
        point: Vector,
        normal: Vector,
    },
    Union(Vec<At<Shape>>),
    Difference {
        from: Box<At<Shape>>,
        minus: Vec<At<Shape>>,
    },
    Intersection(Vec<At<Shape>>),
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Set {
    /// Only points of this one of several bodies; marks are those of its file.
    pub body: Option<At<String>>,
    pub region: Option<At<Shape>>,
    /// Number or name of a mark in the file.
    pub mark: Option<At<Mark>>,
    /// Points where this expression of x, y, z is not 0, such as "noise(x/l, y/l, 0) > 0.2".
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
    pub part: Number,
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
    pub x: Option<Number>,
    pub y: Option<Number>,
    pub z: Option<Number>,
}
