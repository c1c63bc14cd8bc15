//! Direct solution of the equations of a linear body: banded in one dimension, sparse (faer) otherwise.

use super::banded::Banded;
use super::linear_body::LinearBody;
use super::support::Support;
use super::SolveError;
use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::{Llt, Lu};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Mat, Side};

/// Asymmetry (see `Soundness`) up to which a body counts as symmetric.
const SYMMETRIC: f64 = 1e-10;
/// Widest band that is solved as one.
const BAND: usize = 128;

enum Factors {
    Banded(Banded),
    Symmetric(Llt<usize, f64>),
    General(Lu<usize, f64>),
}

/// A factored body on its free components.
pub struct Direct<const D: usize> {
    /// Place of every free component among the unknowns.
    place: Vec<[Option<usize>; D]>,
    unknowns: usize,
    factors: Factors,
}

impl<const D: usize> Direct<D> {
    /// Factors `A + s M` with A the stiffness (force / length) and M the masses; `s` = 0 for equilibrium.
    ///
    /// # Errors
    /// Nothing is free; the matrix is singular or, if symmetric, not positive definite.
    pub fn new(body: &LinearBody<D>, support: &Support<D>, shift: f64) -> Result<Self, SolveError> {
        let order = order(body);
        let mut place = vec![[None; D]; body.points()];
        let (mut unknowns, mut owner) = (0, vec![]);
        for &i in &order {
            for a in (0..D).filter(|a| support.free[i][*a]) {
                place[i][a] = Some(unknowns);
                owner.push((i, a));
                unknowns += 1;
            }
        }
        if unknowns == 0 {
            return Err(SolveError::NothingFree);
        }
        let symmetric = body.soundness().asymmetry <= SYMMETRIC;
        let matrix = Matrix {
            body,
            place: &place,
            shift,
        };
        let named = |e: SolveError| match e {
            SolveError::Indefinite { point } => SolveError::Indefinite {
                point: owner[point].0,
            },
            e => e,
        };
        let width = if D == 1 && symmetric {
            matrix.width()
        } else {
            usize::MAX
        };
        let factors = if width <= BAND {
            let mut band = vec![0.0; unknowns * (width + 1)];
            matrix.entries(|row, column, value| {
                if column <= row {
                    band[row * (width + 1) + row - column] += value;
                }
            });
            let entry = |i: usize, j: usize| band[i * (width + 1) + i - j];
            Factors::Banded(Banded::factor(unknowns, width, entry).map_err(named)?)
        } else {
            let mut triplets = vec![];
            matrix.entries(|row, column, value| {
                if !symmetric || column <= row {
                    triplets.push(Triplet::new(row, column, value));
                }
            });
            let a = SparseColMat::try_new_from_triplets(unknowns, unknowns, &triplets)
                .map_err(|_| SolveError::TooLarge)?;
            drop(triplets);
            if symmetric {
                Factors::Symmetric(a.sp_cholesky(Side::Lower).map_err(|e| match e {
                    faer::sparse::linalg::LltError::Numeric(
                        faer::linalg::cholesky::llt::factor::LltError::NonPositivePivot { index },
                    ) => named(SolveError::Indefinite { point: index }),
                    _ => SolveError::TooLarge,
                })?)
            } else {
                Factors::General(a.sp_lu().map_err(|_| SolveError::Singular)?)
            }
        };
        Ok(Direct {
            place,
            unknowns,
            factors,
        })
    }

    /// Solves for the free components; others become 0.
    pub fn solve(&self, b: &[[f64; D]]) -> Vec<[f64; D]> {
        let mut rhs = vec![0.0; self.unknowns];
        for (b, place) in b.iter().zip(&self.place) {
            for a in 0..D {
                if let Some(n) = place[a] {
                    rhs[n] = b[a];
                }
            }
        }
        match &self.factors {
            Factors::Banded(f) => f.solve(&mut rhs),
            Factors::Symmetric(f) => solved(f, &mut rhs),
            Factors::General(f) => solved(f, &mut rhs),
        }
        let of = |place: &[Option<usize>; D]| place.map(|n| n.map_or(0.0, |n| rhs[n]));
        self.place.iter().map(of).collect()
    }
}

fn solved(factors: &impl Solve<f64>, rhs: &mut [f64]) {
    let column = Mat::from_fn(rhs.len(), 1, |i, _| rhs[i]);
    let x = factors.solve(&column);
    for (i, r) in rhs.iter_mut().enumerate() {
        *r = x[(i, 0)];
    }
}

/// Points along a bar; else as they are (the sparse solver finds its own order).
fn order<const D: usize>(body: &LinearBody<D>) -> Vec<usize> {
    let mut order: Vec<usize> = (0..body.points()).collect();
    if D == 1 {
        order.sort_by(|i, j| body.position[*i][0].total_cmp(&body.position[*j][0]));
    }
    order
}

struct Matrix<'a, const D: usize> {
    body: &'a LinearBody<D>,
    place: &'a [[Option<usize>; D]],
    shift: f64,
}

impl<const D: usize> Matrix<'_, D> {
    /// Largest distance of an entry from the diagonal.
    fn width(&self) -> usize {
        let mut width = 0;
        for (i, place) in self.place.iter().enumerate() {
            let Some(row) = place[0] else { continue };
            for j in self.body.row(i).0 {
                if let Some(column) = self.place[*j as usize][0] {
                    width = width.max(row.abs_diff(column));
                }
            }
        }
        width
    }

    fn entries(&self, mut add: impl FnMut(usize, usize, f64)) {
        let body = self.body;
        for (i, place) in self.place.iter().enumerate() {
            let (partners, blocks) = body.row(i);
            let v = body.volume[i];
            let mut own = [[0.0; D]; D];
            for (&j, c) in partners.iter().zip(blocks) {
                for a in 0..D {
                    for b in 0..D {
                        own[a][b] += v * c[a][b];
                        if let (Some(row), Some(column)) = (place[a], self.place[j as usize][b]) {
                            add(row, column, -v * c[a][b]);
                        }
                    }
                }
            }
            for a in 0..D {
                own[a][a] += self.shift * body.density[i] * v;
                for b in 0..D {
                    if let (Some(row), Some(column)) = (place[a], place[b]) {
                        add(row, column, own[a][b]);
                    }
                }
            }
        }
    }
}
