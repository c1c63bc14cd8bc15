//! The linear body of any law about any state: tangents of bonds, gathered row by row.

use crate::body::{Body, Field, view};
use crate::interaction::{BondTangent, Channel, ContactForces, Interaction};
use crate::spec::{LinearBody, add_alike};
use rayon::prelude::*;

/// Points per piece of work.
const CHUNK: usize = 512;

/// The body's micromoduli at displacement `u`, images of which are fresh. State-based laws reach two families. Of a body that ranks share the first has
/// it, `None` the others.
pub fn linear_body<const D: usize>(
    body: &Body<D>,
    interaction: &mut dyn Interaction<D>,
    u: &Field<D>,
) -> Option<LinearBody<D>> {
    linear_body_touching(body, interaction, None, u)
}

/// The same with points that touch, as contact found them at `u`.
pub fn linear_body_touching<const D: usize>(
    body: &Body<D>,
    interaction: &mut dyn Interaction<D>,
    contact: Option<&ContactForces<D>>,
    u: &Field<D>,
) -> Option<LinearBody<D>> {
    let id = body.id_of();
    let mut bonds = Bonds::default();
    let mut push = |mut bond: BondTangent<D>| {
        (bond.i, bond.j) = (id(bond.i) as usize, id(bond.j) as usize);
        bonds.push(&bond);
    };
    interaction.tangents(body, view(u), &mut push);
    if let Some(contact) = contact {
        contact.tangents(body, u, &mut push);
    }
    let bonds = bonds.of_all(body);
    let gain = body.by_id(|slot| interaction.gain(slot));
    let gain = body.whole(1, gain);
    let position = body.whole(D, body.places().into_flattened());
    let volume = body.whole(1, body.by_id(|slot| body.volume().at(slot)));
    let density = body.whole(1, body.by_id(|slot| body.density().at(slot)));
    let mut bonds = bonds?;
    bonds.sort();
    let n = body.all_points();
    let mut first = vec![0; n + 1];
    for b in &bonds.direct {
        first[b.i as usize + 1] += 1;
    }
    for i in 0..n {
        first[i + 1] += first[i];
    }
    let rows = Rows {
        bonds: &bonds,
        first: &first,
        gain: match (bonds.channels, bonds.gained) {
            (0, _) => vec![],
            (_, true) => vec![1.0; n],
            (_, false) => gain?,
        },
    };
    let points: Vec<usize> = (0..n).collect();
    let parts: Vec<Part<D>> = points
        .par_chunks(CHUNK)
        .map_init(|| rows.row(), |row, chunk| rows.part(chunk, row))
        .collect();
    let entries = parts.iter().map(|p| p.partner.len()).sum();
    let mut made = LinearBody {
        position: position?.as_chunks().0.to_vec(),
        volume: volume?,
        density: density?,
        period: body.period(),
        start: vec![0],
        partner: Vec::with_capacity(entries),
        block: Vec::with_capacity(entries),
        load_map: None,
        mass: None,
    };
    for part in parts {
        let begin = made.partner.len();
        made.start.extend(part.end.iter().map(|e| begin + e));
        made.partner.extend(part.partner);
        made.block.extend(part.block);
    }
    Some(made)
}

/// What a bond does by itself.
#[derive(Debug, Clone, Copy)]
struct DirectBond<const D: usize> {
    i: u32,
    j: u32,
    stiffness: [[f64; D]; D],
}

/// All bonds.
#[derive(Default)]
struct Bonds<const D: usize> {
    direct: Vec<DirectBond<D>>,
    /// So many for each bond.
    channels: usize,
    through: Vec<Channel<D>>,
    /// Are gains in the channels?
    gained: bool,
}

impl<const D: usize> Bonds<D> {
    fn push(&mut self, bond: &BondTangent<D>) {
        let none = Channel {
            share: [0.0; D],
            pull: [[0.0; D]; 2],
        };
        let scalar = Channel {
            share: bond.share,
            pull: bond.pull,
        };
        if !bond.channels.is_empty() {
            // bodies beside this one may have fewer
            self.widen(bond.channels.len(), none);
            self.gained = true;
            self.through.extend(&bond.channels);
        } else if self.channels > 0 || scalar != none {
            self.widen(1, none);
            self.through.push(scalar);
        }
        self.through
            .resize((self.direct.len() + 1) * self.channels, none);
        self.direct.push(DirectBond {
            i: bond.i as u32,
            j: bond.j as u32,
            stiffness: bond.stiffness,
        });
    }

    /// At least so many channels for each bond so far.
    fn widen(&mut self, channels: usize, none: Channel<D>) {
        if channels <= self.channels {
            return;
        }
        let mut wide = Vec::with_capacity(self.direct.len() * channels);
        for n in 0..self.direct.len() {
            let old = &self.through[n * self.channels..(n + 1) * self.channels];
            wide.extend(old);
            wide.resize((n + 1) * channels, none);
        }
        self.through = wide;
        self.channels = channels;
    }

    fn channels_of(&self, n: usize) -> &[Channel<D>] {
        &self.through[n * self.channels..(n + 1) * self.channels]
    }

    /// Those of all ranks, on the first: of each point in their order.
    fn of_all(mut self, body: &Body<D>) -> Option<Bonds<D>> {
        if body.subdomain().is_none() {
            return Some(self);
        }
        let none = Channel {
            share: [0.0; D],
            pull: [[0.0; D]; 2],
        };
        self.widen(body.most(self.channels as f64) as usize, none);
        let mut all = Bonds {
            channels: self.channels,
            gained: body.exchange().any(self.gained),
            ..Bonds::default()
        };
        let mut own: Vec<f64> = vec![];
        for (n, bond) in self.direct.iter().enumerate() {
            own.extend([bond.i, bond.j].map(f64::from));
            own.extend(bond.stiffness.as_flattened());
            for channel in self.channels_of(n) {
                own.extend(channel.share);
                own.extend(channel.pull.as_flattened());
            }
        }
        let numbers = body.joined(own)?;
        for numbers in numbers.chunks_exact(2 + D * D + 3 * D * all.channels) {
            let (ends, numbers) = numbers.split_at(2);
            let (stiffness, through) = numbers.split_at(D * D);
            let row = |numbers: &[f64]| -> [f64; D] { crate::array::from_fn(|b| numbers[b]) };
            all.direct.push(DirectBond {
                i: ends[0] as u32,
                j: ends[1] as u32,
                stiffness: crate::array::from_fn(|a| row(&stiffness[a * D..])),
            });
            all.through
                .extend(through.chunks_exact(3 * D).map(|c| Channel {
                    share: row(c),
                    pull: [row(&c[D..]), row(&c[2 * D..])],
                }));
        }
        Some(all)
    }

    /// Into the order of i; most interactions come in it.
    fn sort(&mut self) {
        if self.direct.is_sorted_by_key(|b| b.i) {
            return;
        }
        let mut order: Vec<usize> = (0..self.direct.len()).collect();
        order.sort_by_key(|k| self.direct[*k].i);
        self.direct = order.iter().map(|k| self.direct[*k]).collect();
        self.through = order
            .iter()
            .flat_map(|k| self.channels_of(*k).to_vec())
            .collect();
    }
}

/// Rows of some points.
struct Part<const D: usize> {
    end: Vec<usize>,
    partner: Vec<u32>,
    block: Vec<[[f64; D]; D]>,
}

struct Rows<'a, const D: usize> {
    /// In order of i.
    bonds: &'a Bonds<D>,
    first: &'a [usize],
    /// Of laws without a scalar: empty.
    gain: Vec<f64>,
}

/// One row in the making.
struct Row<const D: usize> {
    /// Which place each partner has, where a partner may come from several bonds.
    place: Vec<u32>,
    entries: Vec<(u32, [[f64; D]; D])>,
}

impl<const D: usize> Row<D> {
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
    fn row(&self) -> Row<D> {
        Row {
            place: vec![u32::MAX; self.gain.len()],
            entries: vec![],
        }
    }

    fn of(&self, i: usize) -> impl Iterator<Item = (&DirectBond<D>, &[Channel<D>])> {
        let range = self.first[i]..self.first[i + 1];
        range.map(|n| (&self.bonds.direct[n], self.bonds.channels_of(n)))
    }

    fn part(&self, points: &[usize], row: &mut Row<D>) -> Part<D> {
        let mut part = Part {
            end: vec![],
            partner: vec![],
            block: vec![],
        };
        for &i in points {
            match self.gain.is_empty() {
                true => self.gather_direct(i, row),
                false => self.gather(i, row),
            }
            row.entries.sort_unstable_by_key(|e| e.0);
            for (j, block) in row.entries.drain(..) {
                if let Some(place) = row.place.get_mut(j as usize) {
                    *place = u32::MAX;
                }
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

    /// Bonds alone; a partner that is met twice, across two borders of a small periodic body, has one block.
    fn gather_direct(&self, i: usize, row: &mut Row<D>) {
        for bond in &self.bonds.direct[self.first[i]..self.first[i + 1]] {
            row.entries.push((bond.j, bond.stiffness));
        }
        add_alike(&mut row.entries);
    }

    /// Every `η_jk` is `(u_k − u_i) − (u_j − u_i)`.
    fn gather(&self, i: usize, row: &mut Row<D>) {
        let mut pulls = vec![[0.0; D]; self.bonds.channels];
        let mut shares = vec![[0.0; D]; self.bonds.channels];
        for (bond, through) in self.of(i) {
            let j = bond.j as usize;
            row.add(j, |a, b| bond.stiffness[a][b]);
            for (sum, c) in pulls.iter_mut().zip(through) {
                for a in 0..D {
                    sum[a] += c.pull[0][a];
                }
            }
            let gain = self.gain[j];
            if gain != 0.0 {
                shares.fill([0.0; D]);
                for (far, beyond) in self.of(j) {
                    row.add(far.j as usize, |a, b| {
                        let all = through.iter().zip(beyond);
                        all.map(|(c, far)| gain * c.pull[1][a] * far.share[b]).sum()
                    });
                    for (sum, c) in shares.iter_mut().zip(beyond) {
                        for b in 0..D {
                            sum[b] += c.share[b];
                        }
                    }
                }
                row.add(j, |a, b| {
                    let all = through.iter().zip(&shares);
                    all.map(|(c, sum)| -gain * c.pull[1][a] * sum[b]).sum()
                });
            }
        }
        let gain = self.gain[i];
        if gain != 0.0 {
            for (bond, through) in self.of(i) {
                row.add(bond.j as usize, |a, b| {
                    let all = through.iter().zip(&pulls);
                    all.map(|(c, sum)| gain * sum[a] * c.share[b]).sum()
                });
            }
        }
    }
}
