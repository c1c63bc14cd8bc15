//! Regions with their lengths.

use super::context::{Context, Result};
use crate::deck::document::Shape;
use crate::deck::units::Dim;
use crate::deck::value::{At, Vector};
use peridyne::space::region::Region;

const INF: f64 = f64::INFINITY;

pub(super) fn region(context: &Context, shape: &At<Shape>) -> Result<Region> {
    let length = Dim::LENGTH;
    let all = |parts: &[At<Shape>]| {
        parts
            .iter()
            .map(|part| region(context, part))
            .collect::<Result<Vec<_>>>()
    };
    let center = |c: &Option<Vector>| {
        c.as_ref()
            .map_or(Ok([0.0; 3]), |c| context.finite_vector(c, length))
    };
    let region = match &shape.value {
        Shape::Everything => Region::Everything,
        Shape::Block { low, high } => Region::Block {
            low: context.vector(low, length, -INF)?,
            high: context.vector(high, length, INF)?,
        },
        Shape::Cylinder {
            axis,
            center: c,
            radius,
            low,
            high,
        } => Region::Cylinder {
            axis: *axis as usize,
            center: center(c)?,
            radius: context.positive(radius, length, "the radius")?,
            low: low
                .as_ref()
                .map_or(Ok(-INF), |n| context.number(n, length))?,
            high: high
                .as_ref()
                .map_or(Ok(INF), |n| context.number(n, length))?,
        },
        Shape::Sphere { center: c, radius } => Region::Sphere {
            center: center(c)?,
            radius: context.positive(radius, length, "the radius")?,
        },
        Shape::HalfSpace { point, normal } => Region::HalfSpace {
            point: context.finite_vector(point, length)?,
            normal: context.finite_vector(normal, Dim::NUMBER)?,
        },
        Shape::Union(parts) => Region::Union(all(parts)?),
        Shape::Difference { from, minus } => {
            Region::Difference(Box::new(self::region(context, from)?), all(minus)?)
        }
        Shape::Intersection(parts) => Region::Intersection(all(parts)?),
    };
    region
        .check()
        .map_err(|message| context.error(&shape.span, message))?;
    Ok(region)
}
