//! Points that are carried along by nodes, and how much each node counts for each: what smooths a body of atoms.
//!
//! The weight of node g at the point X is `w_g(X) = φ(x_g − X) p(x_g − X)·b(X)`, p the monomials up to second degree and b such that
//! `Σ_g w_g p(x_g − X) = p(0)`: a reproducing kernel (Liu, Jun & Zhang, Int. J. Numer. Meth. Fluids 20, 1995, 1081, (3.5)–(3.10)). So
//! `Σ_g w_g(X) u(x_g) = u(X)` for every quadratic u and every width of φ.

use crate::body::{Body, Values};
use crate::error::BuildError;
use crate::execute::blocks::for_each_piece;
use crate::message;
use crate::quantity::Dimension;
use crate::space::{AXES, Point};
use crate::spec::SmoothSpec;
use std::collections::HashMap;

/// Monomials up to second degree in three dimensions.
const MOST: usize = 10;
/// What may be left of the conditions, whose numbers are about 1.
const LEFT: f64 = 1e-9;

/// A node that a point sees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seen {
    /// Its number, and after [`Nodes::new`] its slot.
    pub node: u32,
    /// The image of it, in periods.
    pub image: [i16; 3],
    pub weight: f64,
}

/// Weights of nodes at points.
#[derive(Debug, Clone)]
pub struct Nodes {
    /// Slots of the points, and the nodes that each sees.
    pub points: Vec<(u32, Vec<Seen>)>,
    /// By slot of nodes: points by their place above, and the weights.
    pub of: Vec<Vec<(u32, f64)>>,
}

impl Nodes {
    /// The nodes that carry a body, as a body, and their weights. Masses and volumes are those of the points, shared by weights.
    ///
    /// # Errors
    /// Periods that no whole number of spacings fills, a width that sees too few nodes, nodes without mass.
    pub fn new<const D: usize>(
        points: &Body<D>,
        spec: &SmoothSpec,
    ) -> Result<(Body<D>, Nodes), BuildError> {
        let position = match spec.spacing {
            Some(spacing) => lattice(points, spacing)?,
            None => places(points),
        };
        let mut rows = weights(points, &position, spec)?;
        let mut volume = vec![0.0; position.len()];
        for (row, slot) in rows.iter().zip(&points.slots) {
            for seen in row {
                volume[seen.node as usize] += seen.weight * points.volume.at(*slot as usize);
            }
        }
        let mean = volume.iter().sum::<f64>() / volume.len() as f64;
        if let Some(n) = volume.iter().position(|v| !(*v > 1e-6 * mean)) {
            return Err(BuildError::ill_posed(
                "smooth",
                format!(
                    "the node at {:?} would have no mass: too few atoms are near it",
                    &position[n][..D]
                ),
            )
            .help("a wider spacing of nodes, or leave spacing out: the atoms' own places are the nodes"));
        }
        let spacing = spec.spacing.unwrap_or(points.spacing);
        let nodes = Body::from_cloud(&position, &volume, &[], spacing, points.period)?;
        let mut of = vec![vec![]; nodes.len];
        for (n, row) in rows.iter_mut().enumerate() {
            for seen in row {
                seen.node = nodes.slots[seen.node as usize];
                of[seen.node as usize].push((n as u32, seen.weight));
            }
        }
        let points = points.slots.iter().copied().zip(rows).collect();
        Ok((nodes, Nodes { points, of }))
    }

    /// Densities of nodes, so that they have the masses of the points.
    pub fn give_masses<const D: usize>(&self, points: &Body<D>, nodes: &mut Body<D>) {
        if let Some(density) = points.density.uniform() {
            nodes.density = Values::Uniform(density);
            return;
        }
        let mass = |n: u32| {
            let slot = self.points[n as usize].0 as usize;
            points.volume.at(slot) * points.density.at(slot)
        };
        let density = nodes.slots.iter().map(|g| {
            let of = self.of[*g as usize].iter();
            of.map(|(n, w)| w * mass(*n)).sum::<f64>() / nodes.volume.at(*g as usize)
        });
        let density: Vec<f64> = density.collect();
        nodes.density = Values::from_points(&density, &nodes.slots, nodes.len, 1.0);
    }

    pub fn bytes(&self) -> usize {
        let seen: usize = self.points.iter().map(|(_, row)| row.len()).sum();
        seen * (size_of::<Seen>() + size_of::<(u32, f64)>())
    }
}

fn places<const D: usize>(body: &Body<D>) -> Vec<Point> {
    let slots = body.slots.iter();
    slots.map(|s| body.position(*s as usize)).collect()
}

/// Places of a square or cubic lattice whose cells hold points of a body: from the least coordinate on where there is a period, else about
/// the middle.
fn lattice<const D: usize>(body: &Body<D>, spacing: f64) -> Result<Vec<Point>, BuildError> {
    let places = places(body);
    let (mut first, mut count, mut step) = ([0.0; D], [1usize; D], [spacing; D]);
    for a in 0..D {
        let all = places.iter().map(|x| x[a]);
        let (low, high) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| {
            (l.min(x), h.max(x))
        });
        match body.period[a] {
            Some(period) => {
                let whole = (period / spacing).round().max(1.0);
                if (whole * spacing - period).abs() > 1e-6 * period {
                    return Err(BuildError::conflict(
                        "smooth.spacing",
                        message![
                            format!("the period along {} is ", AXES[a]),
                            Dimension::LENGTH.of(period),
                            ", no whole number of spacings of nodes, ",
                            Dimension::LENGTH.of(spacing),
                        ],
                    )
                    .help(message![
                        "take ",
                        Dimension::LENGTH.of(period / whole),
                        ", a whole part of the period"
                    ]));
                }
                (first[a], count[a], step[a]) = (low, whole as usize, period / whole);
            }
            None => {
                let most = ((high - low) / spacing - 1e-9).ceil().max(0.0);
                first[a] = 0.5 * (low + high - most * spacing);
                count[a] = most as usize + 1;
            }
        }
    }
    let mut nodes = std::collections::BTreeSet::new();
    for x in &places {
        // a point on the border of cells is in all of them
        let at: [[i64; 2]; D] = crate::array::from_fn(|a| {
            let s = (x[a] - first[a]) / step[a];
            [-1e-6, 1e-6].map(|e| {
                let n = (s + e).round() as i64;
                match body.period[a] {
                    Some(_) => n.rem_euclid(count[a] as i64),
                    None => n.clamp(0, count[a] as i64 - 1),
                }
            })
        });
        for corner in 0..1usize << D {
            // z slowest
            let n: [i64; D] = crate::array::from_fn(|a| at[D - 1 - a][corner >> a & 1]);
            nodes.insert(n);
        }
    }
    let place = |n: &[i64; D]| {
        crate::array::from_fn(|a| match a < D {
            true => first[a] + n[D - 1 - a] as f64 * step[a],
            false => 0.0,
        })
    };
    Ok(nodes.iter().map(place).collect())
}

/// Nodes that each point sees, in order of their numbers and images.
fn weights<const D: usize>(
    body: &Body<D>,
    nodes: &[Point],
    spec: &SmoothSpec,
) -> Result<Vec<Vec<Seen>>, BuildError> {
    let reach = spec.reach;
    let cell = |x: &[f64; D]| x.map(|c| (c / reach).floor() as i64);
    // nodes and their images near the body, by cells
    let points = places(body);
    let (mut low, mut high) = ([f64::INFINITY; D], [f64::NEG_INFINITY; D]);
    for x in &points {
        for a in 0..D {
            (low[a], high[a]) = (low[a].min(x[a] - reach), high[a].max(x[a] + reach));
        }
    }
    let mut cells: HashMap<[i64; D], Vec<(u32, [i16; 3], [f64; D])>> = HashMap::new();
    for (n, x) in nodes.iter().enumerate() {
        let images: [Vec<i16>; D] = crate::array::from_fn(|a| match body.period[a] {
            None => vec![0],
            Some(p) => {
                let from = ((low[a] - x[a]) / p).ceil() as i16;
                let to = ((high[a] - x[a]) / p).floor() as i16;
                (from..=to).collect()
            }
        });
        let all: usize = images.iter().map(Vec::len).product();
        for mut m in 0..all {
            let mut image = [0; 3];
            for a in 0..D {
                image[a] = images[a][m % images[a].len()];
                m /= images[a].len();
            }
            let y: [f64; D] = crate::array::from_fn(|a| {
                x[a] + f64::from(image[a]) * body.period[a].unwrap_or(0.0)
            });
            let cell = cells.entry(cell(&y)).or_default();
            cell.push((n as u32, image, y));
        }
    }
    let mut rows: Vec<Vec<Seen>> = vec![vec![]; points.len()];
    for_each_piece(&mut rows, |first, piece| {
        for (row, x) in piece.iter_mut().zip(&points[first..]) {
            let x: [f64; D] = crate::array::from_fn(|a| x[a]);
            let home = cell(&x);
            let mut near = vec![];
            for n in 0..3usize.pow(D as u32) {
                let mut rest = n;
                let other: [i64; D] = crate::array::from_fn(|a| {
                    let off = rest % 3;
                    rest /= 3;
                    home[a] + off as i64 - 1
                });
                for (node, image, y) in cells.get(&other).into_iter().flatten() {
                    let mut d = [0.0; 3];
                    (0..D).for_each(|a| d[a] = y[a] - x[a]);
                    let phi = spec.window.at(d);
                    if phi > 0.0 {
                        near.push((*node, *image, d, phi));
                    }
                }
            }
            near.sort_by_key(|(node, image, ..)| (*node, *image));
            *row = reproducing::<D>(&near, reach);
        }
    });
    match rows.iter().position(Vec::is_empty) {
        None => Ok(rows),
        Some(n) => Err(BuildError::ill_posed(
            "smooth.width",
            message![
                format!("of the atom at {:?} the kernel of width ", &points[n][..D]),
                Dimension::LENGTH.of(spec.width),
                " sees too few nodes: no weights of theirs give every quadratic displacement",
            ],
        )
        .help("a width of two to three spacings of nodes, or more")),
    }
}

/// Monomials up to second degree.
fn monomials<const D: usize>(d: &[f64; 3], reach: f64) -> ([f64; MOST], usize) {
    let mut p = [0.0; MOST];
    p[0] = 1.0;
    let mut n = 1;
    for a in 0..D {
        p[n] = d[a] / reach;
        n += 1;
    }
    for a in 0..D {
        for b in 0..=a {
            p[n] = d[a] * d[b] / (reach * reach);
            n += 1;
        }
    }
    (p, n)
}

/// The weights of nodes at distances d with φ there; none if there are no such weights.
fn reproducing<const D: usize>(near: &[(u32, [i16; 3], [f64; 3], f64)], reach: f64) -> Vec<Seen> {
    let mut moments = [[0.0; MOST]; MOST];
    let mut count = 1;
    for (_, _, d, phi) in near {
        let (p, n) = monomials::<D>(d, reach);
        count = n;
        for a in 0..n {
            for b in 0..n {
                moments[a][b] += phi * p[a] * p[b];
            }
        }
    }
    let mut seen: Vec<Seen> = near
        .iter()
        .map(|(node, image, ..)| Seen {
            node: *node,
            image: *image,
            weight: 0.0,
        })
        .collect();
    // solved, and what is left solved again: φ of the outermost nodes may be small
    for _ in 0..4 {
        let mut left = [0.0; MOST];
        left[0] = 1.0;
        for (seen, (_, _, d, _)) in seen.iter().zip(near) {
            let (p, n) = monomials::<D>(d, reach);
            (0..n).for_each(|a| left[a] -= seen.weight * p[a]);
        }
        let Some(b) = solve(moments, left, count) else {
            return vec![];
        };
        for (seen, (_, _, d, phi)) in seen.iter_mut().zip(near) {
            let (p, n) = monomials::<D>(d, reach);
            seen.weight += phi * (0..n).map(|a| p[a] * b[a]).sum::<f64>();
        }
    }
    let mut left = [0.0; MOST];
    left[0] = 1.0;
    for (seen, (_, _, d, _)) in seen.iter().zip(near) {
        let (p, n) = monomials::<D>(d, reach);
        (0..n).for_each(|a| left[a] -= seen.weight * p[a]);
    }
    match left.iter().all(|c| c.abs() < LEFT) {
        true => seen,
        false => vec![],
    }
}

/// Elimination with pivots.
fn solve(mut m: [[f64; MOST]; MOST], mut b: [f64; MOST], n: usize) -> Option<[f64; MOST]> {
    for k in 0..n {
        let best = (k..n).max_by(|i, j| m[*i][k].abs().total_cmp(&m[*j][k].abs()))?;
        m.swap(k, best);
        b.swap(k, best);
        if !(m[k][k].abs() > f64::MIN_POSITIVE) {
            return None;
        }
        for i in k + 1..n {
            let part = m[i][k] / m[k][k];
            for c in k..n {
                m[i][c] -= part * m[k][c];
            }
            b[i] -= part * b[k];
        }
    }
    for k in (0..n).rev() {
        let done: f64 = (k + 1..n).map(|c| m[k][c] * b[c]).sum();
        b[k] = (b[k] - done) / m[k][k];
    }
    Some(b)
}
