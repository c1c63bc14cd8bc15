//! The batteries: what every material must do on every lattice and in every dimension, through the public interface.
//!
//! A line in [`sample::materials`] buys a material all of these tests.

mod accounts;
mod bond_rotation;
mod calibration;
mod constants;
mod cracks;
mod criteria;
mod equivalence;
mod healing;
mod lamina;
mod mechanics;
mod memory;
mod motion;
/// The law of a user, who has no other way in than this crate's face.
#[allow(dead_code)]
#[path = "../../../../examples/own-law/src/main.rs"]
mod own_law;
mod ranks;
mod repeat;
mod sample;
mod scale;
mod shifted;
mod stability;
mod state_hash;
mod tangents;
mod tearing;
mod typed;
mod waves;

#[path = "../allocations/mod.rs"]
mod allocations;
/// Potentials and crystals.
#[allow(dead_code)]
#[path = "../atoms/sample.rs"]
mod atoms;

use allocations::allocations;

/// As its user would run it.
#[test]
fn a_law_from_outside_runs() {
    own_law::main();
}
