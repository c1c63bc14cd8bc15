//! Points and bonds in plain numbers, for those who look at them one by one.

use super::family::Family;
use super::state::BondState;
use crate::body::FieldView;
use crate::execute::blocks::Seen;

/// What a law has of a point beside its bonds.
pub struct PlainPoint {
    pub constants: Vec<f64>,
    pub form: Vec<f64>,
    pub past: Vec<f64>,
    /// [`Around::section`](crate::law::material::Around)
    pub section: f64,
}

impl<const D: usize, F: Family<D>> BondState<D, F> {
    /// `constants`: `[materials][numbers]`
    pub fn plain_point(&self, constants: &[f64], slot: usize) -> PlainPoint {
        let mut section = 0.0;
        if self.law.section && D == 2 && !self.held.is_empty() && !self.expansion.is_empty() {
            let strain = self.expansion[slot];
            section = (0.0 - strain) / (1.0 + strain);
        }
        PlainPoint {
            constants: self.plain_constants(constants, slot),
            form: self.form.numbers(slot),
            past: self.past.numbers(slot),
            section,
        }
    }

    /// η of the bond ξ between two slots of the family as laws see it, beyond what temperature or swelling gives the bond.
    pub fn plain_eta(&self, u: FieldView<D>, [i, end]: [usize; 2], xi: &[f64; D]) -> [f64; D] {
        let mut eta: [f64; D] = crate::array::from_fn(|a| u[a][end] - u[a][i]);
        if !self.expansion.is_empty() {
            let strain = 0.5 * (self.expansion[i] + self.expansion[end]);
            for a in 0..D {
                eta[a] = (eta[a] - strain * xi[a]) / (1.0 + strain);
            }
        }
        eta
    }

    /// Constants of a slot, of `[materials][numbers]`.
    pub fn plain_constants(&self, constants: &[f64], slot: usize) -> Vec<f64> {
        let count = self.law.constants;
        match self.placed.data.is_empty() {
            true => constants[self.material_at(slot) * count..][..count].to_vec(),
            false => self.placed.numbers(slot),
        }
    }

    /// What a bond remembers.
    pub fn memory_at(&self, group: usize, k: usize, l: usize) -> Vec<f64> {
        let count = self.law.memory;
        let numbers = (0..count).map(|n| self.memory[self.family.own(group, k, n, count) + l]);
        numbers.collect()
    }

    /// What the bond remembers that leads back.
    pub fn memory_back(&self, group: usize, k: usize, l: usize) -> Vec<f64> {
        let (count, memory) = (self.law.memory, Seen(self.memory.as_ptr()));
        // SAFETY: numbers for every bond of the family
        let number = |n| unsafe { self.family.back::<f64>(memory, group, k, l, n, count) };
        (0..count).map(number).collect()
    }
}
