//! Stiffness of points whose bonds cost energy when a body rotates: of a linear body that stands for atoms of many bodies, or for a state-based solid.
//!
//! Each of its bonds has the energy `¼ V_i (u_j − u_i)·C_ij (u_j − u_i)` seen from either end, and only their sum over the whole body, with its surface, is
//! as large after a rotation. What such bonds have under a strain is no elastic energy. Long waves know only the brackets
//! `[ik,jl] = (1/2V) Σ_bonds K_ik ξ_j ξ_l`, `ρ ω² u_i = Σ [ik,jl] q_j q_l u_k` (Born & Huang 1954, §§ 26, 27), which are the second derivatives of that energy by the
//! components ij and kl of the displacement gradient. The elastic tensor follows from them ([`Stiffness::of_waves`]).
//!
//! Brackets of a crystal at rest are the same with ik and jl exchanged. Under the stress σ they are not, `[ik,jl] − [jl,ik] = δ_ik σ_jl − δ_jl σ_ik`, so that
//! σ shows but for its pressure, `σ_jl = (1/D) Σ_i ([ii,jl] − [jl,ii])`; a pressure is in the tensor of stress against strain anyway.

use super::{Place, STRAIN, Sorted};
use crate::voigt::{Stiffness, components};
use peridyne::run::Simulation;

/// What a rotation may cost of the largest elastic constant: laws that know rotations have their round-off and terms of fourth order.
const ROTATION: f64 = 1e-6;

/// Gives the classes of materials whose bonds resist rotations a stiffness by long waves: the bulk; none is known of points near a surface.
pub(super) fn where_rotations_cost(sim: &dyn Simulation, found: &mut Sorted) {
    match sim.info().dimension {
        1 => {}
        2 => in_dimensions::<2>(sim, found),
        _ => in_dimensions::<3>(sim, found),
    }
}

fn in_dimensions<const D: usize>(sim: &dyn Simulation, found: &mut Sorted) {
    let largest = |c: &Stiffness| (0..components(D)).map(|v| c.c[v][v]).fold(0.0, f64::max);
    let mut resist = vec![];
    for (a, b) in (0..D).flat_map(|b| (0..b).map(move |a| (a, b))) {
        let mut rotation = [[0.0; 3]; 3];
        rotation[a][b] = 0.5 * STRAIN;
        rotation[b][a] = -0.5 * STRAIN;
        let energies = found.energies(sim, rotation);
        for (class, energy) in found.classes.iter().zip(energies) {
            let shear = 2.0 * energy / (STRAIN * STRAIN);
            let scale = class.stiffness.as_ref().map_or(0.0, largest);
            if shear.abs() > ROTATION * scale {
                resist.push(class.material);
            }
        }
    }
    if resist.is_empty() {
        return;
    }
    let brackets = brackets::<D>(sim, found);
    let even = found.even;
    for (class, bracket) in found.classes.iter_mut().zip(brackets) {
        if resist.contains(&class.material) {
            class.long_waves = true;
            class.stiffness = (even || class.place == Place::Bulk).then(|| {
                let stress = deviator::<D>(&bracket);
                Stiffness::of_waves(&bracket, &stress).under_stress(&stress)
            });
        }
    }
}

/// `[ik,jl]` as `[i][j][k][l]` of every class: second derivatives of its energy by components ij and kl of the gradient, by energies of unit gradients and
/// of their pair sums.
fn brackets<const D: usize>(sim: &dyn Simulation, found: &Sorted) -> Vec<Vec<f64>> {
    let n = D * D;
    let of = |v: usize, w: usize| {
        let mut gradient = [[0.0; 3]; 3];
        gradient[v / D][v % D] += STRAIN;
        if v != w {
            gradient[w / D][w % D] += STRAIN;
        }
        found.energies(sim, gradient)
    };
    let alone: Vec<Vec<f64>> = (0..n).map(|v| of(v, v)).collect();
    let mut out = vec![vec![0.0; n * n]; found.classes.len()];
    for v in 0..n {
        for w in 0..=v {
            let both = if v == w { vec![] } else { of(v, w) };
            for (k, bracket) in out.iter_mut().enumerate() {
                let mixed = match v == w {
                    true => 2.0 * alone[v][k],
                    false => both[k] - alone[v][k] - alone[w][k],
                };
                bracket[v * n + w] = mixed / (STRAIN * STRAIN);
                bracket[w * n + v] = mixed / (STRAIN * STRAIN);
            }
        }
    }
    out
}

/// Of the stress of the reference, from its brackets `[i][j][k][l]`.
fn deviator<const D: usize>(bracket: &[f64]) -> [[f64; D]; D] {
    let at = |i: usize, k: usize, j: usize, l: usize| bracket[((i * D + j) * D + k) * D + l];
    std::array::from_fn(|j| {
        std::array::from_fn(|l| {
            let each = (0..D).map(|i| at(i, i, j, l) - at(j, l, i, i));
            each.sum::<f64>() / D as f64
        })
    })
}

#[cfg(test)]
mod tests;
