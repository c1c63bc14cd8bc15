//! The equilibrium of a system, for those who seek one: what is missing of it, what holds, what loads, and the tangent.

use crate::run::system::System;

/// A system whose equilibrium is sought, and that goes where trials go.
pub(in crate::run) struct Problem<'a, const D: usize> {
    pub(super) system: &'a mut System<D>,
}

impl<'a, const D: usize> Problem<'a, D> {
    pub fn of(system: &'a mut System<D>) -> Self {
        Problem { system }
    }
}
