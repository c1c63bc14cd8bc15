//! What depends on the whole families of points: weighted volumes, and what follows.

use super::ListInteraction;
use crate::body::Body;
use crate::execute::lane::TILE;
use crate::interaction::PointConstants;
use crate::interaction::point_constants::unlike;
use crate::law::{BondFactors, Law};

impl<const D: usize, W: Law> ListInteraction<D, W> {
    /// Σ over the bonds of a row whose bit is set in `bits`, in the row's order.
    pub(super) fn sum(&self, row: usize, bits: &[u8], of: impl Fn(usize) -> f64) -> f64 {
        self.list
            .partners(row)
            .filter(|(line, _)| bits[*line] >> (row % TILE) & 1 == 1)
            .map(|(_, j)| of(j))
            .sum()
    }

    /// Multiply the factors of bonds.
    pub(super) fn multiply_factors(
        &mut self,
        factors: &dyn Fn(usize, usize, [i32; D]) -> BondFactors<f64>,
    ) {
        let mut scale = std::mem::take(&mut self.scale);
        scale.resize(self.list.partner.len(), 1.0);
        // points of a list know no cells
        self.each_line(|row, line, [i, j]| {
            scale[line * TILE + row % TILE] *= factors(i, j, [0; D]).pair;
        });
        if scale.iter().any(|x| *x != 1.0) {
            self.scale = scale;
        }
    }

    /// Of one directed bond.
    pub(super) fn factor(&self, row: usize, line: usize) -> f64 {
        let place = line * TILE + row % TILE;
        self.scale.get(place).copied().unwrap_or(1.0)
    }

    /// Weighted volumes, and what follows.
    pub(super) fn weigh(&mut self, body: &Body<D>) {
        match &self.point_constants {
            PointConstants::None => {}
            PointConstants::PerMaterial(c) => {
                for (slot, field) in self.fields.chunks_mut(2).enumerate() {
                    field[0] = c[body.material_of(slot)];
                }
            }
            PointConstants::PerPoint(all) => {
                for (field, own) in self.fields.chunks_mut(2).zip(all) {
                    field.copy_from_slice(own);
                }
            }
            PointConstants::Solid(solids) => {
                let of = |s: usize| solids[body.material_of(s)];
                let view = self.view(&self.moved);
                let mut per_m = vec![0.0; body.len];
                for (row, &i) in self.list.rows.iter().enumerate() {
                    let i = i as usize;
                    let m = self.sum(row, &self.alive, |j| view.constant(i, j).1);
                    if m > 0.0 {
                        per_m[i] = of(i).beta / m;
                    }
                }
                let ratio = |(s, b): (usize, &f64)| of(s).ratio() * b * b;
                if unlike(solids) {
                    self.pressure = per_m.iter().enumerate().map(ratio).collect();
                }
                for (field, b) in self.fields.chunks_mut(2).zip(per_m) {
                    field.copy_from_slice(&[0.0, b]);
                }
            }
        }
    }
}
