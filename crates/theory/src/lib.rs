//! Model to model: what a model of points is as a continuum.

// tensors are indexed by components
#![allow(clippy::needless_range_loop)]

pub mod asked;
pub mod elastic;
pub mod fracture;
pub mod stiffness;
