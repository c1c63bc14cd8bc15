//! Model to model: what a model of points is as a continuum.

// tensors are indexed by components
#![allow(clippy::needless_range_loop)]

pub mod asked;
pub mod convergence;
pub mod crystal;
pub mod dispersion;
pub mod elastic;
pub mod exact;
pub mod fracture;
pub mod gradient;
pub mod jet;
pub mod lattice_elastic;
pub mod moments;
pub mod stability;
pub mod stiffness;
pub mod upscaling;
