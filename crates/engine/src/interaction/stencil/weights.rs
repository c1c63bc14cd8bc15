//! What depends on the whole families of points: factors of bonds, weighted volumes, and the tiles that are alike.

use super::StencilInteraction;
use super::kernel::{ALIKE, WHOLE};
use crate::body::{Body, Column, Grid, field};
use crate::execute::lane::TILE;
use crate::interaction::PointConstants;
use crate::interaction::point_constants::unlike;
use crate::interaction::scale::Scale;
use crate::law::{BondFactors, Law};

impl<const D: usize, W: Law> StencilInteraction<D, W> {
    pub(super) fn multiply_factors(
        &mut self,
        body: &Body<D>,
        factors: &dyn Fn(usize, usize, [i32; D]) -> BondFactors<f64>,
    ) {
        let grid = body.grid();
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
    }

    /// Volume with which the bond along ξ acts on slot i, and its factors, where there are any.
    pub(super) fn reach(
        &self,
        body: &Body<D>,
        i: usize,
        xi: [f64; D],
    ) -> Option<(f64, BondFactors<f64>)> {
        let grid = body.grid();
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

    /// Weighted volumes, and what follows.
    pub(super) fn weigh(&mut self, body: &Body<D>) {
        let grid = body.grid();
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
            PointConstants::PerPoint(all) => {
                for n in 0..2 {
                    self.fields[n] = per_slot(n, &|s| all[s][n]);
                }
            }
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
                if unlike(solids) {
                    self.pressure = per_slot(2, &|s| {
                        of(s).ratio() * self.fields[1][s] * self.fields[1][s]
                    });
                }
            }
        }
        self.look(grid);
    }

    /// Find the tiles whose bonds are all whole, and those of them whose ends are alike.
    pub(super) fn look(&mut self, grid: &Grid<D>) {
        let words = self.width.div_ceil(64);
        let mut state = std::mem::take(&mut self.state);
        for (n, state) in state.iter_mut().enumerate() {
            let row = self.row(n);
            let reach = &self.reaches[self.reach[n] as usize * words..][..words];
            let leads = |k: &usize| reach[k / 64] >> (k % 64) & 1 == 1;
            let whole = (0..self.width).filter(leads).all(|k| row[k] == 0xff);
            let first = grid.tile_slot(self.tiles[n] as usize);
            let bonds = &self.bonds[grid.tile_sublattice(self.tiles[n] as usize)];
            let field = &self.fields[1];
            let alike = whole && !field.is_empty() && {
                let same =
                    |slot: usize| field[slot..slot + TILE].iter().all(|x| *x == field[first]);
                same(first)
                    && (0..self.width)
                        .filter(leads)
                        .all(|k| same(bonds[k].to(first)))
            };
            *state = if whole { WHOLE } else { 0 } | if alike { ALIKE } else { 0 };
        }
        self.state = state;
    }
}
