//! What a potential says of a perfect crystal: energy, density and pressure per atom.

use super::Potential;
use crate::family::stencil::Stencil;
use crate::law::number::Dual;

/// One atom of a perfect crystal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bulk {
    /// Energy per atom (energy).
    pub energy: f64,
    /// Density ρ_h at every atom; 0 for pair potentials.
    pub density: f64,
    /// Below or at this density the embedding energy has no meaning.
    pub least_density: f64,
    /// Pressure (energy / volume), positive where the crystal wants to expand.
    pub pressure: f64,
}

/// Sums over the neighbours that `stencil` has, `volume` per atom (length^D times the section).
pub fn bulk<P: Potential>(p: &P, stencil: &Stencil, spacing: f64, volume: f64) -> Bulk {
    let limit = p.cutoff().powi(2);
    let d = stencil.kind.dimension() as f64;
    let atoms = stencil.offsets.len() as f64;
    // Σ r² dφ/dq and Σ r² df/dq: the virial of a uniform expansion
    let (mut pair, mut density, mut virial, mut spread) = (0.0, 0.0, 0.0, 0.0);
    for o in stencil.offsets.iter().flatten() {
        let q = spacing * spacing * o.squared as f64 / 16.0;
        if q >= limit {
            continue;
        }
        let phi = p.pair(Dual::variable(q));
        pair += phi.value;
        virial += q * phi.slope;
        if P::EMBEDDED {
            let f = p.density(Dual::variable(q));
            density += f.value;
            spread += q * f.slope;
        }
    }
    let (mut energy, density) = (0.5 * pair / atoms, density / atoms);
    let mut per_atom = virial / atoms;
    if P::EMBEDDED {
        let f = p.embedding(Dual::variable(density));
        energy += f.value;
        per_atom += 2.0 * f.slope * spread / atoms;
    }
    Bulk {
        energy,
        density,
        least_density: p.least_density(),
        pressure: -per_atom / (d * volume),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::potential::lennard_jones::LennardJones;
    use crate::space::lattice::LatticeKind;
    use crate::spec::Horizon;

    #[test]
    fn a_chain_at_its_sigma_is_in_equilibrium_and_pressure_is_the_slope_of_energy() {
        let z = |n: i32| (1..=4).map(|j| (j as f64).powi(-n)).sum::<f64>();
        let sigma = (z(6) / (2.0 * z(12))).powf(1.0 / 6.0);
        let potential = LennardJones {
            epsilon: 1.3,
            sigma,
        };
        let stencil = Stencil::new(LatticeKind::Chain, 1.0, Horizon::Ratio(4));
        let at = |a: f64| bulk(&potential, &stencil, a, a);
        assert!(at(1.0).pressure.abs() < 1e-13);
        let h = 1e-6;
        let slope = (at(1.05 + h).energy - at(1.05 - h).energy) / (2.0 * h);
        assert!((at(1.05).pressure + slope).abs() < 1e-8);
    }
}
