//! "Peridynamics as a rigorous coarse-graining of atomistics for multiscale materials design", report of Sandia National Laboratories (2010).
//! Chapter 2, nonlocal advection, has formulas and open questions: studies answer them. Chapter 3 has an example of peridynamics in LAMMPS. Chapter 4, from particle mechanics to continuum mechanics, is
//! cited as lehoucq2010 elsewhere.

#[path = "algorithm-7/mod.rs"]
mod algorithm_7;
#[path = "algorithm-7-lps/mod.rs"]
mod algorithm_7_lps;
mod angles;
mod balance;
mod characteristics;
mod churning;
mod convergence;
mod dispersion;
#[path = "figure-3-1/mod.rs"]
mod figure_3_1;
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
        &characteristics::Characteristics,
        &shocks::Shocks,
        &figure_3_1::Figure31,
        &algorithm_7::Algorithm7,
        &algorithm_7_lps::Algorithm7Lps,
        &pair_forces::PairForces,
        &angles::Angles,
        &balance::Balance,
        &churning::Churning,
    ]
}
