//! Model to model: what a model of points is as a continuum.
//!
//! | question | module |
//! |---|---|
//! | what is a lattice with a law about its reference state? | [`crystal`] |
//! | which waves does it carry, how fast? | [`dispersion`] |
//! | which time step is stable? | [`stability`] |
//! | how stiff is it? | [`elastic_constants`] of a crystal, [`patch_test`] of a finite body, both as tensors of [`voigt`]; [`nominal`]: the moduli that its law names |
//! | which differential equation is it? | [`gradient`], exactly by [`exact`] |
//! | what is the coarse model with the same dynamics, and how far does it agree? | [`upscale`] |
//! | is one model an upscaling of another, to which order? | [`gradient::comparison`] |
//! | which body of fewer points has the same mechanics? | [`coarsen`] |
//! | waves, stability, constants and gradients of one lattice, for a report | [`lattice_dynamics`] |
//! | which factors of bonds make a body as stiff at its ends as inside? | [`homogenize`] |
//! | with which parameters does a model come nearest to data? | [`fit`] |
//! | with which order do errors fall? | [`convergence`] of the levels of [`refine`] |

// the same bits on every machine: libm, not that of C (clippy.toml)
#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod coarsen;
pub mod convergence;
pub mod crystal;
pub mod dispersion;
pub mod elastic_constants;
pub mod exact;
pub mod fit;
pub mod fracture;
pub mod gradient;
pub mod homogenize;
pub mod lattice_dynamics;
pub mod moments;
pub mod nominal;
pub mod patch_test;
pub mod refine;
pub mod stability;
pub mod upscale;
pub mod voigt;
