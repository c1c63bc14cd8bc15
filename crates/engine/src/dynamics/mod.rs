//! Motion in time.

pub mod stable_step;
pub mod verlet;
