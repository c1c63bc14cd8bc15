//! Seconds of the fields of embedded atoms on a grid: `speed [CELLS] [GRID] [WIDTH]`, a block of CELLS³ cells of copper (4 atoms each) with
//! thermal displacements and velocities, one thread; then a small block beside a loop over all bonds for each point.

use peridyne::law::number::Number;
use peridyne::law::potential::Potential;
use peridyne::law::terms::{Near, OfSites, Sites};
use peridyne_fields::neighbours::Neighbours;
use peridyne_fields::{Cell, Fields, Frame, Kernel, Method, Quantity, Shape, Targets, evaluate};
use std::time::Instant;

/// Finnis and Sinclair's kind, with the reach of usual tables of copper (Å, eV).
#[derive(Clone)]
struct Copper;

const CUT: f64 = 5.5;

fn end<N: Number>(q: N) -> N {
    (N::constant(1.0) - q.times(1.0 / (CUT * CUT))).power(4)
}

impl Potential for Copper {
    const EMBEDDED: bool = true;
    fn cutoff(&self) -> f64 {
        CUT
    }
    fn pair<N: Number>(&self, q: N) -> N {
        q.times(1.0 / 6.5).recip().power(4) * end(q).times(0.5)
    }
    fn density<N: Number>(&self, q: N) -> N {
        end(q)
    }
    fn embedding<N: Number>(&self, density: N) -> N {
        density.sqrt().times(-1.5)
    }
}

fn copper(cells: usize) -> Frame {
    let edge = 3.615;
    let side = edge * cells as f64;
    let mut seed = 1u64;
    let mut random = move || {
        seed = seed
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (seed >> 11) as f64 / (1u64 << 53) as f64 * 2.0 - 1.0
    };
    let mut position = vec![];
    for i in 0..cells * cells * cells {
        let cell = [i / (cells * cells), i / cells % cells, i % cells];
        for basis in [[0.0; 3], [0.5, 0.5, 0.0], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5]] {
            position.push(std::array::from_fn(|a| {
                edge * (cell[a] as f64 + basis[a] + 0.25) + 0.1 * random()
            }));
        }
    }
    let n = position.len();
    Frame {
        cell: Cell::orthogonal([0.0; 3], [side; 3], [true; 3]).unwrap(),
        position,
        velocity: Some((0..n).map(|_| [random(), random(), random()]).collect()),
        mass: vec![63.546; n],
        kind: vec![0; n],
        time: None,
    }
}

/// Potential stress at the points of a grid: all bonds, for each point.
fn naive(frame: &Frame, sites: &dyn Sites, kernel: &Kernel, points: &[[f64; 3]]) -> Vec<f64> {
    let neighbours = Neighbours::new(frame, CUT).unwrap();
    let mut partners = vec![];
    let mut bonds = vec![];
    for i in 0..frame.len() {
        neighbours.near(i, &mut partners);
        let near: Vec<Near> = partners.iter().map(|p| Near { kind: 0, y: p.y }).collect();
        sites.terms(0, &near, &mut |t| {
            for &(_, b, g) in &t.pulls {
                bonds.push((neighbours.wrapped[i], near[b as usize - 1].y, g));
            }
        });
    }
    let side = frame.cell.edges[0][0];
    let mut all = vec![0.0; 9 * points.len()];
    for (p, x) in points.iter().enumerate() {
        for (from, y, g) in &bonds {
            // the image that is nearest to the point
            let d: [f64; 3] = std::array::from_fn(|a| {
                let d = x[a] - from[a] - 0.5 * y[a];
                d - (d / side).round() * side + 0.5 * y[a]
            });
            let beta = kernel.bond(d, *y);
            if beta != 0.0 {
                (0..9).for_each(|n| all[9 * p + n] += g * y[n / 3] * y[n % 3] * beta);
            }
        }
    }
    all
}

fn seconds<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let begun = Instant::now();
    let out = work();
    (out, begun.elapsed().as_secs_f64())
}

fn main() {
    let mut arguments = std::env::args().skip(1).map(|a| a.parse::<f64>().unwrap());
    let cells = arguments.next().unwrap_or(63.0) as usize;
    let grid = arguments.next().unwrap_or(64.0) as usize;
    let width = arguments.next().unwrap_or(8.0);
    let sites = OfSites(Copper);
    let method = Method::new(Kernel::new(Shape::Polynomial(3), width).unwrap());
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    pool.install(|| {
        let frame = copper(cells);
        let run = || -> Fields { evaluate(&frame, &sites, &Targets::Grid([grid; 3]), &method).unwrap() };
        let (_, time) = seconds(run);
        println!(
            "{} atoms, {grid}^3 points, width {width}: {time:.2} s on one thread",
            frame.len()
        );
        let small = copper(6);
        let targets = Targets::Grid([8; 3]);
        let (own, fast) = seconds(|| evaluate(&small, &sites, &targets, &method).unwrap());
        let points = targets.positions(&small.cell);
        let (other, slow) = seconds(|| naive(&small, &sites, &method.kernel, &points));
        let stress = own.get(Quantity::StressPotential).unwrap();
        let size = other.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        let off = stress.iter().zip(&other).fold(0.0f64, |m, (a, b)| m.max((a - b).abs())) / size;
        println!(
            "{} atoms, 8^3 points: {fast:.3} s, potential stress alone bond by bond {slow:.3} s, difference {off:.1e}",
            small.len()
        );
    });
}
