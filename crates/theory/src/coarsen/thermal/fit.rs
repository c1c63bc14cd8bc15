//! The least-squares fit of forces to displacements, by blocks of frames.

use super::alike::Alike;
use super::constants::Constants;
use crate::coarsen::block::Block;
use crate::coarsen::small::Semidefinite;
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::ops::Range;

/// Constants of the bonds, and how sure they are.
pub(super) struct Fit {
    /// `[P]`
    pub constants: Vec<f64>,
    /// Of each block of frames: what its residuals would change of the constants.
    pub changes: Vec<Vec<f64>>,
    /// Root mean square of the forces that the fit leaves, over that of the forces.
    pub residual: f64,
}

/// Frames, centred: displacements and forces `[F][N]` less their means.
pub(super) struct Centred<const D: usize> {
    pub displacement: Vec<Vec<[f64; D]>>,
    pub force: Vec<Vec<[f64; D]>>,
}

impl<const D: usize> Centred<D> {
    /// And the means of the displacements `[N]`.
    pub fn new(u: &[Vec<[f64; D]>], f: &[Vec<[f64; D]>]) -> (Centred<D>, Vec<[f64; D]>) {
        let less = |all: &[Vec<[f64; D]>]| {
            let atoms = all.first().map_or(0, Vec::len);
            let mut mean = vec![[0.0; D]; atoms];
            for frame in all {
                for (m, x) in mean.iter_mut().zip(frame) {
                    (0..D).for_each(|a| m[a] += x[a] / all.len() as f64);
                }
            }
            let off = |frame: &Vec<[f64; D]>| -> Vec<[f64; D]> {
                let each = frame.iter().zip(&mean);
                each.map(|(x, m)| std::array::from_fn(|a| x[a] - m[a]))
                    .collect()
            };
            (all.iter().map(off).collect(), mean)
        };
        let (displacement, mean) = less(u);
        let force = less(f).0;
        (
            Centred {
                displacement,
                force,
            },
            mean,
        )
    }
}

/// What enters the equations of the atoms of a class.
struct Local<const D: usize> {
    /// Constants.
    columns: Vec<u32>,
    /// Of each kind of bonds that begins here: places among the columns, and blocks.
    of: Vec<(usize, Vec<(usize, Block<D>)>)>,
}

/// The equations `F_i = Σ_p c_p Σ_j M_p,ij (u_j − u_i)` of all atoms.
struct Equations<'a, const D: usize> {
    alike: &'a Alike<D>,
    frames: &'a Centred<D>,
    constants: usize,
    local: Vec<Local<D>>,
}

impl<'a, const D: usize> Equations<'a, D> {
    fn new(alike: &'a Alike<D>, constants: &Constants<D>, frames: &'a Centred<D>) -> Self {
        let local = (0..alike.members.len()).map(|class| {
            let from = |k: &usize| alike.kinds[*k].from as usize == class;
            let kinds: Vec<usize> = (0..alike.kinds.len()).filter(from).collect();
            let all = kinds.iter().flat_map(|k| &constants.of[*k]);
            let mut columns: Vec<u32> = all.map(|(p, _)| *p).collect();
            columns.sort_unstable();
            columns.dedup();
            let place = |p: u32| columns.partition_point(|c| *c < p);
            let blocks = |k: &usize| {
                let all = constants.of[*k].iter();
                (*k, all.map(|(p, m)| (place(*p), *m)).collect())
            };
            let of = kinds.iter().map(blocks).collect();
            Local { columns, of }
        });
        Equations {
            local: local.collect(),
            alike,
            frames,
            constants: constants.count,
        }
    }

    /// Places of kinds of bonds in the list of their class.
    fn places(&self, local: &Local<D>) -> Vec<usize> {
        let mut places = vec![0; self.alike.kinds.len()];
        for (n, (k, _)) in local.of.iter().enumerate() {
            places[*k] = n;
        }
        places
    }

    /// Rows of an atom in a frame, `[D][columns]`.
    fn rows(&self, local: &Local<D>, places: &[usize], i: usize, t: usize, rows: &mut [f64]) {
        let u = &self.frames.displacement[t];
        let n = local.columns.len();
        rows.fill(0.0);
        for (j, k) in self.alike.bonds(i) {
            let eta: [f64; D] = std::array::from_fn(|a| u[j][a] - u[i][a]);
            for (p, m) in &local.of[places[k]].1 {
                for a in 0..D {
                    rows[a * n + p] += (0..D).map(|b| m[a][b] * eta[b]).sum::<f64>();
                }
            }
        }
    }

    /// Normal equations of some frames: `A` row by row, the part below the diagonal, and `b`.
    fn normal(&self, frames: Range<usize>) -> (Vec<f64>, Vec<f64>) {
        let (mut matrix, mut right) = (vec![0.0; self.constants.pow(2)], vec![0.0; self.constants]);
        for (local, atoms) in self.local.iter().zip(&self.alike.members) {
            let n = local.columns.len();
            let places = self.places(local);
            let mut rows = vec![0.0; D * n];
            let mut own = vec![0.0; n * n];
            for t in frames.clone() {
                for i in atoms.iter().map(|i| *i as usize) {
                    self.rows(local, &places, i, t, &mut rows);
                    let force = self.frames.force[t][i];
                    for (row, f) in rows.chunks_exact(n.max(1)).zip(force) {
                        for (p, x) in row.iter().enumerate() {
                            right[local.columns[p] as usize] += x * f;
                            if *x != 0.0 {
                                let sums = own[p * n..].iter_mut();
                                sums.zip(&row[..=p]).for_each(|(s, y)| *s += x * y);
                            }
                        }
                    }
                }
            }
            for p in 0..n {
                for q in 0..=p {
                    let [p_, q_] = [p, q].map(|p| local.columns[p] as usize);
                    matrix[p_ * self.constants + q_] += own[p * n + q];
                }
            }
        }
        (matrix, right)
    }

    /// What is left of some frames' equations: `Σ Xᵀ r`, `Σ r²`, `Σ F²`.
    fn left(&self, frames: Range<usize>, constants: &[f64]) -> (Vec<f64>, f64, f64) {
        let (mut gradient, mut off, mut size) = (vec![0.0; self.constants], 0.0, 0.0);
        for (local, atoms) in self.local.iter().zip(&self.alike.members) {
            let n = local.columns.len();
            let places = self.places(local);
            let own: Vec<f64> = (local.columns.iter())
                .map(|p| constants[*p as usize])
                .collect();
            let mut rows = vec![0.0; D * n];
            for t in frames.clone() {
                for i in atoms.iter().map(|i| *i as usize) {
                    self.rows(local, &places, i, t, &mut rows);
                    let force = self.frames.force[t][i];
                    for (row, f) in rows.chunks_exact(n.max(1)).zip(force) {
                        let r = row.iter().zip(&own).fold(f, |r, (x, c)| r - x * c);
                        off += r * r;
                        size += f * f;
                        for (p, x) in local.columns.iter().zip(row) {
                            gradient[*p as usize] += x * r;
                        }
                    }
                }
            }
        }
        (gradient, off, size)
    }
}

/// What makes `Σ_j K_ij` of every atom symmetric, as second derivatives of an energy are (K_ji = K_ijᵀ alone does not): equations `G c = 0`, row by row. Without
/// meaning where the lattice sees to it.
struct Symmetric {
    /// `[M][P]`
    rows: Vec<Vec<f64>>,
    /// `A⁻¹ Gᵀ`, row by row.
    answers: Vec<Vec<f64>>,
    /// Of `G A⁻¹ Gᵀ`, which is singular: the sum over all atoms is symmetric anyway.
    factor: Semidefinite,
}

impl Symmetric {
    fn new<const D: usize>(
        alike: &Alike<D>,
        constants: &Constants<D>,
        factor: &Semidefinite,
    ) -> Symmetric {
        // atoms of a class may have bonds to different classes
        let mut known = BTreeSet::new();
        let mut rows = vec![];
        for i in 0..alike.atoms() {
            let mut kinds: Vec<usize> = alike.bonds(i).map(|(_, k)| k).collect();
            kinds.sort_unstable();
            if known.contains(&kinds) {
                continue;
            }
            for a in 0..D {
                for b in 0..a {
                    let mut row = vec![0.0; constants.count];
                    for (p, m) in kinds.iter().flat_map(|k| &constants.of[*k]) {
                        row[*p as usize] += m[a][b] - m[b][a];
                    }
                    if row.iter().any(|x| x.abs() > 1e-9) {
                        rows.push(row);
                    }
                }
            }
            known.insert(kinds);
        }
        let answers: Vec<Vec<f64>> = rows.iter().map(|row| factor.solve(row)).collect();
        let each = rows
            .iter()
            .flat_map(|row| answers.iter().map(|x| dot(row, x)));
        let factor = Semidefinite::new(each.collect(), rows.len());
        Symmetric {
            rows,
            answers,
            factor,
        }
    }

    /// The nearest constants, as the equations measure it, that do.
    fn of(&self, mut constants: Vec<f64>) -> Vec<f64> {
        let off: Vec<f64> = self.rows.iter().map(|row| dot(row, &constants)).collect();
        for (x, answer) in self.factor.solve(&off).iter().zip(&self.answers) {
            let each = constants.iter_mut().zip(answer);
            each.for_each(|(c, a)| *c -= x * a);
        }
        constants
    }
}

fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

/// Blocks of frames, one after the other, evenly.
fn blocks(frames: usize, count: usize) -> Vec<Range<usize>> {
    (0..count)
        .map(|b| b * frames / count..(b + 1) * frames / count)
        .collect()
}

/// The fit over all frames in so many blocks; `None`: frames do not tell some constants apart. Sums have one order on any
/// number of threads.
pub(super) fn fit<const D: usize>(
    alike: &Alike<D>,
    constants: &Constants<D>,
    frames: &Centred<D>,
    count: usize,
) -> Option<Fit> {
    let equations = Equations::new(alike, constants, frames);
    let blocks = blocks(frames.force.len(), count);
    let n = constants.count;
    let (mut matrix, mut right) = (vec![0.0; n * n], vec![0.0; n]);
    for some in blocks.chunks(rayon::current_num_threads()) {
        let each: Vec<_> = (some.par_iter())
            .map(|frames| equations.normal(frames.clone()))
            .collect();
        for (a, b) in each {
            matrix.iter_mut().zip(a).for_each(|(s, x)| *s += x);
            right.iter_mut().zip(b).for_each(|(s, x)| *s += x);
        }
    }
    let factor = Semidefinite::new(matrix, n);
    if !factor.definite() {
        return None;
    }
    let symmetric = Symmetric::new(alike, constants, &factor);
    let solved = symmetric.of(factor.solve(&right));
    let left: Vec<_> = (blocks.par_iter())
        .map(|frames| equations.left(frames.clone(), &solved))
        .collect();
    let off: f64 = left.iter().map(|l| l.1).sum();
    let size: f64 = left.iter().map(|l| l.2).sum();
    Some(Fit {
        changes: (left.iter())
            .map(|l| symmetric.of(factor.solve(&l.0)))
            .collect(),
        constants: solved,
        residual: (off / size).sqrt(),
    })
}
