//! Interatomic potentials on families: fixed lattice neighbours with current distances, or current neighbours.
//!
//! The force on i is `Σ_j 2 [φ′ + (F′_i + F′_j) f′] (y_j − y_i)` with derivatives with respect to `q = r²`
//! (seleson2014 (2.3)); force densities are that over the atom's volume.

pub mod bonded;
pub mod breaking;
pub mod current;
pub mod fan;
pub mod fixed;
mod line;
pub mod smoothed;
pub mod together;
mod union;

use super::tangent::curvature;
use super::{Fault, Tally};
use crate::execute::blocks::PerBlock;
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

/// Room for what a kernel that looks for faults finds.
type Faults = PerBlock<Option<Fault>>;

/// Run such a kernel: a tally of nothing but the first fault in the order of blocks.
fn find_fault<K: Kernel<Out = Option<Fault>>>(faults: &Faults, simd: Simd, kernel: &K) -> Tally {
    Tally {
        fault: faults.fold(simd, kernel, |first, found| *first = first.or(found)),
        ..Tally::default()
    }
}
