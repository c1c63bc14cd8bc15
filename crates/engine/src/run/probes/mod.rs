//! Probes: what is measured of sets of points over time.

mod contour;
mod measure;
mod rectangle;
mod rigid;
pub(super) mod state;
