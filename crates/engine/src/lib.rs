//! peridyne: molecular dynamics and peridynamics as one mechanics, points that talk to a family of points.
//!
//! A [`spec::Spec`] says what to run; `run::build` turns it into a simulation; a simulation steps and
//! answers with [`observe::Snapshot`]s. Lengths, masses and times are in whatever consistent unit system the
//! spec uses; the engine itself is free of units.

// loops over axes index several arrays at once
#![allow(clippy::needless_range_loop, clippy::manual_memcpy)]
// `!(x < limit)` refuses what is not a number, too
#![allow(clippy::neg_cmp_op_on_partial_ord)]

pub mod body;
pub mod condition;
pub mod dynamics;
pub mod error;
pub mod execute;
pub mod expression;
pub mod family;
pub mod fracture;
pub mod interaction;
pub mod law;
pub mod observe;
pub mod run;
#[cfg(test)]
mod samples;
pub mod space;
pub mod spec;
pub mod statics;
