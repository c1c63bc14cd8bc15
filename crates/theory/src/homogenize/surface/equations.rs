//! What factors of bonds must satisfy so that every uniform strain is an equilibrium under its uniform traction.
//!
//! Bond constant `c ω ν` and cells of edge 1. Under the strain ε, bond i–j with factor λ pulls with
//! `λ ω ν (n·ε n) n`; a point with outward area `a` needs `Σ_j λ_ij ω ν n⊗n⊗n = −C·a`, with
//! `C = ½ Σ ω ν r n⊗n⊗n⊗n` over a full family: the stiffness that this lattice really has. Both sides are symmetric in all
//! indices: 1, 4 or 10 equations per point hold for all 1, 3 or 6 strains at once.

use super::neighbourhoods::{Kinds, Neighbourhoods};
use super::sites::Sites;
use std::collections::{BTreeMap, HashSet};

/// A bond of a full family.
#[derive(Debug, Clone, Copy)]
pub struct StencilBond {
    pub offset: [i32; 3],
    /// ω ν
    pub weight: f64,
}

impl StencilBond {
    /// Length in spacings, and direction.
    pub fn direction(&self) -> (f64, [f64; 3]) {
        let o = self.offset.map(f64::from);
        let r = o.iter().map(|c| c * c).sum::<f64>().sqrt();
        (r, o.map(|c| c / r))
    }
}

/// Components of a fully symmetric third-order tensor.
fn triples(d: usize) -> Vec<[usize; 3]> {
    let mut all = vec![];
    for a in 0..d {
        for b in a..d {
            for c in b..d {
                all.push([a, b, c]);
            }
        }
    }
    all
}

/// `½ Σ ω ν r n⊗n⊗n⊗n` of a full family, spacings as lengths.
pub fn stiffness(bonds: &[StencilBond]) -> [[[[f64; 3]; 3]; 3]; 3] {
    let mut sum = [[[[0.0; 3]; 3]; 3]; 3];
    for bond in bonds {
        let (r, n) = bond.direction();
        for a in 0..3 {
            for b in 0..3 {
                for c in 0..3 {
                    for d in 0..3 {
                        sum[a][b][c][d] += 0.5 * bond.weight * r * n[a] * n[b] * n[c] * n[d];
                    }
                }
            }
        }
    }
    sum
}

/// Sparse equations `A λ = b`.
#[derive(Debug, Clone, Default)]
pub struct Equations {
    pub unknowns: usize,
    /// `[M]` coefficients by unknown.
    pub rows: Vec<Vec<(usize, f64)>>,
    /// `[M]`
    pub right: Vec<f64>,
    /// `[M]` a place that each is about.
    pub place: Vec<u32>,
}

impl Equations {
    /// `A λ − b`.
    pub fn residual(&self, x: &[f64]) -> Vec<f64> {
        let rows = self.rows.iter().zip(&self.right);
        rows.map(|(row, b)| row.iter().map(|(k, a)| a * x[*k]).sum::<f64>() - b)
            .collect()
    }

    /// `Aᵀ r`.
    pub fn transposed(&self, r: &[f64]) -> Vec<f64> {
        let mut sum = vec![0.0; self.unknowns];
        for (row, r) in self.rows.iter().zip(r) {
            row.iter().for_each(|(k, a)| sum[*k] += a * r);
        }
        sum
    }
}

/// The equations of all points with an unknown bond, each once. Bonds are unknown that have an end within `layers` of
/// an empty site.
pub fn equations(
    sites: &Sites,
    bonds: &[StencilBond],
    around: &mut Neighbourhoods,
    kinds: &Kinds,
    layers: i32,
) -> Equations {
    let d = sites.dimension;
    let triples = triples(d);
    let c = stiffness(bonds);
    let tiny = 1e-12 * c[0][0][0][0];
    let mut made = Equations::default();
    let mut seen: HashSet<Vec<(usize, i64)>> = HashSet::new();
    for place in kinds.examples() {
        let own = around.of(place);
        let own_near = around.near(own, layers);
        let (_, area) = sites.cell_share(place);
        let mut left = vec![BTreeMap::<usize, f64>::new(); triples.len()];
        let mut right: Vec<f64> = triples
            .iter()
            .map(|[i, j, k]| -(0..d).map(|l| c[*i][*j][*k][l] * area[l]).sum::<f64>())
            .collect();
        for bond in bonds {
            let Some(to) = sites.step(place, bond.offset) else {
                continue;
            };
            let other = around.of(to);
            let unknown = own_near || around.near(other, layers);
            let class = unknown.then(|| around.class(own, other, bond.offset));
            let (_, n) = bond.direction();
            for (e, [i, j, k]) in triples.iter().enumerate() {
                let pull = bond.weight * n[*i] * n[*j] * n[*k];
                match class {
                    Some(class) => *left[e].entry(class).or_default() += pull,
                    None => right[e] -= pull,
                }
            }
        }
        for (row, b) in left.into_iter().zip(right) {
            let row: Vec<(usize, f64)> = row.into_iter().filter(|(_, a)| a.abs() > tiny).collect();
            let b = if b.abs() > tiny { b } else { 0.0 };
            if row.is_empty() && b == 0.0 {
                continue;
            }
            let round = |x: f64| (x / tiny / 1e3).round() as i64;
            let sign = row.first().map_or(1.0, |(_, a)| a.signum());
            let mut key: Vec<(usize, i64)> =
                row.iter().map(|(k, a)| (*k, round(sign * a))).collect();
            key.push((usize::MAX, round(sign * b)));
            if seen.insert(key) {
                made.rows.push(row);
                made.right.push(b);
                made.place.push(place as u32);
            }
        }
    }
    made.unknowns = around.classes();
    made
}
