//! Probes: what is measured of sets of points over time.

mod crack;
mod j_integral;
mod measure;
mod rectangle;
mod rigid;
pub(super) mod state;
