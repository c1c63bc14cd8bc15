//! `peridyne laws`: what a deck can name.

use crate::failure::{Failure, say};
use peridyne::space::lattice::LatticeKind;

const LAWS: &str = "\
laws (material.law)
  pmb       bond-based, prototype microelastic brittle: f = c ω ν V s
            bulk, young or micromodulus; Poisson ratio 1/4, plane stress 1/3
  lps       linear peridynamic solid, state-based: W = ½ κ θ² + β/(2m) Σ ω ν V e²
            two of young, poisson, bulk, shear; any Poisson ratio below 1/2
  eam_like  the shape of both, with its two stiffnesses given directly: pair, volume
  springs   the bond-based law linearised about the reference (lattices): bulk, young or micromodulus

interatomic potentials (material.law); neighbours are the current ones, or with family = \"stencil\" those of the lattice
  lennard_jones  4ε [(σ/r)¹² − (σ/r)⁶]: epsilon, sigma
  morse          D [e^(−2α(r−r0)) − 2 e^(−α(r−r0))]: depth, alpha, distance
  buckingham     A e^(−r/ρ) − C/r⁶: strength, range, dispersion
                 all three: cutoff, end = truncated | shifted | shifted_force | smooth (smooth_from)
  eam            embedded atoms from a table: file (eam/alloy setfl, or .eam funcfl), element, length_scale, energy_scale
  eam_form       embedded atoms in closed form (Mei, Davenport & Fernando 1991): cohesive, pair, alpha, beta, gamma, lambda, …

influence functions (influence)
  constant 1   inverse 1/ξ   conical 1 − ξ/δ   gaussian exp(−(2ξ/δ)²)   cubic_spline

fracture (material.fracture)
  critical_stretch or energy (per area), alpha: s0 = s00 − α s_min
  release at_once (a bond past s0 pulls no more, as in CabanaPD) or after_force (once more, as in LAMMPS)

lattices (body.lattice), spacing = edge of the cell (triangular: nearest neighbours)";

pub fn print() -> Result<(), Failure> {
    say(LAWS);
    for kind in LatticeKind::ALL {
        say(&format!(
            "  {:<11} {}-D, {} sites per cell, nearest neighbours at {:.4} spacings",
            kind.name(),
            kind.dimension(),
            kind.basis().len(),
            kind.nearest()
        ));
    }
    Ok(())
}
