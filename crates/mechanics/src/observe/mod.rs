//! What is seen of a run: columns by name, numbers over time.
//!
//! An [`Observable`] is a function of the [`State`]; [`observables::ALL`] lists them. Columns that laws declare come in by their
//! declaration. [`Snapshot`]s carry columns to writers.

mod least_squares;
mod ledger;
pub mod observables;
mod probe;
mod snapshot;
mod state;
pub mod state_hash;
mod values;

pub use ledger::Ledger;
pub use observables::Observable;
pub use observables::temperature_of;
pub use probe::{ProbeColumn, SpeedColumn};
pub use snapshot::Snapshot;
pub use state::{FamilyBond, Observed, PointForce, State};
pub use state_hash::StateHash;
pub use values::{Column, Values};
