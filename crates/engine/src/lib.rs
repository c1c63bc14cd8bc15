//! peridyne: molecular dynamics and peridynamics as one mechanics, points that talk to a family of points.
//!
//! A [`spec::Spec`] says what to run; `run::build` turns it into a simulation; a simulation steps and
//! answers with [`observe::Snapshot`]s. Lengths, masses and times are in whatever consistent unit system the
//! spec uses; the engine itself is free of units. What models are made of is a crate of its own, `peridyne-mechanics`, whose modules are these.

// the same bits on every machine: libm, not that of C (clippy.toml)
#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub use peridyne_mechanics::{
    array, body, boundary_condition, columns, error, execute, expression, family, fracture,
    interaction, law, message, observe, quantity, space, spec, state,
};

pub(crate) use peridyne_mechanics::constitutive;

pub mod diffusion;
pub(crate) mod dynamics;
pub mod run;
pub mod statics;
