//! Bonds between the points of a body, whatever their law: groups of eight points, whose bonds are walked together.

pub mod abroad;
pub mod breaking;
pub mod cloud;
mod columns;
pub mod family;
mod fatigue;
pub mod fused;
mod heal;
pub mod lattice;
pub mod law;
pub mod points;
mod records;
pub mod repulsion;
pub mod state;
pub mod store;
pub mod view;
mod walks;
mod warmth;

pub use cloud::CloudFamily;
pub use columns::AnyBonds;
pub use lattice::LatticeFamily;
pub use state::BondState;
