//! Statics: every step is an increment of load, and ends in equilibrium.

use super::{SplitStep, Stepper};
use crate::body::{Body, Field, view, view_mut, zeros};
use crate::error::{BuildError, RunError};
use crate::interaction::Sweep;
use crate::interaction::friction::Pressed;
use crate::interaction::{cycles_to_failure, first_to_fail};
use crate::message;
use crate::quantity::Dimension;
use crate::run::clock::Clock;
use crate::run::equilibrium::Way;
use crate::run::equilibrium::problem::Problem;
use crate::run::equilibrium::state::StaticState;
use crate::run::system::{Regime, System};
use crate::spec::{Control, Cycles, Method, Spec, Statics};
use crate::state::Archive;
use crate::statics::Solved;

/// What later increments read.
pub(super) struct Increments<const D: usize> {
    state: StaticState<D>,
}

impl<const D: usize> Stepper<D> for Increments<D> {
    fn archive(&mut self, body: &Body<D>, archive: &mut Archive<'_>) {
        self.state.archive(body, archive);
    }

    fn regime(&self) -> Regime {
        let options = self.state.options;
        Regime {
            equilibrium: true,
            linear: options.method == Method::Linear,
            load_may_fall: self.state.load_may_fall(),
            cycles: options.cycles.is_some(),
            ..Regime::default()
        }
    }

    /// The state before any load: displacements as they are, forces of bonds alone.
    fn start(&mut self, system: &mut System<D>, _: bool) {
        // others may be held than before
        self.state.forget();
        system.start_diffusions();
        system.v.iter_mut().for_each(|c| c.fill(0.0));
        system.stressed = None;
        forces_before(system);
        system.learn_strength();
        // energy that came in from outside counts as initial
        system.accounts.initial = Some(system.energy_now().base());
    }

    /// One increment of load: equilibrium at the next time. On an error the state is that of the increment before.
    fn step(&mut self, system: &mut System<D>) -> Result<(), RunError> {
        let (t, dt) = (system.clock.time(), system.clock.dt());
        system.update_toughness(t + dt)?;
        system.spread(t, system.clock.passes(self.state.options.timed))?;
        system.account_work(0.5, 0.0);
        let pressed = system.pressed();
        let options = self.state.options;
        accumulate_fatigue(system, options.cycles);
        let (u, f) = (system.u.clone(), system.f.clone());
        // nothing acts before the first increment
        let first = !system.clock.has_gone_on() && !options.control.follows_a_path();
        let external = match first {
            true => zeros(system.body.len()),
            false => system.external(),
        };
        system.acting_depart(Pressed::Held);
        let clock = system.clock;
        system.clock.forward();
        if options.control == Control::SequentiallyLinear {
            return self.break_next(system, clock, u, f);
        }
        if options.timed {
            system.interaction.last(system.clock.dt());
        }
        let (state, from) = (&mut self.state, [&u, &f, &external]);
        let result = match options.control.follows_a_path() {
            true => Problem::of(system).settle_path(state, from),
            false => Problem::of(system).settle_increment(state, from),
        };
        system.interaction.last(0.0);
        let (solved, way) = match result {
            Ok(found) => found,
            Err(error) => {
                system.clock = clock;
                system.retreat_diffusions();
                (system.u, system.f) = (u, f);
                system.acting_retreat();
                system.refresh_images();
                return Err(system.unsolved(error));
            }
        };
        if first && way.relaxed != 0.0 {
            warn_of_start(system, way.relaxed);
        }
        self.state.solved = solved;
        let Way { work, lost, .. } = way;
        system.accounts.past.dissipated += lost;
        system.accounts.past.conditions += work;
        system.acting_arrive(&u);
        system.heat_by_deformation(pressed);
        system.account_work(0.5, 0.0);
        Ok(())
    }

    fn changed(&mut self, system: &mut System<D>) {
        self.state.forget();
        system.stressed = None;
        forces_before(system);
    }

    /// There are none.
    fn finish(&mut self, _: &mut System<D>) {}

    fn solved(&self) -> Option<Solved> {
        Some(self.state.solved)
    }

    fn accepts(&self, system: &mut System<D>) -> Result<(), BuildError> {
        system.check_statics(self.state.options)?;
        check_control(system, self.state.options.control)
    }

    fn split(&mut self) -> Option<&mut dyn SplitStep<D>> {
        None
    }
}

impl<const D: usize> Increments<D> {
    /// What a spec asks for, of a system on which all acts that will; one that makes no step may be in no equilibrium.
    ///
    /// # Errors
    /// Nothing brings it into equilibrium.
    pub fn of(options: Statics, spec: &Spec, system: &mut System<D>) -> Result<Self, BuildError> {
        if spec.run.schedule.steps > 0 {
            system.check_statics(options)?;
            check_control(system, options.control)?;
        }
        Ok(Increments::new(options))
    }

    pub fn new(options: Statics) -> Self {
        Increments {
            state: StaticState::new(options),
        }
    }

    /// An increment that ends where the next bonds break.
    fn break_next(
        &mut self,
        system: &mut System<D>,
        clock: Clock,
        u: Field<D>,
        f: Field<D>,
    ) -> Result<(), RunError> {
        match Problem::of(system).settle_sequence(&mut self.state) {
            Ok(solved) => {
                self.state.solved = solved;
                Ok(())
            }
            Err(error) => {
                (system.clock, system.u, system.f) = (clock, u, f);
                system.refresh_images();
                Err(system.unsolved(error))
            }
        }
    }
}

/// Can the load be led so?
fn check_control<const D: usize>(
    system: &mut System<D>,
    control: Control,
) -> Result<(), BuildError> {
    match control {
        Control::Load => Ok(()),
        Control::SequentiallyLinear => system.check_sequence(),
        Control::IndirectDisplacement(_) | Control::ArcLength(_) => system.check_path(),
    }
}

/// Forces from which the next increment sets out; before the first one nothing acts but bonds.
fn forces_before<const D: usize>(system: &mut System<D>) {
    system.refresh_images();
    if system.left_linearly() {
        system.linear_forces();
    } else {
        let (body, u) = (&system.body, &system.u);
        system
            .interaction
            .forces(body, view(u), view_mut(&mut system.f), Sweep::Hold, None);
    }
    if system.clock.has_gone_on() {
        system.other_forces(system.clock.trial());
    }
}

/// Cycles of the load that holds the body where it is; bonds that are worn out break at the first look for the next equilibrium.
fn accumulate_fatigue<const D: usize>(system: &mut System<D>, cycles: Option<Cycles>) {
    let Some(cycles) = cycles.filter(|_| system.clock.has_gone_on()) else {
        return;
    };
    system.refresh_images();
    let (body, u) = (&system.body, view(&system.u));
    let bonds = system.interaction.fatigue_of_bonds(body, u, &cycles);
    if !body.exchange().any(bonds.is_some()) {
        return;
    }
    let bonds = bonds.unwrap_or_default();
    let left = (cycles.most - system.accounts.cycles).max(0.0);
    let first = first_to_fail(&bonds, &cycles);
    let first = system.body.all_of(&first).concat();
    let passed = cycles_to_failure(first, &cycles, left);
    system
        .interaction
        .accumulate_fatigue(&mut bonds.into_iter(), passed);
    system.accounts.cycles += passed;
}

/// The start of the run was no equilibrium.
fn warn_of_start<const D: usize>(system: &mut System<D>, lost: f64) {
    system.info.warnings.push(message![
        "the body is not in equilibrium at the start: on its way there it sets ",
        Dimension::ENERGY.of(lost),
        " free, which counts as dissipated; begin from where nothing pulls (values of heat and species at their reference), or let motion follow",
    ]);
}
