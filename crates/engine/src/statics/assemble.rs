//! The linear body of any law about any state: tangents of bonds, gathered row by row.

use super::linear_body::LinearBody;
use crate::body::{Body, Field};
use crate::interaction::{BondTangent, Interaction};
use rayon::prelude::*;

/// Points per piece of work.
const CHUNK: usize = 512;

/// The body's micromoduli at displacement `u`, images of which are fresh. State-based laws reach two families.
pub fn linear_body<const D: usize>(
    body: &Body<D>,
    interaction: &mut dyn Interaction<D>,
    u: &Field<D>,
) -> LinearBody<D> {
    let mut id = vec![u32::MAX; body.len];
    for (n, &s) in body.slots.iter().enumerate() {
        id[s as usize] = n as u32;
    }
    let mut bonds: Vec<BondTangent<D>> = vec![];
    interaction.tangents(body, u, &mut |mut bond| {
        (bond.i, bond.j) = (id[bond.i] as usize, id[bond.j] as usize);
        bonds.push(bond);
    });
    bonds.sort_by_key(|b| b.i);
    let n = body.points();
    let mut first = vec![0; n + 1];
    for b in &bonds {
        first[b.i + 1] += 1;
    }
    for i in 0..n {
        first[i + 1] += first[i];
    }
    let rows = Rows {
        bonds: &bonds,
        first: &first,
        gain: body
            .slots
            .iter()
            .map(|s| interaction.gain(*s as usize))
            .collect(),
    };
    let points: Vec<usize> = (0..n).collect();
    let parts: Vec<Part<D>> = points
        .par_chunks(CHUNK)
        .map_init(|| Row::empty(n), |row, chunk| rows.part(chunk, row))
        .collect();
    let at = |s: u32| {
        let x = body.position(s as usize);
        std::array::from_fn(|a| x[a])
    };
    let per_point =
        |v: &crate::body::Values| body.slots.iter().map(|s| v.at(*s as usize)).collect();
    let mut made = LinearBody {
        position: body.slots.iter().map(|s| at(*s)).collect(),
        volume: per_point(&body.volume),
        density: per_point(&body.density),
        period: body.period,
        start: vec![0],
        partner: Vec::with_capacity(parts.iter().map(|p| p.partner.len()).sum()),
        block: Vec::with_capacity(parts.iter().map(|p| p.partner.len()).sum()),
    };
    for part in parts {
        let begin = made.partner.len();
        made.start.extend(part.end.iter().map(|e| begin + e));
        made.partner.extend(part.partner);
        made.block.extend(part.block);
    }
    made
}

/// Rows of some points.
struct Part<const D: usize> {
    end: Vec<usize>,
    partner: Vec<u32>,
    block: Vec<[[f64; D]; D]>,
}

struct Rows<'a, const D: usize> {
    /// In order of i.
    bonds: &'a [BondTangent<D>],
    first: &'a [usize],
    gain: Vec<f64>,
}

/// One row in the making: which place each partner has.
struct Row<const D: usize> {
    place: Vec<u32>,
    entries: Vec<(u32, [[f64; D]; D])>,
}

impl<const D: usize> Row<D> {
    fn empty(points: usize) -> Self {
        Row {
            place: vec![u32::MAX; points],
            entries: vec![],
        }
    }

    fn add(&mut self, j: usize, block: impl Fn(usize, usize) -> f64) {
        if self.place[j] == u32::MAX {
            self.place[j] = self.entries.len() as u32;
            self.entries.push((j as u32, [[0.0; D]; D]));
        }
        let entry = &mut self.entries[self.place[j] as usize].1;
        for a in 0..D {
            for b in 0..D {
                entry[a][b] += block(a, b);
            }
        }
    }
}

impl<const D: usize> Rows<'_, D> {
    fn of(&self, i: usize) -> &[BondTangent<D>] {
        &self.bonds[self.first[i]..self.first[i + 1]]
    }

    fn part(&self, points: &[usize], row: &mut Row<D>) -> Part<D> {
        let mut part = Part {
            end: vec![],
            partner: vec![],
            block: vec![],
        };
        for &i in points {
            self.gather(i, row);
            row.entries.sort_unstable_by_key(|e| e.0);
            for (j, block) in row.entries.drain(..) {
                row.place[j as usize] = u32::MAX;
                // a point does not pull itself
                if j as usize != i {
                    part.partner.push(j);
                    part.block.push(block);
                }
            }
            part.end.push(part.partner.len());
        }
        part
    }

    /// Every `η_jk` is `(u_k − u_i) − (u_j − u_i)`.
    fn gather(&self, i: usize, row: &mut Row<D>) {
        let mut pulls = [0.0; D];
        for bond in self.of(i) {
            row.add(bond.j, |a, b| bond.stiffness[a][b]);
            for a in 0..D {
                pulls[a] += bond.pull[0][a];
            }
            let gain = self.gain[bond.j];
            if gain != 0.0 {
                let mut shares = [0.0; D];
                for far in self.of(bond.j) {
                    row.add(far.j, |a, b| gain * bond.pull[1][a] * far.share[b]);
                    for b in 0..D {
                        shares[b] += far.share[b];
                    }
                }
                row.add(bond.j, |a, b| -gain * bond.pull[1][a] * shares[b]);
            }
        }
        let gain = self.gain[i];
        if gain != 0.0 {
            for bond in self.of(i) {
                row.add(bond.j, |a, b| gain * pulls[a] * bond.share[b]);
            }
        }
    }
}
