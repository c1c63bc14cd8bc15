//! What clouds bring with their points: densities and velocities.

use crate::body::Body;
use crate::space::Point;
use crate::spec::{BodySpec, Cloud, Spec};

/// The clouds of a spec, each with the ids of its points.
fn clouds<'a, const D: usize>(
    spec: &'a Spec,
    body: &Body<D>,
) -> Vec<(&'a Cloud, std::ops::Range<usize>)> {
    let cloud = |b: &'a BodySpec| match b {
        BodySpec::Cloud(cloud) => Some(cloud),
        BodySpec::Lattice { .. } | BodySpec::Sites { .. } | BodySpec::Several(_) => None,
    };
    match &spec.body {
        BodySpec::Several(pieces) => {
            let all = pieces.iter().zip(body.ids());
            all.filter_map(|(p, ids)| Some((cloud(&p.body)?, ids)))
                .collect()
        }
        one => cloud(one)
            .map(|c| (c, 0..body.all_points()))
            .into_iter()
            .collect(),
    }
}

/// Points of a cloud that brings densities have those.
pub(super) fn own_densities<const D: usize>(spec: &Spec, body: &mut Body<D>) {
    let mut density: Vec<f64> = vec![];
    for (cloud, ids) in clouds(spec, body) {
        if !cloud.density.is_empty() {
            if density.is_empty() {
                density = body
                    .slots()
                    .iter()
                    .map(|s| body.density().at(*s as usize))
                    .collect();
            }
            density[ids].copy_from_slice(&cloud.density);
        }
    }
    if !density.is_empty() {
        body.set_densities(&density);
    }
}

/// Velocities that clouds bring to points that are here; `None`: they bring none.
pub(super) fn own_velocities<const D: usize>(spec: &Spec, body: &Body<D>) -> Option<Vec<Point>> {
    let mut velocity = vec![];
    for (cloud, ids) in clouds(spec, body) {
        if !cloud.velocity.is_empty() {
            velocity.resize(body.all_points(), [0.0; 3]);
            velocity[ids].copy_from_slice(&cloud.velocity);
        }
    }
    let here = |all: Vec<Point>| {
        (0..body.points())
            .map(|id| all[body.id_of_all(id)])
            .collect()
    };
    (!velocity.is_empty()).then(|| here(velocity))
}
