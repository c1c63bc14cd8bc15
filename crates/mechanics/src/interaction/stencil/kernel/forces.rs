//! The force pass: what every bond pulls, which bonds break, and the new critical stretch.

use super::chunk::{CHUNK, Chunk};
use super::offsets::Offsets;
use super::{Bond, MOST, View};
use crate::body::FieldView;
use crate::execute::blocks::Shared;
use crate::execute::lane::series::{Extension, Function, Series, Stretch};
use crate::execute::lane::{Lane, Piece, TILE};
use crate::execute::simd::Kernel;
use crate::interaction::scale::TileFactors;
use crate::interaction::{BlockTally, Motion, Toughness, history};
use crate::law::Law;
use crate::spec::Breakage;
use std::mem::MaybeUninit;

/// Bonds that a hot loop left for later.
type Waiting = [MaybeUninit<u16>; MOST];

/// Force pass; `FULL` with breaking and repulsion.
pub struct Forces<'a, const D: usize, W, const FULL: bool> {
    pub view: View<'a, D, W>,
    /// What breaking writes: bits of whole bonds, and the tiles that have lost one.
    pub alive: Shared<u8>,
    pub state: Shared<u8>,
    pub f: [Shared; D],
    pub critical: &'a [f64],
    /// `[tiles][8]`, the next critical stretch; none once it cannot change any more.
    pub next: Option<Shared>,
    pub toughness: &'a [Toughness],
    /// Between these values of `e` no whole bond is too close and none breaks.
    pub lower: f64,
    pub upper: f64,
    /// `None`: nothing breaks.
    pub motion: Option<Motion<'a, D>>,
}

impl<const D: usize, W: Law, const FULL: bool> Kernel for Forces<'_, D, W, FULL> {
    type Out = BlockTally;
    type Home = W;

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> BlockTally {
        let v = &self.view;
        let mut tally = BlockTally::default();
        let mut offsets = Offsets::new();
        let mut rare: Waiting = [const { MaybeUninit::uninit() }; MOST];
        for n in v.block(block) {
            // SAFETY: tiles lie inside the arrays, offsets inside the guards; each tile is written by one block
            unsafe {
                match (v.is_intact(n), v.is_scaled(n)) {
                    (true, false) if W::SHARES && v.is_alike(n) => {
                        self.tile::<L, false, true, false>(n, &mut offsets, &mut rare, &mut tally)
                    }
                    (true, false) => {
                        self.tile::<L, false, false, false>(n, &mut offsets, &mut rare, &mut tally)
                    }
                    (false, false) => {
                        self.tile::<L, true, false, false>(n, &mut offsets, &mut rare, &mut tally)
                    }
                    (_, true) => {
                        self.tile::<L, true, false, true>(n, &mut offsets, &mut rare, &mut tally)
                    }
                }
            }
        }
        tally
    }
}

/// The points of a tile.
struct Points<L, const D: usize> {
    /// Number among the active tiles, and the first slot.
    tile: usize,
    i: usize,
    u: [L; D],
    own: [L; 2],
    critical: L,
}

/// The bonds of a tile that waited.
struct Rare<'a, 'b, L, const D: usize, W, const FULL: bool, const SCALED: bool> {
    pass: &'a Forces<'b, D, W, FULL>,
    at: &'a Points<L, D>,
    bonds: &'a [MaybeUninit<u16>],
    scale: TileFactors<'a>,
    acc: &'a mut [L; D],
    tally: &'a mut BlockTally,
}

impl<L: Lane, const D: usize, W: Law, const FULL: bool, const SCALED: bool> Piece
    for Rare<'_, '_, L, D, W, FULL, SCALED>
{
    type Out = ();
    #[inline(always)]
    fn run(self) {
        let (at, bonds, scale) = (self.at, self.bonds, self.scale);
        // SAFETY: the hot loop of this tile left them
        unsafe {
            self.pass
                .rare::<L, SCALED>(at, bonds, scale, self.acc, self.tally)
        }
    }
}

impl<const D: usize, W: Law, const FULL: bool> Forces<'_, D, W, FULL> {
    /// All bonds of a tile. With `ALIKE` all ends of its bonds have the same constant field, with `SCALED` bonds have
    /// factors.
    ///
    /// Where all `e` of a chunk lie between bounds that hold for the whole body, nothing can happen. Else lanes are
    /// looked at one by one: those that break or are too close wait and are added last.
    #[inline(always)]
    unsafe fn tile<L: Lane, const MASKED: bool, const ALIKE: bool, const SCALED: bool>(
        &self,
        tile: usize,
        offsets: &mut Offsets<D>,
        rare: &mut Waiting,
        tally: &mut BlockTally,
    ) {
        let v = &self.view;
        let i = v.slot(tile);
        let series = Series::<Extension>::new();
        // SAFETY: slots and their neighbours lie inside the arrays; at most MOST bonds, checked when the stencil was
        // made
        unsafe {
            let zero = L::splat(0.0);
            let at = Points {
                tile,
                i,
                u: v.displacement::<L>(i),
                own: v.fields::<L>(i),
                critical: if FULL {
                    L::load(self.critical.as_ptr().add(i))
                } else {
                    zero
                },
            };
            let scale = if SCALED {
                v.scale.tile(tile)
            } else {
                TileFactors::NONE
            };
            let (lower, upper) = (L::splat(self.lower), L::splat(self.upper));
            let mut lowest = L::splat(f64::INFINITY);
            let (mut acc, mut total) = ([zero; D], zero);
            let mut waiting = 0;
            let (mut chunk, mut near) = (Chunk::<L>::new(), Chunk::<L>::new());
            let mut word = 0;
            while word < v.reach(tile).len() {
                let (bonds, next) = offsets.stretch(v.stencil(tile), v.reach(tile), word);
                word = next;
                for bonds in bonds.chunks(CHUNK) {
                    let mut left_out = MASKED;
                    let x = chunk.deform::<D, W, MASKED, FULL>(v, bonds, v.row(tile), i, &at.u);
                    if FULL {
                        lowest = x.low.min(lowest);
                        let outside = L::or(x.low.lt(lower), upper.lt(x.high));
                        if L::any(L::or(x.close, outside)) {
                            let close = L::any(x.close);
                            for (c, b) in bonds.iter().enumerate() {
                                let e = chunk.get(c);
                                let raw = if close { v.deform(b, i, &at.u) } else { e };
                                let aside = self.aside(&at, b, e, raw);
                                if L::any(aside) {
                                    chunk.leave_out(c, aside);
                                    rare.get_unchecked_mut(waiting).write(b.number as u16);
                                    waiting += 1;
                                    left_out = true;
                                }
                            }
                        }
                    }
                    let answer = chunk.each(bonds.len(), series, &x, &mut near);
                    if left_out {
                        self.gather::<L, true, ALIKE, SCALED>(
                            &at, bonds, scale, answer, &mut acc, &mut total,
                        );
                    } else {
                        self.gather::<L, false, ALIKE, SCALED>(
                            &at, bonds, scale, answer, &mut acc, &mut total,
                        );
                    }
                }
            }
            for a in 0..D {
                acc[a] = total.fma(at.u[a], acc[a]);
            }
            if FULL && waiting > 0 {
                L::out_of_line(Rare::<L, D, W, FULL, SCALED> {
                    pass: self,
                    at: &at,
                    bonds: &rare[..waiting],
                    scale,
                    acc: &mut acc,
                    tally,
                });
            }
            for a in 0..D {
                // what was summed points from j to i
                (zero - acc[a]).store(self.f[a].at(i));
            }
            if let (true, Some(out)) = (FULL, self.next) {
                let material = |l: usize| v.body.material_of(i + l);
                let alone = history::alone::<L, W>(at.critical);
                let next = history::next_critical(self.toughness, material, lowest, alone);
                next.store(out.at(tile * TILE));
                for x in &next.to_array() {
                    tally.least_critical = tally.least_critical.min(*x);
                }
            }
        }
    }

    /// Add what the bonds of a chunk pull, as `−Σ p (ξ + u_j)` and `Σ p`: less to keep in registers than `u_i` and the
    /// sum (rounding of `e` costs more digits than this difference). With `MASKED`, not in lanes that were left out.
    #[inline(always)]
    unsafe fn gather<L: Lane, const MASKED: bool, const ALIKE: bool, const SCALED: bool>(
        &self,
        at: &Points<L, D>,
        bonds: &[Bond<D>],
        scale: TileFactors,
        answer: &Chunk<L>,
        acc: &mut [L; D],
        total: &mut L,
    ) {
        let v = &self.view;
        let (mut sum, mut all) = (*acc, *total);
        for (c, b) in bonds.iter().enumerate() {
            // SAFETY: as in the first loop, which wrote every bond of the chunk
            unsafe {
                let g = answer.get(c);
                let other = if ALIKE {
                    [L::load(v.fields[0].as_ptr().add(b.to(at.i))), at.own[1]]
                } else {
                    v.fields::<L>(b.to(at.i))
                };
                let mut pull = self.pull::<L, SCALED>(b, g, at.own, other, scale);
                if MASKED {
                    pull = pull.zero_if(g.is_nan());
                }
                let u = v.displacement::<L>(b.to(at.i));
                for a in 0..D {
                    sum[a] = pull.fma(L::splat(b.back[a]) - u[a], sum[a]);
                }
                all = pull + all;
            }
        }
        (*acc, *total) = (sum, all);
    }

    /// Coefficient of `ξ + η`.
    #[inline(always)]
    unsafe fn pull<L: Lane, const SCALED: bool>(
        &self,
        b: &Bond<D>,
        g: L,
        own: [L; 2],
        other: [L; 2],
        scale: TileFactors,
    ) -> L {
        let (law, k) = (self.view.law, L::splat(b.k));
        let n = b.number as usize;
        // SAFETY: a bond of the stencil, of a tile with factors where they are read
        unsafe {
            match (SCALED, W::SHARES) {
                (false, _) => law.pull(k, g, own, other),
                (true, true) => law.scaled_pull(k, g, own, other, scale.all(n)),
                (true, false) => law.pull(k, g, own, other) * scale.pair(n),
            }
        }
    }

    /// Lanes whose bond breaks, or whose ends are too close, whole or not; `e` where the bond is whole, `raw` always.
    #[inline(always)]
    unsafe fn aside<L: Lane>(&self, at: &Points<L, D>, b: &Bond<D>, e: L, raw: L) -> L::Mask {
        // SAFETY: offsets stay inside the guards
        let other = unsafe { L::load(self.critical.as_ptr().add(b.to(at.i))) };
        let breaks = history::limit(other, at.critical).lt(e);
        L::or(breaks, raw.lt(L::splat(b.contact_e)))
    }

    /// Growth of `Σ k r0² s` of whole bonds in half a step: `½Δt Σ k (ξ+η)·(v_j − v_i)/(1 + s)`.
    #[inline(always)]
    unsafe fn growth<L: Lane, const SCALED: bool>(
        &self,
        at: &Points<L, D>,
        motion: &Motion<D>,
        scale: TileFactors,
    ) -> L {
        let v = &self.view;
        let one = L::splat(1.0);
        let mut sum = L::splat(0.0);
        // SAFETY: as in the hot loop
        unsafe {
            for b in v.stencil(at.tile) {
                let dead = L::dead(*v.row(at.tile).add(b.number as usize));
                let j = b.to(at.i);
                let s = Stretch::exact(v.deform(b, at.i, &at.u));
                let mut k = L::splat(b.k);
                if SCALED {
                    k = k * scale.own(b.number as usize);
                }
                let y = v.direction(b, at.i, &at.u);
                let rate = k * parting(motion.v, y, at.i, j).div(one + s);
                sum = sum + rate.zero_if(dead);
            }
        }
        L::splat(motion.half_step()) * sum
    }

    /// The lanes that waited: repulsion, breaking.
    #[inline(always)]
    unsafe fn rare<L: Lane, const SCALED: bool>(
        &self,
        at: &Points<L, D>,
        rare: &[MaybeUninit<u16>],
        scale: TileFactors,
        acc: &mut [L; D],
        tally: &mut BlockTally,
    ) {
        let v = &self.view;
        let (i, own) = (at.i, at.own);
        let bonds = v.stencil(at.tile);
        let partners = &v.partners[v.sublattice(at.tile)];
        let zero = L::splat(0.0);
        // broken bonds: Σ x and Σ k r0² s
        let mut lost: Option<[L; 2]> = None;
        // SAFETY: as in the hot loop
        unsafe {
            for n in rare {
                // the hot loop wrote them
                let n = n.assume_init() as usize;
                let (b, bits) = (&bonds[n], v.row(at.tile).add(n));
                let j = b.to(i);
                let y = v.direction(b, i, &at.u);
                let raw = v.deform(b, i, &at.u);
                let dead = L::dead(*bits);
                let e = raw.nan_if(dead);
                let aside = self.aside(at, b, e, raw);
                let other = v.fields::<L>(j);
                let g = Extension::exact(e);
                let own_pull = self
                    .pull::<L, SCALED>(b, g, own, other, scale)
                    .zero_if(dead);
                let mut pull = L::select(aside, own_pull, zero);
                if let Some(motion) = self.motion {
                    let limit = L::load(self.critical.as_ptr().add(j));
                    let breaks = history::limit(limit, at.critical).lt(e);
                    let which = L::bits(breaks);
                    if which != 0 {
                        *self.alive.at(at.tile * v.width + n) &= !(which as u8);
                        *self.state.at(at.tile) = 0;
                        tally.broken += which.count_ones() as u64;
                        let s = Stretch::exact(e);
                        let mut share = L::splat(b.share) * s;
                        let mut pair = share * s;
                        if SCALED {
                            pair = pair * scale.pair(n);
                            if W::SHARES {
                                share = share * scale.own(n);
                            }
                        }
                        let held = v.law.pair_energy(pair, own, other)
                            + motion.breaking_correction(own_pull, parting(motion.v, y, i, j));
                        let sum = lost.unwrap_or([zero; 2]);
                        lost = Some([
                            sum[0] + L::select(breaks, held, zero),
                            sum[1] + L::select(breaks, share, zero),
                        ]);
                        if motion.breakage == Breakage::BeforeForce {
                            pull = pull.zero_if(breaks);
                        }
                    }
                }
                let close = raw.lt(L::splat(b.contact_e));
                if L::any(close) {
                    pull = pull + v.repel(&partners[n], i, raw, close).0;
                }
                for a in 0..D {
                    acc[a] = pull.fma(y[a], acc[a]);
                }
            }
            if let (Some(lost), Some(motion)) = (lost, self.motion) {
                let growth = if W::SHARES {
                    self.growth::<L, SCALED>(at, &motion, scale)
                } else {
                    zero
                };
                let energy = history::released::<L, W>(v.pressure_factor(i), own, lost, growth);
                for (l, x) in energy.to_array().iter().enumerate() {
                    tally.released.of(W::SHARES, x * v.body.volume.at(i + l));
                }
            }
        }
    }
}

/// `(ξ+η)·(v_j − v_i)`; `y` points from j to i.
#[inline(always)]
unsafe fn parting<L: Lane, const D: usize>(v: FieldView<D>, y: [L; D], i: usize, j: usize) -> L {
    let mut rate = L::splat(0.0);
    for a in 0..D {
        // SAFETY: slots lie inside the arrays
        let relative = unsafe { L::load(v[a].as_ptr().add(i)) - L::load(v[a].as_ptr().add(j)) };
        rate = y[a].fma(relative, rate);
    }
    rate
}

/// After a force pass: the next critical stretches take the place of the old.
pub struct Remember<'a, const D: usize, W> {
    pub view: View<'a, D, W>,
    pub next: &'a [f64],
    pub critical: Shared,
}

impl<const D: usize, W: Law> Kernel for Remember<'_, D, W> {
    type Out = ();
    type Home = W;

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        for n in self.view.block(block) {
            // SAFETY: there are eight numbers per active tile, and tiles lie inside the arrays
            unsafe {
                L::load(self.next.as_ptr().add(n * TILE))
                    .store(self.critical.at(self.view.slot(n)));
            }
        }
    }
}
