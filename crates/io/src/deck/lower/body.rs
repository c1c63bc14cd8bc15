//! Bodies, regions, sets and periods.

use super::Files;
use super::context::{Context, Result};
use crate::deck::document::LatticeName;
use crate::deck::document::{Body, Mark, Periodic, Set, Shape};
use crate::deck::error::nearest;
use crate::deck::units::{Dim, short};
use crate::deck::value::{At, Or, Vector};
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::{BodySpec, Cloud, Members, Perturbation, SetSpec};
use std::collections::BTreeMap;
use std::ops::Range;

const INF: f64 = f64::INFINITY;

impl From<LatticeName> for LatticeKind {
    fn from(name: LatticeName) -> Self {
        match name {
            LatticeName::Chain => LatticeKind::Chain,
            LatticeName::Square => LatticeKind::Square,
            LatticeName::Triangular => LatticeKind::Triangular,
            LatticeName::Cubic => LatticeKind::Cubic,
            LatticeName::Bcc => LatticeKind::Bcc,
            LatticeName::Fcc => LatticeKind::Fcc,
            LatticeName::Diamond => LatticeKind::Diamond,
        }
    }
}

/// Reads the body and settles the dimension of `context`; cells of a 2-D mesh still have areas as volumes.
pub(super) fn body(
    context: &mut Context,
    body: &At<Body>,
    given_dimension: Option<&At<usize>>,
    files: &Files,
) -> Result<BodySpec> {
    let written = &body.value;
    let given = [
        ("lattice", written.lattice.is_some()),
        ("file", written.file.is_some()),
    ];
    let (spec, natural) = match context.one_of(&body.span, "the body", &given)? {
        0 => (
            None,
            written
                .lattice
                .as_ref()
                .map(|l| LatticeKind::from(l.value).dimension()),
        ),
        _ => {
            let points = files.read(context, written)?;
            context.atoms = points.atoms;
            context.micromoduli = points.micromoduli;
            let notes = points.notes.into_iter();
            let name = written.file.as_ref().map_or("", |f| &f.value);
            context.notes.extend(notes.map(|n| format!("{name}: {n}")));
            (Some(points.cloud), points.dimension)
        }
    };
    context.dimension = dimension(context, given_dimension, natural, written.lattice.is_some())?;
    if let (Some(_), Some(unit)) = (&written.lattice, &written.file_unit) {
        return Err(context.error(
            &unit.span,
            "file_unit belongs to a file; a lattice has its spacing",
        ));
    }
    if let (Some(_), Some(step)) = (&written.lattice, &written.file_step) {
        return Err(context.error(&step.span, "file_step belongs to a file with frames"));
    }
    match (&written.lattice, spec) {
        (Some(kind), _) => lattice(context, body, LatticeKind::from(kind.value)),
        (None, Some(mut cloud)) => {
            if let Some(lost) = written
                .origin
                .as_ref()
                .map(|o| &o.span)
                .or(written.region.as_ref().map(|r| &r.span))
            {
                return Err(context.error(
                    lost,
                    "origin and region belong to a lattice; a file brings its points",
                ));
            }
            if let Some(perturb) = &written.perturb {
                return Err(
                    context.error(&perturb.amplitude.span, "only a lattice can be perturbed")
                );
            }
            if let Some(spacing) = &written.spacing {
                cloud.spacing = Some(context.positive(spacing, Dim::LENGTH, "the spacing")?);
            }
            if context.micromoduli.is_some()
                && let Some(unit) = &written.file_unit
            {
                return Err(context.error(
                    &unit.span,
                    "a linear body is in the units of its deck: file_unit cannot change its micromoduli",
                ));
            }
            let density = match context.micromoduli {
                Some(_) => 1.0,
                None => context.units.plain_factor(Dim::DENSITY),
            };
            cloud.density.iter_mut().for_each(|d| *d *= density);
            if let Some(unit) = &written.file_unit {
                let unit = context.positive(unit, Dim::LENGTH, "the unit of the file")?;
                // areas of a 2-D mesh, volumes otherwise
                let power = if natural == Some(2) { 2 } else { 3 };
                cloud.position.iter_mut().flatten().for_each(|c| *c *= unit);
                cloud.volume.iter_mut().for_each(|v| *v *= unit.powi(power));
                if let Some(atoms) = &mut context.atoms {
                    atoms.corner = atoms.corner.map(|c| c * unit);
                    atoms.cell = atoms.cell.map(|c| c * unit);
                }
            }
            if let Some(atoms) = &mut context.atoms {
                let mass = context.units.plain_factor(Dim::MASS);
                atoms.mass = atoms.mass.map(|m| m * mass);
                if atoms.from_momenta {
                    let unit = context.units.ase_velocity();
                    cloud.velocity.iter_mut().flatten().for_each(|v| *v *= unit);
                }
            }
            Ok(BodySpec::Cloud(cloud))
        }
        (None, None) => Err(context.error(&body.span, "the body needs one of lattice, file")),
    }
}

fn dimension(
    context: &Context,
    given: Option<&At<usize>>,
    natural: Option<usize>,
    lattice: bool,
) -> Result<usize> {
    match (given, natural) {
        (None, natural) => Ok(natural.unwrap_or(3)),
        (Some(given), _) if !(1..=3).contains(&given.value) => Err(context.error(
            &given.span,
            format!("the dimension is 1, 2 or 3, not {}", given.value),
        )),
        (Some(given), Some(natural)) if given.value != natural => {
            let what = if lattice { "lattice" } else { "mesh" };
            Err(context.error(
                &given.span,
                format!("the {what} is {natural}-D, not {}-D", given.value),
            ))
        }
        (Some(given), _) => Ok(given.value),
    }
}

fn lattice(context: &Context, body: &At<Body>, kind: LatticeKind) -> Result<BodySpec> {
    let written = &body.value;
    let missing = |key: &str, example: &str| {
        context.error_with(
            &body.span,
            format!("a lattice body needs `{key}`"),
            format!("add {key} = {example}"),
        )
    };
    let spacing = written
        .spacing
        .as_ref()
        .ok_or_else(|| missing("spacing", "\"0.5 mm\""))?;
    let spacing = context.positive(spacing, Dim::LENGTH, "the spacing")?;
    let origin = written
        .origin
        .as_ref()
        .map_or(Ok([0.0; 3]), |o| context.finite_vector(o, Dim::LENGTH))?;
    let region = match (&written.region, &written.cells) {
        (Some(shape), None) => region(context, shape)?,
        (None, Some(cells)) => whole_cells(context, cells, kind, spacing, origin)?,
        (None, None) => return Err(missing("region", "{ block = { low = .., high = .. } }")),
        (Some(_), Some(cells)) => {
            return Err(context.error(&cells.span, "give one of region and cells"));
        }
    };
    let perturb = match &written.perturb {
        None => None,
        Some(perturb) => {
            let amplitude = context.finite(&perturb.amplitude, Dim::LENGTH)?;
            let half = 0.5 * spacing * kind.nearest();
            if !(0.0..half).contains(&amplitude) {
                let message = format!(
                    "the amplitude must lie between 0 and half the distance of points, {}",
                    context.units.write(half, Dim::LENGTH)
                );
                return Err(context.error(&perturb.amplitude.span, message));
            }
            Some(Perturbation {
                amplitude,
                seed: perturb.seed,
            })
        }
    };
    Ok(BodySpec::Lattice {
        kind,
        spacing,
        origin,
        region,
        perturb,
    })
}

/// The block of so many cells along each axis; its upper faces lie just below the next cells.
fn whole_cells(
    context: &Context,
    cells: &At<Vec<At<u32>>>,
    kind: LatticeKind,
    spacing: f64,
    origin: [f64; 3],
) -> Result<Region> {
    let d = context.dimension;
    if cells.value.len() != d {
        let message = format!("{} numbers of cells in {d}-D", cells.value.len());
        let example = ["cells = [100]", "cells = [20, 20]", "cells = [20, 20, 20]"][d - 1];
        return Err(context.error_with(&cells.span, message, format!("write {example}")));
    }
    let (mut low, mut high) = ([-INF; 3], [INF; 3]);
    for (a, n) in cells.value.iter().enumerate() {
        if n.value == 0 {
            return Err(context.error(&n.span, "no cells, no body"));
        }
        let edge = spacing * kind.edges()[a];
        low[a] = origin[a] - edge / 8.0;
        high[a] = origin[a] + edge * (f64::from(n.value) - 0.125);
    }
    Ok(Region::Block { low, high })
}

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

/// The named sets, and one for each named mark of the file that the deck does not name itself.
pub(super) fn sets(
    context: &Context,
    written: &BTreeMap<String, At<Set>>,
    body: &BodySpec,
) -> Result<Vec<SetSpec>> {
    let mut sets = Vec::new();
    for (name, set) in written {
        if name == "all" {
            return Err(context.error(
                &set.span,
                "the set \"all\" exists already: choose another name",
            ));
        }
        let given = [
            ("region", set.value.region.is_some()),
            ("mark", set.value.mark.is_some()),
            ("where", set.value.r#where.is_some()),
        ];
        context.one_of(&set.span, &format!("the set \"{name}\""), &given)?;
        let piece = match &set.value.body {
            Some(name) => Some(super::pieces::named(context, name, body)?),
            None => None,
        };
        let of = piece.map_or(body, |p| &p.body);
        if piece.is_some() && given.iter().all(|(_, given)| !given) {
            let help = "add region, mark or where; the body itself is a set of its name";
            return Err(context.error_with(&set.span, "all points of a body", help));
        }
        let members = match (&set.value.region, &set.value.mark, &set.value.r#where) {
            (Some(shape), _, _) => Members::Region(region(context, shape)?),
            (_, Some(mark), _) => marked(context, mark, of)?,
            (_, _, Some(text)) => Members::Where(context.expression(text, Dim::NUMBER)?),
            (None, None, None) => Members::All,
        };
        sets.push(SetSpec {
            name: name.clone(),
            members: match piece {
                Some(piece) => super::pieces::within(&piece.name, members),
                None => members,
            },
        });
    }
    if let BodySpec::Cloud(cloud) = body {
        for name in named(cloud) {
            if name != "all"
                && !written.contains_key(name)
                && let Some(members) = of_file(cloud, name)
            {
                sets.push(SetSpec {
                    name: name.to_string(),
                    members,
                });
            }
        }
    }
    Ok(sets)
}

/// Names of the file's sets and marks.
pub(super) fn named(cloud: &Cloud) -> Vec<&str> {
    let sets = cloud.sets.iter().map(|(name, _)| name.as_str());
    let mut names: Vec<&str> = sets.collect();
    for (_, name) in &cloud.names {
        if !names.contains(&name.as_str()) {
            names.push(name);
        }
    }
    names
}

/// The points that the file gives a name: a set knows all of them, a mark only those that have no other.
pub(super) fn of_file(cloud: &Cloud, name: &str) -> Option<Members> {
    let set = cloud.sets.iter().find(|(known, _)| known == name);
    let mark = || cloud.names.iter().find(|(_, known)| known == name);
    set.map(|(_, ids)| Members::Points(ids.clone()))
        .or_else(|| mark().map(|(mark, _)| Members::Mark(*mark)))
}

fn marked(context: &Context, mark: &At<Mark>, body: &BodySpec) -> Result<Members> {
    let cloud = match body {
        BodySpec::Cloud(cloud) => cloud,
        BodySpec::Several(_) => {
            return Err(context.error_with(
                &mark.span,
                "each of several bodies has marks of its own",
                "say whose: body = \"NAME\"",
            ));
        }
        BodySpec::Lattice { .. } | BodySpec::Sites { .. } => {
            return Err(context.error(&mark.span, "a lattice has no marks: say region instead"));
        }
    };
    match &mark.value {
        Mark::Number(number) => Ok(Members::Mark(*number)),
        Mark::Name(name) => of_file(cloud, name).ok_or_else(|| {
            let known = named(cloud);
            let help = match nearest(name, known.iter().copied()) {
                Some(near) => format!("did you mean \"{near}\"?"),
                None => format!(
                    "the file names: {}",
                    if known.is_empty() {
                        "none".into()
                    } else {
                        known.join(", ")
                    }
                ),
            };
            context.error_with(&mark.span, format!("the file has no mark \"{name}\""), help)
        }),
    }
}

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
    let mut wanted: Vec<(usize, Range<usize>, Option<f64>)> = Vec::new();
    match &written.value {
        Or::Bare(axes) => wanted.extend(
            axes.iter()
                .map(|axis| (axis.value as usize, axis.span.clone(), None)),
        ),
        Or::Table(periods) => {
            for (a, number) in [&periods.x, &periods.y, &periods.z].into_iter().enumerate() {
                if let Some(number) = number {
                    wanted.push((
                        a,
                        number.span.clone(),
                        Some(context.positive(number, Dim::LENGTH, "the period")?),
                    ));
                }
            }
        }
    }
    for (a, span, period) in wanted {
        let axis = ["x", "y", "z"][a];
        if a >= context.dimension {
            return Err(context.error(
                &span,
                format!("there is no {axis} in {}-D", context.dimension),
            ));
        }
        out[a] = Some(match body {
            BodySpec::Lattice {
                kind,
                spacing,
                region,
                ..
            } => {
                let (low, high) = region.bounds();
                let edge = *spacing * kind.edges()[a];
                let own = cells.and_then(|c| c.value.get(a));
                let own = own.map(|n| f64::from(n.value) * edge);
                let length = period.or(own).unwrap_or(high[a] - low[a]);
                let cells = length / edge;
                if !length.is_finite() || !low[a].is_finite() {
                    let help = "clip the region with a block along it";
                    return Err(context.error_with(
                        &span,
                        format!("the body has no end along {axis} to be a period"),
                        help,
                    ));
                }
                if (cells - cells.round()).abs() > 1e-6 || cells.round() < 1.0 {
                    let message =
                        format!("the period along {axis} is {} lattice cells", short(cells));
                    let help = format!(
                        "make it a whole number of cells of {}",
                        context.units.write(edge, Dim::LENGTH)
                    );
                    return Err(context.error_with(&span, message, help));
                }
                if own.is_some_and(|own| own == length) {
                    out[a] = Some(length);
                    continue;
                }
                let (mut from, mut to) = ([-INF; 3], [INF; 3]);
                (from[a], to[a]) = (low[a], low[a] + length - edge / 8.0);
                let whole = std::mem::replace(region, Region::Everything);
                *region = Region::Intersection(vec![
                    whole,
                    Region::Block {
                        low: from,
                        high: to,
                    },
                ]);
                length
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
