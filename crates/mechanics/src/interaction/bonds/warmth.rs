//! Temperatures of laws that know one: those of the body, where that conducts heat.

use super::family::Family;
use super::state::BondState;
use crate::body::Body;

impl<const D: usize, F: Family<D>> BondState<D, F> {
    /// Points have these temperatures above those of reference, and their bonds where these remember one; false: the law knows none.
    pub fn warm(&mut self, body: &Body<D>, above: &[f64]) -> bool {
        let Some(n) = self.law.temperature else {
            return false;
        };
        for &slot in &body.slots {
            self.past.set(n, slot as usize, above[slot as usize]);
        }
        if !self.law.gathers {
            return true;
        }
        for (group, l, slot) in self.family.points() {
            for k in 0..self.family.bonds(group) {
                self.memory[self.family.own(group, k, n, self.law.memory) + l] = above[slot];
            }
        }
        self.fill_memory(body);
        true
    }

    /// Writes the temperatures of points: of bonds that remember one the mean over those that are whole, `Σ ω ν V T / Σ ω ν V`.
    pub fn read_warmth(&self, body: &Body<D>, above: &mut [f64]) {
        let Some(n) = self.law.temperature else {
            return;
        };
        if !self.law.gathers {
            for slot in body.slots.iter().map(|s| *s as usize) {
                let now = self.past.get(n, slot);
                above[slot] = match self.integrity_at(slot) {
                    1.0 => now,
                    // what is left of the point dissipates so much less
                    left => left.mul_add(now - above[slot], above[slot]),
                };
            }
            return;
        }
        for (group, l, slot) in self.family.points() {
            // of what they grew: bonds that are as warm as they were leave the last bit alone
            let (mut grown, mut whole) = (0.0, 0.0);
            for (k, _, omega, volume) in self.bonds_of(group, l) {
                let now = self.memory[self.family.own(group, k, n, self.law.memory) + l];
                grown += omega * volume * (now - above[slot]);
                whole += omega * volume;
            }
            if whole > 0.0 {
                above[slot] += self.integrity_at(slot) * grown / whole;
            }
        }
    }
}
