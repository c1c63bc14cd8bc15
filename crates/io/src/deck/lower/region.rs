//! Regions with their lengths.

use super::context::{Context, Result};
use crate::deck::document::Shape;
use crate::deck::quantity::Length;
use crate::deck::value::{At, Vector};
use peridyne::space::region::Region;

const INF: f64 = f64::INFINITY;

pub(super) fn region(context: &Context, shape: &At<Shape>) -> Result<Region> {
    let all = |parts: &[At<Shape>]| {
        parts
            .iter()
            .map(|part| region(context, part))
            .collect::<Result<Vec<_>>>()
    };
    let center = |c: &Option<Vector<Length>>| {
        c.as_ref()
            .map_or(Ok([0.0; 3]), |c| context.finite_vector(c))
    };
    let region = match &shape.value {
        Shape::Everything => Region::Everything,
        Shape::Block { low, high } => Region::Block {
            low: context.vector(low, -INF)?,
            high: context.vector(high, INF)?,
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
            radius: context.value(radius)?,
            low: low.as_ref().map_or(Ok(-INF), |n| context.limit(n))?,
            high: high.as_ref().map_or(Ok(INF), |n| context.limit(n))?,
        },
        Shape::Sphere { center: c, radius } => Region::Sphere {
            center: center(c)?,
            radius: context.value(radius)?,
        },
        Shape::HalfSpace { point, normal } => Region::HalfSpace {
            point: context.finite_vector(point)?,
            normal: context.finite_vector(normal)?,
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
