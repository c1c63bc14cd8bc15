//! What depends on the whole families of points: factors of bonds, weighted volumes, and the tiles that are alike.

use super::StencilInteraction;
use super::kernel::{ALIKE, WHOLE};
use crate::body::{Body, Column, field};
use crate::execute::lane::TILE;
use crate::interaction::bonds::family::{Family, Slots};
use crate::interaction::scale::Scale;
use crate::interaction::{FactorsOf, PointConstants};
use crate::law::{BondFactors, Law};

impl<const D: usize, W: Law> StencilInteraction<D, W> {
    pub(super) fn multiply_factors(&mut self, factors: &FactorsOf<D>) {
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
        let mut m = vec![0.0; body.len];
        if matches!(self.point_constants, PointConstants::Solid(_)) {
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
        }
        for slot in body.slots.iter().map(|s| *s as usize) {
            let material = body.material_of(slot);
            let (own, pressure) = self.point_constants.fields(slot, material, m[slot]);
            for (field, x) in self.fields.iter_mut().zip(own).take(W::FIELDS) {
                field[slot] = x;
            }
            if let Some(q) = pressure {
                if self.pressure.is_empty() {
                    self.pressure = Column::new(body.len, 0.0, field::line(6));
                }
                self.pressure[slot] = q;
            }
        }
        for column in self.fields.iter_mut().chain([&mut self.pressure]) {
            if !column.is_empty() {
                body.exchange.fill(column);
            }
        }
        self.look();
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
