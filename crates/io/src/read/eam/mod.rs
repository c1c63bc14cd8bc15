//! Tables of embedded-atom potentials: `eam/alloy` files (setfl), `eam/fs` files and `eam` files (funcfl), as LAMMPS reads them.
//!
//! Format: LAMMPS documentation, `pair_style eam`. Tables start at ρ = 0 and r = 0. Energies in eV, lengths in Å.

mod file;
mod funcfl;
mod setfl;
mod symbol;
#[cfg(test)]
mod tests;
mod values;

use super::whole::titled;
pub use file::{EamElement, EamFile};
pub use funcfl::{funcfl, parse_funcfl};
pub use setfl::{fs, parse_fs, parse_setfl, setfl};
