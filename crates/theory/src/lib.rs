//! Model to model: what a model of points is as a continuum.

pub mod asked;
pub mod elastic;
pub mod fracture;
pub mod stiffness;
