//! A periodic set of points about its reference state: the linear model that dispersion, stability and elastic
//! constants read, whatever the law.
//!
//! Energy per cell to second order in displacements, η = u_to − u_from, n the bond's direction:
//! `½ · ½ Σ_bonds [stiffness (n·η)² + tension (|η|² − (n·η)²)] + ½ Σ_s F″_s (Σ_bonds of s share n·η)²`,
//! the first sum over directed bonds. For an embedded-atom potential `V = φ + (F′_s + F′_t) f`, share = f′. Fans have couplings of their
//! bonds besides ([`Coupling`]).

pub mod arrangement;
pub mod atoms;
pub mod cells;
pub mod coupling;
mod error;
pub mod kinds;
mod lattice;
pub mod many_body;
pub mod mixture;
pub mod potential;
pub mod solid;

pub use atoms::Atom;
pub use coupling::{Coupling, Span};
pub use error::CrystalError;
#[cfg(test)]
pub(crate) use lattice::dimer;
pub use lattice::{Bond, Crystal};
pub use potential::{Reach, Reference};
pub use solid::LatticeSolid;
