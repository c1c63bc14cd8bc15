//! Where a body is likely not what its spec means: not as large as its region, or not as long as its periods; sets that hold all.

use crate::body::{Body, Layout};
use crate::error::BuildError;
use crate::message;
use crate::quantity::{Dimension, Message, rounded};
use crate::space::AXES;
use crate::space::measure::{ends, measure};
use crate::space::region::Region;
use crate::spec::{BodySpec, Members, Spec};

/// Part of the volume of a region by which its body may be larger or smaller without a word.
const CLOSE: f64 = 0.01;
/// Part of a spacing that counts as nothing.
const TOLERANCE: f64 = 1e-6;
/// Spacings between the ends of a body and its images beyond which there is a gap, and below which cells lie in each other.
const GAP: f64 = 3.0;
const OVERLAP: f64 = 0.25;

/// The bodies of a spec, with their names and the points of each.
fn bodies<'a, const D: usize>(
    spec: &'a Spec,
    body: &'a Body<D>,
) -> Vec<(Option<&'a str>, &'a BodySpec, &'a Body<D>)> {
    match &spec.body {
        BodySpec::Several(pieces) => { pieces.iter().zip(body.pieces()) }
            .map(|(p, b)| (Some(p.name.as_str()), &p.body, &b.body))
            .collect(),
        one => vec![(None, one, body)],
    }
}

fn called(name: Option<&str>) -> String {
    name.map_or("the body".into(), |name| format!("body `{name}`"))
}

/// All that may not be meant.
pub(super) fn all<const D: usize>(
    spec: &Spec,
    body: &Body<D>,
    sets: &[(String, Vec<u32>)],
) -> Result<Vec<Message>, BuildError> {
    let mut told = regions(spec, body);
    told.extend(periods(spec, body)?);
    told.extend(self::sets(spec, body, sets));
    Ok(told)
}

/// Points stand for cells: are these as large as the region that they are to fill?
fn regions<const D: usize>(spec: &Spec, body: &Body<D>) -> Vec<Message> {
    // atoms are points
    if spec.potential().is_some() {
        return vec![];
    }
    let told = bodies(spec, body)
        .into_iter()
        .filter_map(|(name, from, body)| {
            let BodySpec::Lattice {
                spacing, region, ..
            } = from
            else {
                return None;
            };
            let wanted = measure(region, D, spec.space.periodic)?;
            let volume = { body.slots().iter() }.map(|s| body.volume().at(*s as usize));
            let found = body.sum(volume) / spec.space.section;
            let off = found / wanted - 1.0;
            if off.abs() <= CLOSE {
                return None;
            }
            let size = [Dimension::LENGTH, Dimension::AREA, Dimension::VOLUME][D - 1];
            let more = if off > 0.0 { "more" } else { "less" };
            let percent = rounded(100.0 * off.abs(), 2);
            Some(message![
                format!("{} holds ", called(name)),
                size.of(found),
                format!(", {percent} % {more} than its region of "),
                size.of(wanted),
                layers(spec, body, region, *spacing).unwrap_or("".into()),
                ". Without an origin cells fill the region, if it is a whole number of spacings",
            ])
        });
    told.collect()
}

/// Where the layers of cells of a box are, along the axis on which they fill it worst.
fn layers<const D: usize>(
    spec: &Spec,
    body: &Body<D>,
    region: &Region,
    spacing: f64,
) -> Option<Message> {
    let [low, high] = ends(region)?;
    let Layout::Grid(grid) = body.layout() else {
        return None;
    };
    let thick = |a: usize| {
        spacing * grid.lattice().kind.edges()[a] / f64::from(grid.lattice().kind.planes(a))
    };
    let along = (0..D)
        .filter(|a| spec.space.periodic[*a].is_none())
        .map(|a| {
            let all = body.slots().iter().map(|s| grid.position(*s as usize)[a]);
            let (first, last) = body.ends(all);
            let whole = last - first + thick(a);
            ((whole / (high[a] - low[a]) - 1.0).abs(), a, first, last)
        });
    let (off, a, first, last) = along.max_by(|x, y| x.0.total_cmp(&y.0))?;
    if off <= TOLERANCE {
        return None;
    }
    let half = 0.5 * thick(a);
    Some(message![
        format!(": along {} its cells reach from ", AXES[a]),
        Dimension::LENGTH.of(first - half),
        " to ",
        Dimension::LENGTH.of(last + half),
        ", the region from ",
        Dimension::LENGTH.of(low[a]),
        " to ",
        Dimension::LENGTH.of(high[a]),
    ])
}

/// Is a body of given points as long as its periods? Lattices are cut to theirs.
///
/// # Errors
/// A body is longer than a period: it lies in its own image.
fn periods<const D: usize>(spec: &Spec, body: &Body<D>) -> Result<Vec<Message>, BuildError> {
    let mut told = vec![];
    if spec.potential().is_some() || spec.micromoduli().is_some() {
        return Ok(told);
    }
    for (name, _, own) in bodies(spec, body) {
        let Layout::Cloud(x) = own.layout() else {
            continue;
        };
        for a in 0..D {
            let Some(period) = own.period()[a] else {
                continue;
            };
            let points = { own.slots().iter() }.map(|s| x[a][*s as usize]);
            let (low, high) = own.ends(points);
            let between = (period - (high - low)) / own.spacing();
            let said = |what: &str| {
                message![
                    format!("the period along {} is ", AXES[a]),
                    Dimension::LENGTH.of(period),
                    format!(", and the points of {} reach over ", called(name)),
                    Dimension::LENGTH.of(high - low),
                    format!(": {what}"),
                ]
            };
            if between <= TOLERANCE {
                return Err(BuildError::conflict(
                    "periodic",
                    said("the body lies in its own image"),
                )
                .help(message![
                    "write the length of the body with the cells of its points, about ",
                    Dimension::LENGTH.of(high - low + own.spacing()),
                    ", or the points of one period only",
                ]));
            }
            if between < OVERLAP {
                told.push(said("its last cells lie in those of its image"));
            } else if between > GAP && name.is_none() {
                let gap = rounded(between - 1.0, 2);
                told.push(said(&format!(
                    "there is a gap of {gap} spacings before its image"
                )));
            }
        }
    }
    Ok(told)
}

/// A condition on places that every point meets is likely one in other units.
fn sets<const D: usize>(spec: &Spec, body: &Body<D>, sets: &[(String, Vec<u32>)]) -> Vec<Message> {
    let told = spec.sets.iter().filter_map(|set| {
        let (members, count, of) = match &set.members {
            Members::Within { body: name, members } => {
                let of = bodies(spec, body).into_iter().find(|b| b.0 == Some(name))?;
                (&**members, of.2.all_points(), called(of.0))
            }
            all => (all, body.all_points(), called(None)),
        };
        let Members::Where(e) = members else {
            return None;
        };
        let (_, ids) = sets.iter().find(|(name, _)| *name == set.name)?;
        (count > 1 && body.count(ids.len() as u64) == count as u64).then(|| {
            Message::from(format!(
                "`{}` holds at every point: the set `{}` is all of {of}; are the numbers in it those of the deck's lengths?",
                e.source(),
                set.name
            ))
        })
    });
    told.collect()
}
