//! A linear body as a NumPy archive (`.npz`): `position [N][D]`, `volume [N]`, `density [N]`, `period [D]` (not a number: free),
//! and the micromoduli as a block-sparse matrix, `start [N + 1]`, `partner [bonds]`, `block [bonds][D][D]` (force density / length,
//! `L_i = Σ_j C_ij (u_j − u_i)`). `scipy.sparse.bsr_matrix((block, partner, start))` is the matrix without its diagonal.
//! `asymmetry [1]` is the largest `|V_i C_ij − V_j C_jiᵀ|` over the largest `|V_i C_ij|`: 0, or round-off, where action is reaction;
//! a body of another kind has no energy, and its matrix needs solvers that take no symmetry.
//!
//! Bodies that were condensed with their loads say where these act: `load_position [M][D]`, `load_volume [M]` and
//! `load_spacing [1]` of the points of the finest body, and the matrix that passes their forces on,
//! `F_q = Σ_p T_qp F_p`: `load_start [M + 1]`, `load_target`, `load_block [..][D][D]`, one row per point p.
//!
//! Bodies whose masses couple points have the mass matrix, `F_i = Σ_j M_ij a_j`: `mass_start [N + 1]`, `mass_partner`,
//! `mass_block [..][D][D]` (mass), one row per point with the point itself in it. Without these every point has its own mass alone,
//! volume times density; with them these are the masses lumped, and the sum is the same.

use super::atomic::{WriteError, write_file};
use crate::read::source;
use ndarray::{Array1, Array2, Array3};
use ndarray_npy::NpzWriter;
use peridyne::run::Info;
use peridyne::spec::LinearBody;
use std::io::{self, Cursor, Error, Write as _};
use std::path::Path;

/// Copies of a bond's micromodulus while a body is made: as tangents, sorted, in rows.
const COPIES: f64 = 3.0;

/// Is there room for the linear body of a model, at least for one whose bonds are all central? (Points with a scalar see the families
/// of their partners, too.)
///
/// # Errors
/// There is not.
pub fn room(info: &Info) -> io::Result<()> {
    let block = 8.0 * (info.dimension * info.dimension) as f64 + 8.0;
    let what = format!(
        "the linear body of {} points with {} bonds",
        info.points, info.directed_bonds
    );
    source::room(&what, COPIES * block * info.directed_bonds as f64)
}

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
    // rows that do not fit together are the reader's to name
    let fits = body.start.windows(2).all(|w| w[0] <= w[1])
        && body.start.last() == Some(&bonds)
        && body.partner.iter().all(|p| (*p as usize) < n);
    let asymmetry = match fits {
        true => body.soundness().asymmetry,
        false => f64::NAN,
    };
    file.add_array("asymmetry", &column(&[asymmetry]))
        .map_err(bad)?;
    if let Some(mass) = &body.mass {
        let start: Vec<i64> = mass.start.iter().map(|s| *s as i64).collect();
        file.add_array("mass_start", &Array1::from_vec(start))
            .map_err(bad)?;
        let partner: Vec<i32> = mass.partner.iter().map(|p| *p as i32).collect();
        file.add_array("mass_partner", &Array1::from_vec(partner))
            .map_err(bad)?;
        let block = mass.block.iter().flatten().flatten().copied().collect();
        let block = Array3::from_shape_vec((mass.partner.len(), D, D), block).map_err(shape)?;
        file.add_array("mass_block", &block).map_err(bad)?;
    }
    if let Some(load_map) = &body.load_map {
        let m = load_map.points();
        let position = load_map.position.iter().flatten().copied().collect();
        let position = Array2::from_shape_vec((m, D), position).map_err(shape)?;
        file.add_array("load_position", &position).map_err(bad)?;
        file.add_array("load_volume", &column(&load_map.volume))
            .map_err(bad)?;
        file.add_array("load_spacing", &column(&[load_map.spacing]))
            .map_err(bad)?;
        let start: Vec<i64> = load_map.start.iter().map(|s| *s as i64).collect();
        file.add_array("load_start", &Array1::from_vec(start))
            .map_err(bad)?;
        let target: Vec<i32> = load_map.target.iter().map(|p| *p as i32).collect();
        file.add_array("load_target", &Array1::from_vec(target))
            .map_err(bad)?;
        let block = load_map.block.iter().flatten().flatten().copied().collect();
        let block = Array3::from_shape_vec((load_map.target.len(), D, D), block).map_err(shape)?;
        file.add_array("load_block", &block).map_err(bad)?;
    }
    Ok(file.finish().map_err(bad)?.into_inner())
}
