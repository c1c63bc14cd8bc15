//! Where points come from, and named sets of them.

use super::{FamilyChoice, Horizon, Influence, SurfaceFactors};
use crate::expression::Expression;
use crate::space::lattice::LatticeKind;
use crate::space::region::Region;
use std::sync::Arc;

/// Where the points come from.
#[derive(Debug, Clone)]
pub enum BodySpec {
    /// Sites of a lattice inside a region (boundary included, decided by integers where the region allows it).
    Lattice {
        kind: LatticeKind,
        /// Cell edge (length).
        spacing: f64,
        /// Position of the first basis site (length).
        origin: [f64; 3],
        region: Region,
        /// Random displacement of every site, uniform in ±`amplitude` per axis (length), and its seed;
        /// the body is then a cloud with the lattice's cell volumes.
        perturb: Option<Perturbation>,
    },
    /// Given lattice sites, in quarters of the cell's edges (see [`crate::space::lattice::Lattice::position`]).
    Sites {
        kind: LatticeKind,
        spacing: f64,
        origin: [f64; 3],
        quarters: Vec<[i32; 3]>,
        volume: Option<f64>,
    },
    /// Points with volumes and marks.
    Cloud(Cloud),
    /// Bodies side by side: bonds inside each, contact between them. Their points come one after another.
    Several(Vec<PieceSpec>),
}

impl BodySpec {
    /// Sites of a lattice, one of them at the origin, inside a region.
    pub fn lattice(kind: LatticeKind, spacing: f64, region: Region) -> BodySpec {
        BodySpec::Lattice {
            kind,
            spacing,
            origin: [0.0; 3],
            region,
            perturb: None,
        }
    }
}

/// A body among several.
#[derive(Debug, Clone)]
pub struct PieceSpec {
    /// For messages, and for [`Members::Within`].
    pub name: String,
    /// One lattice or cloud.
    pub body: BodySpec,
    /// `false`: loose points (powder), which have contact only.
    pub bonded: bool,
    /// `None`: those of the spec; a horizon in spacings counts its own.
    pub horizon: Option<Horizon>,
    pub influence: Option<Influence>,
    pub family: Option<FamilyChoice>,
    /// [`BondsSpec::variable_horizon`](super::BondsSpec::variable_horizon) of its points.
    pub variable_horizon: Option<Expression>,
    /// [`BondsSpec::surface`](super::BondsSpec::surface) of this body.
    pub surface: Option<SurfaceFactors>,
}

impl PieceSpec {
    /// With bonds, and all else as the spec has it.
    pub fn new(name: impl Into<String>, body: BodySpec) -> PieceSpec {
        PieceSpec {
            name: name.into(),
            body,
            bonded: true,
            horizon: None,
            influence: None,
            family: None,
            variable_horizon: None,
            surface: None,
        }
    }
}

impl BodySpec {
    /// The bodies that it is made of; none: it is one.
    pub fn pieces(&self) -> &[PieceSpec] {
        match self {
            BodySpec::Several(pieces) => pieces,
            BodySpec::Lattice { .. } | BodySpec::Sites { .. } | BodySpec::Cloud(_) => &[],
        }
    }

    /// Cell edge or typical distance of points, where the spec says it.
    pub fn spacing(&self) -> Option<f64> {
        match self {
            BodySpec::Lattice { spacing, .. } | BodySpec::Sites { spacing, .. } => Some(*spacing),
            BodySpec::Cloud(c) => c.spacing,
            // of all, if it is the same
            BodySpec::Several(pieces) => {
                let first = pieces.first()?.body.spacing()?;
                let same = |p: &PieceSpec| p.body.spacing() == Some(first);
                pieces.iter().all(same).then_some(first)
            }
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Perturbation {
    pub amplitude: f64,
    pub seed: u64,
}

/// A free cloud of points.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Cloud {
    /// `[N]` positions (length).
    pub position: Vec<[f64; 3]>,
    /// `[N]` volumes (length^D times the section).
    pub volume: Vec<f64>,
    /// `[N]` mass densities, or empty: those of the materials.
    pub density: Vec<f64>,
    /// `[N]` marks, or empty: all 0.
    pub mark: Vec<i32>,
    /// `[N]` velocities at the start, or empty: 0. Given after thermal ones, before `initial`.
    pub velocity: Vec<[f64; 3]>,
    /// Names of marks (physical groups, element sets): `(mark, name)`.
    pub names: Vec<(i32, String)>,
    /// Named sets that marks cannot say: points by their place, rising.
    pub sets: Vec<(String, Arc<[u32]>)>,
    /// Faces that sets of a mesh stand for, by name: the area of each of their points (length^(D−1) times the section).
    pub faces: Vec<(String, Arc<[f64]>)>,
    /// Typical distance of nearest neighbours (length): volume scaling and contact use it. `None`: the cube root
    /// (D-th root) of the mean volume over the section.
    pub spacing: Option<f64>,
}

/// A named set of points.
#[derive(Debug, Clone)]
pub struct SetSpec {
    pub name: String,
    pub members: Members,
}

#[derive(Debug, Clone)]
pub enum Members {
    All,
    Region(Region),
    /// Points whose mark is this number.
    Mark(i32),
    /// Points at whose reference position this is not 0 (x, y, z; t = 0).
    Where(Expression),
    /// Points on these sites of their lattice's cell, counted from 0 as [`LatticeKind::basis`] lists them.
    Basis(Vec<usize>),
    /// Points of a cloud by their place in it, rising.
    Points(Arc<[u32]>),
    /// This part of all points (0–1), the nearest whole number of them, drawn by a seed: the same on every machine.
    Random {
        part: f64,
        seed: u64,
    },
    /// Points of none of these sets.
    Outside(Vec<String>),
    /// Those of one of several bodies, by its name.
    Within {
        body: String,
        members: Box<Members>,
    },
}
