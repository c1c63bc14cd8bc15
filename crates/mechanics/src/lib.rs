//! What peridyne's models are made of: points and the families that they talk to, laws, interactions, conditions, and the
//! registry that a [`spec::Spec`] names them from.
//!
//! Nothing here runs: [`peridyne`](https://docs.rs/peridyne) builds models of these parts, steps them, and has all of these modules under
//! its own name. Lengths, masses and times are in whatever consistent unit system the spec uses.

// the same bits on every machine: libm, not that of C (clippy.toml)
#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod array;
pub mod body;
pub mod boundary_condition;
pub mod columns;
pub mod constitutive;
pub mod error;
pub mod execute;
pub mod expression;
pub mod family;
pub mod fracture;
pub mod interaction;
pub mod law;
pub mod observe;
pub mod quantity;
#[cfg(test)]
mod samples;
pub mod space;
pub mod spec;
pub mod state;
