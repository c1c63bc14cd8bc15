//! A body left to itself: the equilibrium of its bonds alone. Crystals with surfaces or vacancies are not in it about their lattice.

use super::equilibrium::state::StaticState;
use super::model::Model;
use crate::error::{RunError, SolveError};
use crate::fracture::fragments::Fragments;
use crate::spec::{Method, Statics};
use crate::statics::{Solved, Support};

impl<const D: usize> Model<D> {
    /// Newton's method from the displacements of now, without loads and constraints. Every part is held where that needs no force.
    pub(super) fn settle_free(&mut self, tolerance: f64) -> Result<Solved, RunError> {
        if self.contact.is_some() {
            return Err(self.unsolved(SolveError::Contact));
        }
        let forces = std::mem::take(&mut self.applied);
        let prescribed = std::mem::take(&mut self.prescribed);
        self.refresh_images();
        let before = self.u.clone();
        let parts = Fragments::of(&self.body, self.interaction.as_ref()).label;
        let position: Vec<[f64; D]> = self.by_id(|i| {
            let x = self.body.position(i);
            std::array::from_fn(|a| x[a] + self.u[a][i])
        });
        let support = Support::just_enough(&position, &parts, &self.body.period);
        let options = Statics {
            method: Method::Newton,
            tolerance,
            ..Statics::default()
        };
        let solved = self.solve_newton(&mut StaticState::new(options), &support);
        if solved.is_err() {
            self.u = before;
            self.refresh_images();
        }
        (self.applied, self.prescribed) = (forces, prescribed);
        solved.map_err(|error| self.unsolved(error))
    }
}
