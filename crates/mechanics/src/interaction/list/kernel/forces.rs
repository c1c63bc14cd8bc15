//! The force pass: forces, breaking, and what the next step remembers.

use super::{End, View, scatter};
use crate::body::FieldView;
use crate::execute::blocks::Shared;
use crate::execute::lane::series::{Extension, Function, Series, Stretch};
use crate::execute::lane::{Lane, TILE};
use crate::execute::simd::Kernel;
use crate::interaction::{BlockTally, Motion, Toughness, history};
use crate::law::Law;
use crate::spec::Breakage;

/// Force pass.
pub struct Forces<'a, const D: usize, W, const FULL: bool> {
    pub view: View<'a, D, W>,
    /// Bits of whole bonds, which breaking writes.
    pub alive: Shared<u8>,
    pub f: [Shared; D],
    pub next: Shared,
    pub toughness: &'a [Toughness],
    /// Are there points whose bonds never break?
    pub spares: bool,
    /// Material per slot; empty when there is one.
    pub material: &'a [u8],
    /// `None`: nothing breaks.
    pub motion: Option<Motion<'a, D>>,
}

impl<const D: usize, W: Law, const FULL: bool> Kernel for Forces<'_, D, W, FULL> {
    type Out = BlockTally;
    type Home = W;

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> BlockTally {
        let mut tally = BlockTally::default();
        for slice in self.view.block(block) {
            let lines = self.view.list.start[slice]..self.view.list.start[slice + 1];
            // SAFETY: the list was made for these records; each slice is written by one block
            unsafe { self.points::<L>(slice, lines, &mut tally) };
        }
        tally
    }
}

impl<const D: usize, W: Law, const FULL: bool> Forces<'_, D, W, FULL> {
    /// All bonds of a slice.
    #[inline(always)]
    unsafe fn points<L: Lane>(
        &self,
        slice: usize,
        lines: std::ops::Range<usize>,
        tally: &mut BlockTally,
    ) {
        let v = &self.view;
        let zero = L::splat(0.0);
        let contact_e = L::splat(v.contact_e());
        let series = Series::<Extension>::new();
        unsafe {
            let rows = v.rows(slice);
            let i = v.end::<L, true>(rows);
            let mut lowest = L::splat(f64::INFINITY);
            // s0 of pairs of materials: the greatest of all whole bonds
            let mut greatest = L::splat(f64::NEG_INFINITY);
            let mut acc = [zero; D];
            // broken bonds: Σ x and Σ k r0² s, rare
            let mut lost: Option<[L; 2]> = None;
            for line in lines {
                let partners = v.partners(line);
                let j = v.end::<L, true>(partners);
                let b = v.bond::<L>(&i, &j, rows, partners);
                let (k, own, other) = v.acting(&b, i.field, j.field);
                let k = v.scaled(k, line);
                let dead = L::dead(*v.alive.at(line));
                let e = b.e.nan_if(dead);
                let g = series.at(e);
                let mut pull = v.law.pull(k, g, own, other).zero_if(dead);
                if FULL {
                    let limit = match self.spares {
                        false => j.critical.min(i.critical),
                        true => history::limit(j.critical, i.critical),
                    };
                    let breaks = limit.lt(e);
                    lowest = e.min(lowest);
                    if v.paired {
                        let [s00, alpha] = v.pairs.memory::<L>(&b.pair);
                        greatest = (s00 - alpha * history::stretch(e)).max(greatest);
                    }
                    if L::any(L::or(breaks, b.e.lt(contact_e))) {
                        if let Some(motion) = self.motion
                            && L::any(breaks)
                        {
                            let which = L::bits(breaks);
                            *self.alive.at(line) &= !(which as u8);
                            tally.broken += which.count_ones() as u64;
                            let s = Stretch::exact(e);
                            let share = b.k * b.r0_squared * s;
                            let x = v.law.pair_energy(k * b.r0_squared * s * s, own, other)
                                + motion.breaking_correction(
                                    pull,
                                    parting(motion.v, b.y, rows, partners),
                                );
                            let sum = lost.unwrap_or([zero; 2]);
                            lost = Some([
                                sum[0] + L::select(breaks, x, zero),
                                sum[1] + L::select(breaks, share, zero),
                            ]);
                            if motion.breakage == Breakage::BeforeForce {
                                pull = pull.zero_if(breaks);
                            }
                        }
                        pull = pull + v.repel(&b, j.volume, rows, partners).0;
                    }
                }
                for a in 0..D {
                    acc[a] = pull.fma(b.y[a], acc[a]);
                }
            }
            for a in 0..D {
                scatter(acc[a], self.f[a], rows, 1);
            }
            if FULL {
                let material = |l: usize| {
                    let slot = *rows.add(l) as usize;
                    self.material.get(slot).map_or(0, |m| *m as usize)
                };
                let alone = history::alone::<L, W>(i.critical);
                let next = if v.paired {
                    let lonely = lowest.ge(L::splat(f64::INFINITY));
                    L::select(lonely, alone, history::critical(greatest))
                } else {
                    history::next_critical(self.toughness, material, lowest, alone)
                };
                scatter(next, self.next, rows, 1);
                if let (Some(lost), Some(motion)) = (lost, self.motion) {
                    let growth = if W::SHARES {
                        self.growth::<L>(slice, &i, &motion)
                    } else {
                        zero
                    };
                    let kappa = v.volume::<L>(rows);
                    let q = v.pressure_factor(rows, i.field[1]) * kappa;
                    let own = [i.field[0] * kappa, i.field[1]];
                    let energy = history::released::<L, W>(q, own, lost, growth) * i.volume;
                    for x in energy.to_array() {
                        tally.released.of(W::SHARES, x);
                    }
                }
            }
        }
    }
}

impl<const D: usize, W: Law, const FULL: bool> Forces<'_, D, W, FULL> {
    /// Growth of `Σ k r0² s` of whole bonds in half a step: `½Δt Σ k (ξ+η)·(v_j − v_i)/(1 + s)`.
    #[inline(always)]
    unsafe fn growth<L: Lane>(&self, slice: usize, i: &End<L, D>, motion: &Motion<D>) -> L {
        let v = &self.view;
        let mut sum = L::splat(0.0);
        // SAFETY: as in the force pass
        unsafe {
            let rows = v.rows(slice);
            for line in v.list.start[slice]..v.list.start[slice + 1] {
                let partners = v.partners(line);
                let b = v.bond::<L>(i, &v.end::<L, false>(partners), rows, partners);
                let dead = L::dead(*v.alive.at(line));
                let current = L::splat(1.0) + Stretch::exact(b.e);
                let rate = parting(motion.v, b.y, rows, partners).div(current);
                sum = sum + (b.k * rate).zero_if(dead);
            }
        }
        L::splat(motion.half_step()) * sum
    }
}

/// `(ξ+η)·(v_j − v_i)`; `y` points from i to j.
#[inline(always)]
unsafe fn parting<L: Lane, const D: usize>(
    v: FieldView<D>,
    y: [L; D],
    rows: *const u32,
    partners: *const u32,
) -> L {
    let mut rate = L::splat(0.0);
    for a in 0..D {
        let mut relative = [0.0; TILE];
        for (l, r) in relative.iter_mut().enumerate() {
            // SAFETY: rows and partners are slots
            unsafe { *r = v[a][*partners.add(l) as usize] - v[a][*rows.add(l) as usize] };
        }
        // SAFETY: a number per lane
        rate = y[a].fma(unsafe { L::load(relative.as_ptr()) }, rate);
    }
    rate
}
