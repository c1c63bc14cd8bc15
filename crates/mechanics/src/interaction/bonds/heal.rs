//! Broken bonds that become whole again.

use super::family::{Family, Slots};
use super::state::BondState;
use crate::body::Body;
use crate::interaction::criterion::Measure;

impl<const D: usize, F: Family<D>> BondState<D, F> {
    /// Do bonds end by what they bear themselves? Plastic strain and damage are of points, which stay what they are: between such points a new bond would
    /// break at once.
    pub fn ends_by_bonds(&self) -> bool {
        self.law.failure.is_none() && !matches!(self.criteria.measure, Measure::PlasticStrain(_))
    }

    /// Bonds begin anew: nothing was done to them, they remember nothing but the temperature of their point, and points with all of their bonds have lost
    /// nothing.
    pub(super) fn renew(&mut self, body: &Body<D>, bonds: &[(usize, usize, usize)]) {
        let count = self.law.memory;
        let warm = self.law.temperature.filter(|_| self.law.gathers);
        for &(group, k, l) in bonds {
            let slot = self.family.rows(group).slot(l);
            for n in 0..count {
                let at = self.family.own(group, k, n, count) + l;
                self.memory[at] = match warm == Some(n) {
                    true => self.past.get(n, slot),
                    false => 0.0,
                };
            }
            for (all, new) in [(&mut self.work, 0.0), (&mut self.life, 1.0)] {
                if !all.is_empty() {
                    all[self.family.own(group, k, 0, 1) + l] = new;
                }
            }
            let mut others = 0..self.family.bonds(group);
            let has = |k| self.is_whole(group, k, l) || !self.is_counted(group, k, l);
            if !self.integrity.is_empty() && others.all(has) {
                self.integrity[slot] = 1.0;
            }
        }
        self.fill_memory(body);
        self.look_integrity(body);
    }
}
