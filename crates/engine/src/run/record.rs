//! What is written down of a model: families, energies under strain, bonds of atoms.

use super::system::System;
use super::{AtomBond, Families};
use crate::interaction::{BondState, PointEnergies};
use crate::space::full;

impl<const D: usize> System<D> {
    pub(super) fn count_families(&self) -> Families {
        let mut volume = vec![0.0; self.body.len];
        let mut foreign = vec![false; self.body.len];
        let of = |i: usize| self.body.material.get(i).copied().unwrap_or(0);
        self.interaction
            .each_bond(&self.body, &mut |i, j, _, state| {
                if state == BondState::Whole {
                    volume[i] += self.body.volume.at(j);
                    volume[j] += self.body.volume.at(i);
                    let unlike = of(i) != of(j);
                    foreign[i] |= unlike;
                    foreign[j] |= unlike;
                }
            });
        Families {
            size: self
                .body
                .by_id(|i| self.interaction.family_size(&self.body, i) as u32),
            volume: self.body.by_id(|i| volume[i]),
            material: self.body.by_id(of),
            foreign: self.body.by_id(|i| foreign[i]),
        }
    }

    /// Energy densities of bonds under a homogeneous displacement gradient.
    pub(super) fn strained(&self, strain: [[f64; 3]; 3]) -> Vec<f64> {
        let gradient: [[f64; D]; D] =
            std::array::from_fn(|a| std::array::from_fn(|b| strain[a][b]));
        let mut out = PointEnergies::default();
        self.interaction
            .observe_gradient(&self.body, &gradient, &mut out);
        self.body.by_id(|i| out.strain[i])
    }

    /// Bonds between atoms about the displacements of now, and F″ of every atom, in order of ids.
    pub(super) fn bonds_of_atoms(&mut self, visit: &mut dyn FnMut(AtomBond)) -> Option<Vec<f64>> {
        if !self.interaction.is_potential() || self.interaction.has_fans() {
            return None;
        }
        self.refresh_images();
        let id = self.body.ids_by_slot();
        let body = &self.body;
        self.interaction.tangents(body, &self.u, &mut |bond| {
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
            let volume = body.volume.at(bond.i);
            visit(AtomBond {
                from: id[bond.i],
                to: id[bond.j],
                xi: full(&bond.y),
                tension: volume * bond.tension,
                stiffness: volume * along / q,
                share: (0..D).map(|a| bond.share[a] * bond.y[a]).sum::<f64>() / q.sqrt(),
            });
        });
        Some(self.body.by_id(|i| self.interaction.gain(i)))
    }
}
