//! What is seen of a run: observables against closed forms, probes against the laws of mechanics.

mod columns;
mod crack;
mod fields;
mod j_integral;
mod probes;
mod sample;
