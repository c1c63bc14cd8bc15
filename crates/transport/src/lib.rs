//! peridyne-transport: nonlocal conservation laws, `u_t + ∫ F(u(x), u(y)) φ_a(y, x) dy = ε ∫ (u(y) − u(x)) φ_s(y, x) dy`.
//!
//! sandia2010, chapter 2, read with its errata: for `F = ψ((u + v)/2)` the local limit is `u_t + ψ(u)_x = ε u_xx` if the first moment of φ_a and the second one of φ_s are 2
//! ([`kernel`]). `∫u` is kept exactly ([`weights`]); the flux `(u² + uv + v²)/6` keeps `∫u²` besides ([`flux`]). Past the time of a shock the inviscid
//! nonlocal solution oscillates and does not tend to the entropy solution; nothing here adds dissipation of its own.
//!
//! The chapter has scalar laws on a line only; there are no systems in it. In a plane a scalar law carries along a direction field.

// the same bits on every machine: libm, not that of C (clippy.toml)
#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod evolution;
pub mod exact;
pub mod flux;
pub mod formula;
pub mod grid;
pub mod kernel;
pub mod law;
pub mod measure;
pub mod memory;
pub mod noll;
pub mod operator;
mod psi;
pub mod quadrature;
pub mod step;
mod stop;
mod threads;
pub mod wave;
pub mod weights;

pub use evolution::{Evolution, StepSize};
pub use flux::Flux;
pub use formula::Formula;
pub use grid::{Boundary, Grid};
pub use kernel::{Bump, Kernel, Parity, Profile};
pub use law::{Direction, Law};
pub use operator::{Evaluation, Operator};
pub use step::{Method, RunError};
pub use stop::Stop;
