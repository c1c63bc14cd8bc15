//! What fields from particles must show: (lehoucq2010, chapter 4), on potentials of pairs, embedded atoms, triplets, torsion, and of
//! any number of particles.

mod balance;
mod churning;
mod duals;
mod effort;
mod force_states;
mod pair_forces;
mod places;
mod sample;
mod sums;
