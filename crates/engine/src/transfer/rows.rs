//! Conductances of the bonds of a body.

use crate::body::Body;
use crate::error::BuildError;
use crate::execute::blocks::for_each_piece;
use crate::execute::memory;
use crate::interaction::{BondState, Interaction};

/// Of every directed bond, row by row; points stand in the order of their slots.
#[derive(Debug, Clone)]
pub struct Rows {
    /// First bond of each row, and where the last ends.
    start: Vec<usize>,
    partner: Vec<u32>,
    /// g_ij (power / temperature); 0: broken.
    conductance: Vec<f64>,
    /// Σ_j g_ij
    total: Vec<f64>,
}

/// What a conductance is made of.
pub struct Conduction<'a> {
    /// Conductivity of the material of a slot.
    pub conductivity: &'a dyn Fn(usize) -> f64,
    /// `ω ν` of a bond between two slots of a length.
    pub weight: &'a dyn Fn(usize, usize, f64) -> f64,
    /// Place of the point in a slot.
    pub place: &'a [u32],
}

impl Rows {
    /// `g_ij = D k ω ν (1/m_i + 1/m_j) V_i V_j` of every whole bond, `m_i = Σ_j ω ν |ξ|² V_j` over these, and k the harmonic mean of
    /// both ends' conductivities; 0 of bonds that are broken from the start.
    ///
    /// # Errors
    /// They do not fit into memory.
    pub fn new<const D: usize>(
        body: &Body<D>,
        interaction: &dyn Interaction<D>,
        of: &Conduction,
        path: &str,
    ) -> Result<Rows, BuildError> {
        let points = body.points();
        let bonds = interaction.directed_bonds() as f64;
        let bytes = 12.0 * bonds + 64.0 * points as f64;
        memory::afford(
            path,
            "the conductances of the bonds",
            bytes,
            "a smaller body, horizon or m_ratio",
        )?;
        let place = |slot: usize| of.place[slot] as usize;
        let volume = |slot: usize| body.volume.at(slot);
        let mut count = vec![0usize; points + 1];
        let mut moment = vec![0.0; points];
        interaction.each_bond(body, &mut |i, j, xi, state| {
            let square: f64 = xi.iter().map(|x| x * x).sum();
            let weight = match state {
                BondState::Whole => (of.weight)(i, j, square.sqrt()) * square,
                BondState::Broken => 0.0,
            };
            for (a, b) in [(i, j), (j, i)] {
                count[place(a) + 1] += 1;
                moment[place(a)] += weight * volume(b);
            }
        });
        let mut start = count;
        for n in 1..=points {
            start[n] += start[n - 1];
        }
        let bonds = start[points];
        let mut rows = Rows {
            partner: vec![0; bonds],
            conductance: vec![0.0; bonds],
            total: vec![0.0; points],
            start,
        };
        let mut next = rows.start.clone();
        interaction.each_bond(body, &mut |i, j, xi, state| {
            let length = xi.iter().map(|x| x * x).sum::<f64>().sqrt();
            let [a, b] = [(of.conductivity)(i), (of.conductivity)(j)];
            let k = match a == b {
                true => a,
                false => 2.0 * a * b / (a + b),
            };
            let ends = 1.0 / moment[place(i)] + 1.0 / moment[place(j)];
            let weight = D as f64 * (of.weight)(i, j, length) * ends;
            let g = match state {
                BondState::Whole => k * weight * volume(i) * volume(j),
                BondState::Broken => 0.0,
            };
            for (a, b) in [(place(i), place(j)), (place(j), place(i))] {
                rows.partner[next[a]] = b as u32;
                rows.conductance[next[a]] = g;
                next[a] += 1;
            }
        });
        rows.add_up();
        Ok(rows)
    }

    /// Bonds that are broken conduct no longer.
    pub fn break_bonds<const D: usize>(
        &mut self,
        body: &Body<D>,
        interaction: &dyn Interaction<D>,
        place: &[u32],
    ) {
        let mut next = self.start.clone();
        interaction.each_bond(body, &mut |i, j, _, state| {
            for slot in [i, j] {
                let row = place[slot] as usize;
                if state == BondState::Broken {
                    self.conductance[next[row]] = 0.0;
                }
                next[row] += 1;
            }
        });
        self.add_up();
    }

    fn add_up(&mut self) {
        for (n, total) in self.total.iter_mut().enumerate() {
            *total = self.conductance[self.start[n]..self.start[n + 1]]
                .iter()
                .sum();
        }
    }

    pub fn points(&self) -> usize {
        self.total.len()
    }

    /// Σ_j g_ij of each point.
    pub fn totals(&self) -> &[f64] {
        &self.total
    }

    /// `into_i = Σ_j g_ij (T_j − T_i)`: what a bond gives to one end is what it takes from the other, to the last bit.
    pub fn flow(&self, value: impl Fn(usize) -> f64 + Sync, into: &mut [f64]) {
        for_each_piece(into, |first, piece| {
            for (n, into) in piece.iter_mut().enumerate() {
                let i = first + n;
                let own = value(i);
                let row = self.start[i]..self.start[i + 1];
                let bonds = self.partner[row.clone()].iter();
                let mut sum = 0.0;
                for (j, g) in bonds.zip(&self.conductance[row]) {
                    sum += g * (value(*j as usize) - own);
                }
                *into = sum;
            }
        });
    }

    /// Number of the part of each point, whose bonds conduct to each other, by its lowest point.
    pub fn parts(&self) -> Vec<u32> {
        let mut part: Vec<u32> = (0..self.points() as u32).collect();
        let find = |part: &mut Vec<u32>, mut i: u32| {
            while part[i as usize] != i {
                part[i as usize] = part[part[i as usize] as usize];
                i = part[i as usize];
            }
            i
        };
        for i in 0..self.points() {
            for b in self.start[i]..self.start[i + 1] {
                if self.conductance[b] > 0.0 {
                    let [a, b] = [i as u32, self.partner[b]].map(|i| find(&mut part, i));
                    part[a.max(b) as usize] = a.min(b);
                }
            }
        }
        (0..self.points() as u32)
            .map(|i| find(&mut part, i))
            .collect()
    }

    pub fn bytes(&self) -> usize {
        8 * self.start.len() + 12 * self.partner.len() + 8 * self.total.len()
    }
}
