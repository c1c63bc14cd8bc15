//! The bonds of a stencil one by one, in order of slots: for whatever is not a kernel.

use super::StencilInteraction;
use super::kernel::WHOLE;
use crate::body::{Body, FieldView, Grid, view_mut, zeros};
use crate::execute::blocks::PerBlock;
use crate::execute::lane::{Lane, TILE};
use crate::execute::simd::Kernel;
use crate::interaction::tangent::Stretched;
use crate::interaction::{BondForce, BondStatus, BondTangent, Interaction, Sweep, add_virial};
use crate::law::Law;
use std::ops::Range;

/// A point in its tile.
#[derive(Clone, Copy)]
pub(super) struct Place {
    /// Place of the tile among those that have points.
    pub n: usize,
    pub sublattice: usize,
    pub lane: usize,
    pub slot: usize,
}

/// Tiles that one thread takes at a time.
const TILES: usize = 32;

struct Virial<'a, const D: usize, W: Law> {
    of: &'a StencilInteraction<D, W>,
    body: &'a Body<D>,
    u: FieldView<'a, D>,
}

impl<const D: usize, W: Law> Kernel for Virial<'_, D, W> {
    type Out = [f64; 6];

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> [f64; 6] {
        let last = self.of.tiles.len().min((block + 1) * TILES);
        let mut virial = [0.0; 6];
        self.of
            .pulls_of(self.body, self.u, block * TILES..last, |bond| {
                let factor = -0.5 * self.body.volume.at(bond.i);
                add_virial(&mut virial, &bond.force, &bond.y, factor);
            });
        virial
    }
}

impl<const D: usize, W: Law> StencilInteraction<D, W> {
    /// All points.
    pub(super) fn places<'a>(&'a self, grid: &'a Grid<D>) -> impl Iterator<Item = Place> + 'a {
        self.places_of(grid, 0..self.tiles.len())
    }

    /// Those of tiles that may have a broken bond.
    pub(super) fn torn_places<'a>(&'a self, grid: &'a Grid<D>) -> impl Iterator<Item = Place> + 'a {
        let torn = (0..self.tiles.len()).filter(|n| self.is_torn(*n));
        torn.flat_map(|n| self.places_of(grid, n..n + 1))
    }

    /// May a tile have a broken bond?
    fn is_torn(&self, n: usize) -> bool {
        self.state[n] & WHOLE == 0
    }

    /// Those of some tiles.
    fn places_of<'a>(
        &'a self,
        grid: &'a Grid<D>,
        tiles: Range<usize>,
    ) -> impl Iterator<Item = Place> + 'a {
        tiles.flat_map(move |n| {
            let tile = self.tiles[n] as usize;
            let (first, sublattice) = (grid.tile_slot(tile), grid.tile_sublattice(tile));
            let owned = (0..TILE).filter(move |l| grid.is_owned(first + l));
            owned.map(move |lane| Place {
                n,
                sublattice,
                lane,
                slot: first + lane,
            })
        })
    }

    /// Bytes of the bonds of a tile.
    pub(super) fn row(&self, n: usize) -> &[u8] {
        &self.alive[n * self.width..(n + 1) * self.width]
    }

    /// All directed bonds between points that there are: the point, and the number of the bond in its stencil.
    fn directed<'a>(&'a self, body: &'a Body<D>) -> impl Iterator<Item = (Place, usize)> + 'a {
        let grid = body.grid();
        self.places(grid).flat_map(move |p| {
            let partners = &self.partners[p.sublattice];
            let there = move |k: &usize| {
                grid.neighbour(p.slot, partners[*k].cell, partners[*k].to)
                    .is_some()
            };
            (0..partners.len()).filter(there).map(move |k| (p, k))
        })
    }

    /// Where their bits are: byte and lane.
    pub(super) fn bits<'a>(
        &'a self,
        body: &'a Body<D>,
    ) -> impl Iterator<Item = (usize, usize)> + 'a {
        self.directed(body)
            .map(|(p, k)| (p.n * self.width + k, p.lane))
    }

    /// Slots and ξ of all directed bonds.
    pub(super) fn each_end(&self, body: &Body<D>, visit: &mut dyn FnMut(usize, usize, [f64; D])) {
        let original = body.originals();
        for (p, k) in self.directed(body) {
            let b = &self.bonds[p.sublattice][k];
            visit(p.slot, original(b.to(p.slot)), b.back.map(|x| -x));
        }
    }

    fn field(&self, slot: usize) -> [f64; 2] {
        [0, 1].map(|n| self.fields[n].get(slot).copied().unwrap_or(0.0))
    }

    /// The pressures of this state.
    fn update_pressures(&mut self, body: &Body<D>, u: FieldView<D>) {
        if W::SHARES {
            self.forces(body, u, view_mut(&mut zeros(body.len)), Sweep::Hold, None);
        }
    }

    pub(super) fn each_tangent(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        visit: &mut dyn FnMut(BondTangent<D>),
    ) {
        self.update_pressures(body, u);
        let original = body.originals();
        for p in self.places(body.grid()) {
            for (b, bits) in self.bonds[p.sublattice].iter().zip(self.row(p.n)) {
                if bits >> p.lane & 1 == 0 {
                    continue;
                }
                let (i, j) = (p.slot, b.to(p.slot));
                visit(BondTangent::of_law(
                    self.law,
                    [i, original(j)],
                    b.k,
                    self.scale.of(p.n, b.number as usize, p.lane),
                    b.back.map(|x| -x),
                    std::array::from_fn(|a| u[a][j] - u[a][i]),
                    [i, j].map(|s| self.field(s)),
                ));
            }
        }
    }

    pub(super) fn each_pull(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        visit: &mut dyn FnMut(BondForce<D>),
    ) {
        self.update_pressures(body, u);
        self.pulls_of(body, u, 0..self.tiles.len(), visit);
    }

    /// Σ of distance times force over the pairs, on threads.
    pub(super) fn virial_of_pulls(&mut self, body: &Body<D>, u: FieldView<D>) -> [f64; 6] {
        self.update_pressures(body, u);
        let kernel = Virial { of: self, body, u };
        PerBlock::sums(self.tiles.len().div_ceil(TILES)).sum(self.simd, &kernel)
    }

    /// What points of some tiles get from their bonds, as pressures are.
    fn pulls_of(
        &self,
        body: &Body<D>,
        u: FieldView<D>,
        tiles: Range<usize>,
        mut visit: impl FnMut(BondForce<D>),
    ) {
        let grid = body.grid();
        let original = body.originals();
        for p in self.places_of(grid, tiles) {
            let bonds = self.bonds[p.sublattice]
                .iter()
                .zip(&self.partners[p.sublattice]);
            for ((b, to), bits) in bonds.zip(self.row(p.n)) {
                let i = p.slot;
                let alive = bits >> p.lane & 1 == 1;
                // beside the body another row of it lies in memory
                let there = || grid.neighbour(i, to.cell, to.to).is_some();
                if !alive && (self.repulsion.is_none() || !there()) {
                    continue;
                }
                let j = b.to(i);
                let eta: [f64; D] = std::array::from_fn(|a| u[a][j] - u[a][i]);
                let xi = b.back.map(|x| -x);
                let ends = [i, original(j)];
                let mut pull = [0.0; 2];
                let bond = Stretched::new(xi, eta);
                if alive {
                    let fields = [i, j].map(|s| self.field(s));
                    let factors = self.scale.of(p.n, b.number as usize, p.lane);
                    pull = bond.tensions(self.law, b.k, factors, fields);
                }
                if let Some(repulsion) = &self.repulsion {
                    let materials = ends.map(|s| body.material_of(s));
                    let push = repulsion.pull(&xi, &bond.y, materials, self.volume);
                    pull = [pull[0] + push, pull[1] + 0.5 * push];
                }
                if pull[0] != 0.0 {
                    visit(BondForce::central(ends, bond.y, pull));
                }
            }
        }
    }

    /// Every undirected bond of the reference family, of tiles that may have a broken one alone where that is asked for.
    pub(super) fn each_of_family(
        &self,
        body: &Body<D>,
        torn: bool,
        visit: &mut dyn FnMut(usize, usize, [f64; D], BondStatus),
    ) {
        let grid = body.grid();
        let original = body.originals();
        let tiles = (0..self.tiles.len()).filter(|n| !torn || self.is_torn(*n));
        for p in tiles.flat_map(|n| self.places_of(grid, n..n + 1)) {
            let bonds = self.bonds[p.sublattice]
                .iter()
                .zip(&self.partners[p.sublattice]);
            for ((b, to), bits) in bonds.zip(self.row(p.n)) {
                // without images the other end's turn
                if b.shift < 0 && body.images.is_empty() {
                    continue;
                }
                let Some(j) = grid.neighbour(p.slot, to.cell, to.to) else {
                    continue;
                };
                let j = original(j);
                // a bond between a point and its own image counts from one side only
                if p.slot < j || (p.slot == j && b.shift > 0) {
                    let state = BondStatus::of(bits >> p.lane & 1 == 1);
                    visit(p.slot, j, b.back.map(|x| -x), state);
                }
            }
        }
    }
}
