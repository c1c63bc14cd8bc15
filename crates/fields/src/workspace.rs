//! What a term of the energy adds to the bonds and atoms of a block.

use crate::FieldsError;
use crate::bonds::{Block, Bonds, Share, WIDTH};
use crate::frame::Frame;
use crate::kernel::dot;
use crate::molecules::Molecules;
use crate::neighbours::Neighbours;
use crate::partition::{PairForce, Partition};
use peridyne::law::terms::{Sites, Term};
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

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
    /// Has somebody had enough?
    pub stop: fn() -> bool,
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
pub struct Here {
    pub atom: u32,
    pub image: [i32; 3],
    pub y: [f64; 3],
    /// Place in the shares.
    pub share: u32,
    /// Twice the bond with the centre, of those that have one from the start, and 1 more if the centre is its end k.
    pub bond: u32,
}

/// No bond from the start.
pub const NONE: u32 = u32::MAX;

/// Workspace of a block.
pub struct Workspace<'a, 'b> {
    of: &'a Collector<'b>,
    pub out: Block,
    /// Place of each atom in the shares, plus 1.
    shares: Vec<u32>,
    places: Map<(u64, u64)>,
    /// The centre, and what is near it.
    pub here: Vec<Here>,
    weights: Vec<f64>,
    gradient: Vec<[f64; 3]>,
    pull: Vec<f64>,
}

impl<'a, 'b> Workspace<'a, 'b> {
    /// With room for bonds that some block had.
    pub fn new(of: &'a Collector<'b>, mut bonds: Bonds) -> Workspace<'a, 'b> {
        bonds.clear();
        Workspace {
            of,
            out: Block {
                bonds,
                ..Block::default()
            },
            shares: vec![0; of.frame.len()],
            places: Map::default(),
            here: vec![],
            weights: vec![],
            gradient: vec![],
            pull: vec![],
        }
    }

    /// Place of an atom among the shares.
    pub fn share(&mut self, atom: u32) -> u32 {
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

    /// A term about a centre at x.
    pub fn term(&mut self, x: [f64; 3], term: &Term) -> Result<(), FieldsError> {
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
