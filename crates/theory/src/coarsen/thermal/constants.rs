//! Which blocks the bonds may have: what symmetry leaves of them, as fields over all kinds of bonds.
//!
//! `K(−ξ) = K(ξ)ᵀ` is action and reaction; a rotation g of a lattice, all of whose atoms are alike, has `K(gξ) = g K(ξ) gᵀ`.

use super::super::block::{Block, add, inverse, largest, product, scaled, transposed, unit, zero};
use super::alike::{Alike, Vectors};
use std::collections::BTreeMap;

/// Most constants of a fit: their equations are a full matrix.
pub const CONSTANTS_LIMIT: usize = 3000;

/// Blocks of all kinds of bonds as a sum of fields, each with a constant.
pub(super) struct Constants<const D: usize> {
    pub count: usize,
    /// Of each kind of bonds: which constants enter its block, and with what.
    pub of: Vec<Vec<(u32, Block<D>)>>,
    /// Rotations and reflections that were used.
    pub group: Vec<Block<D>>,
}

fn inner<const D: usize>(x: &[Block<D>], y: &[Block<D>]) -> f64 {
    let each = |x: &Block<D>, y: &Block<D>| {
        let pairs = x.as_flattened().iter().zip(y.as_flattened());
        pairs.map(|(x, y)| x * y).sum::<f64>()
    };
    x.iter().zip(y).map(|(x, y)| each(x, y)).sum()
}

impl<const D: usize> Constants<D> {
    /// With the point group of the lattice where all atoms are alike and it is asked for.
    pub fn new(alike: &Alike<D>, symmetry: bool) -> Constants<D> {
        let group = match symmetry && alike.members.len() == 1 {
            true => point_group(&alike.vectors),
            false => vec![unit()],
        };
        // of one class: the kind of a vector
        let mut by_vector = vec![None; alike.vectors.all.len()];
        for (k, kind) in alike.kinds.iter().enumerate() {
            if let Some(v) = alike.vectors.find(&kind.xi) {
                by_vector[v as usize] = Some(k);
            }
        }
        let turned = |k: usize, g: &Block<D>| -> usize {
            if group.len() == 1 {
                return k;
            }
            let v = alike.vectors.find(&times(g, &alike.kinds[k].xi));
            // the group maps the vectors on each other
            v.and_then(|v| by_vector[v as usize]).unwrap_or(k)
        };
        let mut of = vec![vec![]; alike.kinds.len()];
        let mut seen = vec![false; alike.kinds.len()];
        let mut count = 0;
        for first in 0..alike.kinds.len() {
            if seen[first] {
                continue;
            }
            // kinds that follow from the first
            let mut orbit: BTreeMap<usize, Block<D>> = BTreeMap::new();
            for g in &group {
                let k = turned(first, g);
                orbit.insert(k, zero());
                orbit.insert(alike.kinds[k].opposite as usize, zero());
            }
            orbit.keys().for_each(|k| seen[*k] = true);
            let mut kept: Vec<Vec<Block<D>>> = vec![];
            for component in 0..D * D {
                let mut e = zero::<D>();
                e[component / D][component % D] = 1.0;
                let mut field = orbit.clone();
                for g in &group {
                    let k = turned(first, g);
                    let block = product(&product(g, &e), &transposed(g));
                    let back = alike.kinds[k].opposite as usize;
                    for (k, block) in [(k, block), (back, transposed(&block))] {
                        if let Some(sum) = field.get_mut(&k) {
                            add(sum, &scaled(1.0 / group.len() as f64, &block));
                        }
                    }
                }
                let mut field: Vec<Block<D>> = field.into_values().collect();
                // twice is enough
                for _ in 0..2 {
                    for other in &kept {
                        let part = inner(&field, other) / inner(other, other);
                        for (f, o) in field.iter_mut().zip(other) {
                            add(f, &scaled(-part, o));
                        }
                    }
                }
                let size = inner(&field, &field).sqrt();
                if size < 1e-6 {
                    continue;
                }
                let norm = (field.len() as f64).sqrt() / size;
                kept.push(field.iter().map(|f| scaled(norm, f)).collect());
            }
            for field in kept {
                for (k, block) in orbit.keys().zip(field) {
                    if largest(&block) > 1e-12 {
                        of[*k].push((count as u32, block));
                    }
                }
                count += 1;
            }
        }
        Constants { count, of, group }
    }

    /// Blocks of all kinds of bonds.
    pub fn blocks(&self, constants: &[f64]) -> Vec<Block<D>> {
        let sum = |all: &Vec<(u32, Block<D>)>| {
            let mut block = zero();
            for (p, m) in all {
                add(&mut block, &scaled(constants[*p as usize], m));
            }
            block
        };
        self.of.iter().map(sum).collect()
    }

    /// Mean of a tensor over the group.
    pub fn mean(&self, tensor: &Block<D>) -> Block<D> {
        let mut sum = zero();
        for g in &self.group {
            let turned = product(&product(g, tensor), &transposed(g));
            add(&mut sum, &scaled(1.0 / self.group.len() as f64, &turned));
        }
        sum
    }
}

fn times<const D: usize>(m: &Block<D>, x: &[f64; D]) -> [f64; D] {
    std::array::from_fn(|a| (0..D).map(|b| m[a][b] * x[b]).sum())
}

/// Orthogonal maps that map the vectors of a lattice on each other: they map D short ones, and all others with them.
fn point_group<const D: usize>(vectors: &Vectors<D>) -> Vec<Block<D>> {
    let dot = |x: &[f64; D], y: &[f64; D]| (0..D).map(|a| x[a] * y[a]).sum::<f64>();
    let mut sorted = vectors.all.clone();
    sorted.sort_by(|x, y| dot(x, x).total_cmp(&dot(y, y)));
    let Some(basis) = basis(&sorted) else {
        return vec![unit()];
    };
    let columns: Block<D> = std::array::from_fn(|a| std::array::from_fn(|k| basis[k][a]));
    let Some(dual) = inverse(&columns) else {
        return vec![unit()];
    };
    // inner products of vectors that are off by a little
    let longest = basis.iter().map(|b| dot(b, b)).fold(0.0, f64::max).sqrt();
    let off = 4.0 * vectors.size() * longest;
    let mut images: Vec<Vec<[f64; D]>> = vec![vec![]];
    for k in 0..D {
        let mut more = vec![];
        for image in &images {
            for v in &sorted {
                let fits = (0..=k).all(|m| {
                    let other = image.get(m).unwrap_or(v);
                    (dot(v, other) - dot(&basis[k], &basis[m])).abs() < off
                });
                if fits {
                    more.push([image.as_slice(), &[*v]].concat());
                }
            }
        }
        images = more;
    }
    let maps = images.iter().map(|image| {
        let columns: Block<D> = std::array::from_fn(|a| std::array::from_fn(|k| image[k][a]));
        product(&columns, &dual)
    });
    let maps =
        maps.filter(|g| { vectors.all.iter() }.all(|v| vectors.find(&times(g, v)).is_some()));
    maps.collect()
}

/// The shortest D vectors that are independent.
fn basis<const D: usize>(sorted: &[[f64; D]]) -> Option<[[f64; D]; D]> {
    let mut found: Vec<[f64; D]> = vec![];
    let mut across: Vec<[f64; D]> = vec![];
    for v in sorted {
        let mut rest = *v;
        for unit in &across {
            let part: f64 = (0..D).map(|a| rest[a] * unit[a]).sum();
            (0..D).for_each(|a| rest[a] -= part * unit[a]);
        }
        let size = |x: &[f64; D]| x.iter().map(|c| c * c).sum::<f64>().sqrt();
        if size(&rest) > 0.05 * size(v) {
            found.push(*v);
            let s = size(&rest);
            across.push(rest.map(|c| c / s));
        }
        if found.len() == D {
            break;
        }
    }
    found.try_into().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lattice<const D: usize>(sites: &[[f64; D]], period: [f64; D], radius: f64) -> [usize; 3] {
        let alike = Alike::new(sites, &vec![0; sites.len()], period.map(Some), radius).unwrap();
        assert_eq!(alike.members.len(), 1);
        let with = Constants::new(&alike, true);
        let without = Constants::new(&alike, false);
        // nine numbers for each bond and its opposite
        assert_eq!(without.count, D * D * alike.kinds.len() / 2);
        [with.group.len(), with.count, alike.kinds.len()]
    }

    /// Constants by shells as lattice dynamics has them: of a face-centred lattice 3 for (½ ½ 0), 2 for (1 0 0), 4 for (1 ½ ½).
    #[test]
    fn symmetry_leaves_the_constants_of_the_textbooks() {
        let base = [
            [0.0, 0.0, 0.0],
            [0.0, 0.5, 0.5],
            [0.5, 0.0, 0.5],
            [0.5, 0.5, 0.0],
        ];
        let mut sites = vec![];
        for n in 0..64 {
            let cell = [n % 4, n / 4 % 4, n / 16].map(f64::from);
            sites.extend(base.map(|b: [f64; 3]| std::array::from_fn(|a| cell[a] + b[a])));
        }
        assert_eq!(lattice(&sites, [4.0; 3], 0.8), [48, 3, 12]);
        assert_eq!(lattice(&sites, [4.0; 3], 1.1), [48, 5, 18]);
        assert_eq!(lattice(&sites, [4.0; 3], 1.25), [48, 9, 42]);
        // a chain, and the six neighbours of the triangular lattice: along the bond and across it
        let chain: Vec<[f64; 1]> = (0..9).map(|i| [f64::from(i)]).collect();
        assert_eq!(lattice(&chain, [9.0], 2.0), [2, 2, 4]);
        let half = 0.75f64.sqrt();
        let row = |n: i32| f64::from(n / 6);
        let triangular: Vec<[f64; 2]> = (0..36)
            .map(|n| [f64::from(n % 6) + 0.5 * (row(n) % 2.0), half * row(n)])
            .collect();
        assert_eq!(lattice(&triangular, [6.0, 6.0 * half], 1.1), [12, 2, 6]);
    }
}
