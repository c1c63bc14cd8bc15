//! Conductances of the bonds of a body.

use super::places::Places;
use crate::body::Body;
use crate::error::BuildError;
use crate::execute::for_each_piece;
use crate::execute::memory;
use crate::interaction::{BondStatus, EachBond, Interaction};

/// Of every directed bond, row by row; points stand in the order of their [places](Places).
#[derive(Debug, Clone)]
pub struct Rows {
    /// First bond of each row, and where the last ends.
    start: Vec<usize>,
    partner: Vec<u32>,
    /// `D k ω ν V_i V_j` of bonds, the same bits at both ends, and what each has in the weighted volume of its point, `ω ν |ξ|² V_j`.
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
    pub places: &'a Places,
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

/// The bonds that damage counts, seen from each of their points.
fn each_counted<const D: usize>(
    body: &Body<D>,
    interaction: &dyn Interaction<D>,
    visit: &mut EachBond<D>,
) {
    interaction.each_partner(body, &mut |i, j, xi, state| {
        if state != BondStatus::Absent {
            visit(i, j, xi, state);
        }
    });
}

impl Rows {
    /// `g_ij = D k ω ν (1/m_i + 1/m_j) V_i V_j` of every whole bond, `m_i = Σ_j ω ν |ξ|² V_j` over these, and k the harmonic mean of
    /// both ends' conductivities; 0 of bonds that are broken from the start. Of a body that is exact at its surface each is multiplied with its
    /// factor and `m_i` is that of a full family, less the part that broken bonds had in the sum. All ranks ask at once.
    pub fn new<const D: usize>(
        body: &Body<D>,
        interaction: &dyn Interaction<D>,
        of: &Conduction<D>,
    ) -> Rows {
        let points = body.points();
        let place = |slot: usize| of.places.at(slot);
        let volume = |slot: usize| body.volume().at(slot);
        let mut start = vec![0usize; points + 1];
        each_counted(body, interaction, &mut |i, _, _, _| {
            start[place(i) + 1] += 1
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
        let ids = body.ids_of_all();
        let weight = |i: usize, j: usize, xi: &[f64; D], r: f64| {
            let weight = (of.weight)(i, j, xi, r);
            let Some(surface) = &of.surface else {
                return weight;
            };
            // one factor for both ends
            let factor = match ids[i] < ids[j] {
                true => (surface.factor)(i, j, xi),
                false => (surface.factor)(j, i, &xi.map(|x| -x)),
            };
            weight * factor
        };
        let mut next = rows.start.clone();
        each_counted(body, interaction, &mut |i, j, xi, _| {
            let square: f64 = xi.iter().map(|x| x * x).sum();
            let [a, b] = [(of.conductivity)(i), (of.conductivity)(j)];
            let k = match a == b {
                true => a,
                false => 2.0 * (a * b) / (a + b),
            };
            let weight = weight(i, j, &xi, square.sqrt());
            let at = next[place(i)];
            next[place(i)] += 1;
            rows.partner[at] = place(j) as u32;
            rows.reach[at] = k * (D as f64 * weight) * (volume(i) * volume(j));
            rows.part[at] = weight * square * volume(j);
        });
        if let Some(surface) = &of.surface {
            // a full family has those, too, that were never there
            let mut absent = vec![0.0; points];
            interaction.each_partner(body, &mut |i, j, xi, state| {
                if state == BondStatus::Absent {
                    let square: f64 = xi.iter().map(|x| x * x).sum();
                    let weight = weight(i, j, &xi, square.sqrt());
                    absent[place(i)] += weight * square * volume(j);
                }
            });
            for slot in body.slots() {
                let row = place(*slot as usize);
                let part = &mut rows.part[rows.start[row]..rows.start[row + 1]];
                if let Some(moment) = (surface.moment)(*slot as usize) {
                    let full = moment / (part.iter().sum::<f64>() + absent[row]);
                    part.iter_mut().for_each(|p| *p *= full);
                }
            }
        }
        rows.conduct(body, interaction, of.places);
        rows
    }

    /// Is there room for them?
    ///
    /// # Errors
    /// There is not.
    pub fn fit<const D: usize>(
        body: &Body<D>,
        interaction: &dyn Interaction<D>,
        path: &str,
    ) -> Result<(), BuildError> {
        let bonds = interaction.directed_bonds() as f64;
        let bytes = 28.0 * bonds + 64.0 * body.points() as f64;
        memory::afford(
            path,
            "the conductances of the bonds",
            bytes,
            "a smaller body, horizon or m_ratio",
        )
    }

    /// Conductances of the bonds that are whole now: the same of faces that were cut before and of those that opened since. All ranks ask at once.
    pub fn conduct<const D: usize>(
        &mut self,
        body: &Body<D>,
        interaction: &dyn Interaction<D>,
        places: &Places,
    ) {
        let mut next = self.start.clone();
        let mut moment = vec![0.0; places.count()];
        let (conductance, part) = (&mut self.conductance, &self.part);
        each_counted(body, interaction, &mut |i, _, _, state| {
            let row = places.at(i);
            let at = next[row];
            next[row] += 1;
            conductance[at] = match state {
                BondStatus::Whole => 1.0,
                BondStatus::Broken | BondStatus::Absent => 0.0,
            };
            moment[row] += conductance[at] * part[at];
        });
        places.fill(body, &mut moment);
        for row in 0..self.total.len() {
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

    /// Is every point, over bonds that conduct, tied to one of these places? All ranks ask at once.
    pub fn are_tied<const D: usize>(
        &self,
        body: &Body<D>,
        places: &Places,
        to: impl Iterator<Item = u32>,
    ) -> bool {
        let parts = self.parts(places.count());
        let mut tied = vec![0.0; parts.len()];
        to.for_each(|i| tied[i as usize] = 1.0);
        loop {
            let mut part_is = vec![false; parts.len()];
            for (part, tied) in parts.iter().zip(&tied) {
                part_is[*part as usize] |= *tied > 0.0;
            }
            let before = tied.clone();
            for (part, tied) in parts.iter().zip(&mut tied) {
                *tied = f64::from(part_is[*part as usize]);
            }
            // parts go on beyond what is here
            places.fill(body, &mut tied);
            if !body.exchange().any(tied != before) {
                let free = tied[..self.points()].contains(&0.0);
                return !body.exchange().any(free);
            }
        }
    }

    /// Number of the part of each place, whose bonds conduct to each other, by its lowest one.
    fn parts(&self, places: usize) -> Vec<u32> {
        let mut part: Vec<u32> = (0..places as u32).collect();
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
        (0..places as u32).map(|i| find(&mut part, i)).collect()
    }

    pub fn bytes(&self) -> usize {
        8 * self.start.len() + 28 * self.partner.len() + 8 * self.total.len()
    }
}
