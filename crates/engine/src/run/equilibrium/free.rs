//! A body left to itself: the equilibrium of its bonds alone. Crystals with surfaces or vacancies are not in it about their lattice.

use super::problem::Problem;
use super::state::StaticState;
use crate::error::{RunError, SolveError};
use crate::fracture::fragments::Fragments;
use crate::spec::{Method, Statics};
use crate::statics::{Solved, Support};

impl<const D: usize> Problem<'_, D> {
    /// Newton's method from the displacements of now, without loads and constraints. Every part is held where that needs no force.
    pub(in crate::run) fn settle_free(&mut self, tolerance: f64) -> Result<Solved, RunError> {
        if self.system.contact.is_some() {
            return Err(self.system.unsolved(SolveError::Contact));
        }
        let forces = std::mem::take(&mut self.system.applied);
        let prescribed = std::mem::take(&mut self.system.prescribed);
        self.system.refresh_images();
        let before = self.system.u.clone();
        let parts = Fragments::of(&self.system.body, self.system.interaction.as_ref()).label;
        let position: Vec<[f64; D]> = self.system.body.by_id(|i| {
            let x = self.system.body.position(i);
            crate::array::from_fn(|a| x[a] + self.system.u[a][i])
        });
        let support = Support::just_enough(&position, &parts, &self.system.body.period());
        let options = Statics {
            method: Method::Newton,
            tolerance,
            ..Statics::default()
        };
        let solved = self.solve_newton(&mut StaticState::new(options), &support);
        if solved.is_err() {
            self.system.u = before;
            self.system.refresh_images();
        }
        (self.system.applied, self.system.prescribed) = (forces, prescribed);
        solved.map_err(|error| self.system.unsolved(error))
    }
}
