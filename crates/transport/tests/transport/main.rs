//! What the laws must show: sandia2010, chapter 2, and its errata.

mod conservation;
mod convergence;
mod input;
mod operators;
mod sample;
mod steps;
mod waves;
