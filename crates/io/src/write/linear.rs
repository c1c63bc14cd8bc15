//! A linear body as a NumPy archive (`.npz`): `position [N][D]`, `volume [N]`, `density [N]`, `period [D]` (not a number: free),
//! and the micromoduli as a block-sparse matrix, `start [N + 1]`, `partner [bonds]`, `block [bonds][D][D]` (force density / length,
//! `L_i = Σ_j C_ij (u_j − u_i)`). `scipy.sparse.bsr_matrix((block, partner, start))` is the matrix without its diagonal.

use super::atomic::{WriteError, write_file};
use ndarray::{Array1, Array2, Array3};
use ndarray_npy::NpzWriter;
use peridyne::statics::LinearBody;
use std::io::{Cursor, Error, Write as _};
use std::path::Path;

/// Writes the whole file or nothing.
///
/// # Errors
/// The file cannot be written.
pub fn write_linear<const D: usize>(path: &Path, body: &LinearBody<D>) -> Result<(), WriteError> {
    let bytes = archive(body).map_err(WriteError::at("write", path))?;
    write_file(path, |w| w.write_all(&bytes))
}

fn archive<const D: usize>(body: &LinearBody<D>) -> Result<Vec<u8>, Error> {
    let bad = |e: ndarray_npy::WriteNpzError| Error::other(e.to_string());
    let shape = |e: ndarray::ShapeError| Error::other(e.to_string());
    let (n, bonds) = (body.points(), body.partner.len());
    let mut file = NpzWriter::new(Cursor::new(vec![]));
    let position = body.position.iter().flatten().copied().collect();
    let position = Array2::from_shape_vec((n, D), position).map_err(shape)?;
    file.add_array("position", &position).map_err(bad)?;
    let column = |x: &[f64]| Array1::from_vec(x.to_vec());
    file.add_array("volume", &column(&body.volume))
        .map_err(bad)?;
    file.add_array("density", &column(&body.density))
        .map_err(bad)?;
    let period: Vec<f64> = body.period.iter().map(|p| p.unwrap_or(f64::NAN)).collect();
    file.add_array("period", &column(&period)).map_err(bad)?;
    let start: Vec<i64> = body.start.iter().map(|s| *s as i64).collect();
    file.add_array("start", &Array1::from_vec(start))
        .map_err(bad)?;
    let partner: Vec<i32> = body.partner.iter().map(|p| *p as i32).collect();
    file.add_array("partner", &Array1::from_vec(partner))
        .map_err(bad)?;
    let block = body.block.iter().flatten().flatten().copied().collect();
    let block = Array3::from_shape_vec((bonds, D, D), block).map_err(shape)?;
    file.add_array("block", &block).map_err(bad)?;
    Ok(file.finish().map_err(bad)?.into_inner())
}
