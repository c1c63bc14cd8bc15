//! Interatomic potentials and linear springs: force = −∂energy, exchange of energy, closed forms, equivalences.

mod chain;
mod crystal;
mod kinds;
mod many_body;
mod relax;
mod sample;
mod scaled;
mod tangents;
