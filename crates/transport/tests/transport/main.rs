//! What the laws must show: sandia2010, chapter 2, and its errata.

mod conservation;
mod convergence;
mod errors;
mod expressions;
mod input;
mod operators;
mod plane;
mod reference;
mod sample;
mod steps;
mod threads;
mod waves;
