//! Interatomic potentials on families: fixed lattice neighbours with current distances, or current neighbours.
//!
//! The force on i is `Σ_j 2 [φ′ + (F′_i + F′_j) f′] (y_j − y_i)` with derivatives with respect to `q = r²`
//! (seleson2014 (2.3)); force densities are that over the atom's volume.

pub mod bonded;
pub mod breaking;
pub mod current;
pub mod fixed;
mod line;
pub mod many_body;
pub mod smoothed;
pub mod sum;
mod union;

use super::bond::sum_of_virials;
use super::tangent::curvature;
use super::{Fault, PointEnergiesMut, Tally};
use crate::body::Body;
use crate::execute::blocks::{PerBlock, Shared};
use crate::execute::lane::{Lane, TILE};
use crate::execute::simd::{Kernel, Simd};
use crate::law::number::Dual;
use crate::law::potential::Potential;

/// What the embedding energy says of a tile of densities: F and F′.
#[inline(always)]
fn embed<L: Lane, P: Potential>(potential: &P, density: L) -> [L; 2] {
    let f = potential.embedding(Dual::variable(density));
    [f.value, f.slope]
}

/// The first of eight densities that F has no meaning at; `owned` are the lanes that have a point, each in its slot.
#[inline(always)]
fn density_fault<L: Lane, P: Potential>(
    potential: &P,
    density: L,
    owned: u8,
    slot: impl Fn(usize) -> usize,
) -> Option<Fault> {
    let (l, density) = bad_density(potential, density.to_array(), owned)?;
    let slot = slot(l);
    Some(Fault::Density { slot, density })
}

/// Its lane, and the density. Not for each instruction set.
fn bad_density<P: Potential>(
    potential: &P,
    density: [f64; TILE],
    owned: u8,
) -> Option<(usize, f64)> {
    let least = potential.least_density();
    let bad = |l: &usize| owned >> l & 1 == 1 && (density[*l] <= least || density[*l].is_nan());
    (0..TILE).find(bad).map(|l| (l, density[l]))
}

/// F″ per slot, of the last tangents; empty without embedding.
#[derive(Default)]
struct Curvatures(Vec<f64>);

impl Curvatures {
    /// Of each slot's potential, if it has one, and density.
    fn of<'a, P: Potential>(slots: impl Iterator<Item = (Option<&'a P>, f64)>) -> Self {
        let each = slots.map(|(p, density)| p.map_or(0.0, |p| curvature(p, density)));
        Curvatures(each.collect())
    }

    fn at(&self, slot: usize) -> f64 {
        self.0.get(slot).copied().unwrap_or(0.0)
    }
}

/// What each atom says of itself: its energy and, where asked for, its virial, by slot. Totals are sums without rounding, so that it does not show who stands
/// beside whom.
struct Said {
    energy: Vec<f64>,
    virial: Vec<[f64; 6]>,
}

/// Where it goes.
#[derive(Clone, Copy)]
struct Places {
    energy: Shared,
    /// Null: nobody asks.
    virial: Shared<[f64; 6]>,
}

impl Said {
    fn new<const D: usize>(body: &Body<D>, virial: bool) -> Said {
        Said {
            energy: vec![0.0; body.len],
            virial: vec![[0.0; 6]; if virial { body.len } else { 0 }],
        }
    }

    fn places(&mut self) -> Places {
        Places {
            energy: Shared(self.energy.as_mut_ptr()),
            virial: Shared(match self.virial.is_empty() {
                true => std::ptr::null_mut(),
                false => self.virial.as_mut_ptr(),
            }),
        }
    }

    /// Of all atoms, of all ranks.
    fn energy<const D: usize>(&self, body: &Body<D>) -> f64 {
        body.sum(body.slots.iter().map(|s| self.energy[*s as usize]))
    }

    fn virial<const D: usize>(&self, body: &Body<D>) -> [f64; 6] {
        sum_of_virials(body, &self.virial)
    }

    /// Energies per volume.
    fn see<const D: usize>(&self, body: &Body<D>, out: &mut PointEnergiesMut) {
        out.zeros(body.len);
        for s in body.slots.iter().map(|s| *s as usize) {
            out.strain[s] = self.energy[s] / body.volume.at(s);
        }
    }
}

impl Places {
    #[inline(always)]
    fn asks_virial(&self) -> bool {
        !self.virial.0.is_null()
    }

    /// What the own atoms of a tile say, the virial times a sign.
    ///
    /// # Safety
    /// They are nobody else's.
    #[inline(always)]
    unsafe fn put<L: Lane>(&self, slots: &[u32], energy: L, virial: [L; 6], sign: f64) {
        for (e, &slot) in energy.to_array().iter().zip(slots) {
            // SAFETY, both: promised
            unsafe { *self.energy.at(slot as usize) = *e };
        }
        if self.asks_virial() {
            let virial = virial.map(|v| v.to_array());
            for (l, &slot) in slots.iter().enumerate() {
                let of = crate::array::from_fn(|n| sign * virial[n][l]);
                unsafe { *self.virial.at(slot as usize) = of };
            }
        }
    }
}

/// Room for what a kernel that looks for faults finds.
type Faults = PerBlock<Option<Fault>>;

/// Run such a kernel: a tally of nothing but the first fault in the order of blocks.
fn find_fault<K: Kernel<Out = Option<Fault>>>(faults: &Faults, simd: Simd, kernel: &K) -> Tally {
    Tally {
        fault: faults.fold(simd, kernel, |first, found| *first = first.or(found)),
        ..Tally::default()
    }
}
