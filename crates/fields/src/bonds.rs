//! Bonds of a block of centres: pairs of atoms with what the terms of the energy put between them.

use crate::kernel::dot;
use std::ops::Range;

/// Numbers of a bond for each part of the potential: force on p from k, churning vector, power.
pub const WIDTH: usize = 7;

/// Bonds of a block, between an atom p and an atom or image k.
#[derive(Default)]
pub struct Bonds {
    /// Centres, and the one in whose terms a bond was first found.
    origins: Vec<[f64; 3]>,
    origin: Vec<u32>,
    /// Where k is, and from there to p.
    pub end: Vec<[f64; 3]>,
    pub bond: Vec<[f64; 3]>,
    /// `WIDTH` numbers for each part: `f_pk`; `E = D_pk − D_kp − f_pk` with `D_pk = ∂U^(p)/∂x_k`; `D_pk·v_k − D_kp·v_p`.
    pub value: Vec<f64>,
}

impl Bonds {
    pub fn len(&self) -> usize {
        self.end.len()
    }

    /// The centre of a bond.
    pub fn origin(&self, n: usize) -> [f64; 3] {
        self.origins[self.origin[n] as usize]
    }

    /// Bonds from one on that have the same centre.
    pub fn about_one_place(&self, first: usize) -> Range<usize> {
        let same = self.origin[first..]
            .iter()
            .take_while(|o| **o == self.origin[first]);
        first..first + same.count()
    }

    /// Distance of the farthest of their ends from the centre (length).
    pub fn span(&self, some: Range<usize>) -> f64 {
        let mut most = 0.0f64;
        for n in some {
            let origin = self.origin(n);
            let d: [f64; 3] = std::array::from_fn(|c| self.end[n][c] - origin[c]);
            let e: [f64; 3] = std::array::from_fn(|c| d[c] + self.bond[n][c]);
            most = most.max(dot(d, d)).max(dot(e, e));
        }
        most.sqrt()
    }

    pub fn reserve(&mut self, more: usize, parts: usize) {
        self.origin.reserve(more);
        self.end.reserve(more);
        self.bond.reserve(more);
        self.value.reserve(more * parts * WIDTH);
    }

    pub fn clear(&mut self) {
        self.origins.clear();
        self.origin.clear();
        self.end.clear();
        self.bond.clear();
        self.value.clear();
    }

    /// A centre after the others.
    pub fn centre(&mut self, x: [f64; 3]) {
        self.origins.push(x);
    }

    /// A bond of a centre that carries nothing so far; its place.
    pub fn add(&mut self, origin: u32, end: [f64; 3], bond: [f64; 3], parts: usize) -> u32 {
        self.origin.push(origin);
        self.end.push(end);
        self.bond.push(bond);
        self.value.resize(self.value.len() + parts * WIDTH, 0.0);
        self.end.len() as u32 - 1
    }

    /// Leave out those that carry nothing.
    pub fn compact(&mut self, parts: usize) {
        let width = parts * WIDTH;
        let mut left = 0;
        for n in 0..self.end.len() {
            let own = n * width..(n + 1) * width;
            if self.value[own.clone()].iter().any(|x| *x != 0.0) {
                self.origin[left] = self.origin[n];
                self.end[left] = self.end[n];
                self.bond[left] = self.bond[n];
                self.value.copy_within(own, left * width);
                left += 1;
            }
        }
        self.origin.truncate(left);
        self.end.truncate(left);
        self.bond.truncate(left);
        self.value.truncate(left * width);
    }

    /// `Σ x_jk ⊗ f_jk` of the pairs (energy), the same of what churns, and whether anything does.
    pub fn virial(&self, parts: usize) -> ([[f64; 9]; 2], bool) {
        let mut sums = [[0.0; 9]; 2];
        let mut churns = false;
        for (d, of) in self.bond.iter().zip(self.value.chunks_exact(parts * WIDTH)) {
            for v in of.chunks_exact(WIDTH) {
                for n in 0..9 {
                    sums[0][n] += d[n / 3] * v[n % 3];
                }
                if v[3..6].iter().any(|e| *e != 0.0) {
                    churns = true;
                    for n in 0..9 {
                        sums[1][n] += d[n / 3] * v[3 + n % 3];
                    }
                }
            }
        }
        (sums, churns)
    }
}

/// What a block of centres adds to an atom.
#[derive(Debug, Clone, PartialEq)]
pub struct Share {
    pub atom: u32,
    pub force: [f64; 3],
    /// `Σ_k v_k · ∂U^(j)/∂x_k` (4.0.107).
    pub power: f64,
}

/// What a block gives.
#[derive(Default)]
pub struct Block {
    pub bonds: Bonds,
    pub shares: Vec<Share>,
    /// Energy of each of `shares`, for each part.
    pub energy: Vec<f64>,
    /// `Σ x_jk ⊗ f_jk` of the pairs (energy), and the same of what churns.
    pub virial: [[f64; 9]; 2],
    /// Is a churning vector not 0?
    pub churns: bool,
}
