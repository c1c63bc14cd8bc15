//! The force of a user that remembers, `examples/own-actor`, is compiled here as it stands and run.

#[path = "../../../examples/own-actor/src/main.rs"]
mod own_actor;

#[test]
fn a_force_from_outside_remembers_and_has_a_tangent() {
    own_actor::main();
}
