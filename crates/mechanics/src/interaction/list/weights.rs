//! What depends on the bonds one by one: factors, weighted volumes, and what follows.

use super::ListInteraction;
use crate::body::Body;
use crate::interaction::bonds::family::{Family, Slots};
use crate::interaction::{FactorsOf, PointConstants};
use crate::law::Law;

impl<const D: usize, W: Law> ListInteraction<D, W> {
    /// Every directed bond of the list: place, in order of rows; is it whole; slots.
    pub(super) fn each_line(&self, mut visit: impl FnMut(usize, bool, [usize; 2])) {
        let family = &self.bonds.family;
        for (group, k, l) in self.bonds.pairs() {
            let ends = [family.rows(group), family.ends(group, k)].map(|s| s.slot(l));
            let whole = self.bonds.is_whole(group, k, l);
            visit(family.own(group, k, 0, 1) + l, whole, ends);
        }
    }

    /// Fields of a point.
    pub(super) fn field(&self, slot: usize) -> [f64; 2] {
        [0, 1].map(|n| self.fields.get(2 * slot + n).copied().unwrap_or(0.0))
    }

    /// Multiply the factors of bonds.
    pub(super) fn multiply_factors(&mut self, factors: &FactorsOf<D>) {
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
        let mut m = vec![0.0; body.len];
        if matches!(self.point_constants, PointConstants::Solid(_)) {
            let view = self.view(self.moved());
            self.each_line(|_, whole, [i, j]| {
                if whole {
                    m[i] += view.constant(i, j).1;
                }
            });
        }
        self.pressure.clear();
        for (slot, field) in self.fields.chunks_mut(2).enumerate() {
            let material = body.material_of(slot);
            let (own, pressure) = self.point_constants.fields(slot, material, m[slot]);
            field.copy_from_slice(&own);
            self.pressure.extend(pressure);
        }
        if !self.fields.is_empty() {
            let at = |slot: usize, n: usize| 2 * slot + n;
            body.exchange.fill_numbers(&mut self.fields, 2, at);
        }
    }
}
