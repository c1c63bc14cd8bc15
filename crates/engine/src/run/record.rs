//! What is written down of a model: families, energies under strain, bonds of atoms.

use super::system::System;
use super::{AtomBond, Families};
use crate::body::view;
use crate::interaction::{BondStatus, PointEnergies};
use crate::space::full;

pub(super) fn count_families<const D: usize>(system: &System<D>) -> Families {
    let mut volume = vec![0.0; system.body.len()];
    let mut foreign = vec![false; system.body.len()];
    let of = |i: usize| system.body.material_of(i);
    system
        .interaction
        .each_bond(&system.body, &mut |i, j, _, state| {
            if state == BondStatus::Whole {
                volume[i] += system.body.volume().at(j);
                volume[j] += system.body.volume().at(i);
                let unlike = of(i) != of(j);
                foreign[i] |= unlike;
                foreign[j] |= unlike;
            }
        });
    Families {
        size: system
            .body
            .by_id(|i| system.interaction.family_size(&system.body, i) as u32),
        volume: system.body.by_id(|i| volume[i]),
        material: system.body.by_id(|i| of(i) as u8),
        foreign: system.body.by_id(|i| foreign[i]),
    }
}

/// Energy densities of bonds under a homogeneous displacement gradient.
pub(super) fn strained<const D: usize>(system: &System<D>, strain: [[f64; 3]; 3]) -> Vec<f64> {
    let gradient: [[f64; D]; D] =
        crate::array::from_fn(|a| crate::array::from_fn(|b| strain[a][b]));
    let mut out = PointEnergies::default();
    system.interaction.observe_gradient(
        &system.body,
        &gradient,
        &mut out.for_slots(system.body.len()),
    );
    system.body.by_id(|i| out.strain[i])
}

/// Bonds between atoms about the displacements of now, and F″ of every atom, in order of ids.
pub(super) fn bonds_of_atoms<const D: usize>(
    system: &mut System<D>,
    visit: &mut dyn FnMut(AtomBond),
) -> Option<Vec<f64>> {
    if !system.interaction.is_potential() || system.interaction.has_many_body() {
        return None;
    }
    system.refresh_images();
    let id = system.body.ids_by_slot();
    let body = &system.body;
    system
        .interaction
        .tangents(body, view(&system.u), &mut |bond| {
            let square = |x: &[f64; D]| x.iter().map(|c| c * c).sum::<f64>();
            let q = square(&bond.y);
            let along: f64 = (0..D)
                .map(|a| {
                    (0..D)
                        .map(|b| bond.y[a] * bond.stiffness[a][b] * bond.y[b])
                        .sum::<f64>()
                })
                .sum();
            // tangents are force densities
            let volume = body.volume().at(bond.i);
            visit(AtomBond {
                from: id[bond.i],
                to: id[bond.j],
                xi: full(&bond.y),
                tension: volume * bond.tension,
                stiffness: volume * along / q,
                share: (0..D).map(|a| bond.share[a] * bond.y[a]).sum::<f64>() / q.sqrt(),
            });
        });
    Some(system.body.by_id(|i| system.interaction.gain(i)))
}
