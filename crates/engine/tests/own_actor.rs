//! The force of a user that remembers, `examples/own-actor`, is compiled here as it stands and run.

#[path = "../../../examples/own-actor/src/main.rs"]
mod own_actor;

use peridyne::run::Simulation;
use peridyne::spec::{Method, Newmark, Statics, Stepper};
use peridyne::state::Archive;

#[test]
fn a_force_from_outside_remembers_and_has_a_tangent() {
    own_actor::main();
}

/// Without equations, too: masses know what the foundation holds with.
#[test]
fn every_method_that_goes_beyond_the_reference_finds_it() {
    for (method, tolerance) in [(Method::Relaxation, 1e-9), (Method::Fire, 1e-9)] {
        let statics = Statics {
            method,
            tolerance,
            ..Statics::default()
        };
        let mut sim = own_actor::pulled(Stepper::Statics(statics), 40, 1.0);
        let left = sim.displacements()[35][0];
        assert!((left - 0.00986326).abs() < 1e-6, "{method:?}: {left}");
    }
}

/// What it remembers is in the state of a model: one that was never started goes on from there, bit for bit.
#[test]
fn a_model_goes_on_with_what_its_forces_remember() {
    let newton = Statics {
        method: Method::Newton,
        ..Statics::default()
    };
    for (stepper, steps, end) in [
        (Stepper::Verlet, 20_000, 4_000.0),
        (Stepper::Newmark(Newmark::default()), 400, 4_000.0),
        (Stepper::Statics(newton), 40, 1.0),
    ] {
        let go = |sim: &mut Box<dyn Simulation>, steps: u64| {
            (0..steps).for_each(|_| sim.step().unwrap());
        };
        let mut whole = own_actor::bar(stepper, steps, end);
        whole.start(true);
        // slipped, and on its way back
        go(&mut whole, 3 * steps / 4);
        let mut state = vec![];
        let mut archive = Archive::save(&mut state);
        archive.part("model", whole.as_mut());
        archive.done().unwrap();
        let mut again = own_actor::bar(stepper, steps, end);
        let mut from = state.as_slice();
        let mut archive = Archive::load(&mut from);
        archive.part("model", again.as_mut());
        archive.done().unwrap();
        for sim in [&mut whole, &mut again] {
            go(sim, steps / 4);
        }
        assert_eq!(whole.state_hash(), again.state_hash(), "{stepper:?}");
        assert!(whole.displacements()[35][0] > 1e-3);
    }
}
