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

/// Factors of bonds near the surface of a lattice body, points in order of their ids.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceFactors {
    /// Where they come from: who changes the body makes them anew.
    pub method: SurfaceMethod,
    /// `[N]`: which of `rows` and `part` a point has.
    pub row: Vec<u32>,
    /// `[rows]` bonds of such a point with factors other than 1: cells to the partner, the factor of the pair force between two
    /// whole cells, which must be the same from the other end, and that of what the bond adds to the dilatation of this end (1
    /// for laws without).
    pub rows: Vec<Vec<([i32; 3], [f64; 2])>>,
    /// `[rows]` part of its cell that such a point holds: its volume and mass (0–1].
    pub part: Vec<f64>,
    /// What a user should know about them.
    pub warning: Option<Message>,
}
