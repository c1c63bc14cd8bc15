//! Peridynamic solids.

pub mod bond_based;
pub mod dual_horizon;
pub mod eam_like;
pub mod linear;
