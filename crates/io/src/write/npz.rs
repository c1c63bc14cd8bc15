//! Arrays by name as a NumPy archive.

use super::atomic::{WriteError, write_file};
use ndarray::{ArrayViewD, IxDyn};
use ndarray_npy::NpzWriter;
use std::io::{Cursor, Error, Write as _};
use std::path::Path;

/// A name, numbers (the last index runs fastest), and the shape.
pub type Array<'a> = (&'a str, &'a [f64], Vec<usize>);

/// Writes the whole file or nothing.
///
/// # Errors
/// The operating system's; `Other` for numbers that do not fill their shape.
pub fn write_npz(path: &Path, arrays: &[Array]) -> Result<(), WriteError> {
    let bytes = archive(arrays).map_err(WriteError::at("write", path))?;
    write_file(path, |w| w.write_all(&bytes))
}

fn archive(arrays: &[Array]) -> Result<Vec<u8>, Error> {
    let mut file = NpzWriter::new_compressed(Cursor::new(vec![]));
    for (name, values, shape) in arrays {
        let array = ArrayViewD::from_shape(IxDyn(shape), values).map_err(Error::other)?;
        file.add_array(*name, &array).map_err(Error::other)?;
    }
    Ok(file.finish().map_err(Error::other)?.into_inner())
}
