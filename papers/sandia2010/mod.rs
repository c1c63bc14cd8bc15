//! "Peridynamics as a rigorous coarse-graining of atomistics for multiscale materials design", report of Sandia National Laboratories (2010).
//! Chapter 4, from particle mechanics to continuum mechanics, is cited as lehoucq2010 elsewhere.

mod angles;
mod balance;
mod churning;
#[path = "pair-forces/mod.rs"]
mod pair_forces;
mod particles;

use crate::Experiment;

pub fn all() -> Vec<&'static dyn Experiment> {
    vec![
        &pair_forces::PairForces,
        &angles::Angles,
        &balance::Balance,
        &churning::Churning,
    ]
}
