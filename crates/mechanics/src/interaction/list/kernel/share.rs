//! The share pass: what bonds tell their points, of laws with a scalar for each point.

use super::{View, scatter};
use crate::execute::blocks::Shared;
use crate::execute::lane::Lane;
use crate::execute::lane::series::{Series, Stretch};
use crate::execute::simd::Kernel;
use crate::law::Law;

/// Share pass: `P = q Σ k r0² s` into field 0.
pub struct Share<'a, const D: usize, W> {
    pub view: View<'a, D, W>,
    /// Point fields of the law, of which the first is written.
    pub fields: Shared,
}

impl<const D: usize, W: Law> Kernel for Share<'_, D, W> {
    type Out = ();
    type Home = W;

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        let v = &self.view;
        let series = Series::<Stretch>::new();
        for slice in v.block(block) {
            // SAFETY: as in the force pass; pressures are written, stiffnesses read
            unsafe {
                let rows = v.rows(slice);
                let i = v.end::<L, false>(rows);
                let mut sum = L::splat(0.0);
                for line in v.list.start[slice]..v.list.start[slice + 1] {
                    let partners = v.partners(line);
                    let j = v.end::<L, false>(partners);
                    let b = v.bond::<L>(&i, &j, rows, partners);
                    let dead = L::dead(*v.alive.at(line));
                    let e = b.e.nan_if(dead);
                    let s = series.at(e);
                    let kr = (b.k * b.r0_squared).zero_if(dead);
                    sum = kr.fma(s.zero_if(dead), sum);
                }
                let q = v.pressure_factor(rows, L::gather2(v.fields.0, rows)[1]);
                scatter(q * sum, self.fields, rows, 2);
            }
        }
    }
}
