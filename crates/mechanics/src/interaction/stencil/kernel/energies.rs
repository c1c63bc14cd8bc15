//! The energy pass.

use super::View;
use super::chunk::{CHUNK, Chunk};
use super::offsets::Offsets;
use crate::execute::lane::Lane;
use crate::execute::lane::series::{Series, Stretch};
use crate::execute::simd::Kernel;
use crate::interaction::EnergyFields;
use crate::interaction::scale::TileFactors;
use crate::law::Law;

/// Energy pass: strain and repulsion energy density, `Σ k r0² s` and `Σ k r0²` over intact bonds. Sums are returned,
/// fields are written where wanted.
pub struct Energies<'a, const D: usize, W> {
    pub view: View<'a, D, W>,
    pub fields: Option<EnergyFields>,
}

/// Sums over the bonds of a tile.
struct Sums<L> {
    strain: L,
    repulsion: L,
    /// `Σ k r0² s`
    share: L,
    /// `Σ k r0²`
    weight: L,
}

impl<const D: usize, W: Law> Kernel for Energies<'_, D, W> {
    /// Strain and repulsion energy of the block (energy).
    type Out = [f64; 2];
    type Home = W;
    const SELDOM: bool = true;

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> [f64; 2] {
        let v = &self.view;
        let mut sums = [0.0; 2];
        let mut offsets = Offsets::new();
        for n in v.block(block) {
            let i = v.slot(n);
            // SAFETY: as in the force pass
            unsafe {
                let mut tile = if v.is_scaled(n) {
                    self.tile::<L, true>(n, i, &mut offsets)
                } else {
                    self.tile::<L, false>(n, i, &mut offsets)
                };
                if W::SHARES {
                    let q = v.pressure_factor::<L>(i);
                    tile.strain = tile.strain + L::splat(0.5) * q * tile.share * tile.share;
                }
                for (sum, x) in sums.iter_mut().zip([tile.strain, tile.repulsion]) {
                    for (l, x) in x.to_array().iter().enumerate() {
                        *sum += x * v.body.volume.at(i + l);
                    }
                }
                if let Some(out) = self.fields {
                    tile.strain.store(out.strain.at(i));
                    tile.repulsion.store(out.repulsion.at(i));
                    tile.share.store(out.share.at(i));
                    tile.weight.store(out.weight.at(i));
                }
            }
        }
        sums
    }
}

impl<const D: usize, W: Law> Energies<'_, D, W> {
    #[inline(always)]
    unsafe fn tile<L: Lane, const SCALED: bool>(
        &self,
        n: usize,
        i: usize,
        offsets: &mut Offsets<D>,
    ) -> Sums<L> {
        let v = &self.view;
        let series = Series::<Stretch>::new();
        let zero = L::splat(0.0);
        let (mut strain, mut repulsion, mut share, mut weight) = (zero, zero, zero, zero);
        let (mut chunk, mut near_rest) = (Chunk::<L>::new(), Chunk::<L>::new());
        // SAFETY: as in the force pass
        unsafe {
            let ui = v.displacement::<L>(i);
            let own = v.fields::<L>(i);
            let scale = if SCALED {
                v.scale.tile(n)
            } else {
                TileFactors::NONE
            };
            let mut word = 0;
            while word < v.reach(n).len() {
                let (bonds, next) = offsets.stretch(v.stencil(n), v.reach(n), word);
                word = next;
                for bonds in bonds.chunks(CHUNK) {
                    let x = chunk.deform::<D, W, true, true>(v, bonds, v.row(n), i, &ui);
                    let near = L::or(x.close, x.low.lt(L::splat(v.most_contact)));
                    let stretch = chunk.each(bonds.len(), series, &x, &mut near_rest);
                    for (c, b) in bonds.iter().enumerate() {
                        let mut s = stretch.get(c);
                        let gone = s.is_nan();
                        let (mut kr, mut kr_share) = (L::splat(b.share), L::splat(b.share));
                        if SCALED {
                            kr = kr * scale.pair(b.number as usize);
                            kr_share = match W::SHARES {
                                true => kr_share * scale.own(b.number as usize),
                                false => kr,
                            };
                        }
                        s = s.zero_if(gone);
                        let other = v.fields::<L>(b.to(i));
                        let x = v.law.pair_energy(kr * s * s, own, other);
                        // fields mean nothing where there is no point
                        strain = strain + x.zero_if(gone);
                        share = kr_share.fma(s, share);
                    }
                    if v.repulsion.is_some() && L::any(near) {
                        for b in bonds {
                            let e = v.deform(b, i, &ui);
                            let close = e.lt(L::splat(b.contact_e));
                            if L::any(close) {
                                let to = &v.partners[v.sublattice(n)][b.number as usize];
                                repulsion = repulsion + v.repel(to, i, e, close).1;
                            }
                        }
                    }
                    if self.fields.is_some() {
                        for b in bonds {
                            let mut kr = L::splat(b.share);
                            if SCALED && !W::SHARES {
                                kr = kr * scale.pair(b.number as usize);
                            }
                            let dead = L::dead(*v.row(n).add(b.number as usize));
                            weight = weight + kr.zero_if(dead);
                        }
                    }
                }
            }
        }
        Sums {
            strain,
            repulsion,
            share,
            weight,
        }
    }
}
