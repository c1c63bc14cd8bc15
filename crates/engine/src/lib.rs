//! peridyne: molecular dynamics and peridynamics as one mechanics, points that talk to a family of points.
//!
//! A [`spec::Spec`] says what to run; `run::build` turns it into a simulation; a simulation steps and
//! answers with [`observe::Snapshot`]s. Lengths, masses and times are in whatever consistent unit system the
//! spec uses; the engine itself is free of units.

mod array;
pub mod body;
pub mod columns;
pub mod condition;
pub(crate) mod dynamics;
pub mod error;
pub mod execute;
pub mod expression;
pub mod family;
pub(crate) mod fracture;
pub mod interaction;
pub mod law;
pub mod observe;
pub mod quantity;
pub mod run;
#[cfg(test)]
mod samples;
pub mod space;
pub mod spec;
pub mod state;
pub mod statics;
pub mod transfer;
