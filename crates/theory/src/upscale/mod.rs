//! Atoms or fine points to coarse points with the same dynamics: a specification in, a specification out.
//!
//! | law | what is kept | what changes |
//! |---|---|---|
//! | springs, pmb, lps, eam-like on a lattice | horizon δ, moduli | m_ratio = N/n (seleson2009 (A.2), seleson2014 (4.10)) |
//! | a potential whose form allows it (Lennard-Jones) on fixed neighbours, without cut-off | σ̄, ε̄, reach | M = N/n (seleson2009 (5.3)) |
//! | any other potential | energy density under every homogeneous strain, number of shells | lengths times n, energies times n^D (seleson2014 (3.3)) |
//!
//! Atoms of several kinds in a cell, and many-body potentials, keep their shells too, on current neighbours: the coarse crystal is the fine one
//! n times as large with masses n^D times as large. Mass density, pressure, energy density and elastic constants, sites relaxed, are the
//! same, and so are long acoustic waves; at the wave vector k/n it has 1/n of all frequencies at k. Optical waves are lost: those of the
//! coarse crystal lie at 1/n of theirs, and stand for nothing.
//!
//! What a constant of a potential is multiplied by follows from its dimension, and stands with the potential
//! ([`Described::scaled`](peridyne::law::potential::Described::scaled), `keeping_reach`).
//!
//! [`upscale_keeping`] asks for one of the two: [`Keep::Shells`] goes with every law.

mod atoms;
pub mod card;
mod crystal;
mod equilibrium_spacing;
mod error;
pub mod kernels;
mod reference;
mod scale;
mod verdict;

pub use atoms::has_basis_or_many_body;
pub use crystal::crystal;
pub use equilibrium_spacing::equilibrium_spacing;
pub use error::UpscaleError;
pub(crate) use reference::reach;
pub use reference::{REACH, lattice};
pub use scale::{Keep, Rule, upscale, upscale_keeping};
