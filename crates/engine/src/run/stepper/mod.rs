//! What moves a system from step to step: a stepper is a file here, its line in [`stepper`], and its variant of the schedule.

mod increments;
mod newmark;
mod rest;
mod verlet;

use self::increments::Increments;
use self::newmark::NewmarkStepper;
use self::rest::Rest;
use self::verlet::VelocityVerlet;
use super::system::{Regime, System};
use super::time_step::Limits;
use crate::body::Body;
use crate::error::{BuildError, RunError};
use crate::execute::simd::Simd;
use crate::spec::{Spec, Statics, Stepper as Kind};
use crate::state::Archive;
use crate::statics::Solved;

/// Who moves a system, and keeps what it needs for that between steps.
pub(super) trait Stepper<const D: usize>: Send {
    /// Passes what it keeps of the points of a body through an archive, as an [`Owner`](crate::state::Owner) does.
    fn archive(&mut self, body: &Body<D>, archive: &mut Archive<'_>);
    /// What states mean that it leads through.
    fn regime(&self) -> Regime;
    /// First forces and accounts of a run; without bonds: for a body whose bonds are still to be cut.
    fn start(&mut self, system: &mut System<D>, bonds: bool);
    /// One step.
    ///
    /// # Errors
    /// There is no such step; the state is that of the step before (up to round-off).
    fn step(&mut self, system: &mut System<D>) -> Result<(), RunError>;
    /// Columns were written from outside: the next step begins with the forces of what they say now.
    fn changed(&mut self, system: &mut System<D>);
    /// Brings velocities to the whole step.
    fn finish(&mut self, system: &mut System<D>);
    /// What a solver did in the last step; `None`: none is asked.
    fn solved(&self) -> Option<Solved>;
    /// Can it move this system, on which more acts than it was made for?
    ///
    /// # Errors
    /// Why it cannot.
    fn accepts(&self, system: &mut System<D>) -> Result<(), BuildError>;
    /// Halves of a step, between which somebody may act; `None`: it has none.
    fn split(&mut self) -> Option<&mut dyn SplitStep<D>>;
}

/// A step in halves.
pub(super) trait SplitStep<const D: usize> {
    /// Displacements of its end, velocities of its middle. Answers a bound on the path of any point (length).
    ///
    /// # Errors
    /// As for [`Stepper::step`].
    fn depart(&mut self, system: &mut System<D>) -> Result<f64, RunError>;
    /// Forces at its end.
    ///
    /// # Errors
    /// As for [`Stepper::step`].
    fn arrive(&mut self, system: &mut System<D>) -> Result<(), RunError>;
    /// Instead of arriving: back to the step before, to rounding.
    fn turn_back(&mut self, system: &mut System<D>);
}

/// The stepper that a spec asks for, of a system on which all acts that will, and whose steps are `dt` long (time).
///
/// # Errors
/// It cannot move this system.
pub(super) fn stepper<const D: usize>(
    spec: &Spec,
    simd: Simd,
    system: &mut System<D>,
    (limits, dt): (&Limits, f64),
) -> Result<Box<dyn Stepper<D>>, BuildError> {
    Ok(match spec.run.schedule.stepper {
        Kind::Verlet => Box::new(VelocityVerlet::new(spec, simd, system, limits, dt)),
        Kind::Still => Box::new(Rest),
        Kind::Newmark(options) => Box::new(NewmarkStepper::of(options, spec, system, limits, dt)?),
        Kind::Statics(options) => Box::new(Increments::of(options, spec, system)?),
    })
}

/// Increments of the statics before a motion, whose conditions act on the system.
///
/// # Errors
/// They do not bring it into equilibrium.
pub(super) fn before_motion<const D: usize>(
    options: Statics,
    system: &System<D>,
) -> Result<Box<dyn Stepper<D>>, BuildError> {
    system.check_statics(options)?;
    Ok(Box::new(Increments::new(options)))
}
