//! Horizons of points: what each has, and what can have such.

use crate::body::{Body, Layout};
use crate::error::BuildError;
use crate::message;
use crate::quantity::{Dimension, place};
use crate::run::constitutive::general;
use crate::spec::{Calibration, Criterion, FractureSpec, Influence, LawSpec, Spec};

/// What is longer by this part is so by round-off.
const ROUND_OFF: f64 = 1.0 + 1e-9;

/// Where points have horizons of their own, `lps` is a law of `law/material`: its own kernel knows one horizon. Were laws changed?
pub(super) fn resolve(spec: &mut Spec) -> bool {
    let mut changed = false;
    if spec.bonds.own_horizon.is_none() {
        return changed;
    }
    for m in &mut spec.materials {
        if let (LawSpec::Lps(_), Some(law)) = (&m.law, general(&m.law)) {
            m.law = law;
            changed = true;
        }
    }
    changed
}

/// Is the critical stretch that of a fracture energy?
fn of_energy(fracture: FractureSpec) -> bool {
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

fn possible(spec: &Spec) -> Result<(), BuildError> {
    let refused = |path: &str, message: &str, help: &str| {
        Err(BuildError::unsupported(path, message.to_string()).help(help.to_string()))
    };
    let pmb = matches!(spec.materials[..], [ref m] if matches!(m.law, LawSpec::Pmb(_)));
    if !pmb
        && !spec
            .materials
            .iter()
            .all(|m| matches!(m.law, LawSpec::Named(_)))
    {
        return refused(
            "own_horizon",
            "points with horizons of their own are a body of one material of the law pmb, or of laws that their families normalise",
            "take lps, or leave own_horizon out",
        );
    }
    let alike = match spec.bonds.influence {
        Influence::Constant => true,
        Influence::Inverse => !pmb,
        Influence::Conical | Influence::Gaussian | Influence::CubicSpline => false,
        Influence::Formula(formula) => !pmb && !formula.knows_horizon(),
    };
    if !alike {
        return refused(
            "influence",
            "an influence function of the horizon is not known where points have their own",
            "leave influence out",
        );
    }
    if !spec.bonds.volume_scaling {
        return refused(
            "volume_scaling",
            "volumes fade at the horizon of a point: else its stiffness jumps wherever that passes another point",
            "leave volume_scaling out",
        );
    }
    if spec.bonds.calibration != Calibration::Continuum {
        return refused(
            "calibration",
            "the constants of points with horizons of their own are those of the continuum",
            "write calibration = \"continuum\"",
        );
    }
    let scales = !matches!(spec.bonds.influence, Influence::Formula(_));
    let mut materials = spec.materials.iter();
    if let (Some(n), false) = (
        materials.position(|m| m.fracture.is_some_and(of_energy)),
        scales,
    ) {
        return refused(
            &format!("materials[{n}].fracture"),
            "the stretch that a fracture energy stands for falls with the root of the horizon where nothing else is a length, and this influence function has one",
            "give critical_stretch, or leave influence out",
        );
    }
    Ok(())
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
    if !matches!(body.layout, Layout::Cloud(_)) {
        return Err(BuildError::unsupported(
            "own_horizon",
            "horizons of points belong to a single cloud: a lattice has one stencil",
        )
        .help("write family = \"list\", or take the points from a file"));
    }
    possible(spec)?;
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
