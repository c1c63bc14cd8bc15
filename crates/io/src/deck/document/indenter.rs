//! Rigid bodies that push points.

use super::{Cohesion, Friction, StageName};
use crate::deck::units::Dim;
use crate::deck::value::{At, Number, Or, Vector, Written};
use schemars::JsonSchema;
use serde::Deserialize;

/// A rigid body; moved as its centre and rotation (expressions of t) say, or free when it has a mass or a density.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Indenter {
    /// Of a deck with [statics] and [run]: the one of both in which it is there, both when left out (without t, which begins at 0 in each).
    pub stage: Option<At<StageName>>,
    /// For probes and messages.
    pub name: Option<At<String>>,
    /// Force density / length²: a point at a depth g below the surface is pushed out by stiffness g². When left out ten times the bulk modulus
    /// of the stiffest material (in 1-D Young's) over the cube of the smallest spacing: at a depth of a tenth of a spacing it is as stiff as the material.
    #[schemars(extend("dimension" = Dim::INDENTER_STIFFNESS.name()))]
    pub stiffness: Option<Number>,
    /// Radius of a sphere; instead of a shape.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub radius: Option<Number>,
    /// What it is; instead of a radius.
    pub shape: Option<At<Rigid>>,
    /// Its centre: of a driven one expressions of t, of a free one where it begins. Of a surface of triangles where its centroid is; as in the file when left out.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub center: Option<Vector>,
    /// How it is turned about its centre: of a driven one always, of a free one at the start.
    pub rotation: Option<At<Rotation>>,
    /// Of a free one at the start; of a driven one always. 0 when left out.
    #[schemars(extend("dimension" = Dim::VELOCITY.name()))]
    pub velocity: Option<Vector>,
    /// With a mass it moves by the forces on it; without mass and density it is driven.
    #[schemars(extend("dimension" = Dim::MASS.name()))]
    pub mass: Option<Number>,
    /// Instead of a mass: that of its shape.
    #[schemars(extend("dimension" = Dim::DENSITY.name()))]
    pub density: Option<Number>,
    /// Moments of inertia about its centre along the axes of its shape: xx, yy, zz, or these and xy, xz, yz; in 2-D one, about z. Those of its
    /// shape with the same density everywhere when left out. Of a free one.
    #[schemars(extend("dimension" = (Dim::MASS * Dim::AREA).to_string()))]
    pub inertia: Option<At<Vec<Number>>>,
    /// Angular velocity at the start (radians per time); in 2-D one number, about z. Of a free one.
    #[schemars(extend("dimension" = Dim::FREQUENCY.name()))]
    pub spin: Option<Vector>,
    /// On its centre, expressions of t. Of a free one.
    #[schemars(extend("dimension" = Dim::FORCE.name()))]
    pub force: Option<Vector>,
    /// About its centre, expressions of t; in 2-D one number, about z. Of a free one.
    #[schemars(extend("dimension" = Dim::ENERGY.name()))]
    pub torque: Option<Vector>,
    /// Adds mass times this to the force; of a free one.
    #[schemars(extend("dimension" = Dim::ACCELERATION.name()))]
    pub gravity: Option<Vector>,
    /// Coulomb friction on its surface, a number or an expression of t, or a table as for contact; 0 when left out.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub friction: Option<At<Or<Written, Friction>>>,
    /// It pulls what is near; nothing when left out.
    pub cohesion: Option<At<Cohesion>>,
}

/// A rigid shape; its centre is its own origin.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Rigid {
    /// In 2-D a disk.
    Sphere {
        /// Radius.
        #[schemars(extend("dimension" = Dim::LENGTH.name()))]
        radius: Number,
    },
    /// Along the axes before it is turned; in 2-D a rectangle.
    Box {
        /// Lengths of its edges.
        #[schemars(extend("dimension" = Dim::LENGTH.name()))]
        size: Vector,
    },
    /// With flat ends; 3-D.
    Cylinder {
        /// Radius.
        #[schemars(extend("dimension" = Dim::LENGTH.name()))]
        radius: Number,
        /// From end to end.
        #[schemars(extend("dimension" = Dim::LENGTH.name()))]
        length: Number,
        /// Direction along it, of any length; z when left out.
        #[schemars(extend("dimension" = Dim::NUMBER.name()))]
        axis: Option<Vector>,
    },
    /// All that is behind a plane through its centre.
    Plane {
        /// Out of it, towards the points; of any length.
        #[schemars(extend("dimension" = Dim::NUMBER.name()))]
        normal: Vector,
    },
    /// Inside a closed surface of triangles; 3-D.
    Stl {
        /// A binary or text file, relative to the deck.
        file: At<String>,
        /// What 1 in the file is; the deck's unit of length when left out.
        #[schemars(extend("dimension" = Dim::LENGTH.name()))]
        unit: Option<Number>,
    },
}

/// A turn about an axis through the centre.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rotation {
    /// Of any length; z when left out.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub axis: Option<Vector>,
    /// Radians, a number or an expression of t; counter-clockwise when the axis points at you.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub angle: Number,
}
