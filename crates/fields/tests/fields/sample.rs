//! Potentials and frames for tests.

use peridyne::law::number::Number;
use peridyne::law::potential::Potential;
use peridyne::law::terms::{Near, OfSites, Sites, Term};
use peridyne::run::Registry;
use peridyne::spec::{BondedSpec, BondedTerm, Form, Parameters, PotentialSpec};
pub use peridyne_fields::specimen::{Chiral, Cluster, Random, cluster};
use peridyne_fields::{Cell, Frame, Kernel, Method, Shape, Targets, evaluate};

const CUT: f64 = 1.9;

/// 1 at 0, and smooth where it ends.
fn cut<N: Number>(q: N, cutoff: f64) -> N {
    let x = N::constant(1.0) - q.times(1.0 / (cutoff * cutoff));
    x.power(6)
}

/// Lennard-Jones, switched off smoothly.
#[derive(Clone)]
pub struct Smooth;

impl Potential for Smooth {
    fn cutoff(&self) -> f64 {
        CUT
    }
    fn pair<N: Number>(&self, q: N) -> N {
        let s = q.recip().power(3);
        (s * s - s).times(4.0) * cut(q, CUT)
    }
}

/// Embedded atoms: `F = −√(ρ + 0.1)`.
#[derive(Clone)]
pub struct Embedded;

impl Potential for Embedded {
    const EMBEDDED: bool = true;
    fn cutoff(&self) -> f64 {
        CUT
    }
    fn pair<N: Number>(&self, q: N) -> N {
        q.recip().power(4) * cut(q, CUT)
    }
    fn density<N: Number>(&self, q: N) -> N {
        cut(q, CUT)
    }
    fn embedding<N: Number>(&self, density: N) -> N {
        density.plus(0.1).sqrt().times(-2.0)
    }
}

pub fn pairs() -> OfSites<Smooth> {
    OfSites(Smooth)
}

pub fn embedded() -> OfSites<Embedded> {
    OfSites(Embedded)
}

/// Pairs, and triplets that like the tetrahedral angle: `h(ξ_ij) h(ξ_ik) (y_j·y_k + |y_j||y_k|/3)²` with the root replaced by a constant.
pub struct Triplets;

impl Triplets {
    /// h and dh/dξ.
    fn end(xi: f64) -> [f64; 2] {
        let x = 1.0 - 2.0 * xi / (CUT * CUT);
        match x > 0.0 {
            true => [x.powi(6), -12.0 / (CUT * CUT) * x.powi(5)],
            false => [0.0; 2],
        }
    }
}

impl Sites for Triplets {
    fn reach(&self) -> f64 {
        CUT
    }
    fn parts(&self) -> Vec<String> {
        vec!["pair".into(), "triplet".into()]
    }
    fn terms(&self, kind: u32, near: &[Near], visit: &mut dyn FnMut(&Term)) {
        pairs().terms(kind, near, visit);
        let mut term = Term::default();
        for (j, a) in near.iter().enumerate() {
            for (k, b) in near.iter().enumerate().skip(j + 1) {
                let [xj, xk] = [0.5 * a.square(), 0.5 * b.square()];
                let d: [f64; 3] = std::array::from_fn(|c| a.y[c] - b.y[c]);
                let xjk = 0.5 * d.iter().map(|c| c * c).sum::<f64>();
                let ([hj, dj], [hk, dk]) = (Self::end(xj), Self::end(xk));
                if hj == 0.0 || hk == 0.0 {
                    continue;
                }
                // y_j·y_k
                let angle = xj + xk - xjk + 0.4;
                term.begin(1);
                term.energy = 8.0 * hj * hk * angle * angle;
                let [n, m] = [j as u32 + 1, k as u32 + 1];
                term.particles.extend([n, m]);
                let turn = 16.0 * hj * hk * angle;
                term.pulls
                    .push((0, n, 8.0 * dj * hk * angle * angle + turn));
                term.pulls
                    .push((0, m, 8.0 * hj * dk * angle * angle + turn));
                term.pulls.push((n, m, -turn));
                visit(&term);
            }
        }
    }
}

/// A chain of four, told apart by their kinds: stiff bonds, and torsion `1 + cos 3φ`, φ about the bond 1–2.
pub struct Torsion;

/// A number and its slopes with the six squared distances.
#[derive(Clone, Copy)]
struct Six(f64, [f64; 6]);

impl Six {
    fn with(self, other: Six, value: f64, a: f64, b: f64) -> Six {
        Six(
            value,
            std::array::from_fn(|n| a * self.1[n] + b * other.1[n]),
        )
    }
    fn add(self, o: Six) -> Six {
        self.with(o, self.0 + o.0, 1.0, 1.0)
    }
    fn sub(self, o: Six) -> Six {
        self.with(o, self.0 - o.0, 1.0, -1.0)
    }
    fn mul(self, o: Six) -> Six {
        self.with(o, self.0 * o.0, o.0, self.0)
    }
    fn times(self, x: f64) -> Six {
        Six(self.0 * x, self.1.map(|s| s * x))
    }
    fn inverse_root(self) -> Six {
        let value = 1.0 / self.0.sqrt();
        Six(value, self.1.map(|s| -0.5 * s * value / self.0))
    }
}

const ENDS: [(usize, usize); 6] = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];

impl Sites for Torsion {
    fn reach(&self) -> f64 {
        20.0
    }
    fn parts(&self) -> Vec<String> {
        vec!["bond".into(), "torsion".into()]
    }
    fn terms(&self, kind: u32, near: &[Near], visit: &mut dyn FnMut(&Term)) {
        if kind != 0 {
            return;
        }
        // by kinds
        let mut place = [0u32; 4];
        let mut x = [[0.0; 3]; 4];
        for (n, near) in near.iter().enumerate() {
            place[near.kind as usize] = n as u32 + 1;
            x[near.kind as usize] = near.y;
        }
        let xi: Vec<Six> = ENDS
            .iter()
            .enumerate()
            .map(|(n, (a, b))| {
                let value = (0..3).map(|c| 0.5 * (x[*a][c] - x[*b][c]).powi(2)).sum();
                Six(value, std::array::from_fn(|m| f64::from(m == n)))
            })
            .collect();
        let pull = |n: usize, g: f64| {
            let (a, b) = (place[ENDS[n].0], place[ENDS[n].1]);
            (a.min(b), a.max(b), g)
        };
        let mut term = Term::default();
        for n in [0, 3, 5] {
            // ½ k (ξ − ½)², of each bond, by its first atom
            term.begin(0);
            let off = xi[n].0 - 0.5;
            term.energy = 40.0 * off * off;
            term.particles.clear();
            term.particles.extend([place[ENDS[n].0], place[ENDS[n].1]]);
            term.pulls.push(pull(n, 80.0 * off));
            visit(&term);
        }
        // (4.0.148), (4.0.149), numbered 2, 1, 4, 3 from 0, as they are right
        let [x12, x13, x14, x23, x24, x34] = [xi[0], xi[1], xi[2], xi[3], xi[4], xi[5]];
        // dihedral of 1-2-3-4 about 2-3: normals of 1,2,3 and of 2,3,4
        let top = x12
            .mul(x34.sub(x24).add(x23))
            .add(x13.mul(x24.sub(x34).add(x23)))
            .add(x23.mul(x24.add(x34).sub(x23)))
            .sub(x14.mul(x23).times(2.0));
        let area = |a: Six, b: Six, c: Six| {
            let p = a.add(b).sub(c);
            a.mul(b).times(4.0).sub(p.mul(p))
        };
        let cosine = top.mul(area(x12, x13, x23).mul(area(x24, x34, x23)).inverse_root());
        let cube = cosine.mul(cosine).mul(cosine);
        // cos 3φ
        let wave = cube.times(4.0).sub(cosine.times(3.0));
        term.begin(1);
        term.energy = 1.5 * (1.0 + wave.0);
        term.particles.extend(1..4);
        for n in 0..6 {
            term.pulls.push(pull(n, 1.5 * wave.1[n]));
        }
        visit(&term);
    }
}

/// A dense gas in a tilted periodic cell, with a drift.
pub fn gas(seed: u64) -> Frame {
    let edges = [[4.4, 0.0, 0.0], [0.9, 4.2, 0.0], [-0.6, 0.5, 4.6]];
    let cell = Cell::new([-1.0, 0.5, 0.2], edges, [true; 3]).unwrap();
    let mut random = Random(seed);
    let mut position = vec![];
    let n = 4;
    for i in 0..n * n * n {
        let s = [i / (n * n), i / n % n, i % n].map(|k| (k as f64 + 0.5) / n as f64);
        let x = cell.at(s);
        let r = random.vector();
        position.push(std::array::from_fn(|a| x[a] + 0.12 * r[a]));
    }
    let count = position.len();
    Frame {
        cell,
        position,
        velocity: Some(
            (0..count)
                .map(|_| {
                    let v = random.vector();
                    [0.7 + v[0], -0.4 + v[1], 0.2 + v[2]]
                })
                .collect(),
        ),
        mass: (0..count).map(|_| 1.0 + 0.4 * random.signed()).collect(),
        kind: vec![0; count],
        time: Some(0.0),
    }
}

/// The published constants (eV, Å).
pub fn stillinger_weber() -> Box<dyn Sites> {
    let parameters = Parameters::numbers(&[
        ("epsilon", 2.1683),
        ("sigma", 2.0951),
        ("a", 1.80),
        ("lambda", 21.0),
        ("gamma", 1.20),
        ("cos_theta0", -0.333333333333),
        ("A", 7.049556277),
        ("B", 0.6022245584),
        ("p", 4.0),
        ("q", 0.0),
    ]);
    let spec = PotentialSpec {
        name: "stillinger_weber".into(),
        parameters,
        reach: f64::INFINITY,
    };
    Registry::standard().sites(&spec).unwrap()
}

/// Two cells of a diamond lattice along each axis, with displacements of a fifth of an ångström.
pub fn silicon() -> Frame {
    let quarters = [
        [0, 0, 0],
        [2, 2, 0],
        [2, 0, 2],
        [0, 2, 2],
        [1, 1, 1],
        [3, 3, 1],
        [3, 1, 3],
        [1, 3, 3],
    ];
    let (edge, n) = (5.431, 2);
    let mut random = Random(21);
    let mut position = vec![];
    for i in 0..n * n * n {
        let cell = [i / (n * n), i / n % n, i % n];
        for q in quarters {
            let r = random.vector();
            position.push(std::array::from_fn(|a| {
                edge * (cell[a] as f64 + 0.25 * f64::from(q[a])) + 0.2 * r[a]
            }));
        }
    }
    let count = position.len();
    Frame {
        cell: Cell::orthogonal([0.0; 3], [edge * n as f64; 3], [true; 3]).unwrap(),
        position,
        velocity: Some(
            (0..count)
                .map(|_| random.vector().map(|v| 8.0 * v + 4.0))
                .collect(),
        ),
        mass: vec![28.0855 * 1.036427e-4; count],
        kind: vec![0; count],
        time: Some(0.0),
    }
}

/// Neighbouring particles of [`gas`] along an axis as chains of four, with stiff bonds, angles and torsion.
pub fn bonded(count: usize) -> BondedSpec {
    let forms = vec![
        Form::HarmonicBond {
            stiffness: 30.0,
            length: 1.0,
        },
        Form::CosineSquaredAngle {
            stiffness: 6.0,
            cosine: -0.4,
        },
        Form::Dihedral {
            powers: vec![1.0, 0.7, -0.4, 0.9],
        },
    ];
    let term = |form: u32, points: &[u32]| {
        let mut all = [0; 4];
        all[..points.len()].copy_from_slice(points);
        BondedTerm { form, points: all }
    };
    let mut terms = vec![];
    // particles 4k to 4k + 3 follow each other along z; the chain goes on to the next row, and bends there
    for first in (0..count as u32 - 8).step_by(8) {
        let chain = [first + 1, first + 2, first + 6, first + 7];
        for pair in chain.windows(2) {
            terms.push(term(0, pair));
        }
        for three in chain.windows(3) {
            terms.push(term(1, three));
        }
        terms.push(term(2, &chain));
    }
    BondedSpec {
        forms,
        terms,
        special: [0.0, 0.3, 0.5],
    }
}

/// A molecule: four atoms in a bent chain.
pub fn molecule() -> Frame {
    let mut frame = cluster(4, 5);
    frame.position = vec![
        [-0.9, 0.8, 0.1],
        [-0.5, 0.0, 0.0],
        [0.5, 0.05, -0.05],
        [0.8, -0.5, 0.8],
    ];
    frame
}

pub fn method(shape: Shape, width: f64) -> Method {
    Method::new(Kernel::new(shape, width).unwrap())
}

pub fn forces(frame: &Frame, sites: &dyn Sites) -> Vec<[f64; 3]> {
    let targets = Targets::Points(frame.position.clone());
    let fields = evaluate(frame, sites, &targets, &method(Shape::Polynomial(3), 1.0)).unwrap();
    assert!(fields.totals.complete);
    fields.force
}

/// One step of velocity Verlet.
pub fn step(frame: &Frame, sites: &dyn Sites, dt: f64) -> Frame {
    let mut next = frame.clone();
    let kick = |frame: &mut Frame, force: &[[f64; 3]]| {
        let velocity = frame.velocity.as_mut().unwrap();
        for (i, v) in velocity.iter_mut().enumerate() {
            (0..3).for_each(|a| v[a] += 0.5 * dt * force[i][a] / frame.mass[i]);
        }
    };
    kick(&mut next, &forces(frame, sites));
    for (x, v) in next
        .position
        .iter_mut()
        .zip(next.velocity.as_ref().unwrap())
    {
        (0..3).for_each(|a| x[a] += dt * v[a]);
    }
    let force = forces(&next, sites);
    kick(&mut next, &force);
    next.time = frame.time.map(|t| t + dt);
    next
}
