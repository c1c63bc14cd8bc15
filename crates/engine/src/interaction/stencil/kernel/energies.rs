//! The energy pass.

use super::{CHUNK, Offsets, View};
use crate::execute::lane::series::{self, LIMIT, Series};
use crate::execute::lane::{Lane, TILE};
use crate::execute::simd::Kernel;
use crate::interaction::EnergyFields;
use crate::law::Law;
use std::mem::MaybeUninit;

/// Energy pass: strain and repulsion energy density, `Σ k r0² s` and `Σ k r0²` over whole bonds. Sums are returned,
/// fields are written where wanted.
pub struct Energies<'a, const D: usize, W> {
    pub view: View<'a, D, W>,
    pub fields: Option<EnergyFields>,
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
                    let limit = L::splat(LIMIT);
                    let row = v.row(n);
                    let intact = v.is_intact(n);
                    let mut stretched = [MaybeUninit::<L>::uninit(); CHUNK];
                    let ui = v.displacement::<L>(i);
                    let own = v.fields::<L>(i);
                    let (mut strain, mut repulsion, mut share, mut weight) =
                        (zero, zero, zero, zero);
                    for chunk in offsets.chunks() {
                        let (mut low, mut high, mut lowest) = (zero, zero, zero);
                        for (c, n) in chunk.iter().enumerate() {
                            let n = n.assume_init() as usize;
                            let (_, raw) = v.deform(bonds.get_unchecked(n), i, &ui);
                            let mut e = raw;
                            if !intact {
                                // a bond that is not there is not stretched
                                e = raw.zero_if(L::dead(*row.add(n), part));
                            }
                            low = e.min(low);
                            high = e.max(high);
                            lowest = raw.min(lowest);
                            stretched.get_unchecked_mut(c).write(e);
                        }
                        let far = L::any(L::or(limit.lt(high), low.lt(zero - limit)));
                        for (c, n) in chunk.iter().enumerate() {
                            let n = n.assume_init() as usize;
                            let b = bonds.get_unchecked(n);
                            // the loop above wrote these
                            let e = stretched.get_unchecked(c).assume_init();
                            let s = if far {
                                series::stretch(e)
                            } else {
                                series.at(e)
                            };
                            let kr = L::splat(b.share);
                            let other = v.fields::<L>(i.wrapping_add_signed(b.shift));
                            let mut x = v.law.pair_energy(kr * s * s, own, other);
                            if !intact {
                                // fields mean nothing where there is no point
                                x = x.zero_if(L::dead(*row.add(n), part));
                            }
                            strain = strain + x;
                            share = kr.fma(s, share);
                        }
                        if v.repulsion.is_some() && L::any(lowest.lt(L::splat(v.most_contact))) {
                            for n in chunk {
                                let n = n.assume_init() as usize;
                                let b = bonds.get_unchecked(n);
                                let (_, raw) = v.deform(b, i, &ui);
                                let close = raw.lt(L::splat(b.contact_e));
                                if L::any(close) {
                                    repulsion = repulsion + v.repel(&partners[n], i, raw, close).1;
                                }
                            }
                        }
                        if self.fields.is_some() && !W::SHARES {
                            for n in chunk {
                                let n = n.assume_init() as usize;
                                let mut kr = L::splat(bonds.get_unchecked(n).share);
                                if !intact {
                                    kr = kr.zero_if(L::dead(*row.add(n), part));
                                }
                                weight = weight + kr;
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
