//! Corrections of bonds near a surface: plain numbers, made by `peridyne-theory`.

use crate::quantity::Message;

/// Where factors of bonds near a surface come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SurfaceMethod {
    /// Every uniform strain is an equilibrium under its uniform traction.
    Exact,
    /// By the volume of the families.
    Volume,
    /// By the strain energy under uniaxial stretch.
    Energy,
    /// By the stiffness that a point feels when the rest stands still.
    Force,
}

/// Factors of one bond, seen from one of its ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceFactor {
    /// Of the pair force between two whole cells; the same from the other end.
    pub pair: f64,
    /// Of what the bond adds to the dilatation of this end; 1 for laws without.
    pub share: f64,
    /// Of the conductance between two whole cells; the same from the other end.
    pub conductance: f64,
}

impl SurfaceFactor {
    /// Of bonds inside.
    pub const ONE: SurfaceFactor = SurfaceFactor {
        pair: 1.0,
        share: 1.0,
        conductance: 1.0,
    };
}

/// Factors of bonds near the surface of a lattice body, points in order of their ids.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceFactors {
    /// Where they come from: who changes the body makes them anew.
    pub method: SurfaceMethod,
    /// `[N]`: which of `rows` and `part` a point has.
    pub row: Vec<u32>,
    /// `[rows]` bonds of such a point with factors other than 1, and the cells to their partners.
    pub rows: Vec<Vec<([i32; 3], SurfaceFactor)>>,
    /// `[rows]` part of its cell that such a point holds: its volume and mass (0–1].
    pub part: Vec<f64>,
    /// What a user should know about them.
    pub warning: Option<Message>,
}

impl SurfaceFactors {
    /// Does the body end at its outermost points, which hold parts of their cells?
    pub fn ends_at_points(&self) -> bool {
        self.part.iter().any(|p| *p != 1.0)
    }
}
