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
mod svg;

pub use lines::{Mark, Plot, Stroke};
pub use map::{ColorMap, Map};

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::atomic::{WriteError, create_directory, write_file};
use super::fields::invalid;
use canvas::Drawing;

/// Pixels of the PNG per unit of the drawing.
const SCALE: f64 = 2.0;

/// Writes `name.png` and `name.svg`, each all or nothing.
fn save(dir: &Path, name: &str, drawing: io::Result<Drawing>) -> Result<[PathBuf; 2], WriteError> {
    create_directory(dir)?;
    let paths = ["png", "svg"].map(|e| dir.join(format!("{name}.{e}")));
    let drawing = drawing.map_err(WriteError::at("draw", &paths[0]))?;
    write_file(&paths[0], |w| raster::draw(&drawing, SCALE).write_png(w))?;
    write_file(&paths[1], |w| {
        let text = svg::draw(&drawing)?;
        w.write_all(text.as_bytes())
    })?;
    Ok(paths)
}

/// `name (unit)`.
fn titled(name: &str, unit: &str) -> String {
    match unit {
        "" => name.to_string(),
        unit => format!("{name} ({unit})"),
    }
}

#[cfg(test)]
mod tests;
