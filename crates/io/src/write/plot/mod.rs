//! Plots as PNG and SVG: lines and points over axes, and images of two-dimensional arrays with a colour bar.
//!
//! Files: `axis` puts numbers on an axis, `frame` draws the axes, `lines` and `map` what is in them, `canvas` is what they draw on, `raster` and
//! `svg` are its two outputs, `font` is the text of the PNG.
//!
//! ```
//! # use peridyne_io::write::plot::Plot;
//! let (x, y) = ([0.0, 1.0, 2.0], [0.0, 1.0, 4.0]);
//! let plot = Plot::new("A square").x("position", "m").y("area", "m²").line("x²", &x, &y);
//! # let dir = tempfile::tempdir().unwrap();
//! plot.save(dir.path(), "square").unwrap();   // square.png and square.svg
//! ```

mod axis;
mod canvas;
mod frame;
mod lines;
mod map;
mod raster;
mod save;
mod svg;
#[cfg(test)]
mod tests;

use super::atomic::WriteError;
use super::fields::invalid;
pub use lines::{Mark, Plot, Stroke};
pub use map::{ColorMap, Map};
