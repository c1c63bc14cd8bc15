//! Initial values, conditions, pre-cracks.

use super::Files;
use super::context::{Context, Result};
use super::diffusion::{self, Said};
use super::law::force;
use super::region::region;
use crate::deck::document::{
    BondFactor, Condition, CrackName, FlatShape, Healing, Initial, Precrack, Shape, Toughness,
};
use crate::deck::quantity::{Positive, Temperature};
use crate::deck::value::{At, Number, Quantity};
use peridyne::spec::{
    BondFactorSpec, ConditionKind, ConditionSpec, CrackKind, CrackShape, DiffusionCondition,
    HealingSpec, InitialSpec, Members, PrecrackSpec, SetSpec, ToughnessFactor, ToughnessSpec,
};
use std::ops::Range;
use std::sync::Arc;

/// The set that is meant: a named one, one made of a region here, or all.
fn target(
    context: &Context,
    span: &Range<usize>,
    what: String,
    set: &Option<At<String>>,
    shape: &Option<At<Shape>>,
    sets: &mut Vec<SetSpec>,
) -> Result<String> {
    match (set, shape) {
        (Some(_), Some(_)) => {
            Err(context.error(span, format!("{what} has set and region: give one of them")))
        }
        (Some(set), None) => context.known_set(set, sets),
        (None, Some(shape)) => {
            sets.push(SetSpec {
                name: what.clone(),
                members: Members::Region(region(context, shape)?),
            });
            Ok(what)
        }
        (None, None) => Ok("all".into()),
    }
}

pub(super) fn initial(
    context: &Context,
    index: usize,
    at: &At<Initial>,
    sets: &mut Vec<SetSpec>,
) -> Result<InitialSpec> {
    let written = &at.value;
    if written.displacement.is_none()
        && written.velocity.is_none()
        && written.temperature.is_none()
        && written.concentration.is_none()
    {
        return Err(context.error(
            &at.span,
            "an initial value needs one of displacement, velocity, temperature, concentration",
        ));
    }
    Ok(InitialSpec {
        set: target(
            context,
            &at.span,
            format!("initial {}", index + 1),
            &written.set,
            &written.region,
            sets,
        )?,
        displacement: context.components_or_none(&written.displacement)?,
        velocity: context.components_or_none(&written.velocity)?,
    })
}

/// One entry may do several things to its set.
pub(super) fn condition(
    context: &Context,
    index: usize,
    at: &At<Condition>,
    sets: &mut Vec<SetSpec>,
    exchanged: &mut Vec<Said<DiffusionCondition>>,
) -> Result<Vec<ConditionSpec>> {
    let c = &at.value;
    let set = target(
        context,
        &at.span,
        format!("boundary condition {}", index + 1),
        &c.set,
        &c.region,
        sets,
    )?;
    let mut kinds = Vec::new();
    if let Some(v) = &c.displacement {
        kinds.push(ConditionKind::Displacement(context.components(v)?));
    }
    if let Some(v) = &c.velocity {
        kinds.push(ConditionKind::Velocity(context.components(v)?));
    }
    if let Some(v) = &c.body_force {
        kinds.push(ConditionKind::BodyForce(context.components(v)?));
    }
    let area = context.optional(&c.area)?;
    if let Some(v) = &c.traction {
        kinds.push(ConditionKind::Traction {
            value: context.components(v)?,
            area,
        });
    } else if let Some(area) = &c.area
        && !diffusion::has_surface(c)
    {
        return Err(context.error(
            &area.span,
            "area belongs to a traction, a flux or an exchange",
        ));
    }
    let already = exchanged.len();
    diffusion::conditions(context, c, &set, area, exchanged)?;
    if let Some(v) = &c.damping {
        kinds.push(ConditionKind::Damping(context.expression(v)?));
    }
    if let Some(written) = &c.force {
        kinds.push(ConditionKind::Force(force(context, written)?));
    }
    if kinds.is_empty() && exchanged.len() == already {
        let message = "a boundary condition needs one of displacement, velocity, body_force, traction, damping, force, temperature, heat_flux, heat_source, convection, radiation, concentration, species_flux, species_source, species_exchange";
        return Err(context.error(&at.span, message));
    }
    Ok(kinds
        .into_iter()
        .map(|kind| ConditionSpec {
            set: set.clone(),
            kind,
        })
        .collect())
}

/// One that is `late` cuts a body that is loaded.
pub(super) fn precrack(
    context: &Context,
    at: &At<Precrack>,
    late: bool,
    files: &Files,
) -> Result<PrecrackSpec> {
    let p = &at.value;
    let shape = FlatShape {
        segment: p.segment.clone(),
        disk: p.disk.clone(),
        polygon: p.polygon.clone(),
        point: p.point.clone(),
    };
    let kind = match p.kind {
        Some(CrackName::Broken) => CrackKind::Broken,
        None if late => CrackKind::Broken,
        Some(CrackName::Excluded) | None => CrackKind::Excluded,
    };
    let flat = shape.segment.is_some()
        || shape.disk.is_some()
        || shape.polygon.is_some()
        || shape.point.is_some();
    let shape = match (&p.stl, flat) {
        (Some(stl), true) => {
            let message = "a precrack has stl and another shape: give one of them";
            return Err(context.error(&stl.span, message));
        }
        (Some(stl), false) => {
            if context.dimension != 3 {
                let message = format!(
                    "a surface of triangles does not cut a body in {}-D",
                    context.dimension
                );
                return Err(context.error(&stl.span, message));
            }
            let surface = files.stl(context, &stl.value.file, &stl.value.unit)?;
            CrackShape::Surface(Arc::new(surface))
        }
        (None, true) => flat_shape(context, &at.span, "a precrack", &shape)?,
        (None, false) => {
            let message = "a precrack needs one of segment, disk, polygon, point, stl";
            return Err(context.error(&at.span, message));
        }
    };
    Ok(PrecrackSpec { shape, kind })
}

pub(super) fn bond_factor(context: &Context, at: &At<BondFactor>) -> Result<BondFactorSpec> {
    let written = &at.value;
    let Some(shape) = &written.crossing else {
        let field = context.expression(&written.factor)?;
        return Ok(BondFactorSpec::Field(field));
    };
    let factor = context.value(&written.factor)?;
    if factor < 0.0 {
        let message = format!("the factor is {factor}, expected 0 or a positive number");
        return Err(context.error(&written.factor.span, message));
    }
    Ok(BondFactorSpec::Crossing {
        shape: flat_shape(context, &shape.span, "the shape to cross", &shape.value)?,
        factor,
    })
}

pub(super) fn healing(
    context: &Context,
    at: &At<Healing>,
    sets: &[SetSpec],
) -> Result<HealingSpec> {
    let set = match &at.value.set {
        Some(set) => context.known_set(set, sets)?,
        None => "all".to_string(),
    };
    Ok(HealingSpec {
        set,
        below: context.expression(&at.value.below)?,
    })
}

pub(super) fn toughness(
    context: &Context,
    at: &At<Toughness>,
    sets: &[SetSpec],
) -> Result<ToughnessSpec> {
    let written = &at.value;
    let set = match &written.set {
        Some(set) => context.known_set(set, sets)?,
        None => "all".to_string(),
    };
    let given = [
        (
            "critical_stretch_factor",
            written.critical_stretch_factor.is_some(),
        ),
        ("energy_factor", written.energy_factor.is_some()),
        ("temperature", written.temperature.is_some()),
        ("no_failure", written.no_failure.is_some()),
    ];
    context.one_of(&at.span, "the toughness", &given)?;
    let factor = match (&written.critical_stretch_factor, &written.energy_factor) {
        (Some(n), _) => ToughnessFactor::Stretch(context.expression(n)?),
        (_, Some(n)) => ToughnessFactor::Energy(context.expression(n)?),
        (None, None) if let Some(rows) = &written.temperature => {
            let row = |row: &Vec<Number>| {
                let [t, x] = &row[..] else {
                    let message = format!("a row of temperature has {} numbers", row.len());
                    let help = "expected [T, factor]";
                    return Err(context.error_with(&rows.span, message, help));
                };
                let t: Quantity<Temperature> = t.clone().into();
                let factor: Quantity<Positive> = x.clone().into();
                Ok([context.value(&t)?, context.value(&factor)?])
            };
            let made: Vec<[f64; 2]> = rows.value.iter().map(row).collect::<Result<_>>()?;
            if made.is_empty() || made.windows(2).any(|r| r[0][0] >= r[1][0]) {
                let message = "temperatures must rise from row to row";
                return Err(context.error_with(
                    &rows.span,
                    message,
                    "write for example temperature = [[\"300 K\", 1], [\"900 K\", 0.6]]",
                ));
            }
            ToughnessFactor::Temperature(made)
        }
        (None, None) => match &written.no_failure {
            Some(no) if !no.value => {
                let message = "no_failure = false says nothing: leave this table out";
                return Err(context.error(&no.span, message));
            }
            Some(_) | None => ToughnessFactor::NoFailure,
        },
    };
    Ok(ToughnessSpec { set, factor })
}

/// What cuts bonds: a segment, disk, polygon or point.
fn flat_shape(
    context: &Context,
    span: &Range<usize>,
    what: &str,
    p: &FlatShape,
) -> Result<CrackShape> {
    let given = [
        ("segment", p.segment.is_some()),
        ("disk", p.disk.is_some()),
        ("polygon", p.polygon.is_some()),
        ("point", p.point.is_some()),
    ];
    context.one_of(span, what, &given)?;
    let only = |dimensions: &[usize], name: &str| {
        if dimensions.contains(&context.dimension) {
            return Ok(());
        }
        let fitting = ["point", "segment", "disk, polygon or segment"][context.dimension - 1];
        let message = format!("a {name} does not cut a body in {}-D", context.dimension);
        Err(context.error_with(span, message, format!("use {fitting}")))
    };
    let point = |v| context.finite_vector(v);
    Ok(if let Some(s) = &p.segment {
        only(&[2, 3], "segment")?;
        CrackShape::Segment {
            from: point(&s.from)?,
            to: point(&s.to)?,
        }
    } else if let Some(d) = &p.disk {
        only(&[3], "disk")?;
        let normal = context.finite_vector(&d.normal)?;
        let length = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
        if length == 0.0 {
            return Err(context.error(&d.normal.span, "the normal is zero"));
        }
        let radius = context.value(&d.radius)?;
        CrackShape::Disk {
            center: point(&d.center)?,
            normal: normal.map(|n| n / length),
            radius,
        }
    } else if let Some(polygon) = &p.polygon {
        only(&[3], "polygon")?;
        if polygon.value.len() < 3 {
            let message = format!(
                "a polygon has three or more corners, not {}",
                polygon.value.len()
            );
            return Err(context.error(&polygon.span, message));
        }
        CrackShape::Polygon {
            corners: polygon.value.iter().map(point).collect::<Result<_>>()?,
        }
    } else if let Some(x) = &p.point {
        only(&[1], "point")?;
        CrackShape::Point {
            x: context.value(x)?,
        }
    } else {
        return Err(context.error(span, format!("{what} needs a shape")));
    })
}
