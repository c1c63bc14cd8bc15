//! Equilibrium and vibration: linear bodies, solvers, modes.

pub mod linear_body;

pub use linear_body::{LinearBody, Soundness};
