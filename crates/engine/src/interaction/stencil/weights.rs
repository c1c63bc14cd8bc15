//! What depends on the whole families of points: factors of bonds, weighted volumes, and the tiles that are alike.

use super::StencilInteraction;
use super::kernel::{ALIKE, WHOLE};
use crate::body::{Body, Column, field};
use crate::execute::lane::TILE;
use crate::interaction::PointConstants;
use crate::interaction::bonds::family::{Family, Slots};
use crate::interaction::point_constants::unlike;
use crate::interaction::scale::Scale;
use crate::law::{BondFactors, Law};

impl<const D: usize, W: Law> StencilInteraction<D, W> {
    pub(super) fn multiply_factors(
        &mut self,
        factors: &dyn Fn(usize, usize, [i32; D]) -> BondFactors<f64>,
    ) {
        let family = &self.bonds.family;
        let old = std::mem::take(&mut self.scale);
        self.scale = Scale::new(family.groups(), family.width, W::SHARES, |n, k, l| {
            if !self.bonds.is_whole(n, k, l) {
                return BondFactors::ONE;
            }
            let [i, j] = [family.rows(n), family.ends(n, k)].map(|s| s.slot(l));
            let cell = self.partners[family.sublattice(n)][k].cell;
            old.of(n, k, l).times(factors(i, j, cell))
        });
    }

    /// Volume with which the bond along ξ acts on slot i, and its factors, where there are any.
    pub(super) fn reach(&self, i: usize, xi: [f64; D]) -> Option<(f64, BondFactors<f64>)> {
        if self.scale.is_empty() {
            return None;
        }
        let (n, l) = self.bonds.family.find(i)?;
        let k = self.stencil[self.bonds.family.sublattice(n)]
            .iter()
            .position(|b| b.back.map(|x| -x) == xi)?;
        Some((self.volume, self.scale.of(n, k, l)))
    }

    /// Weighted volumes, and what follows.
    pub(super) fn weigh(&mut self, body: &Body<D>) {
        let column = |n: usize| Column::new(body.len, 0.0, field::line(4 + n));
        let per_slot = |n: usize, value: &dyn Fn(usize) -> f64| {
            let mut field = column(n);
            body.set_points(&mut field, value);
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
                let family = &self.bonds.family;
                for n in 0..family.groups() {
                    let first = family.rows(n).slot(0);
                    let bonds = &self.stencil[family.sublattice(n)];
                    let whole = !self.scale.is_empty();
                    for (b, bits) in bonds.iter().zip(family.bits(&self.bonds.alive, n)) {
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
        self.look();
    }

    /// What follows from critical stretches, whose images are those of originals.
    pub(super) fn look_critical(&mut self, body: &Body<D>) {
        let critical = &self.bonds.critical;
        let known = body.slots.iter().map(|s| critical.get(*s as usize));
        let known = known.flatten().copied();
        self.least_critical = known.fold(f64::INFINITY, f64::min);
        self.settled = false;
    }

    /// Find the tiles whose bonds are all whole, and those of them whose ends are alike.
    pub(super) fn look(&mut self) {
        let family = &self.bonds.family;
        let words = family.width.div_ceil(64);
        let mut state = std::mem::take(&mut self.state);
        for (n, state) in state.iter_mut().enumerate() {
            let row = family.bits(&self.bonds.alive, n);
            let reach = &self.reaches[self.reach[n] as usize * words..][..words];
            let leads = |k: &usize| reach[k / 64] >> (k % 64) & 1 == 1;
            let whole = (0..family.width).filter(leads).all(|k| row[k] == 0xff);
            let first = family.rows(n).slot(0);
            let bonds = &self.stencil[family.sublattice(n)];
            let field = &self.fields[1];
            let alike = whole && !field.is_empty() && {
                let same =
                    |slot: usize| field[slot..slot + TILE].iter().all(|x| *x == field[first]);
                same(first)
                    && (0..family.width)
                        .filter(leads)
                        .all(|k| same(bonds[k].to(first)))
            };
            *state = if whole { WHOLE } else { 0 } | if alike { ALIKE } else { 0 };
        }
        self.state = state;
    }
}
