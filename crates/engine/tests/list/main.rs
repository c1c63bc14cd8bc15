//! Horizon lists: the same mechanics as stencils on lattices, the textbook's formulas on random clouds, the same bits
//! in every width and on any number of threads, little memory and no allocation.

mod bits;
mod case;
mod cloud;
mod dual_horizon;
mod repeat;
mod stencil;

#[path = "../allocations/mod.rs"]
mod allocations;

use allocations::allocations;
