//! What is compared to say whether two models are upscalings of each other: gradient equations along symmetry directions.

use super::reference::lattice;

use super::error::UpscaleError;
use crate::crystal::Crystal;
use crate::gradient::comparison::differences;
use crate::lattice_dynamics::TERMS;
use peridyne::spec::Spec;
use std::f64::consts::PI;

/// Up to this part coefficients are equal: round-off of their sums stays far below.
pub(super) const EQUAL: f64 = 1e-9;

/// Symmetry directions of cubic lattices, the first along x.
pub(super) fn directions<const D: usize>() -> Vec<(String, [f64; D])> {
    match D {
        1 => vec![("x".into(), [1.0; D])],
        2 => vec![
            ("[10]".into(), unit(&[1.0, 0.0])),
            ("[11]".into(), unit(&[1.0, 1.0])),
        ],
        _ => vec![
            ("[100]".into(), unit(&[1.0, 0.0, 0.0])),
            ("[110]".into(), unit(&[1.0, 1.0, 0.0])),
            ("[111]".into(), unit(&[1.0, 1.0, 1.0])),
        ],
    }
}

/// Wave number up to which a coarse model is compared: its shortest waves.
pub(super) fn shortest(coarse: &Spec) -> Result<f64, UpscaleError> {
    let (kind, spacing) = lattice(coarse)?;
    Ok(PI / (spacing * kind.nearest()))
}

/// By the linear equations; of crystals with several sites by the elastic constants, `stiffness`.
pub(super) fn linear_differences<const D: usize>(
    a: &Crystal<D>,
    b: &Crystal<D>,
    stiffness: [&Vec<Vec<f64>>; 2],
) -> Vec<(usize, f64)> {
    let of = |c: &Crystal<D>, n: [f64; D]| -> Option<Vec<Vec<f64>>> {
        let all = c.gradient_coefficients(n, TERMS)?;
        Some(all.iter().map(|c| c.concat()).collect())
    };
    let mut found = vec![];
    for (_, n) in directions::<D>() {
        let (Some(left), Some(right)) = (of(a, n), of(b, n)) else {
            let [left, right] = stiffness.map(|c| vec![c.concat()]);
            return differences(&left, &right);
        };
        found.extend(differences(&left, &right));
    }
    found
}

fn unit<const D: usize>(v: &[f64]) -> [f64; D] {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    std::array::from_fn(|a| v[a] / length)
}
