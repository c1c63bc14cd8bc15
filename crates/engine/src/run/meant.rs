//! Where a body is likely not what its spec means: cells that stick out of a region, tractions that act several times.

use crate::body::{Body, Layout};
use crate::message;
use crate::quantity::{Dimension, Message};
use crate::space::region::Region;
use crate::spec::{BodySpec, ConditionKind, Spec};

/// Part of a spacing that counts as nothing.
const TOLERANCE: f64 = 1e-6;
/// Of the points under a traction more than this part inside the body: it is deeper than a layer, corners aside.
const INSIDE: f64 = 0.4;

/// The box that a region begins with.
fn block(region: &Region) -> Option<[[f64; 3]; 2]> {
    match region {
        Region::Block { low, high } => Some([*low, *high]),
        Region::Difference(from, _) => block(from),
        Region::Everything
        | Region::Cylinder { .. }
        | Region::Sphere { .. }
        | Region::HalfSpace { .. }
        | Region::Union(_)
        | Region::Intersection(_) => None,
    }
}

/// Points stand for cells. Cells of a box either fill it, or its faces go through points; in between, the body is longer or shorter
/// than its region.
pub(super) fn regions(spec: &Spec) -> Vec<Message> {
    let bodies: Vec<(&str, &BodySpec)> = match &spec.body {
        BodySpec::Several(pieces) => pieces.iter().map(|p| (p.name.as_str(), &p.body)).collect(),
        one => vec![("", one)],
    };
    let told = bodies.into_iter().filter_map(|(name, body)| {
        let BodySpec::Lattice {
            kind,
            spacing,
            origin,
            region,
            perturb: None,
        } = body
        else {
            return None;
        };
        // a face of others goes through some of the points of a cell
        if kind.basis().len() > 1 {
            return None;
        }
        let [low, high] = block(region)?;
        (0..spec.dimension).find_map(|a| {
            if spec.periodic[a].is_some() || !(low[a].is_finite() && high[a].is_finite()) {
                return None;
            }
            let sites = |x: f64| (x - origin[a]) / spacing;
            // the first and the last point, in spacings from the origin
            let first = (sites(low[a]) - TOLERANCE).ceil();
            let last = (sites(high[a]) + TOLERANCE).floor();
            let count = last - first + 1.0;
            // filled, or with faces through points
            let longer = count - (high[a] - low[a]) / spacing;
            let whole = |x: f64| (longer - x).abs() < TOLERANCE;
            if count < 1.0 || [0.0, 0.5, 1.0].into_iter().any(whole) {
                return None;
            }
            let axis = ["x", "y", "z"][a];
            let place = |n: f64| Dimension::LENGTH.of(origin[a] + n * spacing);
            let of = match name {
                "" => "the region".to_string(),
                name => format!("the region of body `{name}`"),
            };
            Some(message![
                format!("along {axis} {of} is "),
                Dimension::LENGTH.of(high[a] - low[a]),
                " long, and its body ",
                Dimension::LENGTH.of(count * spacing),
                format!(": {count} cells of "),
                Dimension::LENGTH.of(*spacing),
                ", from ",
                place(first - 0.5),
                " to ",
                place(last + 0.5),
                ". A region that is a whole number of spacings, with origin half a spacing inside it, is filled",
            ])
        })
    });
    told.collect()
}

/// A traction counts a face for each point of its set, where no area is given.
pub(super) fn tractions<const D: usize>(
    spec: &Spec,
    body: &Body<D>,
    sets: &[(String, Vec<u32>)],
) -> Vec<Message> {
    let Layout::Grid(grid) = &body.layout else {
        return vec![];
    };
    // neighbours along the axes of the cell are those of other lattices only in part
    if grid.basis() > 1 {
        return vec![];
    }
    let inside = |id: &&u32| {
        let slot = body.slots[**id as usize] as usize;
        (0..D).all(|a| {
            [-1, 1].into_iter().all(|way| {
                let step = std::array::from_fn(|b| if a == b { way } else { 0 });
                grid.neighbour(slot, step, 0).is_some()
            })
        })
    };
    let told = spec.conditions.iter().filter_map(|condition| {
        let ConditionKind::Traction { area: None, .. } = &condition.kind else {
            return None;
        };
        let (name, members) = sets.iter().find(|(name, _)| *name == condition.set)?;
        let deep = members.iter().filter(inside).count();
        (deep as f64 > INSIDE * members.len() as f64).then(|| {
            Message::from(format!(
                "the traction on `{name}` counts a face for each of its {} points, of which {deep} are inside the body: a set of one layer at the surface, or `area`, makes it the traction of that surface",
                members.len()
            ))
        })
    });
    told.collect()
}
