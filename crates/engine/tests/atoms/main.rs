//! Interatomic potentials and linear springs: force = −∂energy, exchange of energy, closed forms, equivalences.

mod chain;
mod crystal;
mod fans;
mod kinds;
mod relax;
mod sample;
mod scaled;
mod tangents;
