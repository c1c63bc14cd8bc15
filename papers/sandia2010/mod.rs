//! "Peridynamics as a rigorous coarse-graining of atomistics for multiscale materials design", report of Sandia National Laboratories (2010).
//! Chapter 2, nonlocal advection, has formulas and open questions: studies answer them. Chapter 4, from particle mechanics to continuum mechanics, is
//! cited as lehoucq2010 elsewhere.

mod angles;
mod balance;
mod churning;
mod convergence;
mod dispersion;
mod laws;
#[path = "pair-forces/mod.rs"]
mod pair_forces;
mod particles;
mod shocks;

use crate::Experiment;

pub fn all() -> Vec<&'static dyn Experiment> {
    vec![
        &dispersion::Dispersion,
        &convergence::Convergence,
        &shocks::Shocks,
        &pair_forces::PairForces,
        &angles::Angles,
        &balance::Balance,
        &churning::Churning,
    ]
}
