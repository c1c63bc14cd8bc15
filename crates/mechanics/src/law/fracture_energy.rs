//! The energy that a crack takes: `G0 / s0²` (energy / area) where every bond across a plane breaks at the stretch s0.

use super::micromodulus::{Moments, mean_length};
use super::solid::eam_like::Solid;
use crate::spec::{Influence, Moduli, Plane};
use std::f64::consts::{FRAC_2_PI, PI};

/// Of bonds with the micromodulus c: `¼ c ⟨|n_z|⟩ M2`.
///
/// A unit area is crossed by bonds of energy `½ Σ |ξ_n| w dV` (each once), `w = ½ c ω s0² r0`, and
/// `⟨|n_z|⟩ = 1, 2/π, ½` in 1, 2, 3 dimensions. Silling & Askari 2005, Ha & Bobaru 2010 are the full ball and disk.
pub fn bond_based(dimension: usize, c: f64, moments: Moments) -> f64 {
    0.25 * c * mean_across(dimension) * moments.second
}

/// `G0 / w_c` (volume² / area): `½ ⟨|n_z|⟩ Σ ν V r0`, where every bond takes the work w_c (energy / volume²)
/// whatever its length. Foster, Silling & Chen 2011: `w_c = 4 G0/(πδ⁴)` of the full ball; of the disk `3 G0/(2tδ³)`, of the line
/// `2 G0/(Aδ²)`.
pub fn of_unit_work(dimension: usize, moments: Moments) -> f64 {
    0.5 * mean_across(dimension) * moments.bare
}

/// `⟨|n_z|⟩` over all directions.
fn mean_across(dimension: usize) -> f64 {
    match dimension {
        1 => 1.0,
        2 => FRAC_2_PI,
        _ => 0.5,
    }
}

/// Of the linear peridynamic solid in two and three dimensions, with `n` of them: bonds of the energy `α ω s² r0²`, `α = n(n+2) G/m`,
/// take `½ ⟨|n_z|⟩ n(n+2) G M3/m` of any influence function, `M3/m = Σ ω ν V r0³ / Σ ω ν V r0²`: 3Gδ and 6Gδ/π of ω = 1/r0. The
/// volumetric part, which the solid of bonds (ν = ¼, of the plane ⅓ and ¼) does not have, is that of Madenci & Oterkus 2014 (6.19),
/// `(3G + (3/4)⁴ (K − 5G/3)) δ`, and (6.20), `(6G/π + 16 (K₂ − 2G)/(9π²)) δ` with `K₂ = λ + G` of the plane, whatever ω is.
pub fn state_based(
    dimension: usize,
    plane: Plane,
    moduli: &Moduli,
    horizon: f64,
    influence: Influence,
) -> f64 {
    let (k, g) = (moduli.bulk(), moduli.shear());
    let n = dimension as f64;
    let pairs = 0.5 * mean_across(dimension) * n * (n + 2.0) * g;
    let kappa = match dimension {
        3 => k - 5.0 * g / 3.0,
        _ => moduli.lame_of(dimension, plane) + g - 2.0 * g,
    };
    pairs * mean_length(dimension, horizon, influence) + of_volume(dimension, kappa) * horizon
}

/// The same of any constants n, κ and β: the dilatation is `n/D` of the trace of the strain.
pub fn of_solid(dimension: usize, solid: Solid, horizon: f64, influence: Influence) -> f64 {
    let pairs = 0.5 * mean_across(dimension) * solid.beta;
    let kappa = solid.kappa * (solid.n / dimension as f64).powi(2);
    pairs * mean_length(dimension, horizon, influence) + of_volume(dimension, kappa) * horizon
}

/// The volumetric part per horizon, see [`state_based`].
fn of_volume(dimension: usize, kappa: f64) -> f64 {
    match dimension {
        3 => 0.75f64.powi(4) * kappa,
        _ => 16.0 * kappa / (9.0 * PI.powi(2)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::influence::influence;

    /// The full ball, the disk of thickness t and the line of cross-section A.
    #[test]
    fn work_of_a_bond_is_the_published_one() {
        let (d, section) = (0.003f64, 0.7);
        let published = [
            2.0 / (section * d * d),
            1.5 / (section * d.powi(3)),
            4.0 / (PI * d.powi(4)),
        ];
        for (n, w) in published.into_iter().enumerate() {
            let section = if n == 2 { 1.0 } else { section };
            let moments = Moments::continuum(n + 1, d, section, Influence::Inverse);
            let found = 1.0 / of_unit_work(n + 1, moments);
            assert!((found / w - 1.0).abs() < 1e-13, "{n}: {found} {w}");
        }
    }

    /// With ν = ¼ the two solids are one.
    #[test]
    fn both_solids_of_poisson_a_quarter_need_the_same_energy() {
        let (k, d) = (10.0, 0.003f64);
        let moduli = Moduli::from_bulk_shear(k, 0.6 * k);
        let found = state_based(3, Plane::Stress, &moduli, d, Influence::Inverse);
        assert!((found / (1.8 * k * d) - 1.0).abs() < 1e-13, "{found}");
    }

    /// Of the solid of bonds, counted: pairs of slices of a bar or block across the plane, over all directions, `∫∫ α ω s² r0² dV dz`.
    #[test]
    fn pairs_take_what_is_counted_across_a_plane_whatever_the_influence_function() {
        let (horizon, g) = (0.7, 3.0);
        for kind in Influence::ALL {
            for dimension in [2, 3] {
                // ν = ¼ in plane strain and in space: no volumetric part
                let moduli = Moduli {
                    young: 2.5 * g,
                    poisson: 0.25,
                };
                let found = state_based(dimension, Plane::Strain, &moduli, horizon, kind);
                let cells = 400;
                let h = horizon / cells as f64;
                let middle = |k: usize| h * (k as f64 + 0.5);
                let (mut weight, mut across) = (0.0, 0.0);
                // ξ = (x, z): z across the plane, x along it
                for (a, b) in (0..cells).flat_map(|a| (0..cells).map(move |b| (a, b))) {
                    let (x, z) = (middle(a), middle(b));
                    let r = x.hypot(z);
                    if r > horizon {
                        continue;
                    }
                    let along = match dimension {
                        2 => 2.0,
                        _ => 2.0 * PI * x,
                    };
                    let part = along * h * h * influence(kind, &[r], r, horizon) * r * r;
                    weight += 2.0 * part;
                    // bonds of this ξ begin up to z in front of it
                    across += z * part;
                }
                let n = dimension as f64;
                let exact = n * (n + 2.0) * g / weight * across;
                assert!(
                    (found / exact - 1.0).abs() < 3e-3,
                    "{kind:?} in {dimension}: {found} is not {exact}"
                );
            }
        }
    }
}
