//! From terms of the energy to bonds: what a block of centres adds between pairs of atoms.
//!
//! Atoms that are near a centre have a bond with it from the start, each pair of the block once, so that terms about their centre find it by
//! the place of the neighbour. Pairs of neighbours of a centre are found by a map.

use crate::FieldsError;
use crate::frame::Frame;
use crate::kernel::dot;
use crate::molecules::Molecules;
use crate::neighbours::{Neighbours, Partner};
use crate::partition::{PairForce, Partition};
use peridyne::law::terms::{Near, Sites, Term};
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};
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

    fn reserve(&mut self, more: usize, parts: usize) {
        self.origin.reserve(more);
        self.end.reserve(more);
        self.bond.reserve(more);
        self.value.reserve(more * parts * WIDTH);
    }

    fn clear(&mut self) {
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
    fn compact(&mut self, parts: usize) {
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
    fn virial(&self, parts: usize) -> ([[f64; 9]; 2], bool) {
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

/// The work of blocks.
pub struct Collector<'a> {
    pub frame: &'a Frame,
    pub sites: &'a dyn Sites,
    pub molecules: Option<&'a Molecules>,
    pub neighbours: &'a Neighbours<'a>,
    pub partition: &'a Partition,
    pub pair_force: PairForce,
    /// Parts that are told apart: all, or one for the sum.
    pub parts: usize,
    /// Velocities from which the drift is taken; empty if there are none.
    pub velocity: &'a [[f64; 3]],
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

/// Numbers as keys: multiplied and folded.
#[derive(Default)]
struct Fold(u64);

impl Hasher for Fold {
    fn finish(&self) -> u64 {
        self.0
    }
    fn write(&mut self, bytes: &[u8]) {
        for b in bytes {
            self.write_u64(u64::from(*b));
        }
    }
    fn write_u64(&mut self, x: u64) {
        let y = (self.0 ^ x).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        self.0 = y ^ (y >> 32);
    }
}

type Map<K> = HashMap<K, u32, BuildHasherDefault<Fold>>;

/// An atom or image that takes part.
#[derive(Clone, Copy)]
struct Here {
    atom: u32,
    image: [i32; 3],
    y: [f64; 3],
    /// Place in the shares.
    share: u32,
    /// Twice the bond with the centre, of those that have one from the start, and 1 more if the centre is its end k.
    bond: u32,
}

/// No bond from the start.
const NONE: u32 = u32::MAX;

/// Room that one block after the other uses.
#[derive(Default)]
pub struct Spare {
    rows: Rows,
    pub bonds: Bonds,
}

/// Neighbours of the centres of a block, row by row.
#[derive(Default)]
struct Rows {
    first: Vec<usize>,
    here: Vec<Here>,
}

impl Rows {
    /// The bond of a centre of an earlier row with an atom.
    fn find(&self, row: usize, atom: u32, image: [i32; 3]) -> Option<u32> {
        let end = self.first.get(row + 1).copied().unwrap_or(self.here.len());
        let row = &self.here[self.first[row]..end];
        let found = row.iter().find(|h| h.atom == atom && h.image == image)?;
        Some(found.bond / 2)
    }
}

/// Room of a block.
struct Room<'a, 'b> {
    of: &'a Collector<'b>,
    out: Block,
    /// Place of each atom in the shares, plus 1.
    shares: Vec<u32>,
    places: Map<(u64, u64)>,
    here: Vec<Here>,
    weights: Vec<f64>,
    gradient: Vec<[f64; 3]>,
    pull: Vec<f64>,
}

impl Collector<'_> {
    /// All that some centres say.
    ///
    /// # Errors
    /// A term that is not finite, or weights that do not add up.
    pub fn collect(&self, centres: &[u32], spare: &mut Spare) -> Result<Block, FieldsError> {
        let mut room = Room {
            of: self,
            out: Block {
                bonds: std::mem::take(&mut spare.bonds),
                ..Block::default()
            },
            shares: vec![0; self.frame.len()],
            places: Map::default(),
            here: vec![],
            weights: vec![],
            gradient: vec![],
            pull: vec![],
        };
        room.out.bonds.clear();
        for i in centres {
            room.out.bonds.centre(self.neighbours.wrapped[*i as usize]);
        }
        let rows = &mut spare.rows;
        self.rows(centres, &mut room, rows);
        let mut near: Vec<Near> = vec![];
        for (row, &i) in centres.iter().enumerate() {
            let end = rows.first.get(row + 1).copied().unwrap_or(rows.here.len());
            room.here.clear();
            room.here.push(Here {
                atom: i,
                image: [0; 3],
                y: [0.0; 3],
                share: row as u32,
                bond: NONE,
            });
            room.here.extend(&rows.here[rows.first[row]..end]);
            near.clear();
            near.extend(room.here[1..].iter().map(|h| Near {
                kind: self.frame.kind[h.atom as usize],
                y: h.y,
            }));
            let mut wrong = None;
            let x = self.neighbours.wrapped[i as usize];
            self.sites
                .terms(self.frame.kind[i as usize], &near, &mut |term| {
                    if wrong.is_none() {
                        wrong = room.term(x, term).err();
                    }
                });
            if let Some(molecules) = self.molecules
                && wrong.is_none()
            {
                wrong = self.bonded(i, molecules, &mut room).err();
            }
            if let Some(message) = wrong {
                let FieldsError(message) = message;
                return Err(FieldsError(format!("particle {}: {message}", i + 1)));
            }
        }
        let mut out = room.out;
        out.bonds.compact(self.parts);
        (out.virial, out.churns) = out.bonds.virial(self.parts);
        Ok(out)
    }

    /// Neighbours of all centres, with a bond for each pair; the centres are the first of the shares.
    fn rows(&self, centres: &[u32], room: &mut Room, rows: &mut Rows) {
        for &i in centres {
            room.share(i);
        }
        rows.first.clear();
        rows.here.clear();
        let mut partners: Vec<Partner> = vec![];
        for (row, &i) in centres.iter().enumerate() {
            rows.first.push(rows.here.len());
            self.neighbours.near(i as usize, &mut partners);
            if row == 0 {
                let most = centres.len() * (partners.len() + 4);
                rows.here.reserve(most);
                room.out.bonds.reserve(3 * most / 4, self.parts);
            }
            let x = self.neighbours.wrapped[i as usize];
            for p in &partners {
                let share = room.share(p.atom);
                let earlier = match (share as usize) <= row {
                    true => rows.find(share as usize, i, p.image.map(|c| -c)),
                    false => None,
                };
                let bond = match earlier {
                    Some(bond) => (bond, true),
                    None => {
                        let end = std::array::from_fn(|c| x[c] + p.y[c]);
                        let bonds = &mut room.out.bonds;
                        let own = bonds.add(row as u32, end, p.y.map(|c| -c), self.parts);
                        (own, false)
                    }
                };
                rows.here.push(Here {
                    atom: p.atom,
                    image: p.image,
                    y: p.y,
                    share,
                    bond: 2 * bond.0 + u32::from(bond.1),
                });
            }
        }
    }

    /// What a centre is bonded to, the nearest images of it.
    fn bonded(&self, i: u32, molecules: &Molecules, room: &mut Room) -> Result<(), FieldsError> {
        let x = self.neighbours.wrapped[i as usize];
        let mut all = vec![];
        molecules.partners(i, &mut all);
        let mut places: Vec<(u32, u32, [f64; 3])> = vec![];
        for atom in all {
            let (image, y) = self
                .frame
                .cell
                .nearest(x, self.neighbours.wrapped[atom as usize]);
            let share = room.share(atom);
            places.push((atom, room.here.len() as u32, y));
            room.here.push(Here {
                atom,
                image,
                y,
                share,
                bond: NONE,
            });
        }
        let at = |atom: u32| match places.binary_search_by_key(&atom, |p| p.0) {
            Ok(n) => (places[n].1, places[n].2),
            Err(_) => (0, [0.0; 3]),
        };
        let mut outcome = Ok(());
        let kind = self.frame.kind[i as usize];
        let first = self.sites.parts().len();
        let of = (self.sites, first);
        molecules.terms((i, kind), &self.frame.kind, &at, of, &mut |term| {
            if outcome.is_ok() {
                outcome = room.term(x, term);
            }
        });
        outcome
    }
}

impl Room<'_, '_> {
    fn share(&mut self, atom: u32) -> u32 {
        let place = &mut self.shares[atom as usize];
        if *place == 0 {
            let (out, parts) = (&mut self.out, self.of.parts);
            out.shares.push(Share {
                atom,
                force: [0.0; 3],
                power: 0.0,
            });
            out.energy.resize(out.energy.len() + parts, 0.0);
            *place = out.shares.len() as u32;
        }
        *place - 1
    }

    fn velocity(&self, at: u32) -> [f64; 3] {
        let atom = self.here[at as usize].atom as usize;
        self.of.velocity.get(atom).copied().unwrap_or([0.0; 3])
    }

    fn term(&mut self, x: [f64; 3], term: &Term) -> Result<(), FieldsError> {
        let part = if self.of.parts == 1 { 0 } else { term.part };
        let star = term.particles.first() == Some(&0) && term.pulls.iter().all(|p| p.0 == 0);
        match self.of.partition {
            Partition::Site if star => self.star(x, term, part),
            Partition::Site | Partition::Equal | Partition::Centre(_) | Partition::Weights(_) => {
                self.any(x, term, part, star)
            }
        }
    }

    /// The commonest: all to the centre, which alone pulls. The pair forces are the forces, and nothing churns.
    fn star(&mut self, x: [f64; 3], term: &Term, part: usize) -> Result<(), FieldsError> {
        let moving = !self.of.velocity.is_empty();
        let own = self.velocity(0);
        let (mut force, mut all, mut finite) = ([0.0; 3], 0.0, term.energy);
        for &(_, b, g) in &term.pulls {
            let k = self.here[b as usize];
            finite += g;
            let f = k.y.map(|c| g * c);
            let mut power = 0.0;
            if moving {
                let v = self.velocity(b);
                power = dot(f, v);
                all += power - dot(f, own);
            }
            let other = &mut self.out.shares[k.share as usize].force;
            for c in 0..3 {
                force[c] += f[c];
                other[c] -= f[c];
            }
            self.add(x, part, [0, b], f, [0.0; 3], power);
        }
        if !finite.is_finite() {
            return Err(not_finite(term));
        }
        let share = self.here[0].share as usize;
        self.out.energy[share * self.of.parts + part] += term.energy;
        let share = &mut self.out.shares[share];
        (0..3).for_each(|c| share.force[c] += force[c]);
        share.power += all;
        Ok(())
    }

    fn any(
        &mut self,
        x: [f64; 3],
        term: &Term,
        part: usize,
        centred: bool,
    ) -> Result<(), FieldsError> {
        let n = term.particles.len();
        let mut weights = std::mem::take(&mut self.weights);
        let mut gradient = std::mem::take(&mut self.gradient);
        let mut pull = std::mem::take(&mut self.pull);
        self.of.partition.weights(term, &mut weights);
        let sum: f64 = weights.iter().sum();
        if weights.len() != n || !((sum - 1.0).abs() < 1e-12) {
            return Err(FieldsError(format!(
                "the weights {weights:?} of a term of {n} atoms do not add up to 1"
            )));
        }
        // ∂U_t/∂x of the term's atoms, in the order of the term
        gradient.clear();
        gradient.resize(n, [0.0; 3]);
        let few = n * n > 4 * term.pulls.len() + 4;
        pull.clear();
        if !few {
            pull.resize(n * n, 0.0);
        }
        let mut finite = term.energy;
        for &(a, b, g) in &term.pulls {
            let [i, j] = [a, b].map(|a| place(&term.particles, a));
            let (Some(i), Some(j)) = (i, j) else {
                return Err(FieldsError(
                    "a term pulls an atom that it does not name".into(),
                ));
            };
            let d = self.between(a, b);
            for c in 0..3 {
                gradient[i][c] += g * d[c];
                gradient[j][c] -= g * d[c];
            }
            finite += g;
            if !few {
                pull[i * n + j] += g;
                pull[j * n + i] += g;
            }
        }
        if !finite.is_finite() {
            return Err(not_finite(term));
        }
        for (i, a) in term.particles.iter().enumerate() {
            let share = self.here[*a as usize].share as usize;
            self.out.energy[share * self.of.parts + part] += weights[i] * term.energy;
            for c in 0..3 {
                self.out.shares[share].force[c] -= gradient[i][c];
            }
        }
        if !self.of.velocity.is_empty() {
            let mut all = 0.0;
            for (i, a) in term.particles.iter().enumerate() {
                all += dot(gradient[i], self.velocity(*a));
            }
            // translations do no work, so the drift need not be put back
            for (i, a) in term.particles.iter().enumerate() {
                let share = self.here[*a as usize].share as usize;
                self.out.shares[share].power += weights[i] * all;
            }
        }
        for i in 0..n {
            for j in i + 1..n {
                let g = match few {
                    true if centred && i != 0 => 0.0,
                    true => pull_of(term, i, j),
                    false => pull[i * n + j],
                };
                let w = [weights[i], weights[j]];
                if g != 0.0 || w != [0.0; 2] {
                    self.pair(x, (term, part), [i, j], w, g, &gradient);
                }
            }
        }
        (self.weights, self.gradient, self.pull) = (weights, gradient, pull);
        Ok(())
    }

    /// x_a − x_b.
    fn between(&self, a: u32, b: u32) -> [f64; 3] {
        let (a, b) = (&self.here[a as usize].y, &self.here[b as usize].y);
        std::array::from_fn(|c| a[c] - b[c])
    }

    /// Two atoms of a term, by their places in it.
    fn pair(
        &mut self,
        x: [f64; 3],
        (term, part): (&Term, usize),
        [i, j]: [usize; 2],
        [wi, wj]: [f64; 2],
        g: f64,
        gradient: &[[f64; 3]],
    ) {
        let [a, b] = [term.particles[i], term.particles[j]];
        let force = match self.of.pair_force {
            PairForce::Distances => self.between(a, b).map(|c| -g * c),
            // F_k between a k and the centre
            PairForce::Differences if i == 0 => gradient[j],
            PairForce::Differences => [0.0; 3],
        };
        let churn: [f64; 3] =
            std::array::from_fn(|c| wi * gradient[j][c] - wj * gradient[i][c] - force[c]);
        let mut power = 0.0;
        if !self.of.velocity.is_empty() {
            power =
                wi * dot(gradient[j], self.velocity(b)) - wj * dot(gradient[i], self.velocity(a));
        }
        self.add(x, part, [a, b], force, churn, power);
    }

    /// Numbers of the bond between an atom a and an atom b, as seen from a.
    fn add(
        &mut self,
        x: [f64; 3],
        part: usize,
        [a, b]: [u32; 2],
        force: [f64; 3],
        churn: [f64; 3],
        power: f64,
    ) {
        let (index, turned) = match self.here[b as usize].bond {
            bond if a == 0 && bond != NONE => (bond / 2, bond % 2 == 1),
            _ => self.far(x, a, b),
        };
        // seen from the other end all change their signs
        let way = if turned { -1.0 } else { 1.0 };
        let place = (index as usize * self.of.parts + part) * WIDTH;
        let value = &mut self.out.bonds.value[place..][..WIDTH];
        for c in 0..3 {
            value[c] += way * force[c];
            value[3 + c] += way * churn[c];
        }
        value[6] += way * power;
    }

    /// The bond of two atoms that none had from the start.
    fn far(&mut self, x: [f64; 3], a: u32, b: u32) -> (u32, bool) {
        let d = self.between(a, b);
        let (p, k) = (self.here[a as usize], self.here[b as usize]);
        let image: [i32; 3] = std::array::from_fn(|c| k.image[c] - p.image[c]);
        let forward = (p.atom, [0; 3]) < (k.atom, image);
        let key = match forward {
            true => key(p.atom, k.atom, image),
            false => key(k.atom, p.atom, image.map(|c| -c)),
        };
        let (bonds, parts) = (&mut self.out.bonds, self.of.parts);
        // centres are the first of the shares
        let origin = self.here[0].share;
        let index = *self.places.entry(key).or_insert_with(|| {
            let (end, d) = if forward { (k, d) } else { (p, d.map(|c| -c)) };
            bonds.add(origin, std::array::from_fn(|c| x[c] + end.y[c]), d, parts)
        });
        (index, !forward)
    }
}

fn not_finite(term: &Term) -> FieldsError {
    FieldsError(format!(
        "its energy or force is not finite ({} within reach): do particles coincide?",
        term.particles.len() - 1
    ))
}

/// Σ G of a pair of a term with few pulls.
fn pull_of(term: &Term, i: usize, j: usize) -> f64 {
    let pair = [term.particles[i], term.particles[j]];
    let [low, high] = [pair[0].min(pair[1]), pair[0].max(pair[1])];
    let own = term.pulls.iter().filter(|p| p.0 == low && p.1 == high);
    own.map(|p| p.2).sum()
}

/// A pair of atoms and the image of the second.
fn key(p: u32, k: u32, image: [i32; 3]) -> (u64, u64) {
    let image = image.iter().fold(0u64, |all, n| {
        (all << 21) | (i64::from(*n) + (1 << 20)) as u64
    });
    ((u64::from(p) << 32) | u64::from(k), image)
}

/// The place of a particle among those of a term, which mostly come in order.
fn place(particles: &[u32], a: u32) -> Option<usize> {
    if a == 0 && particles.first() == Some(&0) {
        return Some(0);
    }
    match particles.binary_search(&a) {
        Ok(at) => Some(at),
        Err(_) => particles.iter().position(|p| *p == a),
    }
}
