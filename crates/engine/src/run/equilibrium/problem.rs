//! The equilibrium of a system, for those who seek one: what is missing of it, what holds, what loads, and the tangent.
//!
//! Of a body that ranks share each rank has the numbers of its own points, in order of ids, and decides by sums over all of them. A matrix, and who holds
//! together with whom, is on the first rank, which tells the others what follows.

use super::whole::{part_of_vectors, told, whole_support, whole_vectors};
use crate::error::SolveError;
use crate::run::system::System;
use crate::statics::{Solved, Sums, Support};

/// A system whose equilibrium is sought, and that goes where trials go.
pub(in crate::run) struct Problem<'a, const D: usize> {
    pub(super) system: &'a mut System<D>,
    /// Over its points.
    pub(super) sums: Sums,
}

impl<'a, const D: usize> Problem<'a, D> {
    pub fn of(system: &'a mut System<D>) -> Self {
        let sums = Sums::of(&system.body, system.body.slots());
        Problem { system, sums }
    }

    /// Solves equations of all points on the first rank, which has their matrix: with what holds them, their right side, and where they are.
    pub(super) fn solve_whole(
        &self,
        (support, b): (&Support<D>, &[[f64; D]]),
        x: &mut [[f64; D]],
        solve: impl FnOnce(&Support<D>, &[[f64; D]], &mut [[f64; D]]) -> Result<Solved, SolveError>,
    ) -> Result<Solved, SolveError> {
        let body = &self.system.body;
        if body.subdomain().is_none() {
            return solve(support, b, x);
        }
        let support = whole_support(body, support);
        let [b, start] = [b, x].map(|own| whole_vectors(body, own));
        let all = support.zip(b).zip(start);
        let found = all.map(|((support, b), mut x)| {
            let found = solve(&support, &b, &mut x);
            found.map(|solved| (solved, x))
        });
        let found = told(body, found.transpose())?;
        let (solved, whole) = found.unzip();
        let solved = body.told(solved.map(|s| [s.iterations as f64, s.residual]));
        x.copy_from_slice(&part_of_vectors(body, whole));
        Ok(Solved {
            iterations: solved[0] as usize,
            residual: solved[1],
        })
    }
}
