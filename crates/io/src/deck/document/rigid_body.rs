//! Rigid bodies that push points.

use super::{Cohesion, Friction, StageName};
use crate::deck::quantity::{
    Acceleration, Density, Energy, Force, Frequency, Inertia, Length, Mass, Positive,
    RigidBodyStiffness, Velocity,
};
use crate::deck::value::{At, Measured, Or, Quantity, Vector};
use schemars::JsonSchema;
use serde::Deserialize;

/// A rigid body; moved as its centre and rotation (expressions of t) say, or free when it has a mass or a density.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RigidBody {
    /// Of a deck with [statics] and [run]: the one of both in which it is there, both by default (without t, which begins at 0 in each).
    pub stage: Option<At<StageName>>,
    /// For probes and messages.
    pub name: Option<At<String>>,
    /// Force density / length²: a point at a depth g below the surface is pushed out by stiffness g². By default ten times the bulk modulus
    /// of the stiffest material (in 1-D Young's) over the cube of the smallest spacing: at a depth of a tenth of a spacing it is as stiff as the material.
    pub stiffness: Option<Quantity<Positive<RigidBodyStiffness>>>,
    /// Radius of a sphere; instead of a shape.
    pub radius: Option<Quantity<Positive<Length>>>,
    /// What it is; instead of a radius.
    pub shape: Option<At<Rigid>>,
    /// Its centre: of a prescribed one expressions of t, of a free one where it begins. Of a surface of triangles where its centroid is; as in the file by default.
    pub center: Option<Vector<Length>>,
    /// Its rotation about its centre: of a prescribed one always, of a free one at the start.
    pub rotation: Option<At<Rotation>>,
    /// Of a free one at the start; of a prescribed one always. 0 by default.
    pub velocity: Option<Vector<Velocity>>,
    /// With a mass it moves by the forces on it; without mass and density it is prescribed.
    pub mass: Option<Quantity<Positive<Mass>>>,
    /// Instead of a mass: that of its shape.
    pub density: Option<Quantity<Positive<Density>>>,
    /// Moments of inertia about its centre along the axes of its shape: xx, yy, zz, or these and xy, xz, yz; in 2-D one, about z. Those of its
    /// shape with the same density everywhere by default. Of a free one.
    pub inertia: Option<At<Vec<Quantity<Inertia>>>>,
    /// Angular velocity at the start (radians per time); in 2-D one number, about z. Of a free one.
    pub angular_velocity: Option<Vector<Frequency>>,
    /// On its centre, expressions of t. Of a free one.
    pub force: Option<Vector<Force>>,
    /// About its centre, expressions of t; in 2-D one number, about z. Of a free one.
    pub torque: Option<Vector<Energy>>,
    /// Adds mass times this to the force; of a free one.
    pub gravity: Option<Vector<Acceleration>>,
    /// Coulomb friction on its surface, a number or an expression of t, or a table as for contact; 0 by default.
    pub friction: Option<At<Or<Measured<Positive>, Friction>>>,
    /// It pulls what is near; nothing by default.
    pub cohesion: Option<At<Cohesion>>,
}

/// A rigid shape; its centre is its own origin.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Rigid {
    /// In 2-D a disk.
    Sphere {
        /// Radius.
        radius: Quantity<Positive<Length>>,
    },
    /// Along the axes before its rotation; in 2-D a rectangle.
    Box {
        /// Lengths of its edges.
        size: Vector<Positive<Length>>,
    },
    /// With flat ends; 3-D.
    Cylinder {
        /// Radius.
        radius: Quantity<Positive<Length>>,
        /// From end to end.
        length: Quantity<Positive<Length>>,
        /// Direction along it, of any length; z by default.
        axis: Option<Vector>,
    },
    /// All that is behind a plane through its centre.
    Plane {
        /// Out of it, towards the points; of any length.
        normal: Vector,
    },
    /// Inside a closed surface of triangles; 3-D.
    Stl {
        /// A binary or text file, relative to the deck.
        file: At<String>,
        /// What 1 in the file is; the deck's unit of length by default.
        unit: Option<Quantity<Positive<Length>>>,
    },
}

/// A rotation about an axis through the centre.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rotation {
    /// Of any length; z by default.
    pub axis: Option<Vector>,
    /// Radians, a number or an expression of t; counter-clockwise when the axis points at you.
    pub angle: Quantity,
}
