//! Named sets, the materials and the initial state of the points in them.

use super::feasible::possible;
use super::names::Names;
use super::parts::parts;
use super::reference::SplitMix;
use super::system::System;
use crate::body::Body;
use crate::error::BuildError;
use crate::message;
use crate::quantity::{Dimension, Message};
use crate::space::lattice::Lattice;
use crate::space::{AXES, Point};
use crate::spec::{BodySpec, Carriers, Members, Spec};

/// Does a point (index, reference position) belong?
type Member<'a> = Box<dyn Fn(usize, &Point) -> bool + 'a>;

/// Named sets and the numbers of their points.
pub(super) type Sets = Vec<(String, Vec<u32>)>;

/// Point ids of every named set, and its points among those that carry loads. A set may have points of the one kind only.
pub(super) fn sets<const D: usize>(
    spec: &Spec,
    body: &Body<D>,
    carriers: Option<&Carriers<D>>,
) -> Result<(Sets, Sets), BuildError> {
    let (mut out, mut carried) = (vec![], vec![]);
    for set in &spec.sets {
        let belongs = member(spec, body, &set.name, &set.members, 0, body.spacing())?;
        let ids: Vec<u32> = body
            .slots()
            .iter()
            .enumerate()
            .filter(|(id, s)| belongs(*id, &body.position(**s as usize)))
            .map(|(id, _)| id as u32)
            .collect();
        let mut loaded: Vec<u32> = vec![];
        let by_place = match &set.members {
            Members::All | Members::Region(_) | Members::Where(_) => true,
            Members::Mark(_)
            | Members::Basis(_)
            | Members::Points(_)
            | Members::Random { .. }
            | Members::Outside(_)
            | Members::Within { .. } => false,
        };
        if let Some(carriers) = carriers
            && by_place
        {
            let belongs = member(spec, body, &set.name, &set.members, 0, carriers.spacing)?;
            let at = |p: &usize| {
                let x = &carriers.position[*p];
                crate::array::from_fn(|a| if a < D { x[a] } else { 0.0 })
            };
            let points = (0..carriers.points()).filter(|p| belongs(*p, &at(p)));
            loaded = points.map(|p| p as u32).collect();
        }
        // another rank may have its points
        if ids.is_empty() && loaded.is_empty() && body.subdomain().is_none() {
            return Err(BuildError::empty(
                format!("sets.{}", set.name),
                format!("set `{}` has no points", set.name),
            )
            .help(extent(body)));
        }
        out.push((set.name.clone(), ids));
        carried.push((set.name.clone(), loaded));
    }
    Ok((out, carried))
}

/// Where the points of a body are, for somebody who missed them all.
fn extent<const D: usize>(body: &Body<D>) -> Message {
    let mut told = Message::from("points lie at ");
    for a in 0..D {
        let all = body.slots().iter().map(|s| body.position(*s as usize)[a]);
        let (low, high) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| {
            (l.min(x), h.max(x))
        });
        let comma = if a == 0 { "" } else { ", " };
        told = message![
            told,
            format!("{comma}{} from ", AXES[a]),
            Dimension::LENGTH.of(low),
            " to ",
            Dimension::LENGTH.of(high),
        ];
    }
    message![told, "; numbers without a unit are in those of the deck"]
}

/// The test of a set; `first` is the id of the first point that places count from, `spacing` that of the points.
fn member<'a, const D: usize>(
    spec: &'a Spec,
    body: &'a Body<D>,
    set: &str,
    members: &'a Members,
    first: usize,
    spacing: f64,
) -> Result<Member<'a>, BuildError> {
    Ok(match members {
        Members::All => Box::new(|_, _| true),
        Members::Region(region) => {
            let slack = 1e-9 * spacing;
            Box::new(move |_, x| region.contains(x) || near(region, x, slack))
        }
        Members::Where(condition) => Box::new(|_, x| condition.eval(x, 0.0) != 0.0),
        Members::Mark(mark) => {
            Box::new(|id, _| body.marks().get(id).copied().unwrap_or(0) == *mark)
        }
        Members::Basis(sites) => {
            let (BodySpec::Lattice {
                kind,
                spacing,
                origin,
                perturb: None,
                ..
            }
            | BodySpec::Sites {
                kind,
                spacing,
                origin,
                ..
            }) = &spec.body
            else {
                let message = format!(
                    "set `{set}` is of sites of a cell, and the body is no lattice, or a perturbed one"
                );
                return Err(BuildError::conflict(format!("sets.{set}"), message));
            };
            let lattice = Lattice {
                kind: *kind,
                spacing: *spacing,
                origin: *origin,
            };
            let basis = kind.basis();
            if let Some(n) = sites.iter().find(|n| **n >= basis.len()) {
                let message = format!(
                    "set `{set}` is of site {}; the cell of a {} lattice has {}",
                    n + 1,
                    kind.name(),
                    basis.len()
                );
                return Err(BuildError::invalid(format!("sets.{set}"), message));
            }
            Box::new(move |_, x| {
                let quarter = lattice.quarter(x).map(|q| q.rem_euclid(4));
                sites.iter().any(|n| basis[*n] == quarter)
            })
        }
        Members::Points(ids) => {
            let place = move |id: usize| id.checked_sub(first).map(|n| n as u32);
            Box::new(move |id, _| place(id).is_some_and(|n| ids.binary_search(&n).is_ok()))
        }
        Members::Random { part, seed } => {
            if !(0.0..=1.0).contains(part) {
                let message = format!("the part is {part}, expected a number from 0 to 1");
                return Err(BuildError::invalid(format!("sets.{set}"), message));
            }
            let drawn = drawn(body.points(), *part, *seed);
            Box::new(move |id, _| drawn[id])
        }
        Members::Outside(names) => {
            let mut others = vec![];
            for name in names {
                let Some(other) = spec.sets.iter().find(|s| s.name == *name) else {
                    return Err(BuildError::unknown(
                        format!("sets.{set}"),
                        name,
                        format!("set `{set}` is outside of `{name}`, which does not exist"),
                    ));
                };
                if matches!(other.members, Members::Outside(_)) {
                    let message = format!("`{set}` and `{name}` are both what others leave");
                    return Err(BuildError::conflict(format!("sets.{set}"), message));
                }
                others.push(member(spec, body, name, &other.members, first, spacing)?);
            }
            Box::new(move |id, x| others.iter().all(|o| !o(id, x)))
        }
        Members::Within {
            body: name,
            members,
        } => {
            let named = match &spec.body {
                BodySpec::Several(pieces) => pieces.iter().position(|p| p.name == *name),
                BodySpec::Lattice { .. } | BodySpec::Sites { .. } | BodySpec::Cloud(_) => None,
            };
            let Some(ids) = named.and_then(|n| body.ids().into_iter().nth(n)) else {
                return Err(BuildError::unknown(
                    format!("sets.{set}"),
                    name,
                    format!("set `{set}` is of the body `{name}`, which does not exist"),
                ));
            };
            let inner = member(spec, body, set, members, ids.start, spacing)?;
            Box::new(move |id, x| ids.contains(&id) && inner(id, x))
        }
    })
}

/// Which of so many points are drawn.
fn drawn(points: usize, part: f64, seed: u64) -> Vec<bool> {
    let mut random = SplitMix(seed);
    let numbers: Vec<f64> = (0..points).map(|_| random.unit()).collect();
    let mut order: Vec<usize> = (0..points).collect();
    order.sort_by(|a, b| numbers[*a].total_cmp(&numbers[*b]));
    let mut drawn = vec![false; points];
    let count = (part * points as f64).round() as usize;
    order[..count].iter().for_each(|n| drawn[*n] = true);
    drawn
}

/// Points within round-off of a region's boundary belong to it.
fn near(region: &crate::space::region::Region, x: &Point, slack: f64) -> bool {
    (0..3).any(|a| {
        [-slack, slack].into_iter().any(|d| {
            let mut y = *x;
            y[a] += d;
            region.contains(&y)
        })
    })
}

pub(super) fn assign_materials<const D: usize>(
    spec: &Spec,
    body: &mut Body<D>,
    sets: &[(String, Vec<u32>)],
) -> Result<(), BuildError> {
    let materials = &spec.materials;
    if let [only] = materials.as_slice()
        && only.set == "all"
    {
        body.set_density(only.density);
        return Ok(());
    }
    if materials.len() > u8::MAX as usize {
        return Err(BuildError::too_many(
            "materials",
            format!("{} materials; at most 255", materials.len()),
        ));
    }
    let mut of: Vec<Option<u8>> = vec![None; body.points()];
    for (n, m) in materials.iter().enumerate() {
        let all: Vec<u32>;
        let ids = if m.set == "all" {
            all = (0..body.points() as u32).collect();
            &all
        } else {
            let Some((_, ids)) = sets.iter().find(|(name, _)| *name == m.set) else {
                return Err(BuildError::unknown(
                    format!("materials[{n}].set"),
                    &m.set,
                    format!(
                        "material `{}` is on set `{}`, which does not exist",
                        m.name, m.set
                    ),
                ));
            };
            ids
        };
        for &id in ids {
            if let Some(other) = of[id as usize].replace(n as u8) {
                let x = body.position(body.slots()[id as usize] as usize);
                return Err(BuildError::conflict(
                    format!("materials[{n}].set"),
                    format!(
                        "point {} at {x:?} belongs to material `{}` and to material `{}`",
                        id + 1,
                        materials[other as usize].name,
                        m.name
                    ),
                )
                .help("make the materials' sets disjoint"));
            }
        }
    }
    if let Some(id) = of.iter().position(Option::is_none) {
        let x = body.position(body.slots()[id] as usize);
        return Err(BuildError::missing(
            "materials",
            format!("point {} at {x:?} belongs to no material", id + 1),
        )
        .help("make the materials' sets cover the body"));
    }
    let of_points = of.iter().map(|m| m.unwrap_or(0));
    let density: Vec<f64> = of_points
        .clone()
        .map(|m| materials[m as usize].density)
        .collect();
    body.give_materials(of_points);
    body.set_densities(&density);
    if body.marks().is_empty() {
        body.set_marks(of.iter().map(|m| i32::from(m.unwrap_or(0))).collect());
    }
    Ok(())
}

/// Every point of the body of a spec: where it is in the reference, and its material by its place in the spec.
///
/// # Errors
/// There are no such points, or their sets do not cover them.
pub fn materials_of(spec: &Spec) -> Result<Vec<(Point, usize)>, BuildError> {
    possible(spec, None)?;
    match spec.space.dimension {
        1 => of_points::<1>(spec),
        2 => of_points::<2>(spec),
        _ => of_points::<3>(spec),
    }
}

/// Materials of each of several bodies, by their place in the spec; of a single one none.
///
/// # Errors
/// As of [`materials_of`].
pub fn materials_of_bodies(spec: &Spec) -> Result<Vec<Vec<usize>>, BuildError> {
    let all = materials_of(spec)?;
    match spec.space.dimension {
        1 => of_bodies::<1>(spec, &all),
        2 => of_bodies::<2>(spec, &all),
        _ => of_bodies::<3>(spec, &all),
    }
}

fn of_bodies<const D: usize>(
    spec: &Spec,
    all: &[(Point, usize)],
) -> Result<Vec<Vec<usize>>, BuildError> {
    let ids = parts::<D>(spec)?.1.ids();
    let each = ids.into_iter().map(|ids| {
        let mut of: Vec<usize> = all[ids].iter().map(|(_, m)| *m).collect();
        of.sort_unstable();
        of.dedup();
        of
    });
    Ok(each.collect())
}

fn of_points<const D: usize>(spec: &Spec) -> Result<Vec<(Point, usize)>, BuildError> {
    let (_, mut body) = parts::<D>(spec)?;
    let sets = sets(spec, &body, None)?.0;
    assign_materials(spec, &mut body, &sets)?;
    let slots = body.slots().iter().map(|s| *s as usize);
    Ok(slots
        .map(|s| (body.position(s), body.material_of(s)))
        .collect())
}

/// Displacements and velocities at the start.
pub(super) fn initial<const D: usize>(
    spec: &Spec,
    names: &Names<D>,
    system: &mut System<D>,
) -> Result<(), BuildError> {
    for (n, init) in spec.loading.initial.iter().enumerate() {
        let members = system.body.slots_of(&init.set, &names.sets);
        let (slots, points) = members.map_err(|e| e.at(format!("initial[{n}].set")))?;
        if slots.is_empty() && names.carriers.is_some() {
            return Err(BuildError::empty(
                format!("initial[{n}].set"),
                format!("no point of `{}` was retained", init.set),
            ));
        }
        for a in 0..D {
            for (field, e) in [
                (&mut system.u[a], &init.displacement[a]),
                (&mut system.v[a], &init.velocity[a]),
            ] {
                let Some(e) = e else { continue };
                for (s, x) in slots.iter().zip(&points) {
                    let value = e.eval(x, 0.0);
                    if !value.is_finite() {
                        return Err(BuildError::invalid(
                            format!("initial[{n}]"),
                            format!("`{}` is {value} at {x:?}", e.source()),
                        ));
                    }
                    field[*s as usize] = value;
                }
            }
        }
    }
    Ok(())
}
