//! Probes: what is measured of sets of points over time.

mod contour;
mod crack;
mod measure;
mod rectangle;
mod rigid;
pub(super) mod state;
