//! The field's classics: closed forms, handbooks, experiments.

pub mod bench;

#[path = "bar-interface/mod.rs"]
mod bar_interface;
#[path = "bar-wave/mod.rs"]
mod bar_wave;
mod bimetal;
mod branching;
#[path = "brazilian-disk/mod.rs"]
mod brazilian_disk;
mod cantilever;
#[path = "compact-tension/mod.rs"]
mod compact_tension;
mod creep;
#[path = "double-cantilever/mod.rs"]
mod double_cantilever;
mod fatigue;
#[path = "fibre-composite/mod.rs"]
mod fibre_composite;
#[path = "fragmenting-cylinder/mod.rs"]
mod fragmenting_cylinder;
mod hertz;
mod kalthoff;
mod neck;
#[path = "plate-with-hole/mod.rs"]
mod plate_with_hole;
mod quench;
#[path = "shear-band/mod.rs"]
mod shear_band;
#[path = "shock-tube/mod.rs"]
mod shock_tube;
mod spall;
#[path = "sphere-on-plate/mod.rs"]
pub mod sphere_on_plate;
#[path = "taylor-bar/mod.rs"]
mod taylor_bar;
#[path = "thin-film/mod.rs"]
mod thin_film;
#[path = "three-point-bend/mod.rs"]
mod three_point_bend;
#[path = "touching-bars/mod.rs"]
mod touching_bars;
#[path = "vibrating-plate/mod.rs"]
mod vibrating_plate;

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
        &three_point_bend::ThreePointBend,
        &double_cantilever::DoubleCantilever,
        &vibrating_plate::VibratingPlate,
        &hertz::Hertz,
        &fibre_composite::FibreComposite,
        &thin_film::ThinFilm,
        &sphere_on_plate::SphereOnPlate,
        &fragmenting_cylinder::FragmentingCylinder,
        &taylor_bar::TaylorBar,
        &creep::Creep,
        &touching_bars::TouchingBars,
        &bimetal::Bimetal,
        &quench::Quench,
        &fatigue::Fatigue,
        &shock_tube::ShockTube,
        &neck::Neck,
        &shear_band::ShearBand,
    ]
}
