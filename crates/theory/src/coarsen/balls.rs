//! All balls of a body: those that are translations of each other are solved once.

use super::ball::{Ball, Beyond, Scratch, Walk, walk};
use super::block::{Block, unit};
use super::coupling::Coupling;
use super::error::CoarsenError;
use super::shapes::Shapes;
use super::signature::{Looks, Signature, grain};
use super::solve::{Effort, adjoint};
use peridyne::spec::LinearBody;
use rayon::prelude::*;
use std::collections::HashMap;

/// A body and which of its points are retained.
pub(super) struct Task<'a, const D: usize> {
    pub body: &'a LinearBody<D>,
    /// Ascending.
    pub retained: &'a [u32],
    /// `[N]`
    pub marked: &'a [bool],
    pub range: f64,
    /// `Soundness::asymmetry` of the body.
    pub asymmetry: f64,
    /// `[N]`: do loads act on this point?
    pub loaded: &'a [bool],
    /// Are shapes of all removed points wanted?
    pub shaped: bool,
}

/// What an elimination makes.
pub(super) struct Eliminated<const D: usize> {
    pub coupling: Coupling<D>,
    pub work: Work,
    /// `[N]` per loaded point: which coarse points its force reaches, ascending, and the part that does; empty for the others.
    pub pass: Vec<Vec<(u32, Block<D>)>>,
    /// If they were wanted, or are there anyway.
    pub shapes: Option<Shapes<D>>,
}

/// What the balls took.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Work {
    /// Balls that were solved; the others are translations of them.
    pub solved: usize,
    /// Of these by LU, because their matrix is not symmetric; the others by conjugate gradients.
    pub direct: usize,
    /// Points of the largest ball.
    pub points: usize,
    /// Products with the stiffness of a ball, over all that were solved; 0 for a direct solution.
    pub products: usize,
    /// Floating-point operations of these.
    pub flops: f64,
    /// Largest deviation of the sum of a row from the row of the body below: 0 but for round-off (row scheme).
    pub row_sum: f64,
}

/// A solved ball, which stands for all of its class.
pub(super) struct Solved<const D: usize> {
    /// The adjoint displacements of its removed points, in the order of the walk.
    pub adjoint: Vec<Block<D>>,
    /// The coarse row, in the order of the rim.
    pub row: Vec<Block<D>>,
}

pub(super) struct Balls<const D: usize> {
    pub solved: Vec<Solved<D>>,
    /// `[retained]`: the ball that stands for it.
    pub class: Vec<usize>,
    pub work: Work,
}

/// Numbers classes in the order of their first members, which stand for them.
pub(super) fn classes(signatures: &[Signature]) -> (Vec<usize>, Vec<usize>) {
    let mut known = HashMap::new();
    let mut first = vec![];
    let class = (0..)
        .zip(signatures)
        .map(|(k, s)| {
            *known.entry(*s).or_insert_with(|| {
                first.push(k);
                first.len() - 1
            })
        })
        .collect();
    (class, first)
}

impl<const D: usize> Task<'_, D> {
    /// One value per retained point, in their order, whatever the threads.
    pub fn each<T: Send>(&self, f: impl Fn(&mut Scratch, usize) -> T + Send + Sync) -> Vec<T> {
        (0..self.retained.len())
            .into_par_iter()
            .map_init(|| Scratch::new(self.body.points()), f)
            .collect()
    }

    /// Points of the ball about the k-th retained point.
    pub fn walk(&self, k: usize, radius: f64, scratch: &mut Scratch) -> Walk<D> {
        let centre = self.retained[k] as usize;
        walk(
            self.body,
            self.marked,
            centre,
            radius,
            grain(self.range),
            scratch,
        )
    }

    /// Where forces go that act on retained points: nowhere else.
    pub fn kept(&self) -> Vec<Vec<(u32, Block<D>)>> {
        let mut pass = vec![vec![]; self.body.points()];
        for (k, &q) in (0..).zip(self.retained) {
            if self.loaded[q as usize] {
                pass[q as usize].push((k, unit()));
            }
        }
        pass
    }

    pub fn balls(&self, radius: f64, beyond: Beyond) -> Result<Balls<D>, CoarsenError> {
        let looks = Looks::new(self.body, self.marked, self.range);
        let signatures = self.each(|scratch, k| looks.of(&self.walk(k, radius, scratch)));
        let (class, first) = classes(&signatures);
        let solved: Vec<Result<_, CoarsenError>> = first
            .par_iter()
            .map_init(
                || Scratch::new(self.body.points()),
                |scratch, &k| {
                    let walk = self.walk(k, radius, scratch);
                    let ball = Ball::new(self.body, &walk, radius, beyond, scratch);
                    let (adjoint, effort) = adjoint(&ball, self.asymmetry)?;
                    let row = ball.coarse_row(&adjoint);
                    let row_sum = match beyond {
                        Beyond::Free => ball.row_sum(&row),
                        Beyond::Held => 0.0,
                    };
                    let points = walk.removed.len() + walk.rim.len();
                    Ok((Solved { adjoint, row }, effort, points, row_sum))
                },
            )
            .collect();
        let mut balls = Balls {
            solved: vec![],
            class,
            work: Work::default(),
        };
        for one in solved {
            let (solved, effort, points, row_sum) = one?;
            balls.work.take(effort, points, row_sum);
            balls.solved.push(solved);
        }
        Ok(balls)
    }
}

impl Work {
    fn take(&mut self, effort: Effort, points: usize, row_sum: f64) {
        self.solved += 1;
        self.direct += usize::from(effort.direct);
        self.points = self.points.max(points);
        self.products += effort.iterations;
        self.flops += effort.flops;
        self.row_sum = self.row_sum.max(row_sum);
    }
}
