//! Periods of a body, and the corner that they begin at.

use super::context::{Context, Result};
use super::points;
use crate::deck::document::{Body, Periodic};
use crate::deck::units::{Dim, short};
use crate::deck::value::{At, Or};
use peridyne::space::region::Region;
use peridyne::spec::BodySpec;
use std::ops::Range;

/// Part of a cell by which a period ends before the next begins.
const BELOW: f64 = 1e-5;

const INF: f64 = f64::INFINITY;

/// Lower corner of the periods: of the whole cells, of the region, or of the file's box.
pub(super) fn corner(context: &Context, written: &Body, body: &BodySpec) -> [f64; 3] {
    match body {
        BodySpec::Lattice { origin, region, .. } => {
            let low = match &written.cells {
                Some(_) => *origin,
                None => region.bounds().0,
            };
            low.map(|c| if c.is_finite() { c } else { 0.0 })
        }
        BodySpec::Sites { .. } | BodySpec::Cloud(_) | BodySpec::Several(_) => {
            context.atoms.as_ref().map_or([0.0; 3], |file| file.corner)
        }
    }
}

/// Periods per axis. A lattice body is cut to one period, half open: the face at the upper end is the image of the
/// one at the lower end.
pub(super) fn periods(
    context: &Context,
    written: Option<&At<Periodic>>,
    cells: Option<&At<Vec<At<u32>>>>,
    body: &mut BodySpec,
) -> Result<[Option<f64>; 3]> {
    let mut out = [None; 3];
    let Some(written) = written else {
        if let Some(linear) = &context.micromoduli {
            return Ok(linear.period());
        }
        if let Some(file) = &context.atoms
            && let Some(periodic) = file.periodic
        {
            out = std::array::from_fn(|a| {
                (a < context.dimension && periodic[a]).then_some(file.cell[a])
            });
        }
        return Ok(out);
    };
    for (a, span, period) in wanted(context, &written.value)? {
        let axis = ["x", "y", "z"][a];
        if a >= context.dimension {
            return Err(context.error(
                &span,
                format!("there is no {axis} in {}-D", context.dimension),
            ));
        }
        if let Some(period) = period
            && let Some(length) = points::longer(context, body, a, period)
        {
            let [period, length] = [period, length].map(|x| context.units.show(x, Dim::LENGTH));
            return Err(context.error(
                &span,
                format!(
                    "the body is {length} long along {axis}, and repeats every {period}: it would lie in its own image"
                ),
            ));
        }
        out[a] = Some(match body {
            BodySpec::Lattice {
                kind,
                spacing,
                region,
                ..
            } => {
                let edge = *spacing * kind.edges()[a];
                let own = cells.and_then(|c| c.value.get(a));
                let own = own.map(|n| f64::from(n.value) * edge);
                cut(context, region, (a, &span), edge, [period, own])?
            }
            BodySpec::Several(_) => period.ok_or_else(|| {
                context.error_with(
                    &span,
                    "several bodies do not say their period",
                    format!("write periodic = {{ {axis} = \"50 mm\" }}"),
                )
            })?,
            BodySpec::Sites { .. } | BodySpec::Cloud(_) => period
                .or(context.atoms.as_ref().map(|f| f.cell[a]))
                .ok_or_else(|| {
                    context.error_with(
                        &span,
                        "points from a file do not say their period",
                        format!("write periodic = {{ {axis} = \"50 mm\" }}"),
                    )
                })?,
        });
    }
    Ok(out)
}

/// Axis, place in the deck and length of each period that is written.
type Wanted = Vec<(usize, Range<usize>, Option<f64>)>;

fn wanted(context: &Context, written: &Periodic) -> Result<Wanted> {
    let mut wanted: Wanted = Vec::new();
    match written {
        Or::Bare(axes) => wanted.extend(
            axes.iter()
                .map(|axis| (axis.value as usize, axis.span.clone(), None)),
        ),
        Or::Table(periods) => {
            for (a, number) in [&periods.x, &periods.y, &periods.z].into_iter().enumerate() {
                if let Some(number) = number {
                    wanted.push((a, number.span.clone(), Some(context.value(number)?)));
                }
            }
        }
    }
    Ok(wanted)
}

/// Cuts a region of a lattice to one period along axis `a`, which is written at `span`: to the `period` that is given, to that of
/// its `own` cells, or to its own length.
fn cut(
    context: &Context,
    region: &mut Region,
    (a, span): (usize, &Range<usize>),
    edge: f64,
    [period, own]: [Option<f64>; 2],
) -> Result<f64> {
    let axis = ["x", "y", "z"][a];
    let (low, high) = region.bounds();
    let length = period.or(own).unwrap_or(high[a] - low[a]);
    let cells = length / edge;
    if !length.is_finite() || !low[a].is_finite() {
        let help = "clip the region with a block along it";
        return Err(context.error_with(
            span,
            format!("the body has no end along {axis} to be a period"),
            help,
        ));
    }
    if (cells - cells.round()).abs() > 1e-6 || cells.round() < 1.0 {
        let message = format!("the period along {axis} is {} lattice cells", short(cells));
        let help = format!(
            "make it a whole number of cells of {}",
            context.units.write(edge, Dim::LENGTH)
        );
        return Err(context.error_with(span, message, help));
    }
    if own.is_some_and(|own| own == length) {
        return Ok(length);
    }
    let (mut from, mut to) = ([-INF; 3], [INF; 3]);
    (from[a], to[a]) = (low[a], low[a] + length - edge * BELOW);
    let whole = std::mem::replace(region, Region::Everything);
    *region = Region::Intersection(vec![
        whole,
        Region::Block {
            low: from,
            high: to,
        },
    ]);
    Ok(length)
}
