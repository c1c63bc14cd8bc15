//! Peridynamic solids.

pub mod bond_based;
pub mod eam_like;
pub mod linear;
