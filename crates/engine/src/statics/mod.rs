//! Equilibrium and vibration: linear bodies, solvers, modes.
//!
//! | question | module |
//! |---|---|
//! | which linear body is a law about a state? | [`assemble`] |
//! | what does it do to a displacement, with or without a matrix? | [`operator`] |
//! | is it held? | [`support`] |
//! | is it elastic? | [`Soundness`] |
//! | where is it in equilibrium? | [`direct`] (banded in 1-D), [`cg`]; of any law [`relaxation`], [`fire`] |
//! | what do its masses do where they couple points? | [`Masses`] |
//! | how does it vibrate? | [`modes`] |

pub mod assemble;
pub mod cg;
pub mod direct;
pub mod fire;
mod goal;
mod masses;
pub mod modes;
pub mod operator;
pub mod relaxation;
mod solved;
pub mod support;
mod vectors;

pub use crate::law::soundness::Soundness;
pub use assemble::{linear_body, linear_body_touching};
pub use direct::{Direct, SYMMETRIC};
pub use goal::{Goal, Imbalance};
pub use masses::Masses;
pub use operator::{Assembled, LinearOperator, Shifted, Swept};
pub use solved::Solved;
pub use support::Support;
pub use vectors::{Block, Sums, diagonal, dot, norm};
