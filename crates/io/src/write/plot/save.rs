//! A drawing as a picture of pixels and of lines.

use super::canvas::Drawing;
use crate::write::atomic::{WriteError, create_directory, write_file};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Pixels of the PNG per unit of the drawing.
pub(super) const SCALE: f64 = 2.0;

/// Writes `name.png` and `name.svg`, each all or nothing.
pub(super) fn save(
    dir: &Path,
    name: &str,
    drawing: io::Result<Drawing>,
) -> Result<[PathBuf; 2], WriteError> {
    create_directory(dir)?;
    let paths = ["png", "svg"].map(|e| dir.join(format!("{name}.{e}")));
    let drawing = drawing.map_err(WriteError::at("draw", &paths[0]))?;
    write_file(&paths[0], |w| {
        super::raster::draw(&drawing, SCALE).write_png(w)
    })?;
    write_file(&paths[1], |w| {
        let text = super::svg::draw(&drawing)?;
        w.write_all(text.as_bytes())
    })?;
    Ok(paths)
}

/// `name (unit)`.
pub(super) fn titled(name: &str, unit: &str) -> String {
    match unit {
        "" => name.to_string(),
        unit => format!("{name} ({unit})"),
    }
}
