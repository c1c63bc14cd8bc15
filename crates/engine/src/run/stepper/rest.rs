//! Points stand where they are; what spreads through bonds goes on.

use super::{SplitStep, Stepper};
use crate::body::Body;
use crate::error::{BuildError, RunError};
use crate::run::system::{Regime, System};
use crate::state::Archive;
use crate::statics::Solved;

/// Keeps nothing.
pub(super) struct Rest;

impl<const D: usize> Stepper<D> for Rest {
    fn archive(&mut self, _: &Body<D>, _: &mut Archive<'_>) {}

    fn regime(&self) -> Regime {
        Regime::default()
    }

    fn start(&mut self, system: &mut System<D>, bonds: bool) {
        system.begin(bonds);
    }

    fn step(&mut self, system: &mut System<D>) -> Result<(), RunError> {
        system.spread(system.clock.time(), system.clock.dt())?;
        system.clock.forward();
        Ok(())
    }

    /// No step asks for forces.
    fn changed(&mut self, _: &mut System<D>) {}

    /// They are those of whole steps.
    fn finish(&mut self, _: &mut System<D>) {}

    fn solved(&self) -> Option<Solved> {
        None
    }

    fn accepts(&self, _: &mut System<D>) -> Result<(), BuildError> {
        Err(BuildError::unsupported(
            "",
            "points stand still in these steps: nothing moves or pushes them",
        )
        .help("take [run] with integrator = \"verlet\" or \"newmark\""))
    }

    fn split(&mut self) -> Option<&mut dyn SplitStep<D>> {
        None
    }
}
