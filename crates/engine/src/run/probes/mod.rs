//! Probes: what is measured of sets of points over time.

mod contour;
mod measure;
mod rectangle;
pub(super) mod state;
