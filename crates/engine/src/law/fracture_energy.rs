//! The energy that a crack takes: `G0 / s0²` (energy / area) where every bond across a plane breaks at the stretch s0.

use super::micromodulus::Moments;
use crate::spec::{Moduli, Plane};
use std::f64::consts::{FRAC_2_PI, PI};

/// Of bonds with the micromodulus c: `¼ c ⟨|n_z|⟩ M2`.
///
/// A unit area is crossed by bonds of energy `½ Σ |ξ_n| w dV` (each once), `w = ½ c ω s0² r0`, and
/// `⟨|n_z|⟩ = 1, 2/π, ½` in 1, 2, 3 dimensions. Silling & Askari 2005, Ha & Bobaru 2010 are the full ball and disk.
pub fn bond_based(dimension: usize, c: f64, moments: Moments) -> f64 {
    let mean = match dimension {
        1 => 1.0,
        2 => FRAC_2_PI,
        _ => 0.5,
    };
    0.25 * c * mean * moments.second
}

/// Of the linear peridynamic solid in two and three dimensions: Madenci & Oterkus 2014 (6.19),
/// `(3G + (3/4)⁴ (K − 5G/3)) δ`, and (6.20), `(6G/π + 16 (K₂ − 2G)/(9π²)) δ` with `K₂ = λ + G` of the plane.
pub fn state_based(dimension: usize, plane: Plane, moduli: &Moduli, horizon: f64) -> f64 {
    let (k, g) = (moduli.bulk(), moduli.shear());
    let stiffness = if dimension == 3 {
        3.0 * g + 0.75f64.powi(4) * (k - 5.0 * g / 3.0)
    } else {
        let in_plane = moduli.lame_of(dimension, plane) + g;
        6.0 * g / PI + 16.0 * (in_plane - 2.0 * g) / (9.0 * PI.powi(2))
    };
    stiffness * horizon
}

#[cfg(test)]
mod tests {
    use super::*;

    /// With ν = ¼ the two solids are one.
    #[test]
    fn both_solids_of_poisson_a_quarter_need_the_same_energy() {
        let (k, d) = (10.0, 0.003f64);
        let moduli = Moduli::from_bulk_shear(k, 0.6 * k);
        let found = state_based(3, Plane::Stress, &moduli, d);
        assert!((found / (1.8 * k * d) - 1.0).abs() < 1e-13, "{found}");
    }
}
