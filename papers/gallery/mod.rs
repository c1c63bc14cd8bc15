//! The field's classics: closed forms, handbooks, experiments.

mod bench;

#[path = "bar-interface/mod.rs"]
mod bar_interface;
#[path = "bar-wave/mod.rs"]
mod bar_wave;
mod branching;
#[path = "brazilian-disk/mod.rs"]
mod brazilian_disk;
mod cantilever;
#[path = "compact-tension/mod.rs"]
mod compact_tension;
mod kalthoff;
#[path = "plate-with-hole/mod.rs"]
mod plate_with_hole;
mod spall;

use crate::Experiment;

pub fn all() -> Vec<&'static dyn Experiment> {
    vec![
        &plate_with_hole::PlateWithHole,
        &brazilian_disk::BrazilianDisk,
        &cantilever::Cantilever,
        &bar_wave::BarWave,
        &bar_interface::BarInterface,
        &spall::Spall,
        &compact_tension::CompactTension,
        &branching::Branching,
        &kalthoff::Kalthoff,
    ]
}
