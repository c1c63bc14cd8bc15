//! The energy pass.

use super::{View, scatter};
use crate::execute::lane::Lane;
use crate::execute::lane::series::{Series, Stretch};
use crate::execute::simd::Kernel;
use crate::interaction::EnergyFields;
use crate::law::Law;

/// Energy pass: strain and repulsion energy density, `Σ k r0² s` and `Σ k r0²` over intact bonds.
pub struct Energies<'a, const D: usize, W> {
    pub view: View<'a, D, W>,
    pub fields: Option<EnergyFields>,
}

impl<const D: usize, W: Law> Kernel for Energies<'_, D, W> {
    /// Strain and repulsion energy of the block (energy).
    type Out = [f64; 2];
    type Home = W;
    const SELDOM: bool = true;

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> [f64; 2] {
        let v = &self.view;
        let series = Series::<Stretch>::new();
        let mut sums = [0.0; 2];
        let contact_e = L::splat(v.contact_e());
        for slice in v.block(block) {
            // SAFETY: as in the force pass
            unsafe {
                let zero = L::splat(0.0);
                let rows = v.rows(slice);
                let i = v.end::<L, true>(rows);
                let (mut strain, mut repulsion, mut share, mut weight) = (zero, zero, zero, zero);
                for line in v.list.start[slice]..v.list.start[slice + 1] {
                    let partners = v.partners(line);
                    let j = v.end::<L, true>(partners);
                    let b = v.bond::<L>(&i, &j, rows, partners);
                    let (k, own, other) = v.acting(&b, i.field, j.field);
                    let k = v.scaled(k, line);
                    let dead = L::dead(*v.alive.at(line));
                    let s = series.at(b.e.nan_if(dead)).zero_if(dead);
                    let kr = (b.k * b.r0_squared).zero_if(dead);
                    let kr_pair = (k * b.r0_squared).zero_if(dead);
                    let x = v.law.pair_energy(kr_pair * s * s, own, other);
                    strain = strain + x.zero_if(dead);
                    share = kr.fma(s, share);
                    weight = weight + kr;
                    if v.repulsion.is_some() && L::any(b.e.lt(contact_e)) {
                        repulsion = repulsion + v.repel(&b, j.volume, rows, partners).1;
                    }
                }
                if W::SHARES {
                    let q = v.pressure_factor(rows, i.field[1]) * v.volume::<L>(rows);
                    strain = strain + L::splat(0.5) * q * share * share;
                }
                for (sum, x) in sums.iter_mut().zip([strain, repulsion]) {
                    let energy = x * i.volume;
                    energy.to_array().iter().for_each(|x| *sum += x);
                }
                if let Some(out) = self.fields {
                    scatter(strain, out.strain, rows, 1);
                    scatter(repulsion, out.repulsion, rows, 1);
                    scatter(share, out.share, rows, 1);
                    scatter(weight, out.weight, rows, 1);
                }
            }
        }
        sums
    }
}
