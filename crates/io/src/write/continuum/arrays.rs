//! `fields.npz`: an array for each quantity by its short name, `points`, and the standard errors of means as `NAME_error`. Of a grid the
//! first indices are those of z, y, x; then come the components, for tensors `[a][b]` with the index of the divergence first.

use super::columns::Table;
use crate::write::atomic::{WriteError, write_file};
use ndarray::{ArrayD, IxDyn};
use ndarray_npy::NpzWriter;
use std::io::{Cursor, Error, Write as _};
use std::path::Path;

/// Writes the whole file or nothing.
///
/// # Errors
/// The operating system's.
pub fn write_arrays(path: &Path, table: &Table) -> Result<(), WriteError> {
    let bytes = archive(table).map_err(WriteError::at("write", path))?;
    write_file(path, |w| w.write_all(&bytes))
}

fn archive(table: &Table) -> Result<Vec<u8>, Error> {
    let mut file = NpzWriter::new(Cursor::new(vec![]));
    let places = match &table.grid {
        Some(([nx, ny, nz], _)) => vec![*nz, *ny, *nx],
        None => vec![table.points.len()],
    };
    let mut add = |name: &str, values: Vec<f64>, components: &[usize]| -> Result<(), Error> {
        let shape = [&places[..], components].concat();
        let array = ArrayD::from_shape_vec(IxDyn(&shape), values)
            .map_err(|e| Error::other(e.to_string()))?;
        file.add_array(name, &array)
            .map_err(|e| Error::other(e.to_string()))
    };
    add(
        "points",
        table.points.iter().flatten().copied().collect(),
        &[3],
    )?;
    for column in &table.columns {
        let components: &[usize] = match column.quantity.components() {
            3 => &[3],
            9 => &[3, 3],
            _ => &[],
        };
        if let Ok(values) = &column.values {
            add(&column.name, values.clone(), components)?;
        }
        if let Some(errors) = &column.errors {
            add(
                &format!("{}_error", column.name),
                errors.clone(),
                components,
            )?;
        }
    }
    let bytes = file.finish().map_err(|e| Error::other(e.to_string()))?;
    Ok(bytes.into_inner())
}
