//! Direct solution of the equations of a linear body: banded in one dimension, sparse (faer) otherwise.

use super::operator::LinearOperator;
use super::solved::Solved;
use super::support::Support;
use super::vectors::{Block, add, diagonal, norm};
use crate::error::SolveError;
use crate::execute::memory;
use crate::spec::LinearBody;
use peridyne_algebra::banded::{Banded, Factored};
use peridyne_algebra::{FactorError, Factors as Sparse};

/// Asymmetry (see `Soundness`) up to which a body counts as symmetric.
pub const SYMMETRIC: f64 = 1e-10;
/// Widest band that is solved as one.
const BAND: usize = 128;
/// A pivot of a band below this part of its diagonal entry counts as 0.
const PIVOT: f64 = 1e-14;

enum Factors {
    Banded(Factored<f64>),
    Sparse(Sparse),
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
        let symmetric = body.soundness().asymmetry <= SYMMETRIC;
        Direct::made(body, support, Own::Masses(shift), symmetric)
    }

    /// Factors `A` with a symmetric stiffness of each point against its own place besides (`[N]`, force / length).
    ///
    /// # Errors
    /// Those of [`Direct::new`].
    pub fn against(
        body: &LinearBody<D>,
        support: &Support<D>,
        own: &[Block<D>],
    ) -> Result<Self, SolveError> {
        let symmetric = body.soundness().asymmetry <= SYMMETRIC;
        Direct::made(body, support, Own::Blocks(own), symmetric)
    }

    /// Factors the stiffness of a body that need not be positive definite.
    ///
    /// # Errors
    /// Nothing is free; the matrix is singular.
    pub fn of_any_sign(body: &LinearBody<D>, support: &Support<D>) -> Result<Self, SolveError> {
        Direct::made(body, support, Own::Masses(0.0), false)
    }

    fn made(
        body: &LinearBody<D>,
        support: &Support<D>,
        own: Own<'_, D>,
        symmetric: bool,
    ) -> Result<Self, SolveError> {
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
        let matrix = Matrix {
            body,
            place: &place,
            own,
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
            let mut band = Banded::zeros(unknowns, width);
            matrix.entries(|row, column, value| {
                if row <= column {
                    band.add(row, column, value);
                }
            });
            let factors = band.factor_if(|pivot, diagonal| *pivot > PIVOT * diagonal);
            Factors::Banded(factors.map_err(|row| named(SolveError::Indefinite { point: row }))?)
        } else {
            let mut entries = vec![];
            matrix.entries(|row, column, value| {
                if !symmetric || column <= row {
                    entries.push((row, column, value));
                }
            });
            let made = match symmetric {
                true => Sparse::symmetric(unknowns, &entries, |bytes| {
                    memory::available().is_none_or(|left| bytes <= left)
                }),
                false => Sparse::general(unknowns, &entries),
            };
            Factors::Sparse(made.map_err(|e| match e {
                FactorError::NotPositive { row } => named(SolveError::Indefinite { point: row }),
                FactorError::Singular => SolveError::Singular,
                FactorError::TooLarge => SolveError::TooLarge,
            })?)
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
            Factors::Sparse(f) => f.solve(&mut rhs),
        }
        let of = |place: &[Option<usize>; D]| place.map(|n| n.map_or(0.0, |n| rhs[n]));
        self.place.iter().map(of).collect()
    }

    /// Solves `A x = b` for the free components, refined once; held ones keep their `x`. `operator` is what was factored,
    /// or near to it.
    pub fn solve_held(
        &self,
        operator: &mut dyn LinearOperator<D>,
        support: &Support<D>,
        b: &[[f64; D]],
        x: &mut [[f64; D]],
    ) -> Solved {
        let mut product = vec![[0.0; D]; b.len()];
        // what the held ones pull, and what the loads add
        let mut left = |x: &[[f64; D]], b: &[[f64; D]]| {
            operator.apply(x, &mut product);
            let mut r: Vec<[f64; D]> = b
                .iter()
                .zip(&product)
                .map(|(b, p)| crate::array::from_fn(|a| b[a] - p[a]))
                .collect();
            support.mask(&mut r);
            r
        };
        let mut held = x.to_vec();
        for (h, free) in held.iter_mut().zip(&support.free) {
            for a in (0..D).filter(|a| free[*a]) {
                h[a] = 0.0;
            }
        }
        let r = left(&held, b);
        let start = norm(&r);
        let mut solution = self.solve(&r);
        let correction = self.solve(&left(&solution, &r));
        add(&mut solution, 1.0, &correction);
        let residual = norm(&left(&solution, &r));
        for ((x, s), free) in x.iter_mut().zip(&solution).zip(&support.free) {
            for a in (0..D).filter(|a| free[*a]) {
                x[a] = s[a];
            }
        }
        Solved {
            iterations: 1,
            residual: if start > 0.0 { residual / start } else { 0.0 },
        }
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

/// What stands on the diagonal beside the bonds.
#[derive(Clone, Copy)]
enum Own<'a, const D: usize> {
    /// This part of the masses.
    Masses(f64),
    Blocks(&'a [Block<D>]),
}

struct Matrix<'a, const D: usize> {
    body: &'a LinearBody<D>,
    place: &'a [[Option<usize>; D]],
    own: Own<'a, D>,
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
            let mut own = match self.own {
                Own::Masses(part) => diagonal(part * body.density[i] * v),
                Own::Blocks(all) => all[i],
            };
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
                for b in 0..D {
                    if let (Some(row), Some(column)) = (place[a], place[b]) {
                        add(row, column, own[a][b]);
                    }
                }
            }
        }
    }
}
