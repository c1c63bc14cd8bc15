//! Potentials and states on which theorems are tried: a term of any number of particles, and one that knows left from right. Particles
//! are in free space and told apart by their kinds, 0, 1, ….

use crate::frame::{Cell, Frame, cross};
use crate::kernel::dot;
use peridyne::law::terms::{Near, Sites, Term};

/// Numbers that look random and are the same everywhere (a linear congruential generator, its upper bits).
pub struct Random(pub u64);

impl Random {
    /// From −1 to 1.
    pub fn signed(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64 * 2.0 - 1.0
    }

    /// Components from −1 to 1.
    pub fn vector(&mut self) -> [f64; 3] {
        [self.signed(), self.signed(), self.signed()]
    }
}

/// Farther than the particles of a [`cluster`] are apart.
const REACH: f64 = 100.0;

/// A term of all particles: `2 sin(Σ c_ab ξ_ab) + 3 exp(−Σ d_ab ξ_ab)` with random constants of each pair of kinds. Its centre is the particle of
/// kind 0.
pub struct Cluster {
    /// Number of particles.
    pub count: usize,
    /// Of the constants.
    pub seed: u64,
}

impl Cluster {
    fn constants(&self) -> Vec<[f64; 2]> {
        let mut random = Random(self.seed);
        let pairs = self.count * self.count;
        (0..pairs)
            .map(|_| [random.signed(), 0.1 * (1.0 + random.signed())])
            .collect()
    }
}

impl Sites for Cluster {
    fn reach(&self) -> f64 {
        REACH
    }

    fn parts(&self) -> Vec<String> {
        vec!["cluster".into()]
    }

    fn terms(&self, kind: u32, near: &[Near], visit: &mut dyn FnMut(&Term)) {
        if kind != 0 {
            return;
        }
        let constants = self.constants();
        let mut all = vec![(0, [0.0; 3])];
        all.extend(near.iter().map(|n| (n.kind as usize, n.y)));
        let (mut phase, mut decay, mut pairs) = (0.0, 0.0, vec![]);
        for (a, (k, x)) in all.iter().enumerate() {
            for (b, (l, y)) in all.iter().enumerate().skip(a + 1) {
                let d: [f64; 3] = std::array::from_fn(|i| x[i] - y[i]);
                let xi = 0.5 * dot(d, d);
                let [c, e] = constants[k.min(l) * self.count + k.max(l)];
                phase += c * xi;
                decay += e * xi;
                pairs.push((a as u32, b as u32, c, e));
            }
        }
        let mut term = Term::default();
        term.begin(0);
        term.particles.extend(1..all.len() as u32);
        let fall = 3.0 * libm::exp(-decay);
        term.energy = 2.0 * libm::sin(phase) + fall;
        for (a, b, c, e) in pairs {
            term.pulls
                .push((a, b, 2.0 * c * libm::cos(phase) - e * fall));
        }
        visit(&term);
    }
}

/// The chiral energy (4.0.28) of particles of the kinds 0 to 3, `U = (x1 − x0)·((x2 − x0) × (x3 − x0))`, by distances: the root of Gram's
/// determinant, with its sign. Not of four particles in a plane, where that root has no slope.
pub struct Chiral;

impl Sites for Chiral {
    fn reach(&self) -> f64 {
        REACH
    }

    fn parts(&self) -> Vec<String> {
        vec!["volume".into()]
    }

    fn terms(&self, kind: u32, near: &[Near], visit: &mut dyn FnMut(&Term)) {
        if kind != 0 {
            return;
        }
        let mut place = [0u32; 4];
        let mut y = [[0.0; 3]; 4];
        for (n, near) in near.iter().enumerate() {
            place[near.kind as usize] = n as u32 + 1;
            y[near.kind as usize] = near.y;
        }
        let normal = [cross(y[2], y[3]), cross(y[3], y[1]), cross(y[1], y[2])];
        let volume = dot(y[1], normal[0]);
        let mut term = Term::default();
        term.begin(0);
        term.energy = volume;
        term.particles.extend(1..4);
        // cofactors of Gram's matrix are products of the normals; over 2U for the root
        let cofactor = |a: usize, b: usize| dot(normal[a - 1], normal[b - 1]) / (2.0 * volume);
        for a in 1..4 {
            let row: f64 = (1..4).map(|b| 2.0 * cofactor(a, b)).sum();
            term.pulls.push((0, place[a], row));
            for b in a + 1..4 {
                let (low, high) = (place[a].min(place[b]), place[a].max(place[b]));
                term.pulls.push((low, high, -2.0 * cofactor(a, b)));
            }
        }
        visit(&term);
    }
}

/// Particles of kinds 0, 1, … on a rough spiral, about 1 apart, with velocities.
pub fn cluster(count: usize, seed: u64) -> Frame {
    let mut random = Random(seed);
    let around = |k: usize| {
        let t = 2.4 * k as f64;
        [libm::cos(t), libm::sin(t), 0.35 * k as f64 - 0.5]
    };
    let position = (0..count)
        .map(|k| {
            let (x, r) = (around(k), random.vector());
            std::array::from_fn(|a| x[a] + 0.3 * r[a])
        })
        .collect();
    let velocity = (0..count)
        .map(|_| random.vector().map(|v| v + 0.5))
        .collect();
    Frame {
        cell: Cell::free(3.0),
        position,
        velocity: Some(velocity),
        mass: (0..count).map(|_| 1.0 + 0.4 * random.signed()).collect(),
        kind: (0..count as u32).collect(),
        time: Some(0.0),
    }
}
