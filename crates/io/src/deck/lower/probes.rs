//! Probes: what is measured over time.

use super::context::{Context, Result};
use crate::deck::document::{MeasureName, Probe};
use crate::deck::error::nearest;
use crate::deck::value::At;
use peridyne::spec::{
    CrackTipSpec, Fold, JIntegralSpec, Measure, Part, ProbeSpec, RigidQuantity, SetSpec,
};

/// Damage of a point that is part of a crack, by default.
const CRACKED: f64 = 0.3;

/// Keys that not all measures have, and which of them a measure needs and may have.
fn keys(measure: MeasureName) -> (&'static [&'static str], &'static [&'static str]) {
    match measure {
        MeasureName::Reaction | MeasureName::Energy => (&[], &[]),
        MeasureName::Moment => (&["about"], &[]),
        MeasureName::Mean | MeasureName::Min | MeasureName::Max | MeasureName::Sum => {
            (&["of"], &["component"])
        }
        MeasureName::Value => (&["of", "at"], &["component"]),
        MeasureName::RigidBody => (&["rigid_body"], &["of"]),
        MeasureName::JIntegral => (&["corners"], &["direction"]),
        MeasureName::CrackTip => (&["from"], &["direction", "damage"]),
        MeasureName::Opening => (&["between"], &[]),
        MeasureName::Fragments => (&[], &["points"]),
    }
}

pub(super) fn probe(context: &Context, at: &At<Probe>, sets: &[SetSpec]) -> Result<ProbeSpec> {
    let written = &at.value;
    if written.name.value.trim().is_empty() {
        return Err(context.error_with(
            &written.name.span,
            "a probe needs a name",
            "the columns of history.csv begin with it",
        ));
    }
    let measure = written.measure.value;
    let title = measure.title();
    let (must, may) = keys(measure);
    let given = [
        ("of", written.of.as_ref().map(|k| &k.span)),
        ("component", written.component.as_ref().map(|k| &k.span)),
        ("rigid_body", written.rigid_body.as_ref().map(|k| &k.span)),
        ("about", written.about.as_ref().map(|k| &k.span)),
        ("at", written.at.as_ref().map(|k| &k.span)),
        ("corners", written.corners.as_ref().map(|k| &k.span)),
        ("direction", written.direction.as_ref().map(|k| &k.span)),
        ("from", written.from.as_ref().map(|k| &k.span)),
        ("damage", written.damage.as_ref().map(|k| &k.span)),
        ("between", written.between.as_ref().map(|k| &k.span)),
        ("points", written.points.as_ref().map(|k| &k.span)),
    ];
    for (key, span) in given {
        match span {
            None if must.contains(&key) => {
                return Err(context.error_with(
                    &at.span,
                    format!("the probe `{}` needs the key `{key}`", written.name.value),
                    example(key),
                ));
            }
            Some(span) if !must.contains(&key) && !may.contains(&key) => {
                return Err(context.error_with(
                    span,
                    format!("the measure {title} has no key `{key}`"),
                    "remove it, or choose another measure",
                ));
            }
            None | Some(_) => {}
        }
    }
    if let (MeasureName::JIntegral, Some(set)) = (measure, &written.set) {
        return Err(context.error_with(
            &set.span,
            "a contour goes through all points of its rectangle",
            "remove `set`",
        ));
    }
    if let (MeasureName::Fragments, Some(set)) = (measure, &written.set) {
        let message = "fragments are those of the whole body";
        return Err(context.error_with(&set.span, message, "remove `set`"));
    }
    if let (MeasureName::RigidBody, Some(set)) = (measure, &written.set) {
        let message = "a rigid body is measured as a whole, whatever points it touches";
        return Err(context.error_with(&set.span, message, "remove `set`"));
    }
    let set = match &written.set {
        None => "all".into(),
        Some(set) => context.known_set(set, sets)?,
    };
    let of = written
        .of
        .as_ref()
        .map_or(String::new(), |o| o.value.clone());
    let part = match written.component.as_ref().map(|c| c.value.as_str()) {
        None => Part::All,
        Some("magnitude") => Part::Magnitude,
        Some(name) => Part::Component(name.into()),
    };
    let over = |fold| Measure::Over {
        fold,
        of: of.clone(),
        part: part.clone(),
    };
    let place = |key: &Option<_>| match key {
        Some(vector) => context.finite_vector(vector),
        None => Ok([0.0; 3]),
    };
    let measure = match measure {
        MeasureName::Reaction => Measure::Reaction,
        MeasureName::Energy => Measure::Energy,
        MeasureName::Moment => Measure::Moment {
            about: place(&written.about)?,
        },
        MeasureName::Mean => over(Fold::Mean),
        MeasureName::Min => over(Fold::Min),
        MeasureName::Max => over(Fold::Max),
        MeasureName::Sum => over(Fold::Sum),
        MeasureName::Value => Measure::Value {
            at: place(&written.at)?,
            of,
            part,
        },
        MeasureName::RigidBody => Measure::RigidBody {
            rigid_body: { written.rigid_body.as_ref() }.map_or(String::new(), |n| n.value.clone()),
            of: rigid(context, written)?,
        },
        MeasureName::JIntegral => Measure::JIntegral(j_integral(context, written)?),
        MeasureName::CrackTip => Measure::CrackTip(crack_tip(context, written)?),
        MeasureName::Opening => Measure::Opening {
            between: between(context, written)?,
        },
        MeasureName::Fragments => Measure::Fragments {
            points: written.points.as_ref().map_or(1, |p| p.value),
        },
    };
    Ok(ProbeSpec {
        name: written.name.value.clone(),
        set,
        measure,
    })
}

/// What of a rigid body; `None`: all.
fn rigid(context: &Context, written: &Probe) -> Result<Option<RigidQuantity>> {
    let Some(of) = &written.of else {
        return Ok(None);
    };
    let all = RigidQuantity::ALL;
    if let Some(found) = all.iter().find(|q| q.name() == of.value) {
        return Ok(Some(*found));
    }
    let names = all.map(RigidQuantity::name);
    let help = match nearest(&of.value, names) {
        Some(near) => format!("did you mean \"{near}\"?"),
        None => format!("a rigid body has {}", names.join(", ")),
    };
    let message = format!("a rigid body has no `{}`", of.value);
    Err(context.error_with(&of.span, message, help))
}

/// What to write for a key.
fn example(key: &str) -> &'static str {
    match key {
        "of" => "write for example of = \"displacement\"; `peridyne laws` lists the fields",
        "about" => "write for example about = [0, 0, 0]",
        "rigid_body" => "write the name of a [[rigid_body]]: rigid_body = \"punch\"",
        "from" => {
            "write where the crack starts, for example the tip of its pre-crack: from = [\"50 mm\", \"20 mm\"]"
        }
        "between" => {
            "write two places: between = [[0, \"-2 mm\"], [0, \"2 mm\"]]; the points nearest to them are measured"
        }
        "at" => "write for example at = [\"5 mm\", 0, 0]: the nearest point counts",
        _ => {
            "write two opposite corners of a rectangle around the tip: corners = [[\"10 mm\", \"-5 mm\"], [\"20 mm\", \"5 mm\"]]"
        }
    }
}

fn j_integral(context: &Context, written: &Probe) -> Result<JIntegralSpec> {
    let corners = written.corners.as_ref().map_or(&[][..], |c| &c.value);
    let span = written.corners.as_ref().map_or(0..0, |c| c.span.clone());
    if context.dimension != 2 {
        return Err(context.error(
            &span,
            format!(
                "a contour is one in two dimensions, this body has {}",
                context.dimension
            ),
        ));
    }
    let [a, b] = corners else {
        return Err(context.error_with(&span, "a rectangle has two opposite corners", example("")));
    };
    let [a, b] = [context.finite_vector(a)?, context.finite_vector(b)?];
    let [x, y, _] = direction(context, written)?;
    Ok(JIntegralSpec {
        low: [a[0].min(b[0]), a[1].min(b[1])],
        high: [a[0].max(b[0]), a[1].max(b[1])],
        direction: [x, y],
    })
}

/// Where a crack grows to, as a unit vector.
fn direction(context: &Context, written: &Probe) -> Result<[f64; 3]> {
    let Some(vector) = &written.direction else {
        return Ok([1.0, 0.0, 0.0]);
    };
    let along = context.finite_vector(vector)?;
    let largest = along.iter().fold(0.0, |l: f64, c| l.max(c.abs()));
    if largest == 0.0 {
        return Err(context.error_with(
            &vector.span,
            "this is no direction",
            "write where the crack grows to: direction = [1, 0]",
        ));
    }
    // neither too small nor too large for its square
    let along = along.map(|c| c / largest);
    let length = along.iter().map(|c| c * c).sum::<f64>().sqrt();
    Ok(along.map(|c| c / length))
}

fn crack_tip(context: &Context, written: &Probe) -> Result<CrackTipSpec> {
    let from = match &written.from {
        Some(place) => context.finite_vector(place)?,
        None => [0.0; 3],
    };
    Ok(CrackTipSpec {
        from,
        direction: direction(context, written)?,
        damage: context.value_or(&written.damage, CRACKED)?,
    })
}

fn between(context: &Context, written: &Probe) -> Result<[[f64; 3]; 2]> {
    let places = written.between.as_ref().map_or(&[][..], |p| &p.value);
    let [a, b] = places else {
        let span = written.between.as_ref().map_or(0..0, |p| p.span.clone());
        return Err(context.error_with(
            &span,
            "an opening is between two places",
            example("between"),
        ));
    };
    Ok([context.finite_vector(a)?, context.finite_vector(b)?])
}
