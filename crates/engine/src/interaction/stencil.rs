//! Any law on a lattice stencil: tiles of eight points walk the offsets together; one bit per bond is all that is
//! stored.

mod assemble;
mod kernel;

use super::history;
use super::scale::Scale;
use super::{
    BondForce, BondState, BondTangent, EnergyFields, Interaction, Motion, PointConstants,
    PointEnergies, Repulsion, Sweep, Tally, Toughness,
};
use crate::body::{Body, Column, Field, Identity, Layout, field, zeros};
use crate::columns::Declaration;
use crate::error::BuildError;
use crate::execute::blocks::{PerBlock, Shared, run_blocks};
use crate::execute::lane::TILE;
use crate::execute::simd::Simd;
use crate::family::offsets::OffsetSet;
use crate::law::BondFactors;
use crate::law::Law;
use crate::spec::CrackKind;
pub use assemble::StencilParts;
pub use kernel::MOST;
use kernel::{Bond, Energies, Forces, Partner, Remember, Share, View};
use std::ops::AddAssign;

/// A law on a stencil.
pub struct StencilInteraction<const D: usize, W: Law> {
    body: Identity,
    law: W,
    simd: Simd,
    /// Per sublattice.
    bonds: Vec<Vec<Bond<D>>>,
    partners: Vec<Vec<Partner<D>>>,
    /// The offsets of `bonds`.
    offsets: OffsetSet<D>,
    /// Bytes per tile in `alive`: the longest stencil.
    width: usize,
    /// Tiles that have points.
    tiles: Vec<u32>,
    /// `[tiles][width]`: bit l of a byte is the bond of point l of the tile.
    alive: Vec<u8>,
    /// `[tiles]`: are all bonds whole, and their ends alike? See the kernel's `WHOLE` and `ALIKE`.
    state: Vec<u8>,
    /// `[tiles]`: which row of `reaches`.
    reach: Vec<u32>,
    /// `[different][words]`: a bit per offset that any point of a tile has a partner at.
    reaches: Vec<u64>,
    /// Factors of bonds.
    scale: Scale,
    /// Family size per active tile and lane.
    family: Vec<u16>,
    directed: u64,
    /// Point fields of the law, per slot (empty where unused).
    fields: [Column; 2],
    /// Pressure factors per slot where materials differ; else the law's own.
    pressure: Column,
    point_constants: PointConstants,
    toughness: Vec<Toughness>,
    repulsion: Option<Repulsion>,
    /// Critical `e` per slot.
    critical: Column,
    /// `[tiles][8]`: the next ones.
    next: Vec<f64>,
    /// The lowest of `critical`.
    least_critical: f64,
    /// No critical stretch changes any more: none depends on the strain, and the first are known.
    settled: bool,
    /// The highest `e` at which any bond repels.
    most_contact: f64,
    /// Of a whole cell.
    volume: f64,
    guard: usize,
    tallies: PerBlock<Tally>,
    sums: PerBlock<[f64; 2]>,
}

impl<const D: usize, W: Law> StencilInteraction<D, W> {
    /// For kernels that only read.
    fn view<'a>(&'a self, body: &'a Body<D>, u: &'a Field<D>) -> View<'a, D, W> {
        let alive = Shared(self.alive.as_ptr().cast_mut());
        let state = Shared(self.state.as_ptr().cast_mut());
        self.view_of(body, u, alive, state)
    }

    fn view_of<'a>(
        &'a self,
        body: &'a Body<D>,
        u: &'a Field<D>,
        alive: Shared<u8>,
        state: Shared<u8>,
    ) -> View<'a, D, W> {
        let Layout::Grid(grid) = &body.layout else {
            unreachable!("stencils live on grids")
        };
        View {
            law: self.law,
            grid,
            body,
            bonds: &self.bonds,
            partners: &self.partners,
            width: self.width,
            tiles: &self.tiles,
            alive,
            state,
            reach: &self.reach,
            reaches: &self.reaches,
            scale: &self.scale,
            u: std::array::from_fn(|a| &*u[a]),
            fields: [&self.fields[0], &self.fields[1]],
            pressure: &self.pressure,
            repulsion: self.repulsion.as_ref(),
            most_contact: self.most_contact,
        }
    }

    fn sweep<const FULL: bool>(
        &mut self,
        body: &Body<D>,
        u: &Field<D>,
        f: &mut Field<D>,
        motion: Option<Motion<D>>,
    ) -> Tally {
        let alive = Shared(self.alive.as_mut_ptr());
        let state = Shared(self.state.as_mut_ptr());
        let next = Shared(self.next.as_mut_ptr());
        let next = (!self.settled).then_some(next);
        let kernel = Forces::<D, W, FULL> {
            view: self.view_of(body, u, alive, state),
            f: std::array::from_fn(|a| Shared(f[a].as_mut_ptr())),
            critical: &self.critical,
            next,
            toughness: &self.toughness,
            lower: self.most_contact,
            upper: self.least_critical,
            motion,
        };
        self.tallies.fold(self.simd, &kernel, Tally::add_assign)
    }

    /// n and 1/m at a slot, from `β/m`.
    fn per_weight(&self, body: &Body<D>, slot: usize) -> [f64; 2] {
        match &self.point_constants {
            PointConstants::Solid(s) => {
                let s = s[body.material_of(slot)];
                [s.n, self.fields[1][slot] / s.beta]
            }
            PointConstants::None | PointConstants::PerMaterial(_) => [0.0; 2],
        }
    }

    /// Where the bits of all directed bonds are between points that there are, in order of slots: byte and lane.
    fn bits<'a>(&'a self, body: &'a Body<D>) -> impl Iterator<Item = (usize, usize)> + 'a {
        let Layout::Grid(grid) = &body.layout else {
            unreachable!("stencils live on grids")
        };
        let tiles = self.tiles.iter().enumerate();
        tiles.flat_map(move |(n, &t)| {
            let slot = grid.tile_slot(t as usize);
            let partners = &self.partners[grid.tile_sublattice(t as usize)];
            let owned = (0..TILE).filter(move |l| grid.is_owned(slot + l));
            owned.flat_map(move |l| {
                let there = move |k: &usize| {
                    grid.neighbour(slot + l, partners[*k].cell, partners[*k].to)
                        .is_some()
                };
                let first = n * self.width;
                (0..partners.len())
                    .filter(there)
                    .map(move |k| (first + k, l))
            })
        })
    }

    fn row(&self, n: usize) -> &[u8] {
        &self.alive[n * self.width..(n + 1) * self.width]
    }

    /// Energies of all points, with `Σ k r0² s` in place of the dilatation and `Σ k r0²` of what is whole.
    fn sums(&self, body: &Body<D>, u: &Field<D>, out: &mut PointEnergies) {
        out.zeros(body.len);
        let kernel = Energies {
            view: self.view(body, u),
            fields: Some(EnergyFields {
                strain: Shared(out.strain.as_mut_ptr()),
                repulsion: Shared(out.repulsion.as_mut_ptr()),
                share: Shared(out.dilatation.as_mut_ptr()),
                weight: Shared(out.whole.as_mut_ptr()),
            }),
        };
        self.sums.sum(self.simd, &kernel);
    }

    /// `P / Σ k r0² s` at a slot.
    fn pressure_factor(&self, i: usize) -> f64 {
        match self.pressure.get(i) {
            Some(q) => *q,
            None => self.law.pressure_factor(self.fields[1][i]),
        }
    }
}

impl<const D: usize, W: Law> Interaction<D> for StencilInteraction<D, W> {
    fn made_for(&self) -> Identity {
        self.body
    }

    fn family(&self) -> &'static str {
        "stencil"
    }

    unsafe fn forces_unchecked(
        &mut self,
        body: &Body<D>,
        u: &Field<D>,
        f: &mut Field<D>,
        sweep: Sweep<D>,
        seen: Option<&mut PointEnergies>,
    ) -> Tally {
        if let Some(seen) = seen {
            self.sums(body, u, seen);
            if W::SHARES {
                for &slot in &body.slots {
                    let i = slot as usize;
                    self.fields[0][i] = self.pressure_factor(i) * seen.dilatation[i];
                }
            }
            seen.dilate::<W, D>(body, |i| self.per_weight(body, i));
        } else if W::SHARES {
            let mut pressure = std::mem::take(&mut self.fields[0]);
            let kernel = Share {
                view: self.view(body, u),
                out: Shared(pressure.as_mut_ptr()),
            };
            run_blocks(self.simd, &kernel, self.sums.blocks());
            self.fields[0] = pressure;
        }
        if W::SHARES {
            body.fill_images(&mut self.fields[0]);
        }
        let motion = sweep.motion();
        let total = if self.critical.is_empty() {
            self.sweep::<false>(body, u, f, motion)
        } else {
            self.sweep::<true>(body, u, f, motion)
        };
        if motion.is_some() && !self.critical.is_empty() && !self.settled {
            let mut critical = std::mem::take(&mut self.critical);
            let kernel = Remember {
                view: self.view(body, u),
                next: &self.next,
                critical: Shared(critical.as_mut_ptr()),
            };
            run_blocks(self.simd, &kernel, self.sums.blocks());
            self.critical = critical;
            body.fill_images(&mut self.critical);
            self.least_critical = total.least_critical;
            self.settled = self.toughness.iter().all(|t| t.alpha == 0.0);
        }
        // a point may have lost its last bond
        self.settled &= total.broken == 0;
        total
    }

    unsafe fn energy_unchecked(&mut self, body: &Body<D>, u: &Field<D>) -> [f64; 2] {
        let kernel = Energies {
            view: self.view(body, u),
            fields: None,
        };
        self.sums.sum(self.simd, &kernel)
    }

    unsafe fn observe_unchecked(&self, body: &Body<D>, u: &Field<D>, out: &mut PointEnergies) {
        self.sums(body, u, out);
        out.dilate::<W, D>(body, |i| self.per_weight(body, i));
    }

    unsafe fn tangents_unchecked(
        &mut self,
        body: &Body<D>,
        u: &Field<D>,
        visit: &mut dyn FnMut(BondTangent<D>),
    ) {
        if W::SHARES {
            // the pressures of this state
            self.forces(body, u, &mut zeros(body.len), Sweep::Hold, None);
        }
        let Layout::Grid(grid) = &body.layout else {
            unreachable!("stencils live on grids")
        };
        let original = body.originals();
        let field = |n: usize, slot: usize| self.fields[n].get(slot).copied().unwrap_or(0.0);
        for (n, &t) in self.tiles.iter().enumerate() {
            let first = grid.tile_slot(t as usize);
            let bonds = &self.bonds[grid.tile_sublattice(t as usize)];
            for i in (first..first + TILE).filter(|i| grid.is_owned(*i)) {
                for (b, bits) in bonds.iter().zip(self.row(n)) {
                    if bits >> (i - first) & 1 == 0 {
                        continue;
                    }
                    let j = b.to(i);
                    visit(BondTangent::of_law(
                        self.law,
                        [i, original(j)],
                        b.k,
                        self.scale.of(n, b.number as usize, i - first),
                        b.back.map(|x| -x),
                        std::array::from_fn(|a| u[a][j] - u[a][i]),
                        [i, j].map(|s| [field(0, s), field(1, s)]),
                    ));
                }
            }
        }
    }

    fn each_force(
        &mut self,
        body: &Body<D>,
        u: &Field<D>,
        visit: &mut dyn FnMut(BondForce<D>),
    ) -> bool {
        if W::SHARES {
            // the pressures of this state
            self.forces(body, u, &mut zeros(body.len), Sweep::Hold, None);
        }
        let Layout::Grid(grid) = &body.layout else {
            unreachable!("stencils live on grids")
        };
        let original = body.originals();
        let field = |n: usize, slot: usize| self.fields[n].get(slot).copied().unwrap_or(0.0);
        for (n, &t) in self.tiles.iter().enumerate() {
            let first = grid.tile_slot(t as usize);
            let sub = grid.tile_sublattice(t as usize);
            let bonds = self.bonds[sub].iter().zip(&self.partners[sub]);
            for i in (first..first + TILE).filter(|i| grid.is_owned(*i)) {
                for ((b, to), bits) in bonds.clone().zip(self.row(n)) {
                    let alive = bits >> (i - first) & 1 == 1;
                    // beside the body another row of it lies in memory
                    let there = || grid.neighbour(i, to.cell, to.to).is_some();
                    if !alive && (self.repulsion.is_none() || !there()) {
                        continue;
                    }
                    let j = b.to(i);
                    let eta: [f64; D] = std::array::from_fn(|a| u[a][j] - u[a][i]);
                    let xi = b.back.map(|x| -x);
                    let ends = [i, original(j)];
                    let mut pull = 0.0;
                    let y = std::array::from_fn(|a| xi[a] + eta[a]);
                    if alive {
                        let fields = [i, j].map(|s| [field(0, s), field(1, s)]);
                        let factors = self.scale.of(n, b.number as usize, i - first);
                        pull = BondTangent::of_law(self.law, ends, b.k, factors, xi, eta, fields)
                            .tension;
                    }
                    if let Some(repulsion) = &self.repulsion {
                        let materials = ends.map(|s| body.material_of(s));
                        pull += repulsion.pull(&xi, &y, materials, self.volume);
                    }
                    if pull != 0.0 {
                        let force = y.map(|c| pull * c);
                        visit(BondForce {
                            i,
                            j: ends[1],
                            y,
                            force,
                        });
                    }
                }
            }
        }
        true
    }

    fn gain(&self, slot: usize) -> f64 {
        if W::SHARES {
            self.pressure_factor(slot)
        } else {
            0.0
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
                let sub = grid.tile_sublattice(t as usize);
                for (k, b) in self.bonds[sub].iter().enumerate() {
                    // without images the other end's turn
                    if b.shift < 0 && original.is_empty() {
                        continue;
                    }
                    let to = &self.partners[sub][k];
                    let Some(j) = grid.neighbour(first + l, to.cell, to.to) else {
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
                        visit(first + l, j, b.back.map(|x| -x), state);
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
            let slot = grid.tile_slot(t as usize);
            if self.state[n] != 0 {
                out[slot..slot + TILE].fill(0.0);
                continue;
            }
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
                    let partner = slot.wrapping_add_signed(b.shift as isize) as u32;
                    let elsewhere = || {
                        original.get(&partner).is_some_and(|o| {
                            let x = grid.position(*o as usize);
                            let to: [f64; D] = std::array::from_fn(|a| x[a]);
                            crosses(std::array::from_fn(|a| to[a] + b.back[a]), to)
                        })
                    };
                    if crosses(from, std::array::from_fn(|a| from[a] - b.back[a])) || elsewhere() {
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
        self.look(grid);
        count
    }

    fn scale_bonds(
        &mut self,
        body: &Body<D>,
        factors: &dyn Fn(usize, usize, [i32; D]) -> BondFactors<f64>,
    ) -> Result<(), BuildError> {
        let Layout::Grid(grid) = &body.layout else {
            unreachable!("stencils live on grids")
        };
        let old = std::mem::take(&mut self.scale);
        self.scale = Scale::new(self.tiles.len(), self.width, W::SHARES, |n, k, l| {
            let tile = self.tiles[n] as usize;
            let i = grid.tile_slot(tile) + l;
            let to = self.partners[grid.tile_sublattice(tile)].get(k);
            let to = to.filter(|_| self.row(n)[k] >> l & 1 == 1);
            let ends = to.and_then(|b| Some((b.cell, grid.neighbour(i, b.cell, b.to)?)));
            ends.map_or(BondFactors::ONE, |(cell, j)| {
                old.of(n, k, l).times(factors(i, j, cell))
            })
        });
        Ok(())
    }

    fn reached(&self, body: &Body<D>, i: usize, xi: [f64; D]) -> Option<(f64, BondFactors<f64>)> {
        let Layout::Grid(grid) = &body.layout else {
            unreachable!("stencils live on grids")
        };
        if self.scale.is_empty() {
            return None;
        }
        let tile = (i - grid.guard) / TILE;
        let n = self.tiles.binary_search(&(tile as u32)).ok()?;
        let k = self.bonds[grid.tile_sublattice(tile)]
            .iter()
            .position(|b| b.back.map(|x| -x) == xi)?;
        Some((self.volume, self.scale.of(n, k, (i - grid.guard) % TILE)))
    }

    fn prepare(&mut self, body: &Body<D>) {
        self.check(body, &[]);
        let Layout::Grid(grid) = &body.layout else {
            unreachable!("stencils live on grids")
        };
        let column = |n: usize| Column::new(body.len, 0.0, field::line(4 + n));
        let per_slot = |n: usize, value: &dyn Fn(usize) -> f64| {
            let mut field = column(n);
            for &s in &body.slots {
                field[s as usize] = value(s as usize);
            }
            body.fill_images(&mut field);
            field
        };
        match &self.point_constants {
            PointConstants::None => {}
            PointConstants::PerMaterial(c) => {
                self.fields[0] = per_slot(0, &|s| c[body.material_of(s)])
            }
            PointConstants::Solid(solids) => {
                let mut m = vec![0.0; body.len];
                for (n, &t) in self.tiles.iter().enumerate() {
                    let first = grid.tile_slot(t as usize);
                    let bonds = &self.bonds[grid.tile_sublattice(t as usize)];
                    let whole = !self.scale.is_empty();
                    for (b, bits) in bonds.iter().zip(self.row(n)) {
                        for l in 0..TILE {
                            if whole || bits >> l & 1 == 1 {
                                m[first + l] += b.share;
                            }
                        }
                    }
                }
                let of = |s: usize| solids[body.material_of(s)];
                let per_m = |s: usize, x: f64| if m[s] > 0.0 { x / m[s] } else { 0.0 };
                self.fields[0] = column(0);
                self.fields[1] = per_slot(1, &|s| per_m(s, of(s).beta));
                if solids.iter().any(|s| s.ratio() != solids[0].ratio()) {
                    self.pressure = per_slot(2, &|s| {
                        of(s).ratio() * self.fields[1][s] * self.fields[1][s]
                    });
                }
            }
        }
        self.look(grid);
    }

    fn directed_bonds(&self) -> u64 {
        self.directed
    }

    fn family_size(&self, _: &Body<D>, slot: usize) -> usize {
        // tiles are sorted; find the one that holds the slot
        let first = |t: u32| t as usize * TILE;
        let n = self
            .tiles
            .partition_point(|t| first(*t) + self.guard + TILE <= slot);
        self.family
            .get(n * TILE + (slot - self.guard) % TILE)
            .map_or(0, |f| *f as usize)
    }

    fn point_field(&self, field: usize, slot: usize) -> f64 {
        self.fields[field].get(slot).copied().unwrap_or(0.0)
    }

    fn in_family(&self, body: &Body<D>, i: usize, j: usize) -> bool {
        let Layout::Grid(grid) = &body.layout else {
            unreachable!("stencils live on grids")
        };
        let ((ci, bi), (cj, bj)) = (grid.cell(i), grid.cell(j));
        self.offsets
            .contains(std::array::from_fn(|a| cj[a] - ci[a]), bi, bj)
    }

    fn columns(&self) -> Vec<Declaration> {
        history::columns(!self.critical.is_empty())
    }

    fn read_column(&self, body: &Body<D>, _: &Field<D>, name: &str, out: &mut Vec<f64>) -> bool {
        match name {
            history::WHOLE => {
                out.clear();
                let bit = |(at, l): (usize, usize)| f64::from(self.alive[at] >> l & 1);
                out.extend(self.bits(body).map(bit));
                true
            }
            _ => history::read_critical(body, &self.critical, name, out),
        }
    }

    fn write_column(&mut self, body: &Body<D>, name: &str, values: &[f64]) -> bool {
        let Layout::Grid(grid) = &body.layout else {
            unreachable!("stencils live on grids")
        };
        if name != history::WHOLE {
            if !history::write_critical(body, &mut self.critical, name, values) {
                return false;
            }
            body.fill_images(&mut self.critical);
            let known = body.slots.iter().map(|s| self.critical[*s as usize]);
            self.least_critical = known.fold(f64::INFINITY, f64::min);
            self.settled = false;
            return true;
        }
        let bits: Vec<_> = self.bits(body).collect();
        if bits.len() != values.len() {
            return false;
        }
        for ((at, l), value) in bits.into_iter().zip(values) {
            match *value != 0.0 {
                true => self.alive[at] |= 1 << l,
                false => self.alive[at] &= !(1 << l),
            }
        }
        self.settled = false;
        self.look(grid);
        true
    }

    fn memory(&self) -> (&[u8], &[f64]) {
        (&self.alive, &self.critical)
    }

    fn bytes(&self) -> usize {
        let words = self.fields[0].len()
            + self.fields[1].len()
            + self.pressure.len()
            + self.critical.len()
            + self.next.len();
        self.alive.len()
            + self.state.len()
            + self.scale.bytes()
            + 4 * self.reach.len()
            + 8 * self.reaches.len()
            + self.offsets.bytes()
            + 2 * self.family.len()
            + 4 * self.tiles.len()
            + 8 * words
    }
}
