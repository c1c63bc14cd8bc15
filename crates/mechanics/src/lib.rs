//! What peridyne's models are made of: points and the families that they talk to, laws, interactions, conditions, and the
//! shelf that a [`spec::Spec`] names them from.
//!
//! Nothing here runs: [`peridyne`](https://docs.rs/peridyne) builds models of these parts, steps them, and has all of these modules under
//! its own name. Lengths, masses and times are in whatever consistent unit system the spec uses.

pub mod array;
pub mod body;
pub mod columns;
pub mod condition;
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
