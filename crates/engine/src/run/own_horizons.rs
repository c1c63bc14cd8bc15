//! Horizons of points: what each has, and what can have such.

use crate::body::Body;
use crate::error::BuildError;
use crate::message;
use crate::quantity::{Dimension, place};
use crate::run::constitutive::{generalised, is_solid};
use crate::spec::{Criterion, FractureSpec, Spec};

/// What is longer by this part is so by round-off.
const ROUND_OFF: f64 = 1.0 + 1e-9;

/// Where points have horizons of their own, solids are laws of `law/material`, and so is `pmb` of several materials: their own kernels know one
/// horizon, or one material. Were laws changed?
pub(super) fn resolve(spec: &mut Spec) -> bool {
    let several = spec.materials.len() > 1;
    spec.bonds.own_horizon.is_some() && generalised(spec, |law| several || is_solid(law))
}

/// Is the critical stretch that of a fracture energy?
pub(super) fn of_energy(fracture: FractureSpec) -> bool {
    matches!(fracture.criterion, Criterion::Energy(_))
}

/// Does what bonds bear follow the horizon of each point?
pub(super) fn strengthen(spec: &Spec) -> bool {
    spec.bonds.own_horizon.is_some()
        && spec
            .materials
            .iter()
            .any(|m| m.fracture.is_some_and(of_energy))
}

/// By what the critical stretch of a material at this horizon differs where points have their own: `G ∝ E s² δ` of a body without another length.
pub(super) fn strength(spec: &Spec, material: usize, horizon: f64, own: Option<f64>) -> f64 {
    let fracture = spec.materials.get(material).and_then(|m| m.fracture);
    match own {
        Some(own) if fracture.is_some_and(of_energy) => (horizon / own).sqrt(),
        Some(_) | None => 1.0,
    }
}

/// Gives the points of a cloud the horizons that the spec asks for, none longer than `longest`.
pub(super) fn give<const D: usize>(
    spec: &Spec,
    body: &mut Body<D>,
    longest: f64,
) -> Result<(), BuildError> {
    let Some(expression) = &spec.bonds.own_horizon else {
        return Ok(());
    };
    if expression.depends_on_time() {
        return Err(BuildError::invalid(
            "own_horizon",
            "horizons are those of the reference, and this one depends on t",
        )
        .help("write it with x, y, z alone"));
    }
    let mut own = vec![0.0; body.len];
    for &s in &body.slots {
        let x = body.position(s as usize);
        let horizon = expression.eval(&x, 0.0);
        if !(horizon > 0.0 && horizon <= longest * ROUND_OFF) {
            return Err(BuildError::invalid(
                "own_horizon",
                message![
                    "the horizon of the point at ",
                    place(&x[..D]),
                    " is ",
                    Dimension::LENGTH.of(horizon),
                    ", expected a positive length up to the horizon of the body, ",
                    Dimension::LENGTH.of(longest),
                ],
            )
            .help("horizon is the longest of all"));
        }
        own[s as usize] = horizon;
    }
    body.horizon = own;
    Ok(())
}
