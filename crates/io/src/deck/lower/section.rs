//! Thickness of a plane body, cross-section of a line.

use super::context::{Context, Result};
use crate::deck::document::{Document, PlaneName};
use peridyne::spec::Plane;

pub(super) fn plane(document: &Document) -> Plane {
    match document.plane.as_ref().map(|p| p.value) {
        Some(PlaneName::Strain) => Plane::Strain,
        Some(PlaneName::Stress) | None => Plane::Stress,
    }
}

pub(super) fn section(context: &Context, document: &Document) -> Result<f64> {
    let d = context.dimension;
    if let Some(plane) = &document.plane
        && d != 2
    {
        return Err(context.error(
            &plane.span,
            format!("plane stress and strain are 2-D; this body is {d}-D"),
        ));
    }
    match (&document.thickness, &document.area) {
        (Some(thickness), None) if d == 2 => context.value(thickness),
        (None, Some(area)) if d == 1 => context.value(area),
        (None, None) => Ok(1.0),
        (Some(thickness), _) if d != 2 => Err(context.error(
            &thickness.span,
            format!("thickness belongs to a 2-D body; this one is {d}-D"),
        )),
        (_, Some(area)) => Err(context.error(
            &area.span,
            format!("area belongs to a 1-D body; this one is {d}-D"),
        )),
        (Some(_), None) => Ok(1.0),
    }
}
