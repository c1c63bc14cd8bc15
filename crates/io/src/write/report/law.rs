//! Frames of a conservation law as a scene.

use std::path::Path;

use ndarray::ArrayD;

use super::scene::{Look, Maker, Scene, Values};
use crate::read::ReadError;
use crate::read::npz::Npz;
use crate::write::run_json::Setting;

/// `frames.npz`: `x` (of a plane `x[point, 2]`), `t`, `u[frame, point]`.
///
/// # Errors
/// It cannot be read, or has other arrays.
pub fn read(path: &Path, setting: &Setting) -> Result<Option<Scene>, ReadError> {
    let wrong = |e: String| ReadError::file(path, e);
    let mut file = Npz::open(path).map_err(wrong)?;
    let mut array =
        |name: &str| -> Result<ArrayD<f64>, ReadError> { file.array(name).map_err(wrong) };
    let [x, t, u] = [array("x")?, array("t")?, array("u")?];
    let width = if x.ndim() == 2 {
        x.shape()[1].max(1)
    } else {
        1
    };
    let x: Vec<f64> = x.iter().copied().collect();
    let place = x
        .chunks_exact(width)
        .flat_map(|row| std::array::from_fn::<f64, 3, _>(|a| row.get(a).copied().unwrap_or(0.0)));
    let place: Vec<f64> = place.collect();
    let points = place.len() / 3;
    let u: Vec<f64> = u.iter().copied().collect();
    if points == 0 || u.len() != points * t.len() {
        return Err(wrong("u is not one number for each point and time".into()));
    }
    let mut maker = Maker::new("law", setting);
    for (n, (time, u)) in t.iter().zip(u.chunks_exact(points)).enumerate() {
        let look = Look {
            step: n as u64,
            value: *time,
            position: place.clone(),
            displacement: Some(vec![0.0; place.len()]),
            arrays: Box::new(std::iter::once(Ok(Values::new("u", "scalar", u.to_vec())))),
        };
        maker.push(look, setting)?;
    }
    Ok(maker.made())
}
