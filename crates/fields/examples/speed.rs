//! What the fields of embedded atoms cost: a block of CELLS³ cells of copper (4 atoms each) with thermal displacements and velocities, one
//! thread.
//!
//! `speed [CELLS] [GRID] [WIDTH]`: one grid (GRID³ points) and width (Å); `speed table [CELLS]`: several of both. `speed shapes [CELLS]`: other functions.
//! Beside each stands a loop over all bonds for each point, measured on eight points and scaled to all, and what β alone costs on points that
//! wait side by side. `speed alone …` leaves these away.

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

/// Potential stress at some points: all bonds, for each point; with the number of bonds, each from both ends, and their whole length.
fn naive(
    frame: &Frame,
    sites: &dyn Sites,
    kernel: &Kernel,
    points: &[[f64; 3]],
) -> (Vec<f64>, [f64; 2]) {
    let neighbours = Neighbours::new(frame, CUT).unwrap();
    let side = frame.cell.edges[0][0];
    let mut sums = vec![0.0; 9 * points.len()];
    let mut count = [0.0; 2];
    let mut partners = vec![];
    for i in 0..frame.len() {
        neighbours.near(i, &mut partners);
        let near: Vec<Near> = partners.iter().map(|p| Near { kind: 0, y: p.y }).collect();
        let mut pulls = vec![0.0; near.len()];
        sites.terms(0, &near, &mut |t| {
            t.pulls.iter().for_each(|p| pulls[p.1 as usize - 1] += p.2);
        });
        let from = neighbours.wrapped[i];
        for (Near { y, .. }, g) in near.iter().zip(pulls) {
            count[0] += 1.0;
            count[1] += y.iter().map(|c| c * c).sum::<f64>().sqrt();
            for (p, x) in points.iter().enumerate() {
                // the image that is nearest to the point
                let d: [f64; 3] = std::array::from_fn(|a| {
                    let d = x[a] - from[a] - 0.5 * y[a];
                    d - (d / side).round() * side + 0.5 * y[a]
                });
                let beta = kernel.bond(d, *y);
                if beta != 0.0 {
                    (0..9).for_each(|n| sums[9 * p + n] += g * y[n / 3] * y[n % 3] * beta);
                }
            }
        }
    }
    (sums, count)
}

/// Seconds that this thread has worked, where the system says so: other programs on the machine do not count.
fn clock() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(1e-9 * text.split(' ').next()?.parse::<f64>().ok()?)
}

fn seconds<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let (begun, before) = (Instant::now(), clock());
    let out = work();
    let worked = clock().zip(before).map(|(b, a)| b - a);
    (out, worked.unwrap_or(begun.elapsed().as_secs_f64()))
}

/// β of a bond at points that wait side by side (ns for each).
fn limit(kernel: &Kernel) -> f64 {
    let n = 512;
    let spread = |k: usize, by: f64| {
        (0..n)
            .map(|i| kernel.width() * (((i * k) as f64 * by).fract() - 0.5))
            .collect::<Vec<f64>>()
    };
    let columns = [spread(1, 0.618), spread(3, 0.414), spread(7, 0.732)];
    let mut out = vec![0.0; n];
    let rounds = 20_000;
    let (_, time) = seconds(|| {
        for _ in 0..rounds {
            let d = [&columns[0][..], &columns[1], &columns[2]];
            peridyne_fields::bond::bonds(
                std::hint::black_box(kernel),
                d,
                [1.5, -1.2, 0.9],
                std::hint::black_box(&mut out),
            );
        }
    });
    1e9 * time / (rounds * n) as f64
}

fn row(frame: &Frame, shape: Shape, grid: usize, width: f64, beside: bool) {
    let sites = OfSites(Copper);
    let method = Method::new(Kernel::new(shape, width).unwrap());
    let targets = Targets::Grid([grid; 3]);
    let (own, time) = seconds(|| -> Fields { evaluate(frame, &sites, &targets, &method).unwrap() });
    let per_atom = 1e6 * time / frame.len() as f64;
    if !beside {
        println!(
            "| {grid}³ | {width} | {time:.2} | {per_atom:.1} | {} |",
            shape.name()
        );
        return;
    }
    let points = targets.positions(&frame.cell);
    let some: Vec<usize> = (0..8).map(|k| k * (points.len() - 1) / 7).collect();
    let at: Vec<[f64; 3]> = some.iter().map(|p| points[*p]).collect();
    let ((other, [both, length]), slow) = seconds(|| naive(frame, &sites, &method.kernel, &at));
    let stress = own.get(Quantity::StressPotential).unwrap();
    let size = other.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let pairs = some
        .iter()
        .enumerate()
        .flat_map(|(k, p)| (0..9).map(move |n| (9 * k + n, 9 * p + n)));
    let off = pairs
        .map(|(a, b)| (other[a] - stress[b]).abs())
        .fold(0.0, f64::max)
        / size;
    // points in the balls about both ends and the cylinder between them
    let count = both / 2.0;
    let round = std::f64::consts::PI * width * width;
    let density = points.len() as f64 / frame.cell.volume();
    let near = density * (count * round * width * 4.0 / 3.0 + round * length / 2.0);
    println!(
        "| {grid}³ | {width} | {time:.2} | {per_atom:.1} | {:.1} | {:.1} | {:.1} | {:.0} | {off:.0e} |",
        near / count,
        1e9 * time / near,
        limit(&method.kernel),
        slow / 8.0 * points.len() as f64 / time,
    );
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let mode = words.first().filter(|w| w.parse::<f64>().is_err());
    let mut numbers = words
        .iter()
        .skip(usize::from(mode.is_some()))
        .map(|a| a.parse::<f64>().unwrap());
    let mode = mode.map_or("", |w| w);
    let whole = matches!(mode, "" | "alone");
    let cells = numbers.next().unwrap_or(if whole { 63.0 } else { 24.0 }) as usize;
    let grid = numbers.next().unwrap_or(64.0) as usize;
    let width = numbers.next().unwrap_or(8.0);
    let polynomial = Shape::Polynomial(3);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    pool.install(|| {
        let frame = copper(cells);
        println!("{} atoms, one thread", frame.len());
        println!("| grid | width (Å) | s | µs per atom | points per bond | ns per bond and point | of β alone | naive, times as long | difference |");
        println!("|---|---|---|---|---|---|---|---|---|");
        match mode {
            "table" => {
                for grid in [16, 32, 64] {
                    for width in [4.0, 8.0, 12.0] {
                        row(&frame, polynomial, grid, width, true);
                    }
                }
            }
            "shapes" => {
                for (shape, width) in [
                    (Shape::Polynomial(0), 8.0),
                    (polynomial, 8.0),
                    (Shape::Polynomial(7), 8.0),
                    (Shape::CubicSpline, 8.0),
                    (Shape::QuarticSpline, 8.0),
                    (Shape::Gaussian, 1.0),
                ] {
                    row(&frame, shape, 32, width, false);
                }
            }
            _ => row(&frame, polynomial, grid, width, mode != "alone"),
        }
    });
}
