//! Conductances of the bonds of a body.

use crate::body::Body;
use crate::error::BuildError;
use crate::execute::for_each_piece;
use crate::execute::memory;
use crate::interaction::{BondStatus, Interaction};

/// Of every directed bond, row by row; points stand in the order of their slots.
#[derive(Debug, Clone)]
pub struct Rows {
    /// First bond of each row, and where the last ends.
    start: Vec<usize>,
    partner: Vec<u32>,
    /// `D k ω ν V_i V_j` of bonds, and what each has in the weighted volume of its point, `ω ν |ξ|² V_j`.
    reach: Vec<f64>,
    part: Vec<f64>,
    /// g_ij (power / temperature); 0: broken.
    conductance: Vec<f64>,
    /// Σ_j g_ij
    total: Vec<f64>,
}

/// What a conductance is made of.
pub struct Conduction<'a, const D: usize> {
    /// Conductivity of the material of a slot.
    pub conductivity: &'a dyn Fn(usize) -> f64,
    /// `ω ν` of a bond between two slots of a length.
    pub weight: &'a dyn Fn(usize, usize, &[f64], f64) -> f64,
    /// Place of the point in a slot.
    pub place: &'a [u32],
    /// Of a body that is exact at its surface; `None`: each end has the weighted volume of the bonds that it has.
    pub surface: Option<Surface<'a, D>>,
}

/// What makes a constant gradient steady at every point of a body that ends at its outer points.
pub struct Surface<'a, const D: usize> {
    /// Factor of the conductance of the bond from a slot to another, that way.
    pub factor: &'a dyn Fn(usize, usize, &[f64; D]) -> f64,
    /// `Σ ω ν |ξ|² V` of a full family, by the slot of a point; `None`: of one in a body that ends otherwise.
    pub moment: &'a dyn Fn(usize) -> Option<f64>,
}

impl Rows {
    /// `g_ij = D k ω ν (1/m_i + 1/m_j) V_i V_j` of every whole bond, `m_i = Σ_j ω ν |ξ|² V_j` over these, and k the harmonic mean of
    /// both ends' conductivities; 0 of bonds that are broken from the start. Of a body that is exact at its surface each is multiplied with its
    /// factor and `m_i` is that of a full family, less the part that broken bonds had in the sum.
    ///
    /// # Errors
    /// They do not fit into memory.
    pub fn new<const D: usize>(
        body: &Body<D>,
        interaction: &dyn Interaction<D>,
        of: &Conduction<D>,
        path: &str,
    ) -> Result<Rows, BuildError> {
        let points = body.points();
        let bonds = interaction.directed_bonds() as f64;
        let bytes = 28.0 * bonds + 64.0 * points as f64;
        memory::afford(
            path,
            "the conductances of the bonds",
            bytes,
            "a smaller body, horizon or m_ratio",
        )?;
        let place = |slot: usize| of.place[slot] as usize;
        let volume = |slot: usize| body.volume().at(slot);
        let mut start = vec![0usize; points + 1];
        interaction.each_bond(body, &mut |i, j, _, _| {
            for slot in [i, j] {
                start[place(slot) + 1] += 1;
            }
        });
        for n in 1..=points {
            start[n] += start[n - 1];
        }
        let bonds = start[points];
        let mut rows = Rows {
            partner: vec![0; bonds],
            reach: vec![0.0; bonds],
            part: vec![0.0; bonds],
            conductance: vec![0.0; bonds],
            total: vec![0.0; points],
            start,
        };
        let mut next = rows.start.clone();
        interaction.each_bond(body, &mut |i, j, xi, _| {
            let xi = &xi;
            let square: f64 = xi.iter().map(|x| x * x).sum();
            let [a, b] = [(of.conductivity)(i), (of.conductivity)(j)];
            let k = match a == b {
                true => a,
                false => 2.0 * a * b / (a + b),
            };
            let weight = (of.weight)(i, j, xi, square.sqrt());
            let factor = of.surface.as_ref().map_or(1.0, |s| (s.factor)(i, j, xi));
            let weight = weight * factor;
            let reach = k * (D as f64 * weight) * volume(i) * volume(j);
            for (a, b) in [(i, j), (j, i)] {
                let at = next[place(a)];
                rows.partner[at] = place(b) as u32;
                rows.reach[at] = reach;
                rows.part[at] = weight * square * volume(b);
                next[place(a)] += 1;
            }
        });
        if let Some(surface) = &of.surface {
            for slot in body.slots() {
                let row = place(*slot as usize);
                let part = &mut rows.part[rows.start[row]..rows.start[row + 1]];
                if let Some(moment) = (surface.moment)(*slot as usize) {
                    let full = moment / part.iter().sum::<f64>();
                    part.iter_mut().for_each(|p| *p *= full);
                }
            }
        }
        rows.conduct(body, interaction, of.place);
        Ok(rows)
    }

    /// Conductances of the bonds that are whole now: the same of faces that were cut before and of those that opened since.
    pub fn conduct<const D: usize>(
        &mut self,
        body: &Body<D>,
        interaction: &dyn Interaction<D>,
        place: &[u32],
    ) {
        let mut next = self.start.clone();
        let mut moment = vec![0.0; self.total.len()];
        let (conductance, part) = (&mut self.conductance, &self.part);
        interaction.each_bond(body, &mut |i, j, _, state| {
            for slot in [i, j] {
                let row = place[slot] as usize;
                let at = next[row];
                next[row] += 1;
                conductance[at] = match state {
                    BondStatus::Whole => 1.0,
                    BondStatus::Broken | BondStatus::Absent => 0.0,
                };
                moment[row] += conductance[at] * part[at];
            }
        });
        for row in 0..moment.len() {
            for at in self.start[row]..self.start[row + 1] {
                if self.conductance[at] > 0.0 {
                    let other = moment[self.partner[at] as usize];
                    self.conductance[at] = self.reach[at] * (1.0 / moment[row] + 1.0 / other);
                }
            }
        }
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
        8 * self.start.len() + 28 * self.partner.len() + 8 * self.total.len()
    }
}
