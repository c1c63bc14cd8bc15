//! What is seen of a run: observables against closed forms, probes against the laws of mechanics.

mod columns;
mod contour;
mod crack;
mod fields;
mod probes;
mod sample;
