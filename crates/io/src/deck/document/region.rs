//! Regions, sets of points, and periods.

use super::AxisName;
use crate::deck::quantity::{Fraction, Length, Positive};
use crate::deck::value::{At, Or, Quantity, Vector};
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
        low: Vector<Length>,
        /// Highest corner; an axis may be inf.
        high: Vector<Length>,
    },
    /// A cylinder along an axis.
    Cylinder {
        /// Axis along which it lies.
        axis: AxisName,
        /// A point on its axis; the origin by default.
        center: Option<Vector<Length>>,
        /// Radius.
        radius: Quantity<Positive<Length>>,
        /// Where it begins along its axis; endless by default.
        low: Option<Quantity<Length>>,
        /// Where it ends; endless by default.
        high: Option<Quantity<Length>>,
    },
    /// In 2-D a disk.
    Sphere {
        /// Its middle; the origin by default.
        center: Option<Vector<Length>>,
        /// Radius.
        radius: Quantity<Positive<Length>>,
    },
    /// Where normal · (x − point) ≤ 0.
    HalfSpace {
        /// A point on its boundary.
        point: Vector<Length>,
        /// Points out of it; of any length.
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

/// Points with a name, for materials, boundary conditions, probes: those that meet all that is given here.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Set {
    /// Only points of this one of several bodies; blocks are those of its file.
    pub body: Option<At<String>>,
    /// Points in this region.
    pub region: Option<At<Shape>>,
    /// Number or name of a block in the file.
    pub block: Option<At<Block>>,
    /// Points where this expression of x, y, z is not 0, such as "noise(x/l, y/l, 0) > 0.2".
    pub r#where: Option<Quantity>,
    /// Points of a lattice on these sites of its cell, counted from 1: of bcc the corner and the middle; of fcc the corner and the
    /// middles of the faces x, y and z; of diamond those four, then the same moved by a quarter.
    pub basis: Option<At<Vec<At<usize>>>>,
    /// Points drawn at random.
    pub random: Option<At<Drawn>>,
}

/// A part of the points, drawn at random; the same for any number of threads and ranks.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Drawn {
    /// How many of all points, from 0 to 1; the nearest whole number of them.
    pub part: Quantity<Fraction>,
    /// The same number draws the same points.
    pub seed: u64,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Block {
    Number(i32),
    Name(String),
}

/// Axes whose period is the region, or the period of each.
pub type Periodic = Or<Vec<At<AxisName>>, Periods>;

/// Boundary conditions of a periodic box: the period along each axis that has one.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Periods {
    /// Period along x.
    pub x: Option<Quantity<Length>>,
    /// Period along y.
    pub y: Option<Quantity<Length>>,
    /// Period along z.
    pub z: Option<Quantity<Length>>,
}
