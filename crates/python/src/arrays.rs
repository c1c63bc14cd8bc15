//! Numbers as arrays of NumPy. A column is gathered in the order of ids once; the array then owns what was gathered.

use crate::error::expected;
use numpy::{PyArray, PyArrayMethods, PyReadonlyArrayDyn};
use peridyne::observe::Values;
use peridyne::space::Point;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// `[N]` of scalars, `[N, k]` of vectors (3), symmetric tensors (6: xx yy zz xy xz yz) and tensors (9, row by row).
pub fn of_values(py: Python<'_>, values: Values) -> PyResult<Bound<'_, PyAny>> {
    fn rows<'py, const K: usize>(
        py: Python<'py>,
        rows: Vec<[f64; K]>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let count = rows.len();
        let flat = PyArray::from_vec(py, rows.into_flattened());
        Ok(flat.reshape([count, K])?.into_any())
    }
    Ok(match values {
        Values::Scalars(v) => PyArray::from_vec(py, v).into_any(),
        Values::Vectors(v) => rows(py, v)?,
        Values::Symmetric(v) => rows(py, v)?,
        Values::Tensors(v) => rows(py, v)?,
        Values::Integers(v) => PyArray::from_vec(py, v).into_any(),
        Values::Counts(v) => PyArray::from_vec(py, v).into_any(),
    })
}

/// Numbers of an array, or of nested lists, row by row, with the lengths of its axes.
pub fn numbers(given: &Bound<'_, PyAny>) -> PyResult<(Vec<f64>, Vec<usize>)> {
    let numpy = given.py().import("numpy")?;
    let array = numpy
        .call_method1("asarray", (given, numpy.getattr("float64")?))
        .map_err(|_| expected(format!("expected numbers, got {}", kind(given))))?;
    let array: PyReadonlyArrayDyn<'_, f64> = array.extract()?;
    let array = array.as_array();
    Ok((array.iter().copied().collect(), array.shape().to_vec()))
}

/// Vectors `[N, 3]`, `[N, d]` or, of all points alike, `[3]` or `[d]`.
pub fn vectors(given: &Bound<'_, PyAny>, count: usize, d: usize) -> PyResult<Vec<Point>> {
    let (all, shape) = numbers(given)?;
    let width = shape.last().copied().unwrap_or(0);
    let fits = (width == d || width == 3)
        && match shape[..] {
            [_] => true,
            [n, _] => n == count,
            _ => false,
        };
    if !fits {
        let shapes = match d {
            3 => format!("({count}, 3) or (3,)"),
            d => format!("({count}, {d}), ({count}, 3), ({d},) or (3,)"),
        };
        return Err(PyValueError::new_err(format!(
            "expected an array of shape {shapes}, got {shape:?}"
        )));
    }
    let row = |row: &[f64]| std::array::from_fn(|a| row.get(a).copied().unwrap_or(0.0));
    let rows: Vec<Point> = all.chunks_exact(width).map(row).collect();
    match shape.len() {
        1 => Ok(vec![rows[0]; count]),
        _ => Ok(rows),
    }
}

pub fn kind(given: &Bound<'_, PyAny>) -> String {
    let name = given.get_type().name();
    name.map_or_else(|_| "something else".into(), |n| n.to_string())
}
