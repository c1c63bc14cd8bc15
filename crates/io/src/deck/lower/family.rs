//! Who talks to whom, and how strongly.

use super::context::{Context, Result};
use crate::deck::document::{
    CalibrationName, Document, FamilyName, HorizonRatio, InfluenceName, InfluenceWritten,
    SurfaceName,
};
use crate::deck::quantity::{Length, Positive};
use crate::deck::units::{Dim, short};
use crate::deck::value::{At, Measured, Or};
use peridyne::run::Registry;
use peridyne::spec::{
    BodySpec, Calibration, FamilyChoice, Formula, Horizon, Influence, MaterialSpec, Spec,
    SurfaceFactors, SurfaceMethod,
};

/// Of atoms: do they talk to those that are near now, and may a continuum's fields be made of their potentials in several ways?
pub(super) fn of_atoms(document: &Document, atoms: bool) -> (bool, bool) {
    let current = atoms
        && matches!(
            document.family,
            None | Some(FamilyName::Auto | FamilyName::Neighbours)
        );
    let kept = document.family == Some(FamilyName::Reference) && document.smooth.is_none();
    (current, current || kept && atoms)
}

/// Neighbours are those of atoms.
pub(super) fn goes_with(context: &Context, document: &Document, current: bool) -> Result<()> {
    if document.family == Some(FamilyName::Neighbours) && !current {
        let registry = Registry::standard();
        let all = registry.descriptors().map(|d| &*d.name);
        let potentials: Vec<&str> = all.filter(|name| registry.is_potential(name)).collect();
        return Err(context.error(
            &document.body.span,
            format!(
                "family = \"neighbours\" belongs to interatomic potentials ({})",
                potentials.join(", ")
            ),
        ));
    }
    Ok(())
}

pub(super) fn choice(document: &Document) -> FamilyChoice {
    match document.family {
        Some(FamilyName::Stencil) => FamilyChoice::Stencil,
        Some(FamilyName::List) => FamilyChoice::List,
        Some(FamilyName::Neighbours) => FamilyChoice::Neighbours,
        Some(FamilyName::Reference) => FamilyChoice::Reference,
        Some(FamilyName::Auto) | None => FamilyChoice::Auto,
    }
}

pub(super) fn calibration(document: &Document) -> Calibration {
    match document.calibration {
        Some(CalibrationName::Continuum) => Calibration::Continuum,
        Some(CalibrationName::Discrete) | None => Calibration::Discrete,
    }
}

/// The horizon of a body whose points have none of their own; `current`: is it one of atoms that are near now?
pub(super) fn horizon_of(
    context: &Context,
    document: &Document,
    body: &BodySpec,
    current: bool,
) -> Result<Horizon> {
    match &document.horizon {
        Some(written) => horizon(context, written, body),
        // the cut-off takes its place
        None if current => Ok(Horizon::Ratio(1)),
        None if let Some(linear) = &context.micromoduli => {
            Ok(Horizon::Length(linear.range() * (1.0 + 1e-9)))
        }
        None => Err(context.error_with(
            &document.body.span,
            "the key `horizon` is missing",
            "write horizon = { m_ratio = 3 }, or a length",
        )),
    }
}

pub(super) fn horizon(
    context: &Context,
    written: &At<Or<Measured<Positive<Length>>, HorizonRatio>>,
    body: &BodySpec,
) -> Result<Horizon> {
    // the length of the shortest bond, where it is known
    let lattice = match body {
        BodySpec::Lattice { kind, spacing, .. } => Some((*spacing, spacing * kind.nearest())),
        BodySpec::Cloud(cloud) => cloud.spacing.map(|s| (s, 0.0)),
        BodySpec::Sites { kind, spacing, .. } => Some((*spacing, spacing * kind.nearest())),
        // each has its own
        BodySpec::Several(_) => None,
    };
    let on_lattices = match body {
        BodySpec::Lattice { .. } | BodySpec::Sites { .. } => true,
        BodySpec::Cloud(_) | BodySpec::Several(_) => false,
    };
    let below = |length: f64, shortest: f64| {
        let [length, shortest] = [length, shortest].map(|l| context.units.write(l, Dim::LENGTH));
        let message =
            format!("the horizon {length} is below the distance of points {shortest}: no bonds");
        context.error_with(&written.span, message, "write horizon = { m_ratio = 3 }")
    };
    match &written.value {
        Or::Bare(number) => {
            let number = At {
                value: number.clone(),
                span: written.span.clone(),
            };
            let length = context.value(&number)?;
            match lattice {
                Some((_, shortest)) if length < shortest => Err(below(length, shortest)),
                _ => Ok(Horizon::Length(length)),
            }
        }
        Or::Table(HorizonRatio { m_ratio }) => {
            let ratio = context.value(m_ratio)?;
            let Some((spacing, shortest)) = lattice else {
                return Err(context.error_with(
                    &m_ratio.span,
                    "m_ratio counts spacings, and these points have none",
                    "give body.spacing, or the horizon as a length",
                ));
            };
            let whole = ratio.fract() == 0.0 && ratio <= f64::from(u32::MAX);
            if ratio * spacing < shortest {
                Err(below(ratio * spacing, shortest))
            } else if ratio > 1000.0 {
                Err(context.error(
                    &m_ratio.span,
                    format!(
                        "m_ratio = {} would bond everything: 3 is usual",
                        short(ratio)
                    ),
                ))
            } else if whole && on_lattices {
                Ok(Horizon::Ratio(ratio as u32))
            } else {
                Ok(Horizon::Length(ratio * spacing))
            }
        }
    }
}

/// The customary influence function of the law, unless one is asked for.
pub(super) fn influence(
    context: &Context,
    written: Option<&At<InfluenceWritten>>,
    materials: &[MaterialSpec],
) -> Result<Influence> {
    let Some(At { value, span }) = written else {
        let first = materials.first().map(|m| &m.law);
        let registry = Registry::standard();
        let written = first.and_then(|law| registry.written(law));
        return Ok(written.map_or(Influence::Constant, |(d, _)| d.influence));
    };
    Ok(match value {
        InfluenceWritten::Named(InfluenceName::Constant) => Influence::Constant,
        InfluenceWritten::Named(InfluenceName::Inverse) => Influence::Inverse,
        InfluenceWritten::Named(InfluenceName::Linear) => Influence::Linear,
        InfluenceWritten::Named(InfluenceName::Gaussian) => Influence::Gaussian,
        InfluenceWritten::Named(InfluenceName::CubicSpline) => Influence::CubicSpline,
        InfluenceWritten::Formula(text) => {
            // a word by itself is a name that was meant, or a variable
            let word = text.trim();
            let alone = word.chars().all(|c| c.is_ascii_alphabetic() || c == '_');
            if alone && !Formula::VARIABLES.contains(&word) && !["e", "pi"].contains(&word) {
                return Err(context.error_with(
                    span,
                    format!("there is no influence function `{word}`"),
                    format!(
                        "write constant, inverse, conical, gaussian, cubic_spline, or an expression of {}: \"r^-2\"",
                        Formula::VARIABLES.join(", ")
                    ),
                ));
            }
            let expression = context.unmeasured(text, span, (Formula::VARIABLES, Dim::LENGTH))?;
            Influence::Formula(Formula::new(expression))
        }
    })
}

/// Factors of the bonds near the surface that a deck asks for.
pub(super) fn surface_factors(
    context: &Context,
    named: &At<SurfaceName>,
    spec: &Spec,
) -> Result<Option<SurfaceFactors>> {
    let method = match named.value {
        SurfaceName::None => return Ok(None),
        SurfaceName::Exact => SurfaceMethod::Exact,
        SurfaceName::Volume => SurfaceMethod::Volume,
        SurfaceName::Energy => SurfaceMethod::Energy,
        SurfaceName::Force => SurfaceMethod::Force,
    };
    match peridyne_theory::homogenize::surface::correct(spec, method) {
        Ok((factors, _)) => Ok(Some(factors)),
        Err(e) => {
            let message = context.units.tell(&e.message());
            Err(context.error_with(&named.span, message, e.help()))
        }
    }
}
