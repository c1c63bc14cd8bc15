//! Points of a file that are likely not what the deck means.

use super::context::{Context, Result};
use super::section::section;
use crate::deck::document::Document;
use crate::deck::units::Dim;
use crate::deck::value::At;
use crate::read::plane;
use crate::read::spacing::Spacing;
use peridyne::spec::{BodySpec, Cloud, PieceSpec};

/// A volume is that many times the cube of the distance to the next point at most, and at least the inverse.
const FACTOR: f64 = 100.0;
/// Part of a period.
const ROUND_OFF: f64 = 1e-6;

/// Coordinates that the dimension leaves out are the same everywhere.
pub(super) fn lie_flat(context: &Context, cloud: &Cloud, file: &At<String>) -> Result<()> {
    let d = context.dimension;
    if d == 3 {
        return Ok(());
    }
    plane::lies(cloud.position.iter(), d).map_err(|why| {
        context.error(
            &file.span,
            format!("of the points of {}, {why}", file.value),
        )
    })
}

/// So they are in several bodies; `new` is the next.
pub(super) fn lie_together(
    context: &Context,
    before: &[PieceSpec],
    new: &BodySpec,
    file: Option<&At<String>>,
) -> Result<()> {
    let (BodySpec::Cloud(new), Some(file)) = (new, file) else {
        return Ok(());
    };
    let clouds = before.iter().filter_map(|p| match &p.body {
        BodySpec::Cloud(cloud) => Some((&p.name, cloud)),
        BodySpec::Lattice { .. } | BodySpec::Sites { .. } | BodySpec::Several(_) => None,
    });
    for (name, cloud) in clouds {
        let both = cloud.position.iter().chain(&new.position);
        if plane::lies(both, context.dimension).is_err() {
            let axes = ["x", "y", "z"];
            return Err(context.error(
                &file.span,
                format!(
                    "{} lies elsewhere along {} than the body \"{name}\", and {}-D bodies lie in one plane or line: they would be on top of each other",
                    file.value,
                    axes[context.dimension..].join(" or "),
                    context.dimension
                ),
            ));
        }
    }
    Ok(())
}

/// What is odd about the volumes that a file says.
pub(super) fn odd_volumes(
    context: &Context,
    document: &Document,
    cloud: &Cloud,
    file: &At<String>,
) -> Result<Option<String>> {
    let spacing = Spacing::new(&cloud.position);
    if spacing.dimension() != context.dimension || cloud.position.len() < 2 {
        return Ok(None);
    }
    let excess = libm::exp(spacing.excess(&cloud.volume, None)) / section(context, document)?;
    if (1.0 / FACTOR..=FACTOR).contains(&excess) {
        return Ok(None);
    }
    let power = ["length", "area", "volume"][context.dimension - 1];
    let text = format!(
        "points of {} have volumes {excess:.1e} times the {power} between a point and the next (the first has {}): is that the column of volumes, and are they in the units of the coordinates{}?",
        file.value,
        context.units.show(cloud.volume[0], Dim::VOLUME),
        match context.dimension {
            3 => "",
            2 => ", times the thickness",
            _ => ", times the area",
        }
    );
    Ok(Some(context.source.remark(&file.span, &text)))
}

/// How long a mesh is along an axis, if that is more than a period. Of points without cells the engine knows no more than their places, and looks
/// at these.
pub(super) fn longer(context: &Context, body: &BodySpec, a: usize, period: f64) -> Option<f64> {
    let ends = context
        .ends
        .filter(|_| matches!(body, BodySpec::Cloud(_)))?;
    let [low, high] = ends[a];
    Some(high - low).filter(|length| *length > period * (1.0 + ROUND_OFF))
}
