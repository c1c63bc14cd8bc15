//! The law of a user, `examples/own-law`, is compiled here as it stands and run.

#[path = "../../../examples/own-law/src/main.rs"]
mod own_law;

#[test]
fn a_law_from_outside_runs() {
    own_law::main();
}
