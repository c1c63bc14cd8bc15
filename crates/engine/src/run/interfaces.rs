//! Interfaces of a spec: which points of two bodies they bond, and by which law.

use super::calibration::cloud_moments;
use super::near::{Placed, points_near};
use super::reference::{cell, outlined};
use crate::body::Body;
use crate::constitutive::{Bulk, ConstitutiveModel, Registry};
use crate::error::BuildError;
use crate::execute::simd::Simd;
use crate::interaction::Interface;
use crate::law::micromodulus::Moments;
use crate::message;
use crate::quantity::Dimension;
use crate::space::cells::Cells;
use crate::spec::{Calibration, InterfaceSpec, PieceSpec, Spec};

/// An interface with its law, and places of the two bodies.
pub(super) struct Joined<const D: usize> {
    pub bodies: [usize; 2],
    pub model: ConstitutiveModel,
    pub interface: Interface<D>,
}

/// All interfaces between the bodies of `all`.
pub(super) fn interfaces<const D: usize>(
    spec: &Spec,
    pieces: &[PieceSpec],
    all: &Body<D>,
    registry: &Registry,
    simd: Simd,
) -> Result<Vec<Joined<D>>, BuildError> {
    let mut made: Vec<Joined<D>> = vec![];
    for (n, written) in spec.interactions.interfaces.iter().enumerate() {
        let joined = join(spec, pieces, all, registry, simd, written);
        let joined = joined.map_err(|e| named(n, written, e))?;
        let [a, b] = joined.bodies;
        if made
            .iter()
            .any(|m| m.bodies == [a, b] || m.bodies == [b, a])
        {
            return Err(BuildError::conflict(
                format!("interface[{n}].bodies"),
                format!(
                    "two interfaces join `{}` and `{}`",
                    pieces[a].name, pieces[b].name
                ),
            )
            .help("one interface joins two bodies"));
        }
        made.push(joined);
    }
    Ok(made)
}

fn join<const D: usize>(
    spec: &Spec,
    pieces: &[PieceSpec],
    all: &Body<D>,
    registry: &Registry,
    simd: Simd,
    written: &InterfaceSpec,
) -> Result<Joined<D>, BuildError> {
    let bodies = joined_by(pieces, written)?;
    // its law on a full family of the first body
    let mut own = of_first(spec, &pieces[bodies[0]], written);
    registry.resolve(&mut own)?;
    let full = outlined::<D>(&own)?;
    let spacings = bodies.map(|b| {
        let piece = &all.pieces()[b].body;
        cell(
            &Spec {
                body: pieces[b].body.clone(),
                ..own.clone()
            },
            piece,
        )
    });
    let spacing = 0.5 * (spacings[0] + spacings[1]);
    let mut moments = full.bulk;
    if let (None, Some(body), Calibration::Discrete) = (moments, &full.body, spec.bonds.calibration)
    {
        moments = cloud_moments(&own, body, full.horizon, spacings[0])?;
    }
    let continuum = || Moments::continuum(D, full.horizon, spec.space.section, written.influence);
    let bulk = Bulk {
        moments: moments.unwrap_or_else(continuum),
        // bonds between two bodies are on no lattice
        family: vec![],
    };
    let model =
        ConstitutiveModel::new::<D>(&own, None, full.horizon, spacing, bulk, registry, simd)?;
    let slots = near(all, bodies, model.reach());
    if slots.is_empty() {
        return Err(BuildError::empty(
            "horizon",
            message![
                format!("no point of `{}` is within its horizon ", written.bodies[0]),
                Dimension::LENGTH.of(full.horizon),
                format!(" of `{}`", written.bodies[1]),
            ],
        )
        .help("a longer horizon, or bodies that are nearer to each other"));
    }
    let position: Vec<[f64; 3]> = slots.iter().map(|s| all.home(*s as usize)).collect();
    let volume: Vec<f64> = slots.iter().map(|s| all.volume().at(*s as usize)).collect();
    let cloud = Body::from_cloud(&position, &volume, &[], spacing, all.period())?;
    let mut side = vec![0; cloud.len()];
    for (all_slot, slot) in slots.iter().zip(cloud.slots()) {
        side[*slot as usize] = all.piece_of(*all_slot as usize);
    }
    let bonds = model.interaction_across(&cloud, |i, j| side[i] != side[j])?;
    Ok(Joined {
        bodies,
        interface: Interface::new(all, cloud, slots, bonds),
        model,
    })
}

fn named(n: usize, written: &InterfaceSpec, e: BuildError) -> BuildError {
    let path = e.path.strip_prefix("materials[0].").unwrap_or(&e.path);
    BuildError {
        path: format!("interface[{n}].{path}"),
        message: message![format!("interface `{}`: ", written.name), e.message],
        ..e
    }
}

/// The two bodies that an interface joins.
fn joined_by(pieces: &[PieceSpec], written: &InterfaceSpec) -> Result<[usize; 2], BuildError> {
    let mut bodies = [0; 2];
    for (place, name) in bodies.iter_mut().zip(&written.bodies) {
        let Some(found) = pieces.iter().position(|p| p.name == *name) else {
            return Err(BuildError::unknown(
                "bodies",
                name,
                format!("there is no body `{name}`"),
            ));
        };
        *place = found;
    }
    if bodies[0] == bodies[1] {
        return Err(
            BuildError::invalid("bodies", "it joins a body with itself").help("name two bodies")
        );
    }
    Ok(bodies)
}

/// The first body as if it were made of what the bonds of an interface are.
fn of_first(spec: &Spec, first: &PieceSpec, written: &InterfaceSpec) -> Spec {
    let mut own = Spec {
        body: first.body.clone(),
        materials: vec![written.material()],
        ..spec.clone()
    };
    own.bonds.horizon = written.horizon;
    own.bonds.influence = written.influence;
    own.bonds.variable_horizon = None;
    own.interactions.pairs = vec![];
    own.interactions.contact = None;
    own.interactions.interfaces = vec![];
    own.damage.precracks = vec![];
    own
}

/// Points (ids in their order) that bonds of interfaces may have: ranks have copies of them. All ask at once.
pub(super) fn ends<const D: usize>(spec: &Spec, all: &Body<D>) -> Result<Vec<u32>, BuildError> {
    let (pieces, mut ends) = (spec.body.pieces(), vec![]);
    for (n, written) in spec.interactions.interfaces.iter().enumerate() {
        let named = |e| named(n, written, e);
        let bodies = joined_by(pieces, written).map_err(named)?;
        let own = of_first(spec, &pieces[bodies[0]], written);
        // none that is as near as its law says is left out by round-off
        let reach = 1.001 * outlined::<D>(&own).map_err(named)?.horizon;
        let (points, own) = points_near(all, reach, |n| bodies.contains(&n));
        let joined = is_near(&points, &all.period(), reach);
        let own = (0..own).filter(|i| joined[*i]).map(|i| points[i].0);
        ends.extend(all.all_of(&own.collect::<Vec<_>>()).concat());
    }
    ends.sort_unstable();
    ends.dedup();
    Ok(ends)
}

/// Slots of the points of two bodies that are within `reach` (length) of the other, in order of ids; of a part of them slots of copies, too.
fn near<const D: usize>(all: &Body<D>, bodies: [usize; 2], reach: f64) -> Vec<u32> {
    let of = all.slots_by_id().into_iter().map(|s| {
        let home = all.home(s as usize);
        let place = crate::array::from_fn(|a| home[a]);
        (s, all.piece_of(s as usize), place)
    });
    let of: Vec<Placed<D>> = of.filter(|of| bodies.contains(&of.1)).collect();
    let joined = is_near(&of, &all.period(), reach);
    let near = (0..of.len()).filter(|i| joined[*i]);
    near.map(|i| of[i].0).collect()
}

/// Which of these points are within `reach` (length) of one of another body.
fn is_near<const D: usize>(
    points: &[Placed<D>],
    period: &[Option<f64>; D],
    reach: f64,
) -> Vec<bool> {
    let x: [Vec<f64>; D] = crate::array::from_fn(|a| points.iter().map(|(.., x)| x[a]).collect());
    let slots: Vec<u32> = (0..points.len() as u32).collect();
    let mut found = vec![false; points.len()];
    if !points.is_empty() {
        let x = crate::array::from_fn(|a| x[a].as_slice());
        let cells = Cells::new(x, &slots, *period, reach);
        for (i, found) in found.iter_mut().enumerate() {
            cells.candidates(i, |j, square| {
                *found |= points[j as usize].1 != points[i].1 && square <= reach * reach;
            });
        }
    }
    found
}
