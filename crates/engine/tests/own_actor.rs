//! The force of a user that remembers, `examples/own-actor`, is compiled here as it stands and run.

#[path = "../../../examples/own-actor/src/main.rs"]
mod own_actor;

use peridyne::spec::{Method, Statics, Stepper};

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
