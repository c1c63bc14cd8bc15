//! The energy pass.

use super::{Offsets, View};
use crate::execute::blocks::Shared;
use crate::execute::lane::series::{self, Series};
use crate::execute::lane::{Lane, TILE};
use crate::execute::simd::Kernel;
use crate::law::Law;

/// Energy pass: strain and repulsion energy density, `Σ k r0² s` and `Σ k r0²` over whole bonds. Sums are returned,
/// fields are written where wanted.
pub struct Energies<'a, const D: usize, W> {
    pub view: View<'a, D, W>,
    pub fields: Option<EnergyFields>,
}

#[derive(Clone, Copy)]
pub struct EnergyFields {
    pub strain: Shared,
    pub repulsion: Shared,
    pub share: Shared,
    pub weight: Shared,
}

impl<const D: usize, W: Law> Kernel for Energies<'_, D, W> {
    /// Strain and repulsion energy of the block (energy).
    type Out = [f64; 2];

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> [f64; 2] {
        let v = &self.view;
        let series = Series::stretch();
        let mut sums = [0.0; 2];
        let mut offsets = Offsets::new();
        for n in v.block(block) {
            offsets.of(v.reach(n));
            let bonds = v.stencil(n);
            let partners = &v.partners[v.sublattice(n)];
            for part in 0..TILE / L::N {
                let i = v.slot(n) + part * L::N;
                // SAFETY: as in the force pass
                unsafe {
                    let zero = L::splat(0.0);
                    let ui = v.displacement::<L>(i);
                    let own = v.fields::<L>(i);
                    let (mut strain, mut repulsion, mut share, mut weight) =
                        (zero, zero, zero, zero);
                    for k in offsets.chunks().flatten() {
                        // all were written
                        let k = k.assume_init() as usize;
                        let b = bonds.get_unchecked(k);
                        let (_, e) = v.deform(b, i, &ui);
                        let dead = L::dead(*v.row(n).add(k), part);
                        let whole = e.zero_if(dead);
                        let s = if L::any(series.beyond(whole)) {
                            series::stretch(whole)
                        } else {
                            series.at(whole)
                        };
                        let kr = L::splat(b.share);
                        let other = v.fields::<L>(i.wrapping_add_signed(b.shift));
                        strain = strain + v.law.pair_energy(kr * s * s, own, other).zero_if(dead);
                        share = kr.fma(s, share);
                        weight = weight + kr.zero_if(dead);
                        if v.repulsion.is_some() {
                            let close = e.lt(L::splat(b.contact_e));
                            if L::any(close) {
                                repulsion = repulsion + v.repel(&partners[k], i, e, close).1;
                            }
                        }
                    }
                    if W::SHARES {
                        let q = v.pressure_factor(i);
                        strain = strain + L::splat(0.5) * q * share * share;
                    }
                    // lane by lane, so that the width does not show in the sum
                    for (sum, x) in sums.iter_mut().zip([strain, repulsion]) {
                        x.to_array()[..L::N]
                            .iter()
                            .for_each(|x| *sum += x * v.volume);
                    }
                    if let Some(out) = self.fields {
                        strain.store(out.strain.at(i));
                        repulsion.store(out.repulsion.at(i));
                        share.store(out.share.at(i));
                        weight.store(out.weight.at(i));
                    }
                }
            }
        }
        sums
    }
}
