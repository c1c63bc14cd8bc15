//! From terms of the energy to bonds: what a block of centres adds between pairs of atoms, each pair of images once per block.

use crate::FieldsError;
use crate::frame::Frame;
use crate::kernel::dot;
use crate::molecules::Molecules;
use crate::neighbours::{Neighbours, Partner};
use crate::partition::{PairForce, Partition};
use peridyne::law::terms::{Near, Sites, Term};
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

/// Numbers of a bond for each part of the potential: force on p from k, churning vector, power.
pub const WIDTH: usize = 7;

/// Bonds of a block, between an atom p and an atom or image k.
#[derive(Default)]
pub struct Bonds {
    /// Where k is, and from there to p.
    pub end: Vec<[f64; 3]>,
    pub bond: Vec<[f64; 3]>,
    /// `WIDTH` numbers for each part: `f_pk`; `E = D_pk − D_kp − f_pk` with `D_pk = ∂U^(p)/∂x_k`; `D_pk·v_k − D_kp·v_p`.
    pub value: Vec<f64>,
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
    fn write_u32(&mut self, x: u32) {
        self.write_u64(u64::from(x));
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
}

/// Room of a block.
struct Room<'a, 'b> {
    of: &'a Collector<'b>,
    out: Block,
    shares: Map<u32>,
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
    pub fn collect(&self, centres: &[u32]) -> Result<Block, FieldsError> {
        let mut room = Room {
            of: self,
            out: Block::default(),
            shares: Map::default(),
            places: Map::default(),
            here: vec![],
            weights: vec![],
            gradient: vec![],
            pull: vec![],
        };
        let mut partners: Vec<Partner> = vec![];
        let mut near: Vec<Near> = vec![];
        for &i in centres {
            self.neighbours.near(i as usize, &mut partners);
            near.clear();
            near.extend(partners.iter().map(|p| Near {
                kind: self.frame.kind[p.atom as usize],
                y: p.y,
            }));
            room.here.clear();
            let share = room.share(i);
            room.here.push(Here {
                atom: i,
                image: [0; 3],
                y: [0.0; 3],
                share,
            });
            for p in &partners {
                let share = room.share(p.atom);
                room.here.push(Here {
                    atom: p.atom,
                    image: p.image,
                    y: p.y,
                    share,
                });
            }
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
        Ok(room.out)
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
        let (out, parts) = (&mut self.out, self.of.parts);
        *self.shares.entry(atom).or_insert_with(|| {
            out.shares.push(Share {
                atom,
                force: [0.0; 3],
                power: 0.0,
            });
            out.energy.resize(out.energy.len() + parts, 0.0);
            out.shares.len() as u32 - 1
        })
    }

    fn velocity(&self, at: u32) -> [f64; 3] {
        let atom = self.here[at as usize].atom as usize;
        self.of.velocity.get(atom).copied().unwrap_or([0.0; 3])
    }

    fn term(&mut self, x: [f64; 3], term: &Term) -> Result<(), FieldsError> {
        let n = term.particles.len();
        let part = if self.of.parts == 1 { 0 } else { term.part };
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
        let star = n * n > 4 * term.pulls.len() + 4;
        pull.clear();
        if !star {
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
            if !star {
                pull[i * n + j] += g;
                pull[j * n + i] += g;
            }
        }
        if !finite.is_finite() {
            return Err(FieldsError(format!(
                "its energy or force is not finite ({} within reach): do particles coincide?",
                n - 1
            )));
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
        {
            let centred = self.is_star(term);
            if star && centred && weights[1..].iter().all(|w| *w == 0.0) {
                // the commonest: all to the centre, which alone pulls
                for &(_, b, g) in &term.pulls {
                    let j = place(&term.particles, b).unwrap_or(0);
                    self.pair(x, (term, part), [0, j], [weights[0], 0.0], g, &gradient);
                }
            } else {
                for i in 0..n {
                    for j in i + 1..n {
                        let g = match star {
                            true if centred && i != 0 => 0.0,
                            true => self.pull_of(term, i, j),
                            false => pull[i * n + j],
                        };
                        let w = [weights[i], weights[j]];
                        if g != 0.0 || w != [0.0; 2] {
                            self.pair(x, (term, part), [i, j], w, g, &gradient);
                        }
                    }
                }
            }
        }
        (self.weights, self.gradient, self.pull) = (weights, gradient, pull);
        Ok(())
    }

    fn is_star(&self, term: &Term) -> bool {
        term.particles.first() == Some(&0) && term.pulls.iter().all(|p| p.0 == 0)
    }

    /// Σ G of a pair of a term with few pulls.
    fn pull_of(&self, term: &Term, i: usize, j: usize) -> f64 {
        let pair = [term.particles[i], term.particles[j]];
        let [low, high] = [pair[0].min(pair[1]), pair[0].max(pair[1])];
        let own = term.pulls.iter().filter(|p| p.0 == low && p.1 == high);
        own.map(|p| p.2).sum()
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
        let d = self.between(a, b);
        let mut force = match self.of.pair_force {
            PairForce::Distances => d.map(|c| -g * c),
            // F_k between a k and the centre
            PairForce::Differences if i == 0 => gradient[j],
            PairForce::Differences => [0.0; 3],
        };
        let mut churn: [f64; 3] =
            std::array::from_fn(|c| wi * gradient[j][c] - wj * gradient[i][c] - force[c]);
        let mut power = 0.0;
        if !self.of.velocity.is_empty() {
            power =
                wi * dot(gradient[j], self.velocity(b)) - wj * dot(gradient[i], self.velocity(a));
        }
        for m in 0..9 {
            self.out.virial[0][m] += d[m / 3] * force[m % 3];
            self.out.virial[1][m] += d[m / 3] * churn[m % 3];
        }
        let (p, k) = (self.here[a as usize], self.here[b as usize]);
        let image: [i32; 3] = std::array::from_fn(|c| k.image[c] - p.image[c]);
        let forward = (p.atom, [0; 3]) < (k.atom, image);
        let (key, way) = match forward {
            true => (key(p.atom, k.atom, image), 1.0),
            false => (key(k.atom, p.atom, image.map(|c| -c)), -1.0),
        };
        let bonds = &mut self.out.bonds;
        let parts = self.of.parts;
        let index = *self.places.entry(key).or_insert_with(|| {
            let (p, d) = if forward { (k, d) } else { (p, d.map(|c| -c)) };
            bonds.end.push(std::array::from_fn(|c| x[c] + p.y[c]));
            bonds.bond.push(d);
            bonds.value.resize(bonds.value.len() + parts * WIDTH, 0.0);
            bonds.end.len() as u32 - 1
        }) as usize;
        // seen from the other end all change their signs
        for c in 0..3 {
            force[c] *= way;
            churn[c] *= way;
        }
        let value = &mut bonds.value[(index * parts + part) * WIDTH..][..WIDTH];
        for c in 0..3 {
            value[c] += force[c];
            value[3 + c] += churn[c];
        }
        value[6] += way * power;
    }
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
