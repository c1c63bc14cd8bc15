//! What depends on the whole families of points: weighted volumes, and what follows.

use super::ListInteraction;
use crate::body::Body;
use crate::interaction::PointConstants;
use crate::interaction::bonds::family::Family;
use crate::interaction::point_constants::unlike;
use crate::law::{BondFactors, Law};

impl<const D: usize, W: Law> ListInteraction<D, W> {
    /// Multiply the factors of bonds.
    pub(super) fn multiply_factors(
        &mut self,
        factors: &dyn Fn(usize, usize, [i32; D]) -> BondFactors<f64>,
    ) {
        let mut scale = std::mem::take(&mut self.scale);
        scale.resize(self.bonds.family.memory(), 1.0);
        // points of a list know no cells
        self.each_line(|place, _, [i, j]| scale[place] *= factors(i, j, [0; D]).pair);
        if scale.iter().any(|x| *x != 1.0) {
            self.scale = scale;
        }
    }

    /// Of one directed bond.
    pub(super) fn factor(&self, place: usize) -> f64 {
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
                let view = self.view(self.moved());
                let mut per_m = vec![0.0; body.len];
                self.each_line(|_, whole, [i, j]| {
                    if whole {
                        per_m[i] += view.constant(i, j).1;
                    }
                });
                for (i, m) in per_m.iter_mut().enumerate() {
                    *m = if *m > 0.0 { of(i).beta / *m } else { 0.0 };
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
