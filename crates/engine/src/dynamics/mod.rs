//! Motion in time.

pub mod contact_step;
pub mod stable_step;
pub mod verlet;
