//! Any law on a lattice stencil: tiles of eight points walk the offsets together; one bit per bond is all that is
//! stored.

use super::bond::{critical_stretch, deform};
use super::{
    BondState, Interaction, PointConstants, PointEnergies, Repulsion, Sweep, Tally, Toughness,
    history,
};
use crate::body::{Body, Field, Grid, Layout};
use crate::execute::blocks::{Shared, for_each_block};
use crate::execute::lane::{self, Lane, TILE};
use crate::execute::simd::{Kernel, Simd};
use crate::family::offsets::OffsetSet;
use crate::family::stencil::Stencil;
use crate::law::Law;
use crate::spec::CrackKind;

/// Tiles per block of work.
const BLOCK: usize = 32;

/// A bond of the stencil with its constants.
#[derive(Debug, Clone, Copy)]
#[repr(C)] // what the hot loop reads comes first
struct Bond<const D: usize> {
    /// Slots from i to j.
    shift: isize,
    xi: [f64; D],
    inv_r0_squared: f64,
    k: f64,
    /// Repulsion acts where `e` is below this; −1 without repulsion.
    contact_e: f64,
    r0_squared: f64,
    contact_distance: f64,
    cell: [i32; D],
    to: usize,
}

/// A law on a stencil.
pub struct StencilInteraction<const D: usize, W: Law> {
    law: W,
    simd: Simd,
    /// Per sublattice.
    bonds: Vec<Vec<Bond<D>>>,
    /// The offsets of `bonds`.
    offsets: OffsetSet<D>,
    /// Bytes per tile in `alive`: the longest stencil.
    width: usize,
    /// Tiles that have points.
    tiles: Vec<u32>,
    /// `[tiles][width]`: bit l of a byte is the bond of point l of the tile.
    alive: Vec<u8>,
    /// Family size per active tile and lane.
    family: Vec<u16>,
    directed: u64,
    /// Point fields of the law, per slot (empty where unused).
    fields: [Vec<f64>; 2],
    /// Pressure factors per slot where materials differ; else the law's own.
    pressure: Vec<f64>,
    point_constants: PointConstants,
    toughness: Vec<Toughness>,
    repulsion: Option<Repulsion>,
    /// Critical `e` per slot, now and next.
    critical: Vec<f64>,
    next: Vec<f64>,
    volume: f64,
    guard: usize,
    tallies: Vec<Tally>,
    unit: Vec<()>,
    sums: Vec<[f64; 2]>,
}

/// Everything a stencil interaction is made of.
pub struct StencilParts<'a, const D: usize, W> {
    pub body: &'a Body<D>,
    pub grid: &'a Grid<D>,
    pub stencil: &'a Stencil,
    pub law: W,
    /// `ω ν` of a bond of this length.
    pub weight: &'a dyn Fn(f64) -> f64,
    pub point_constants: PointConstants,
    pub toughness: Vec<Toughness>,
    pub repulsion: Option<Repulsion>,
    pub simd: Simd,
}

impl<const D: usize, W: Law> StencilInteraction<D, W> {
    pub fn new(parts: StencilParts<D, W>) -> Self {
        let StencilParts {
            body,
            grid,
            stencil,
            law,
            weight,
            point_constants,
            toughness,
            repulsion,
            simd,
        } = parts;
        let volume = body
            .volume
            .uniform()
            .expect("a lattice body has one volume");
        let h = grid.lattice.spacing;
        let edges = grid.lattice.kind.edges();
        let bonds: Vec<Vec<Bond<D>>> = stencil
            .offsets
            .iter()
            .enumerate()
            .map(|(from, list)| {
                list.iter()
                    .map(|o| {
                        let xi: [f64; D] =
                            std::array::from_fn(|a| h * edges[a] * (o.quarter[a] as f64 / 4.0));
                        let r0_squared = h * h * (o.squared as f64 / 16.0);
                        let r0 = r0_squared.sqrt();
                        let d = repulsion.map_or(0.0, |c| c.distance(r0));
                        let cell: [i32; D] = std::array::from_fn(|a| o.cell[a]);
                        Bond {
                            shift: grid.shift(cell.map(i64::from), o.to as i64 - from as i64)
                                as isize,
                            xi,
                            inv_r0_squared: 1.0 / r0_squared,
                            k: law.constant(r0, 1.0 / r0, weight(r0) * volume),
                            r0_squared,
                            contact_e: d * d / r0_squared - 1.0,
                            contact_distance: d,
                            cell,
                            to: o.to,
                        }
                    })
                    .collect()
            })
            .collect();
        let width = stencil.bonds();
        let tiles: Vec<u32> = (0..grid.tiles())
            .filter(|t| grid.owned[*t] != 0)
            .map(|t| t as u32)
            .collect();
        let mut alive = vec![0u8; tiles.len() * width];
        let mut family = vec![0u16; tiles.len() * TILE];
        let mut directed = 0;
        for (n, &t) in tiles.iter().enumerate() {
            let first = grid.tile_slot(t as usize);
            let sub = grid.tile_sublattice(t as usize);
            for l in 0..TILE {
                if !grid.is_owned(first + l) {
                    continue;
                }
                for (k, b) in bonds[sub].iter().enumerate() {
                    if grid.neighbour(first + l, b.cell, b.to).is_some() {
                        alive[n * width + k] |= 1 << l;
                        family[n * TILE + l] += 1;
                        directed += 1;
                    }
                }
            }
        }
        let remembers = repulsion.is_some() || toughness.iter().any(|t| t.s00.is_finite());
        let critical = if remembers {
            vec![f64::INFINITY; body.len]
        } else {
            vec![]
        };
        let blocks = tiles.len().div_ceil(BLOCK);
        StencilInteraction {
            law,
            simd,
            offsets: OffsetSet::new(grid, &bonds, |b| (b.cell, b.to)),
            bonds,
            width,
            tiles,
            alive,
            family,
            directed,
            fields: [vec![], vec![]],
            pressure: vec![],
            point_constants,
            toughness,
            repulsion,
            next: critical.clone(),
            critical,
            volume,
            guard: grid.guard,
            tallies: vec![Tally::default(); blocks],
            unit: vec![(); blocks],
            sums: vec![[0.0; 2]; blocks],
        }
    }

    fn view<'a>(&'a self, body: &'a Body<D>, u: &'a Field<D>) -> View<'a, D, W> {
        let Layout::Grid(grid) = &body.layout else {
            unreachable!("stencils live on grids")
        };
        View {
            law: self.law,
            grid,
            body,
            bonds: &self.bonds,
            width: self.width,
            tiles: &self.tiles,
            alive: &self.alive,
            u: std::array::from_fn(|a| u[a].as_slice()),
            fields: [&self.fields[0], &self.fields[1]],
            volume: self.volume,
            repulsion: self.repulsion,
        }
    }

    fn sweep<const FULL: bool>(
        &mut self,
        body: &Body<D>,
        u: &Field<D>,
        f: &mut Field<D>,
        motion: Option<(&Field<D>, f64)>,
    ) {
        let mut tallies = std::mem::take(&mut self.tallies);
        let kernel = Forces::<D, W, FULL> {
            view: self.view(body, u),
            f: std::array::from_fn(|a| Shared(f[a].as_mut_ptr())),
            critical: &self.critical,
            next: Shared(self.next.as_ptr().cast_mut()),
            memory: Shared(self.alive.as_ptr().cast_mut()),
            toughness: &self.toughness,
            pressure: &self.pressure,
            motion,
        };
        for_each_block(self.simd, &kernel, &mut tallies);
        self.tallies = tallies;
    }

    /// θ over `Σ k r0² s` at a slot: `n/m`, from `β/m`.
    fn dilatation_factor(&self, body: &Body<D>, slot: usize) -> f64 {
        match &self.point_constants {
            PointConstants::Solid(s) => {
                let s = s[body.material_of(slot)];
                s.n / s.beta * self.fields[1][slot]
            }
            _ => 0.0,
        }
    }

    fn row(&self, n: usize) -> &[u8] {
        &self.alive[n * self.width..(n + 1) * self.width]
    }
}

/// What all kernels read.
struct View<'a, const D: usize, W> {
    law: W,
    grid: &'a Grid<D>,
    body: &'a Body<D>,
    bonds: &'a [Vec<Bond<D>>],
    width: usize,
    tiles: &'a [u32],
    alive: &'a [u8],
    u: [&'a [f64]; D],
    fields: [&'a [f64]; 2],
    volume: f64,
    repulsion: Option<Repulsion>,
}

impl<const D: usize, W: Law> View<'_, D, W> {
    #[inline(always)]
    unsafe fn displacement<L: Lane>(&self, slot: usize) -> [L; D] {
        // SAFETY: slots and their neighbours lie between the guards
        std::array::from_fn(|a| unsafe { L::load(self.u[a].as_ptr().add(slot)) })
    }

    #[inline(always)]
    unsafe fn fields<L: Lane>(&self, slot: usize) -> [L; 2] {
        std::array::from_fn(|a| {
            if a < W::FIELDS {
                unsafe { L::load(self.fields[a].as_ptr().add(slot)) }
            } else {
                L::splat(0.0)
            }
        })
    }

    /// `ξ+η` and `e` of bond `b` for the points at `i`.
    #[inline(always)]
    unsafe fn deform<L: Lane>(&self, b: &Bond<D>, i: usize, ui: &[L; D]) -> ([L; D], L) {
        let j = i.wrapping_add_signed(b.shift);
        let uj = unsafe { self.displacement::<L>(j) };
        let eta = std::array::from_fn(|a| uj[a] - ui[a]);
        deform(eta, b.xi.map(L::splat), L::splat(b.inv_r0_squared))
    }

    fn block(&self, block: usize) -> std::ops::Range<usize> {
        block * BLOCK..((block + 1) * BLOCK).min(self.tiles.len())
    }

    /// Coefficient of `ξ+η` from repulsion in the lanes that are closer than allowed and really there, and their
    /// energy density.
    #[inline(always)]
    fn repel<L: Lane>(&self, b: &Bond<D>, i: usize, e: L, close: L::Mask) -> (L, L) {
        let Some(c) = self.repulsion else {
            return (L::splat(0.0), L::splat(0.0));
        };
        let mut there = 0u8;
        for l in 0..L::N {
            if L::bits(close) >> l & 1 == 1
                && self.grid.is_owned(i + l)
                && self.grid.neighbour(i + l, b.cell, b.to).is_some()
            {
                there |= 1 << l;
            }
        }
        let absent = L::dead(there, 0);
        let r = (L::splat(b.r0_squared) * (L::splat(1.0) + e)).sqrt();
        let d = L::splat(b.contact_distance);
        let pull = (L::splat(c.stiffness * self.volume) * (r - d)).div(r);
        let energy = L::splat(0.5 * c.stiffness * self.volume) * (r - d) * (r - d) * L::splat(0.5);
        (pull.zero_if(absent), energy.zero_if(absent))
    }
}

/// Force pass; `FULL` with breaking and repulsion.
struct Forces<'a, const D: usize, W, const FULL: bool> {
    view: View<'a, D, W>,
    f: [Shared; D],
    critical: &'a [f64],
    next: Shared,
    memory: Shared<u8>,
    toughness: &'a [Toughness],
    pressure: &'a [f64],
    /// Velocity of the step's middle, and the step; none if bonds must not break.
    motion: Option<(&'a Field<D>, f64)>,
}

impl<const D: usize, W: Law, const FULL: bool> Kernel for Forces<'_, D, W, FULL> {
    type Out = Tally;

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> Tally {
        let v = &self.view;
        let mut tally = Tally::default();
        for n in v.block(block) {
            let tile = v.tiles[n] as usize;
            let bonds = v.bonds[v.grid.tile_sublattice(tile)].as_slice();
            // SAFETY: tiles lie inside the arrays, offsets inside the guards; each tile is written by one block
            unsafe {
                let row =
                    std::slice::from_raw_parts_mut(self.memory.0.add(n * v.width), bonds.len());
                let whole = row.iter().all(|b| *b == 0xff);
                for part in 0..TILE / L::N {
                    let i = v.grid.tile_slot(tile) + part * L::N;
                    if whole {
                        self.points::<L, false>(bonds, row, i, part, &mut tally);
                    } else {
                        self.points::<L, true>(bonds, row, i, part, &mut tally);
                    }
                }
            }
        }
        tally
    }
}

impl<const D: usize, W: Law, const FULL: bool> Forces<'_, D, W, FULL> {
    /// All bonds of the `N` points at slot `i`.
    #[inline(always)]
    unsafe fn points<L: Lane, const MASKED: bool>(
        &self,
        bonds: &[Bond<D>],
        row: &mut [u8],
        i: usize,
        part: usize,
        tally: &mut Tally,
    ) {
        let v = &self.view;
        unsafe {
            let zero = L::splat(0.0);
            let ui = v.displacement::<L>(i);
            let own = v.fields::<L>(i);
            let critical_i = if FULL {
                L::load(self.critical.as_ptr().add(i))
            } else {
                zero
            };
            let mut lowest = L::splat(f64::INFINITY);
            let mut acc = [zero; D];
            // broken bonds: Σ x and Σ k r0² s, rare
            let mut lost: Option<[L; 2]> = None;
            for (b, bits) in bonds.iter().zip(row.iter_mut()) {
                let (y, raw) = v.deform(b, i, &ui);
                let dead = L::dead(*bits, part);
                let e = if MASKED { raw.nan_if(dead) } else { raw };
                let j = i.wrapping_add_signed(b.shift);
                let other = v.fields::<L>(j);
                let mut rare = lane::beyond_series(e);
                let mut limit = zero;
                if FULL {
                    limit = L::load(self.critical.as_ptr().add(j)).min(critical_i);
                    rare = L::or(rare, limit.lt(e));
                    lowest = e.min(lowest);
                }
                if FULL && MASKED {
                    rare = L::or(rare, raw.lt(L::splat(b.contact_e)));
                }
                let k = L::splat(b.k);
                let mut pull;
                if L::any(rare) {
                    pull = v.law.pull(k, lane::extension_over_length(e), own, other);
                    if MASKED {
                        pull = pull.zero_if(dead);
                    }
                    if FULL {
                        let close = raw.lt(L::splat(b.contact_e));
                        if L::any(close) {
                            pull = pull + v.repel(b, i, raw, close).0;
                        }
                    }
                    if FULL && self.motion.is_some() {
                        let breaks = limit.lt(e);
                        let which = L::bits(breaks);
                        if which != 0 {
                            *bits &= !((which as u8) << (part * L::N));
                            tally.broken += which.count_ones() as u64;
                            let s = lane::stretch(e);
                            let share = k * L::splat(b.r0_squared) * s;
                            let held = v.law.pair_energy(share * s, own, other)
                                + self.farewell(pull, y, i, j);
                            let x = L::select(breaks, held, zero);
                            let share = L::select(breaks, share, zero);
                            let sum = lost.unwrap_or([zero; 2]);
                            lost = Some([sum[0] + x, sum[1] + share]);
                        }
                    }
                } else {
                    pull = v
                        .law
                        .pull(k, lane::extension_over_length_series(e), own, other);
                    if MASKED {
                        pull = pull.zero_if(dead);
                    }
                }
                for a in 0..D {
                    acc[a] = pull.fma(y[a], acc[a]);
                }
            }
            for a in 0..D {
                acc[a].store(self.f[a].at(i));
            }
            if FULL {
                self.next_critical(i, lowest);
                if let Some(lost) = lost {
                    self.release(i, own, lost, tally);
                }
            }
        }
    }

    /// Energy density that a breaking bond takes from the motion while it pulls once more, over half a step:
    /// half of `½Δt F·(v_j − v_i)`, the other half goes to the partner.
    #[inline(always)]
    unsafe fn farewell<L: Lane>(&self, pull: L, y: [L; D], i: usize, j: usize) -> L {
        let Some((v, dt)) = self.motion else {
            return L::splat(0.0);
        };
        let mut rate = L::splat(0.0);
        for a in 0..D {
            let relative = unsafe { L::load(v[a].as_ptr().add(j)) - L::load(v[a].as_ptr().add(i)) };
            rate = y[a].fma(relative, rate);
        }
        L::splat(0.25 * dt) * pull * rate
    }

    /// `s0 = s00 − α s_min` for the points at slot `i`, as a critical `e`.
    #[inline(always)]
    unsafe fn next_critical<L: Lane>(&self, i: usize, lowest: L) {
        let material = |l| self.view.body.material_of(i + l);
        let e0 = history::next_critical(self.toughness, material, lowest);
        unsafe { e0.store(self.next.at(i)) };
    }

    /// Energy of the bonds that the points at `i` just lost, from `Σ x` and `Σ k r0² s` over them.
    #[inline(always)]
    unsafe fn release<L: Lane>(&self, i: usize, own: [L; 2], lost: [L; 2], tally: &mut Tally) {
        let q: L = unsafe { pressure_factor(&self.view, self.pressure, i) };
        let energy = history::released::<L, W>(q, own, lost);
        // one by one: the order of the sum must not depend on the width
        for x in &energy.to_array()[..L::N] {
            tally.released += x * self.view.volume;
        }
    }
}

/// Share pass: `P = q Σ k r0² s` into field 0.
struct Share<'a, const D: usize, W> {
    view: View<'a, D, W>,
    out: Shared,
    pressure: &'a [f64],
}

impl<const D: usize, W: Law> Kernel for Share<'_, D, W> {
    type Out = ();

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        let v = &self.view;
        for n in v.block(block) {
            let tile = v.tiles[n] as usize;
            let bonds = v.bonds[v.grid.tile_sublattice(tile)].as_slice();
            let row = &v.alive[n * v.width..n * v.width + bonds.len()];
            let whole = row.iter().all(|b| *b == 0xff);
            for part in 0..TILE / L::N {
                let i = v.grid.tile_slot(tile) + part * L::N;
                // SAFETY: as in the force pass
                unsafe {
                    let sum = if whole {
                        self.sum::<L, false>(bonds, row, i, part)
                    } else {
                        self.sum::<L, true>(bonds, row, i, part)
                    };
                    let q: L = pressure_factor(v, self.pressure, i);
                    (q * sum).store(self.out.at(i));
                }
            }
        }
    }
}

impl<const D: usize, W: Law> Share<'_, D, W> {
    #[inline(always)]
    unsafe fn sum<L: Lane, const MASKED: bool>(
        &self,
        bonds: &[Bond<D>],
        row: &[u8],
        i: usize,
        part: usize,
    ) -> L {
        let v = &self.view;
        unsafe {
            let ui = v.displacement::<L>(i);
            let mut sum = L::splat(0.0);
            for (b, bits) in bonds.iter().zip(row) {
                let (_, raw) = v.deform(b, i, &ui);
                let dead = L::dead(*bits, part);
                let e = if MASKED { raw.nan_if(dead) } else { raw };
                let mut s = if L::any(lane::beyond_series(e)) {
                    lane::stretch(e)
                } else {
                    lane::stretch_series(e)
                };
                if MASKED {
                    s = s.zero_if(dead);
                }
                sum = L::splat(b.k * b.r0_squared).fma(s, sum);
            }
            sum
        }
    }
}

/// Energy pass: strain and repulsion energy density, `Σ k r0² s` and `Σ k r0²` over whole bonds. Sums are returned,
/// fields are written where wanted.
struct Energies<'a, const D: usize, W> {
    view: View<'a, D, W>,
    pressure: &'a [f64],
    fields: Option<EnergyFields>,
}

#[derive(Clone, Copy)]
struct EnergyFields {
    strain: Shared,
    repulsion: Shared,
    share: Shared,
    weight: Shared,
}

impl<const D: usize, W: Law> Kernel for Energies<'_, D, W> {
    /// Strain and repulsion energy of the block (energy).
    type Out = [f64; 2];

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> [f64; 2] {
        let v = &self.view;
        let mut sums = [0.0; 2];
        for n in v.block(block) {
            let tile = v.tiles[n] as usize;
            let bonds = v.bonds[v.grid.tile_sublattice(tile)].as_slice();
            for part in 0..TILE / L::N {
                let i = v.grid.tile_slot(tile) + part * L::N;
                // SAFETY: as in the force pass
                unsafe {
                    let zero = L::splat(0.0);
                    let ui = v.displacement::<L>(i);
                    let own = v.fields::<L>(i);
                    let (mut strain, mut repulsion, mut share, mut weight) =
                        (zero, zero, zero, zero);
                    for (k, b) in bonds.iter().enumerate() {
                        let (_, e) = v.deform(b, i, &ui);
                        let dead = L::dead(v.alive[n * v.width + k], part);
                        let s = lane::stretch(e.nan_if(dead)).zero_if(dead);
                        let kr = L::splat(b.k * b.r0_squared);
                        let other = v.fields::<L>(i.wrapping_add_signed(b.shift));
                        strain = strain + v.law.pair_energy(kr * s * s, own, other).zero_if(dead);
                        share = kr.fma(s, share);
                        weight = weight + kr.zero_if(dead);
                        if v.repulsion.is_some() {
                            let close = e.lt(L::splat(b.contact_e));
                            if L::any(close) {
                                repulsion = repulsion + v.repel(b, i, e, close).1;
                            }
                        }
                    }
                    if W::SHARES {
                        let q = pressure_factor(v, self.pressure, i);
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

/// `P / Σ k r0² s` of the points at slot `i`.
#[inline(always)]
unsafe fn pressure_factor<L: Lane, const D: usize, W: Law>(
    v: &View<D, W>,
    factors: &[f64],
    i: usize,
) -> L {
    // SAFETY: slots lie inside the arrays
    unsafe {
        if factors.is_empty() {
            v.law.pressure_factor(L::load(v.fields[1].as_ptr().add(i)))
        } else {
            L::load(factors.as_ptr().add(i))
        }
    }
}

impl<const D: usize, W: Law> Interaction<D> for StencilInteraction<D, W> {
    fn forces(&mut self, body: &Body<D>, u: &Field<D>, f: &mut Field<D>, sweep: Sweep<D>) -> Tally {
        if W::SHARES {
            let mut unit = std::mem::take(&mut self.unit);
            let mut pressure = std::mem::take(&mut self.fields[0]);
            let kernel = Share {
                view: self.view(body, u),
                out: Shared(pressure.as_mut_ptr()),
                pressure: &self.pressure,
            };
            for_each_block(self.simd, &kernel, &mut unit);
            body.fill_images(&mut pressure);
            self.fields[0] = pressure;
            self.unit = unit;
        }
        let motion = match sweep {
            Sweep::Evolve { v, dt } => Some((v, dt)),
            Sweep::Hold => None,
        };
        if self.critical.is_empty() {
            self.sweep::<false>(body, u, f, motion);
        } else {
            self.sweep::<true>(body, u, f, motion);
        }
        if motion.is_some() && !self.critical.is_empty() {
            std::mem::swap(&mut self.critical, &mut self.next);
            body.fill_images(&mut self.critical);
        }
        let mut total = Tally::default();
        for t in &self.tallies {
            total += *t;
        }
        total
    }

    fn energy(&mut self, body: &Body<D>, u: &Field<D>) -> [f64; 2] {
        let mut sums = std::mem::take(&mut self.sums);
        let kernel = Energies {
            view: self.view(body, u),
            pressure: &self.pressure,
            fields: None,
        };
        for_each_block(self.simd, &kernel, &mut sums);
        self.sums = sums;
        self.sums
            .iter()
            .fold([0.0; 2], |t, s| [t[0] + s[0], t[1] + s[1]])
    }

    fn observe(&self, body: &Body<D>, u: &Field<D>, out: &mut PointEnergies) {
        let mut share = vec![0.0; body.len];
        let mut weight = vec![0.0; body.len];
        for field in [&mut out.strain, &mut out.repulsion, &mut out.dilatation] {
            field.clear();
            field.resize(body.len, 0.0);
        }
        let kernel = Energies {
            view: self.view(body, u),
            pressure: &self.pressure,
            fields: Some(EnergyFields {
                strain: Shared(out.strain.as_mut_ptr()),
                repulsion: Shared(out.repulsion.as_mut_ptr()),
                share: Shared(share.as_mut_ptr()),
                weight: Shared(weight.as_mut_ptr()),
            }),
        };
        for_each_block(self.simd, &kernel, &mut vec![[0.0; 2]; self.tallies.len()]);
        for &slot in &body.slots {
            let i = slot as usize;
            if W::SHARES {
                out.dilatation[i] = self.dilatation_factor(body, i) * share[i];
            } else if weight[i] > 0.0 {
                out.dilatation[i] = D as f64 * share[i] / weight[i];
            }
        }
    }

    fn each_bond(&self, body: &Body<D>, visit: &mut dyn FnMut(usize, usize, [f64; D], BondState)) {
        let Layout::Grid(grid) = &body.layout else {
            unreachable!("stencils live on grids")
        };
        let mut original: std::collections::HashMap<u32, u32> = std::collections::HashMap::new();
        original.extend(body.images.iter().copied());
        for (n, &t) in self.tiles.iter().enumerate() {
            let first = grid.tile_slot(t as usize);
            for l in 0..TILE {
                if !grid.is_owned(first + l) {
                    continue;
                }
                for (k, b) in self.bonds[grid.tile_sublattice(t as usize)]
                    .iter()
                    .enumerate()
                {
                    let Some(j) = grid.neighbour(first + l, b.cell, b.to) else {
                        continue;
                    };
                    let j = original.get(&(j as u32)).map_or(j, |o| *o as usize);
                    // a bond between a point and its own image counts from one side only
                    if first + l < j || (first + l == j && b.shift > 0) {
                        let state = if self.row(n)[k] >> l & 1 == 1 {
                            BondState::Whole
                        } else {
                            BondState::Broken
                        };
                        visit(first + l, j, b.xi, state);
                    }
                }
            }
        }
    }

    fn damage(&self, body: &Body<D>, out: &mut [f64]) {
        let Layout::Grid(grid) = &body.layout else {
            unreachable!("stencils live on grids")
        };
        for (n, &t) in self.tiles.iter().enumerate() {
            let mut whole = [0u32; TILE];
            for b in self.row(n) {
                for (l, w) in whole.iter_mut().enumerate() {
                    *w += (b >> l & 1) as u32;
                }
            }
            for l in 0..TILE {
                let family = self.family[n * TILE + l];
                let slot = grid.tile_slot(t as usize) + l;
                out[slot] = if family == 0 {
                    0.0
                } else {
                    1.0 - whole[l] as f64 / family as f64
                };
            }
        }
    }

    fn cut(
        &mut self,
        body: &Body<D>,
        kind: CrackKind,
        crosses: &(dyn Fn([f64; D], [f64; D]) -> bool + Sync),
    ) -> u64 {
        let Layout::Grid(grid) = &body.layout else {
            unreachable!("stencils live on grids")
        };
        let original: std::collections::HashMap<u32, u32> = body.images.iter().copied().collect();
        let mut count = 0;
        for n in 0..self.tiles.len() {
            let t = self.tiles[n] as usize;
            let bonds = &self.bonds[grid.tile_sublattice(t)];
            for l in 0..TILE {
                let slot = grid.tile_slot(t) + l;
                if !grid.is_owned(slot) {
                    continue;
                }
                let x = grid.position(slot);
                let from: [f64; D] = std::array::from_fn(|a| x[a]);
                for (k, b) in bonds.iter().enumerate() {
                    let byte = &mut self.alive[n * self.width + k];
                    if *byte >> l & 1 == 0 {
                        continue;
                    }
                    // a bond through a periodic face is in two places; either end must see the same
                    let partner = slot.wrapping_add_signed(b.shift) as u32;
                    let elsewhere = || {
                        original.get(&partner).is_some_and(|o| {
                            let x = grid.position(*o as usize);
                            let to: [f64; D] = std::array::from_fn(|a| x[a]);
                            crosses(std::array::from_fn(|a| to[a] - b.xi[a]), to)
                        })
                    };
                    if crosses(from, std::array::from_fn(|a| from[a] + b.xi[a])) || elsewhere() {
                        *byte &= !(1 << l);
                        count += 1;
                        if kind == CrackKind::Absent {
                            self.family[n * TILE + l] -= 1;
                        }
                    }
                }
            }
        }
        if kind == CrackKind::Absent {
            self.directed -= count;
        }
        count
    }

    fn prepare(&mut self, body: &Body<D>) {
        let Layout::Grid(grid) = &body.layout else {
            unreachable!("stencils live on grids")
        };
        let per_slot = |value: &dyn Fn(usize) -> f64| {
            let mut field = vec![0.0; body.len];
            for &s in &body.slots {
                field[s as usize] = value(s as usize);
            }
            body.fill_images(&mut field);
            field
        };
        match &self.point_constants {
            PointConstants::None => {}
            PointConstants::PerMaterial(c) => {
                self.fields[0] = per_slot(&|s| c[body.material_of(s)])
            }
            PointConstants::Solid(solids) => {
                let mut m = vec![0.0; body.len];
                for (n, &t) in self.tiles.iter().enumerate() {
                    let first = grid.tile_slot(t as usize);
                    let bonds = &self.bonds[grid.tile_sublattice(t as usize)];
                    for (b, bits) in bonds.iter().zip(self.row(n)) {
                        for l in 0..TILE {
                            if bits >> l & 1 == 1 {
                                m[first + l] += b.k * b.r0_squared;
                            }
                        }
                    }
                }
                let of = |s: usize| solids[body.material_of(s)];
                let per_m = |s: usize, x: f64| if m[s] > 0.0 { x / m[s] } else { 0.0 };
                self.fields[0] = vec![0.0; body.len];
                self.fields[1] = per_slot(&|s| per_m(s, of(s).beta));
                if solids.iter().any(|s| s.ratio() != solids[0].ratio()) {
                    self.pressure =
                        per_slot(&|s| of(s).ratio() * self.fields[1][s] * self.fields[1][s]);
                }
            }
        }
    }

    fn directed_bonds(&self) -> u64 {
        self.directed
    }

    fn family_size(&self, slot: usize) -> usize {
        // tiles are sorted; find the one that holds the slot
        let first = |t: u32| t as usize * TILE;
        let n = self
            .tiles
            .partition_point(|t| first(*t) + self.guard + TILE <= slot);
        self.family
            .get(n * TILE + (slot - self.guard) % TILE)
            .map_or(0, |f| *f as usize)
    }

    fn critical_stretch(&self, slot: usize) -> f64 {
        self.critical
            .get(slot)
            .map_or(f64::INFINITY, |e| critical_stretch(*e))
    }

    fn in_family(&self, body: &Body<D>, i: usize, j: usize) -> bool {
        let Layout::Grid(grid) = &body.layout else {
            unreachable!("stencils live on grids")
        };
        let ((ci, bi), (cj, bj)) = (grid.cell(i), grid.cell(j));
        self.offsets
            .contains(std::array::from_fn(|a| cj[a] - ci[a]), bi, bj)
    }

    fn memory(&mut self) -> (&mut [u8], &mut [f64]) {
        (&mut self.alive, &mut self.critical)
    }

    fn bytes(&self) -> usize {
        let words = self.fields[0].len()
            + self.fields[1].len()
            + self.pressure.len()
            + self.critical.len()
            + self.next.len();
        self.alive.len()
            + self.offsets.bytes()
            + 2 * self.family.len()
            + 4 * self.tiles.len()
            + 8 * words
    }
}
