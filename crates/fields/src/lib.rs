//! Continuum fields from particles (lehoucq2010, chapter 4 of the Sandia report of 2010, with its misprints mended).
//!
//! A localization function φ makes densities of particles: `ρ(x) = Σ_j m_j φ(x − x_j)`, and so momentum and energy. Their balance
//! laws hold exactly, at every point and time, for any potential, if stress and heat flux are what follows from them. Conventions, throughout:
//!
//! - `x_jk = x_j − x_k`, `ξ_jk = |x_jk|²/2`, `G_jk = ∂U/∂ξ_jk`; the force on j from k is `f_jk = −x_jk G_jk`.
//! - Bond function `β_jk(x) = ∫₀¹ φ(x − λ x_j − (1 − λ) x_k) dλ`, so that `φ_j − φ_k = −∇·(x_jk β_jk)` (4.0.81), (4.0.82).
//! - Tensors: the first index is that of the divergence. Stress is positive in tension.
//! - `v = π/ρ` where there is mass, `u_j = v_j − v`; a velocity is not defined where ρ = 0, and nothing that needs it.
//! - `σ_K = −Σ m u⊗u φ` (4.0.78); `σ_U = −Σ x_jk ⊗ f_jk β_jk`, every pair and periodic image once (4.0.84).
//! - `e = Σ (½ m v² + U^(j)) φ_j` (4.0.63), where the parts `U^(j)` of the atoms are a choice: [`Partition`].
//! - `q_K = Σ u (½ m u² + U^(j)) φ` (4.0.104), `q_U = Σ_jk (u_k · ∂U^(j)/∂x_k) x_jk β_jk` (4.0.114), `q_C^μ = z^{μν} v^ν` (4.0.115)
//!   with the churning tensor `z = σ_U + Σ_jk x_jk ⊗ ∂U^(j)/∂x_k β_jk` (4.0.116). The whole heat flux is the sum of the three.
//! - Balance: `∂ρ/∂t + ∇·π = 0`; `∂π/∂t + ∇·(ρ v⊗v − σ) = 0`; `∂e/∂t + ∇·(e v − σ·v + q) = 0`.
//!
//! Churning is a theorem, not a conjecture. With `F_k = −∂U/∂x_k`, `Σ_jk (x_j − x_k) ⊗ ∂U^(j)/∂x_k = Σ_k x_k ⊗ F_k`, for
//! every `U^(j)` is invariant under translations (`Σ_k ∂U^(j)/∂x_k = 0`, which removes x_j) and the parts add up to U. But
//! `Σ_k x_k ⊗ F_k = Σ_pairs x_jk ⊗ f_jk = −∫σ_U`. So `∫z = 0`, whatever φ, the partition, and the number of particles in a term.
//! z is linear in β, so what is left of it depends on differences of β alone: at a fixed point these fall as `s⁻²` relative to β
//! with the width s of φ, and so does z relative to stress. At the scale of atoms it is not small.
//!
//! [`sums::evaluate`] does the work, [`pairs::evaluate`] for peridynamic bodies; [`residuals`] measures how well the balance laws hold.

// the same bits on every machine: libm, not that of C (clippy.toml)
#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod accumulate;
pub mod average;
pub mod bond;
mod bonds;
mod collect;
pub mod effort;
mod error;
pub mod fields;
pub mod frame;
mod gauss;
pub mod kernel;
pub mod method;
pub mod molecules;
pub mod neighbours;
pub mod pairs;
pub mod partition;
mod patch;
mod polynomial;
mod quantity;
pub mod residuals;
mod scalars;
mod segment;
mod segments;
pub mod specimen;
mod spline;
pub mod sums;
pub mod targets;
mod wide;
mod workspace;

pub use error::FieldsError;
pub use fields::{Fields, Quantity};
pub use frame::{Cell, Frame};
pub use kernel::{Kernel, Shape};
pub use method::{Method, Progress};
pub use partition::{PairForce, Partition};
pub use sums::evaluate;
pub use targets::Targets;
