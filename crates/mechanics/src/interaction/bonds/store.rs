//! Where numbers of points lie: a column for each, or records of four for gathers.

use crate::body::Exchange;
use crate::execute::blocks::{Seen, Shared};

/// Columns begin so far apart that a sweep's loads do not compete for the same cache lines (see [`crate::body::field`]).
const PAGE: usize = 512;
const OFF: usize = 72;

/// How `numbers` of each of so many slots are laid out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Layout {
    pub numbers: usize,
    slots: usize,
    /// Numbers from column to column, or from quadruple to quadruple.
    pub stride: usize,
    pub records: bool,
}

impl Layout {
    /// A column per number.
    pub fn columns(numbers: usize, slots: usize) -> Layout {
        Layout {
            numbers,
            slots,
            stride: slots.next_multiple_of(PAGE) + OFF,
            records: false,
        }
    }

    /// Records of four numbers, as many as they take.
    pub fn records(numbers: usize, slots: usize) -> Layout {
        Layout {
            numbers,
            slots,
            stride: 4 * slots,
            records: true,
        }
    }

    pub fn len(&self) -> usize {
        if self.numbers == 0 {
            0
        } else if self.records {
            self.numbers.div_ceil(4) * self.stride
        } else {
            (self.numbers - 1) * self.stride + self.slots
        }
    }

    /// Place of number `n` of a slot.
    #[inline(always)]
    pub fn at(&self, n: usize, slot: usize) -> usize {
        if self.records {
            n / 4 * self.stride + 4 * slot + n % 4
        } else {
            n * self.stride + slot
        }
    }
}

/// Numbers of points.
#[derive(Debug, Clone)]
pub struct Store {
    pub layout: Layout,
    pub data: Vec<f64>,
}

impl Store {
    pub fn zeros(layout: Layout) -> Store {
        Store {
            layout,
            data: vec![0.0; layout.len()],
        }
    }

    pub fn get(&self, n: usize, slot: usize) -> f64 {
        self.data[self.layout.at(n, slot)]
    }

    /// All of a slot.
    pub fn numbers(&self, slot: usize) -> Vec<f64> {
        (0..self.layout.numbers)
            .map(|n| self.get(n, slot))
            .collect()
    }

    pub fn set(&mut self, n: usize, slot: usize, x: f64) {
        let at = self.layout.at(n, slot);
        self.data[at] = x;
    }

    /// For sweeps that write their own points.
    pub fn shared(&mut self) -> OwnRows {
        OwnRows {
            layout: self.layout,
            data: Shared(self.data.as_mut_ptr()),
        }
    }

    /// For sweeps that read.
    pub fn view(&self) -> Rows {
        Rows {
            layout: self.layout,
            data: Seen(self.data.as_ptr()),
        }
    }

    /// Fills the copies of all numbers.
    pub fn fill(&mut self, exchange: &Exchange) {
        let layout = self.layout;
        exchange.fill_numbers(&mut self.data, layout.numbers, |slot, n| layout.at(n, slot));
    }

    pub fn bytes(&self) -> usize {
        8 * self.data.len()
    }
}

/// A store as a sweep sees it.
#[derive(Clone, Copy)]
pub struct Rows {
    pub layout: Layout,
    pub data: Seen,
}

/// A store that a sweep writes, each block its own points.
#[derive(Clone, Copy)]
pub struct OwnRows {
    pub layout: Layout,
    pub data: Shared,
}

impl OwnRows {
    /// For those who read beside that.
    pub fn seen(self) -> Rows {
        Rows {
            layout: self.layout,
            data: self.data.seen(),
        }
    }
}
