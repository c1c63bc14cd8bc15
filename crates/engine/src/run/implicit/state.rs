//! What the implicit stepper keeps between steps.

use crate::body::Body;
use crate::condition::rigid::Wrench;
use crate::run::equilibrium::state::StaticState;
use crate::spec::{Control, Method, Newmark, Statics};
use crate::state::Archive;
use crate::statics::Support;

/// Factors that may serve again, and for whom.
pub(in crate::run) struct Implicit<const D: usize> {
    pub options: Newmark,
    pub equations: StaticState<D>,
    /// What was held when the factors were made.
    pub held: Support<D>,
    /// `[N]` accelerations at the end of the last step; empty: those of the forces.
    pub acceleration: Vec<[f64; D]>,
    /// `(m a, dL/dt)` of rigid bodies with mass at the end of the last step; empty: what acts on them.
    pub bodies: Vec<Wrench>,
    /// Can bonds break?
    pub breaks: bool,
}

impl<const D: usize> Implicit<D> {
    pub fn archive(&mut self, body: &Body<D>, archive: &mut Archive<'_>) {
        archive.list("acceleration", &mut self.acceleration);
        archive.list("rigid_bodies", &mut self.bodies);
        archive.list("free", &mut self.held.free);
        self.equations
            .archive_kept(body.period, &self.held, archive);
    }

    pub fn new(options: Newmark) -> Self {
        let equations = StaticState::new(Statics {
            method: Method::Newton,
            control: Control::Load,
            solver: options.solver,
            tolerance: options.tolerance,
            timed: true,
            cycles: None,
            most_iterations: options.most_iterations,
        });
        Implicit {
            options,
            equations,
            held: Support::none(0),
            acceleration: vec![],
            bodies: vec![],
            breaks: false,
        }
    }
}
