//! What factors of bonds must satisfy so that every uniform strain is an equilibrium under its uniform traction.
//!
//! Bond constant `c ω ν` and cells of edge 1. Under the strain ε, bond i–j with factor λ pulls with
//! `λ ω ν (n·ε n) n`; a point with outward area `a` needs `Σ_j λ_ij ω ν n⊗n⊗n = −C·a`, with
//! `C = ½ Σ ω ν r n⊗n⊗n⊗n` over a full family: the stiffness that this lattice really has. Both sides are symmetric in all
//! indices: 1, 4 or 10 equations per point hold for all 1, 3 or 6 strains at once. In a state-based solid the pair forces
//! are `λ ω ν (e/r) r n`: the same with `ω r` for ω.
//!
//! Of the dilatation `θ_i = (D/m) Σ_j η_ij ω ν r e_ij`, with the m of a full family and a factor η of every directed bond,
//! is asked that it is the trace of any uniform strain, and that its forces `κ θ (D/m) ω ν r (v_i η_ij + v_j η_ji) n` (v:
//! parts of cells) sum to those of the pressure κθ on the area: `Σ_j η_ij ω ν r² n⊗n = (m/D) 1` and
//! `Σ_j (v_i η_ij + v_j η_ji) ω ν r n = −(m/D) a`.
//!
//! Conduction has a factor ζ of the conductance `2 D k ω ν/m` of a bond between whole cells: a constant gradient along any axis brings in
//! what leaves through the area if `Σ_j ζ_ij ω ν r n = −(m/2D) a`, m that of a full family. In a state-based solid
//! ζ = λ is one solution: the trace of its equations is this one.

use super::neighbourhoods::{Bonds, Kinds, Neighbourhoods};
use super::sites::Sites;
use std::collections::{BTreeMap, HashSet};

/// A bond of a full family.
#[derive(Debug, Clone, Copy)]
pub struct StencilBond {
    pub offset: [i32; 3],
    /// ω ν, of state-based solids times r: of the pair force.
    pub weight: f64,
    /// ω ν r: of the dilatation.
    pub share: f64,
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
    let mutual = Mutual {
        sites,
        bonds,
        kinds,
        layers,
        tiny: 1e-12 * c[0][0][0][0],
    };
    let pull = |bond: &StencilBond, e: usize| {
        let (_, n) = bond.direction();
        let [i, j, k] = triples[e];
        bond.weight * n[i] * n[j] * n[k]
    };
    let right = |area: &[f64; 3], e: usize| {
        let [i, j, k] = triples[e];
        -(0..d).map(|l| c[i][j][k][l] * area[l]).sum::<f64>()
    };
    mutual.equations(around, triples.len(), pull, right)
}

/// The equations of the factors ζ of conductances.
pub fn conductances(
    sites: &Sites,
    bonds: &[StencilBond],
    around: &mut Neighbourhoods,
    kinds: &Kinds,
    layers: i32,
) -> Equations {
    let d = sites.dimension;
    let half: f64 = bonds.iter().map(|b| b.share * b.direction().0).sum();
    let half = half / (2 * d) as f64;
    let mutual = Mutual {
        sites,
        bonds,
        kinds,
        layers,
        tiny: 1e-12 * half,
    };
    let flow = |bond: &StencilBond, a: usize| bond.share * bond.direction().1[a];
    mutual.equations(around, d, flow, |area, a| -half * area[a])
}

/// Equations of factors that both directions of a bond share.
struct Mutual<'a> {
    sites: &'a Sites,
    bonds: &'a [StencilBond],
    kinds: &'a Kinds,
    layers: i32,
    /// What is 0 but for round-off.
    tiny: f64,
}

impl Mutual<'_> {
    /// `Σ factor · term(bond, e) = right(area, e)` for e below `count`; bonds whose factor is known to be 1 go to the right.
    fn equations(
        &self,
        around: &mut Neighbourhoods,
        count: usize,
        term: impl Fn(&StencilBond, usize) -> f64,
        right: impl Fn(&[f64; 3], usize) -> f64,
    ) -> Equations {
        let mut made = Collected::new(self.tiny);
        for place in self.kinds.examples() {
            let own = around.of(place);
            let own_near = around.near(own, self.layers);
            let (_, area) = self.sites.cell_share(place);
            let mut left = vec![BTreeMap::<usize, f64>::new(); count];
            let mut right: Vec<f64> = (0..count).map(|e| right(&area, e)).collect();
            for bond in self.bonds {
                let Some(to) = self.sites.step(place, bond.offset) else {
                    continue;
                };
                let other = around.of(to);
                let unknown = own_near || around.near(other, self.layers);
                let class = unknown.then(|| around.class(Bonds::Mutual, own, other, bond.offset));
                for e in 0..count {
                    let x = term(bond, e);
                    match class {
                        Some(class) => *left[e].entry(class).or_default() += x,
                        None => right[e] -= x,
                    }
                }
            }
            made.add(place, left, right);
        }
        made.finish(around.classes(Bonds::Mutual))
    }
}

/// The equations of the factors η of the dilatation.
pub fn shares(
    sites: &Sites,
    bonds: &[StencilBond],
    around: &mut Neighbourhoods,
    kinds: &Kinds,
    layers: i32,
) -> Equations {
    let d = sites.dimension;
    let pairs: Vec<[usize; 2]> = (0..d).flat_map(|a| (a..d).map(move |b| [a, b])).collect();
    let third = bonds.iter().map(|b| b.share * b.direction().0).sum::<f64>() / d as f64;
    let mut made = Collected::new(1e-12 * third);
    for place in kinds.examples() {
        let own = around.of(place);
        let own_near = around.near(own, layers);
        let (part, area) = sites.cell_share(place);
        let mut left = vec![BTreeMap::<usize, f64>::new(); pairs.len() + d];
        let mut right: Vec<f64> = pairs
            .iter()
            .map(|[a, b]| if a == b { third } else { 0.0 })
            .chain((0..d).map(|a| -third * area[a]))
            .collect();
        for bond in bonds {
            let Some(to) = sites.step(place, bond.offset) else {
                continue;
            };
            let other = around.of(to);
            let beyond = sites.cell_share(to).0;
            let (r, n) = bond.direction();
            let unknown = own_near || around.near(other, layers);
            let ends = unknown.then(|| {
                let back = bond.offset.map(|c| -c);
                let mut class = |from, to, o| around.class(Bonds::Directed, from, to, o);
                [class(own, other, bond.offset), class(other, own, back)]
            });
            let mut add = |e: usize, end: usize, x: f64| match ends {
                Some(class) => *left[e].entry(class[end]).or_default() += x,
                None => right[e] -= x,
            };
            for (e, [a, b]) in pairs.iter().enumerate() {
                add(e, 0, bond.share * r * n[*a] * n[*b]);
            }
            for a in 0..d {
                add(pairs.len() + a, 0, part * bond.share * n[a]);
                add(pairs.len() + a, 1, beyond * bond.share * n[a]);
            }
        }
        made.add(place, left, right);
    }
    made.finish(around.classes(Bonds::Directed))
}

/// Equations, each once.
struct Collected {
    tiny: f64,
    seen: HashSet<Vec<(usize, i64)>>,
    made: Equations,
}

impl Collected {
    fn new(tiny: f64) -> Collected {
        Collected {
            tiny,
            seen: HashSet::new(),
            made: Equations::default(),
        }
    }

    fn add(&mut self, place: usize, left: Vec<BTreeMap<usize, f64>>, right: Vec<f64>) {
        let tiny = self.tiny;
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
            if self.seen.insert(key) {
                self.made.rows.push(row);
                self.made.right.push(b);
                self.made.place.push(place as u32);
            }
        }
    }

    fn finish(mut self, unknowns: usize) -> Equations {
        self.made.unknowns = unknowns;
        self.made
    }
}
