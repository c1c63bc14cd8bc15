//! What is written down of a model: snapshots, families, energies under strain.

use super::model::Model;
use super::{Families, Simulation, SnapshotOptions};
use crate::body::Layout;
use crate::fracture::fragments::Fragments;
use crate::interaction::{BondState, PointEnergies};
use crate::observe::Snapshot;
use crate::space::Point;

impl<const D: usize> Model<D> {
    pub(super) fn record(&mut self, options: SnapshotOptions) -> Snapshot {
        self.finish();
        let mut snapshot = Snapshot {
            step: self.step,
            time: self.time(),
            dimension: D,
            spacing: self.body.spacing,
            reference: self.reference(),
            displacement: self.displacements(),
            velocity: self.vectors(&self.v),
            damage: self.damage(),
            mark: if self.body.mark.is_empty() {
                vec![0; self.body.points()]
            } else {
                self.body.mark.clone()
            },
            body: match self.body.pieces() {
                [] => vec![],
                _ => self.by_id(|i| self.body.piece_of(i) as u32),
            },
            ..Snapshot::default()
        };
        if options.energies {
            self.refresh_images();
            let mut energies = PointEnergies::default();
            self.interaction.observe(&self.body, &self.u, &mut energies);
            snapshot.energy_density = self.by_id(|i| energies.strain[i] + energies.repulsion[i]);
            snapshot.dilatation = self.by_id(|i| energies.dilatation[i]);
        }
        if options.fragments {
            snapshot.fragment = Some(Fragments::of(&self.body, self.interaction.as_ref()).label);
        }
        if options.bonds {
            let mut id = vec![0u32; self.body.len];
            for (k, &s) in self.body.slots.iter().enumerate() {
                id[s as usize] = k as u32;
            }
            let mut bonds = vec![];
            self.interaction
                .each_bond(&self.body, &mut |i, j, _, state| {
                    if state == BondState::Whole {
                        let (a, b) = (id[i], id[j]);
                        bonds.push((a.min(b), a.max(b)));
                    }
                });
            snapshot.bonds = Some(bonds);
        }
        snapshot
    }

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
            size: self.by_id(|i| self.interaction.family_size(&self.body, i) as u32),
            volume: self.by_id(|i| volume[i]),
            material: self.by_id(of),
            foreign: self.by_id(|i| foreign[i]),
        }
    }

    /// Energy densities of bonds under a homogeneous displacement gradient.
    pub(super) fn strained(&self, strain: [[f64; 3]; 3]) -> Vec<f64> {
        // images of a grid have displacements of their own; a list knows none, so the jump of a homogeneous strain
        // lies somewhere in a periodic cloud: it is put in several places, and each point asked when it is far away
        let cut: [bool; D] = std::array::from_fn(|a| {
            !matches!(self.body.layout, Layout::Grid(_)) && self.body.period[a].is_some()
        });
        let reach = self.info.horizon * (1.0 + 1e-6);
        let period = |a: usize| self.body.period[a].unwrap_or(0.0);
        // so many places that every point is at least a horizon from one of them
        let places: [usize; D] = std::array::from_fn(|a| match cut[a] {
            true => (1.0 / (1.0 - 2.0 * reach / period(a)).max(1e-2)).ceil() as usize + 1,
            false => 1,
        });
        let mut energy = vec![0.0; self.body.points()];
        let mut u = self.body.at_rest();
        let mut out = PointEnergies::default();
        for n in 0..places.iter().product() {
            let mut rest: usize = n;
            let at: [f64; D] = std::array::from_fn(|a| {
                let k = rest % places[a];
                rest /= places[a];
                k as f64 / places[a] as f64 * period(a)
            });
            // position in the period that begins at the cut
            let unwrapped = |slot: usize| -> Point {
                let mut x = self.body.position(slot);
                for a in (0..D).filter(|a| cut[*a]) {
                    x[a] = (x[a] - at[a]).rem_euclid(period(a));
                }
                x
            };
            // images are periodic in displacement; a homogeneous strain is not: give each its own
            let images = self.body.images.iter().map(|(copy, _)| copy);
            for &s in self.body.slots.iter().chain(images) {
                let x = unwrapped(s as usize);
                for a in 0..D {
                    u[a][s as usize] = (0..D).map(|b| strain[a][b] * x[b]).sum();
                }
            }
            self.interaction.observe(&self.body, &u, &mut out);
            for (e, &s) in energy.iter_mut().zip(&self.body.slots) {
                let x = unwrapped(s as usize);
                if (0..D).all(|a| !cut[a] || (reach..=period(a) - reach).contains(&x[a])) {
                    *e = out.strain[s as usize];
                }
            }
        }
        energy
    }
}
