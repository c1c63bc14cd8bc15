//! Continuum fields of the running model.

use super::context::{Context, Result};
use crate::continuum::plan::{Choice, FieldsSpec, Place};
use crate::deck::document::{
    AxisName, Centre, Fields, KernelName, PairForceName, PartitionName, Smooth,
};
use crate::deck::quantity::Length;
use crate::deck::value::{At, Or, Vector};
use crate::write::folder::{plain, stays};
use peridyne::spec::{SmoothSpec, Window};
use peridyne_fields::targets::affordable;
use peridyne_fields::{Kernel, PairForce, Partition, Shape, Targets};
use std::ops::Range;
use std::path::Path;

/// `atoms`: a potential between current neighbours or those of the reference, which leaves choices.
pub(super) fn fields(
    context: &Context,
    written: &[At<Fields>],
    atoms: bool,
) -> Result<Vec<FieldsSpec>> {
    let mut all: Vec<FieldsSpec> = vec![];
    for at in written {
        let one = one(context, at, atoms)?;
        let folder = |of: &FieldsSpec| plain(Path::new(&of.name));
        if all.iter().any(|other| folder(other) == folder(&one)) {
            let span = at.value.name.as_ref().map_or(&at.span, |n| &n.span);
            return Err(context.error_with(
                span,
                format!("two [[fields]] write into the folder `{}`", one.name),
                "give each a name of its own",
            ));
        }
        all.push(one);
    }
    Ok(all)
}

fn one(context: &Context, at: &At<Fields>, atoms: bool) -> Result<FieldsSpec> {
    let written = &at.value;
    let name = written.name.as_ref().map_or("fields", |n| &n.value);
    if let Some(given) = &written.name
        && (name.trim().is_empty() || !stays(Path::new(name)))
    {
        return Err(context.error_with(
            &given.span,
            format!("{name:?} is no folder inside that of the results"),
            "write for example name = \"stress\"",
        ));
    }
    let every = match &written.every {
        Some(n) if n.value == 0 => {
            return Err(context.error_with(
                &n.span,
                "every counts steps from 1",
                "leave it out to get the last state only",
            ));
        }
        other => other.as_ref().map(|n| n.value),
    };
    let averaged = averaged(context, written)?;
    if let Some(film) = written.film.as_ref().filter(|f| f.value.0.is_some()) {
        if written.grid.is_none() {
            return Err(context.error_with(
                &film.span,
                "a film is one of the slice of a grid",
                "write grid = [40, 40], or leave film out",
            ));
        }
        if every.is_none() {
            return Err(context.error_with(
                &film.span,
                "a film has frames",
                "write every = 10, the steps between them, or leave film out",
            ));
        }
    }
    Ok(FieldsSpec {
        name: name.into(),
        shape: shape(context, written.kernel.value, written.smoothness.as_ref())?,
        width: context.value(&written.width)?,
        averaged,
        place: place(context, at, averaged)?,
        choice: choice(context, written, atoms)?,
        every,
        skip: written.skip.unwrap_or(0),
        each: written.each,
        film: written.film.as_ref().and_then(|f| f.value.0),
        pressure: written.pressure,
        coordinate: written.coordinate,
        residuals: written.residuals.unwrap_or(16),
    })
}

/// Nodes that carry atoms along.
pub(super) fn smooth(context: &Context, written: &At<Smooth>) -> Result<SmoothSpec> {
    let at = &written.value;
    let shape = shape(context, at.kernel.value, at.smoothness.as_ref())?;
    let width = context.value(&at.width)?;
    let kernel =
        Kernel::new(shape, width).map_err(|e| context.error(&written.span, e.to_string()))?;
    Ok(SmoothSpec {
        width,
        reach: kernel.radius(),
        spacing: { at.spacing.as_ref() }
            .map(|s| context.value(s))
            .transpose()?,
        window: Window::new(move |d| kernel.value(d)),
    })
}

/// A localization function.
fn shape(context: &Context, kernel: KernelName, smoothness: Option<&At<u32>>) -> Result<Shape> {
    if let Some(n) = smoothness {
        if kernel != KernelName::Polynomial {
            return Err(context.error_with(
                &n.span,
                "smoothness is one of polynomials",
                "write kernel = \"polynomial\", or leave it out",
            ));
        }
        if n.value > Shape::SMOOTHEST {
            return Err(context.error(
                &n.span,
                format!(
                    "polynomials have a smoothness of 0 to {}, not {}",
                    Shape::SMOOTHEST,
                    n.value
                ),
            ));
        }
    }
    Ok(match kernel {
        KernelName::Polynomial => Shape::Polynomial(smoothness.map_or(3, |n| n.value)),
        KernelName::Bspline => Shape::CubicSpline,
        KernelName::Quartic => Shape::QuarticSpline,
        KernelName::Gaussian => Shape::Gaussian,
        KernelName::Step => Shape::Polynomial(0),
        KernelName::Cell => Shape::Cell,
    })
}

fn averaged(context: &Context, written: &Fields) -> Result<[bool; 3]> {
    let mut averaged: [bool; 3] = std::array::from_fn(|a| a >= context.dimension);
    let Some(axes) = &written.average else {
        return Ok(averaged);
    };
    for axis in &axes.value {
        let a = match axis.value {
            AxisName::X => 0,
            AxisName::Y => 1,
            AxisName::Z => 2,
        };
        if a >= context.dimension {
            let name = ["x", "y", "z"][a];
            return Err(context.error(
                &axis.span,
                format!("there is no {name} in {}-D", context.dimension),
            ));
        }
        averaged[a] = true;
    }
    if averaged == [true; 3] {
        return Err(context.error_with(
            &axes.span,
            "one axis must be left that is not averaged over",
            "leave one out",
        ));
    }
    Ok(averaged)
}

fn place(context: &Context, at: &At<Fields>, averaged: [bool; 3]) -> Result<Place> {
    let written = &at.value;
    let given = [
        ("grid", written.grid.is_some()),
        ("points", written.points.is_some()),
        ("line", written.line.is_some()),
        ("plane", written.plane.is_some()),
    ];
    context.one_of(&at.span, "[[fields]]", &given)?;
    if let (Some(corners), None) = (&written.corners, &written.grid) {
        return Err(context.error_with(
            &corners.span,
            "corners are those of the box that a grid divides",
            "remove them, or write grid",
        ));
    }
    let vector = |v: &Vector<Length>| context.finite_vector(v);
    let several = |n: &At<usize>| match n.value {
        0 => Err(context.error(&n.span, "at least one point")),
        n => Ok(n),
    };
    let fits = |span: &Range<usize>, points: f64| {
        affordable(points).map_err(|e| context.error(span, e.to_string()))
    };
    if let Some(grid) = &written.grid {
        return self::grid(context, written, grid, averaged);
    }
    if let Some(points) = &written.points {
        if points.value.is_empty() {
            return Err(context.error(&points.span, "at least one point"));
        }
        let all = points.value.iter().map(vector);
        return Ok(Place::Points(all.collect::<Result<_>>()?));
    }
    let made = match (&written.line, &written.plane) {
        (Some(line), _) => {
            let line = &line.value;
            fits(&line.count.span, line.count.value as f64)?;
            Targets::line(
                vector(&line.from)?,
                vector(&line.to)?,
                several(&line.count)?,
            )
        }
        (None, Some(plane)) => {
            let plane = &plane.value;
            let [a, b] = &plane.edges.value[..] else {
                return Err(context.error(&plane.edges.span, "a parallelogram has two edges"));
            };
            if plane.counts.value.contains(&0) {
                return Err(context.error(&plane.counts.span, "at least one point"));
            }
            let [n, m] = plane.counts.value;
            fits(&plane.counts.span, n as f64 * m as f64)?;
            let edges = [vector(a)?, vector(b)?];
            Targets::plane(vector(&plane.corner)?, edges, plane.counts.value)
        }
        (None, None) => Targets::Points(vec![]),
    };
    Ok(match made {
        Targets::Points(points) => Place::Points(points),
        Targets::Grid(counts) => Place::Grid {
            counts,
            corners: None,
        },
    })
}

fn grid(
    context: &Context,
    written: &Fields,
    grid: &At<Vec<At<usize>>>,
    averaged: [bool; 3],
) -> Result<Place> {
    let d = context.dimension;
    if grid.value.len() != d {
        return Err(context.error(
            &grid.span,
            format!("a grid has {d} counts in {d}-D, not {}", grid.value.len()),
        ));
    }
    let mut counts = [1; 3];
    for (a, n) in grid.value.iter().enumerate() {
        counts[a] = n.value;
        let name = ["x", "y", "z"][a];
        if n.value == 0 {
            return Err(context.error(&n.span, format!("the grid has 0 points along {name}")));
        }
        if averaged[a] && n.value != 1 {
            return Err(context.error_with(
                &n.span,
                format!("{name} is averaged over: the grid has 1 point along it"),
                "write 1",
            ));
        }
    }
    let Some(written) = &written.corners else {
        return Ok(Place::Grid {
            counts,
            corners: None,
        });
    };
    let [a, b] = &written.value[..] else {
        return Err(context.error_with(
            &written.span,
            "a box has two opposite corners",
            "write for example corners = [[0, 0], [\"10 mm\", \"5 mm\"]]",
        ));
    };
    let [a, b] = [context.finite_vector(a)?, context.finite_vector(b)?];
    if let Some(axis) = (0..d).find(|axis| a[*axis] == b[*axis]) {
        let name = ["x", "y", "z"][axis];
        return Err(context.error(&written.span, format!("the box has no length along {name}")));
    }
    Ok(Place::Grid {
        counts,
        corners: Some([
            std::array::from_fn(|n| a[n].min(b[n])),
            std::array::from_fn(|n| a[n].max(b[n])),
        ]),
    })
}

fn choice(context: &Context, written: &Fields, atoms: bool) -> Result<Option<Choice>> {
    let partition = match &written.partition {
        None => Partition::Site,
        Some(at) => match &at.value {
            Or::Bare(PartitionName::Site) => Partition::Site,
            Or::Bare(PartitionName::Equal) => Partition::Equal,
            Or::Table(Centre { centre }) => Partition::Centre(context.value(centre)?),
        },
    };
    let pair_force = match written.pair_force.as_ref().map(|p| p.value) {
        None | Some(PairForceName::Distances) => PairForce::Distances,
        Some(PairForceName::Differences) => PairForce::Differences,
    };
    if atoms {
        return Ok(Some(Choice {
            partition,
            pair_force,
            parts: written.parts.as_ref().is_some_and(|p| p.value),
        }));
    }
    let chosen = [
        (
            written.partition.as_ref().map(|p| &p.span),
            !matches!(partition, Partition::Site),
            "the energy of a point of a peridynamic body is its own",
            "write partition = \"site\", or leave it out",
        ),
        (
            written.pair_force.as_ref().map(|p| &p.span),
            pair_force != PairForce::Differences,
            "the forces of a peridynamic body's bonds are those of its force states",
            "write pair_force = \"differences\", or leave it out",
        ),
        (
            written.parts.as_ref().map(|p| &p.span),
            written.parts.as_ref().is_some_and(|p| p.value),
            "a peridynamic body has no parts of a potential",
            "leave parts out",
        ),
    ];
    for (span, another, message, help) in chosen {
        if let Some(span) = span.filter(|_| another) {
            return Err(context.error_with(span, message, help));
        }
    }
    Ok(None)
}
