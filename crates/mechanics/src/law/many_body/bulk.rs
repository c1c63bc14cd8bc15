//! What a fan says of a perfect crystal of one kind of atom, and of two atoms alone.

use super::{ManyBody, tangents};
use crate::family::stencil::Stencil;
use crate::law::number::Dual;
use crate::law::potential::bulk::Bulk;
use crate::law::slopes::Slopes;
use crate::law::terms::{Near, Sites};

/// Energy of two atoms of the first kind (energy) at a distance (length).
pub fn pair<F: ManyBody>(many_body: &F, distance: f64) -> f64 {
    let row = many_body.table().at([0; 3]);
    let arm = many_body.arm::<f64, _>(Dual::variable(0.5 * distance * distance), row);
    let zeta = Slopes::<f64, 2>::nth(0.0, 1);
    2.0 * many_body.bond::<f64, _>(&arm.along(0), zeta, row).value
}

/// Sums over the neighbours that `stencil` has, `volume` per atom (length^D times the section).
pub fn bulk<F: ManyBody>(many_body: &F, stencil: &Stencil, spacing: f64, volume: f64) -> Bulk {
    let atoms = stencil.offsets.len() as f64;
    let (mut energy, mut virial) = (0.0, 0.0);
    for offsets in &stencil.offsets {
        let near: Vec<Near> = offsets
            .iter()
            .map(|o| Near {
                kind: 0,
                y: crate::array::from_fn(|a| {
                    let edge = (stencil.kind.edge_squared()[a] as f64).sqrt() * spacing;
                    0.25 * f64::from(o.quarter[a]) * edge
                }),
            })
            .collect();
        super::sites::ManyBodySites(many_body.clone()).terms(0, &near, &mut |t| energy += t.energy);
        tangents(many_body, 0, &near, &mut |t| {
            virial -= t.pull * t.y.iter().map(|y| y * y).sum::<f64>();
        });
    }
    Bulk {
        energy: energy / atoms,
        density: 0.0,
        least_density: f64::NEG_INFINITY,
        pressure: virial / (atoms * stencil.kind.dimension() as f64 * volume),
    }
}
