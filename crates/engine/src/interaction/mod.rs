//! A law bound to a family: forces, energies and bonds of a body. Compiled once per law and family, called once
//! per sweep.

pub(crate) mod atoms;
pub(crate) mod bond;
pub(crate) mod bonds;
pub mod cohesion;
pub mod contact;
mod contact_forces;
mod contract;
pub mod coulomb;
pub(crate) mod criterion;
mod evaluation;
pub mod friction;
pub(crate) mod history;
pub(crate) mod interface;
pub(crate) mod linear;
pub mod list;
pub(crate) mod material;
pub(crate) mod micromoduli;
pub mod nearness;
pub mod pairs;
mod point_constants;
mod point_energies;
pub mod pull;
pub mod repulsion;
pub(crate) mod scale;
pub(crate) mod several;
mod spin;
pub mod stencil;
mod sweep;
pub mod tangent;
pub mod weight;

pub use contact_forces::ContactForces;
pub use contract::Interaction;
pub use criterion::Wearing;
pub use evaluation::Evaluation;
pub use point_constants::PointConstants;
use point_constants::laws_fields;
use point_energies::EnergyFields;
pub use point_energies::{PointEnergies, PointEnergiesMut};
pub use repulsion::{PairTable, Repulsion, in_series};
pub(crate) use sweep::Motion;
pub use sweep::{Fault, Released, Sweep, Tally};
pub use tangent::{BondTangent, Channel};

/// Critical stretch of one material: `s0 = s00 − α s_min`; infinite `s00` never breaks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Toughness {
    pub s00: f64,
    pub alpha: f64,
}

/// Is a bond of the reference family whole?
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BondStatus {
    Whole,
    Broken,
}

impl BondStatus {
    fn of(whole: bool) -> Self {
        match whole {
            true => BondStatus::Whole,
            false => BondStatus::Broken,
        }
    }
}

/// Axes of the components of a virial.
const VIRIAL: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// Add `factor · y ⊗ pull` to a virial.
pub(crate) fn add_virial<const D: usize>(
    sum: &mut [f64; 6],
    pull: &[f64; D],
    y: &[f64; D],
    factor: f64,
) {
    for (sum, (m, n)) in sum.iter_mut().zip(VIRIAL) {
        if n < D {
            *sum += factor * y[m] * pull[n];
        }
    }
}

/// `gradient · x`
fn along<const D: usize>(gradient: &[[f64; D]; D], x: &[f64]) -> [f64; D] {
    gradient.map(|row| row.iter().zip(x).map(|(g, x)| g * x).sum())
}

/// A directed bond, and what it does to the point that it belongs to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BondForce<const D: usize> {
    /// Slots of points, images resolved.
    pub i: usize,
    pub j: usize,
    /// From i to j now; of linear laws in the reference (length).
    pub y: [f64; D],
    /// What i gets from the bond: that of its own force state and that of its partner's (force / volume).
    pub force: [f64; D],
    /// That of its own force state: `∂W_i/∂y`, with the memory of the law held, so that V_i times it is `∂(W_i V_i)/∂x_j`. `None`: the
    /// law has no potential, or terms of more than two points.
    pub own: Option<[f64; D]>,
}
