//! Places of points among values: those that are here in order of slots, then those of other ranks that bonds lead to.

use crate::body::Body;

/// Places of points among values.
#[derive(Debug, Clone, Default)]
pub struct Places {
    /// Place of the point in a slot.
    of_slots: Vec<u32>,
    /// Slots of the points that are here, and of others', in order of places.
    here: Vec<u32>,
    others: Vec<u32>,
}

impl Places {
    pub fn new<const D: usize>(body: &Body<D>) -> Places {
        let mut here = body.slots().to_vec();
        here.sort_unstable();
        let mut of_slots = vec![u32::MAX; body.len()];
        for (place, slot) in here.iter().enumerate() {
            of_slots[*slot as usize] = place as u32;
        }
        // whoever is not here is called by one of its copies
        let exchange = body.exchange();
        let copies = exchange.copies().filter(|s| exchange.original(*s) == *s);
        let mut others: Vec<u32> = copies.map(|slot| slot as u32).collect();
        others.sort_unstable();
        for (n, slot) in others.iter().enumerate() {
            of_slots[*slot as usize] = (here.len() + n) as u32;
        }
        Places {
            of_slots,
            here,
            others,
        }
    }

    /// Place of the point in a slot.
    pub fn at(&self, slot: usize) -> usize {
        self.of_slots[slot] as usize
    }

    /// Slots of the points that are here, in order of places.
    pub fn here(&self) -> &[u32] {
        &self.here
    }

    /// Places in all.
    pub fn count(&self) -> usize {
        self.here.len() + self.others.len()
    }

    /// What other ranks' points have, behind what those have that are here. All ranks ask at once.
    pub fn fill<const D: usize>(&self, body: &Body<D>, values: &mut [f64]) {
        if !body.exchange().is_shared() {
            return;
        }
        let mut column = vec![0.0; body.len()];
        for (slot, value) in self.here.iter().zip(&*values) {
            column[*slot as usize] = *value;
        }
        body.exchange().fill(&mut column);
        for (slot, value) in self.others.iter().zip(&mut values[self.here.len()..]) {
            *value = column[*slot as usize];
        }
    }

    pub fn bytes(&self) -> usize {
        4 * (self.of_slots.len() + self.here.len() + self.others.len())
    }
}
