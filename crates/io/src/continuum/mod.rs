//! From files of atoms and words of a user to what [`peridyne_fields`] takes: units, masses, frames, potentials.

pub mod elements;
pub mod frame;
pub mod kinds;
pub mod live;
pub mod plan;
pub mod potential;
pub mod run;
pub mod units;

pub use frame::{Masses, frame, of_unit_mass};
pub use kinds::Kind;
pub use potential::{Model, model, of_deck};
pub use units::Units;
