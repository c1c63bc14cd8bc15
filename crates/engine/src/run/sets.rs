//! Named sets, the materials and the initial state of the points in them.

use super::agreed::agreed;
use super::names::Names;
use super::parts::parts;
use super::reference::SplitMix;
use super::sanity::possible;
use super::system::System;
use crate::body::Body;
use crate::error::BuildError;
use crate::message;
use crate::quantity::{Dimension, Message};
use crate::space::lattice::Lattice;
use crate::space::{AXES, Point};
use crate::spec::{BodySpec, LoadMap, MaterialSpec, Members, Spec};

/// Does a point (id among all, reference position) belong?
type Member<'a> = Box<dyn Fn(usize, &Point) -> bool + 'a>;

/// Named sets and the numbers of their points.
pub(super) type Sets = Vec<(String, Vec<u32>)>;

/// Ids of the points here of every named set, and its points among those that carry loads. A set may have points of the one kind only.
pub(super) fn sets<const D: usize>(
    spec: &Spec,
    body: &Body<D>,
    load_map: Option<&LoadMap<D>>,
) -> Result<(Sets, Sets), BuildError> {
    let (mut out, mut kinematic) = (vec![], vec![]);
    for set in &spec.sets {
        let belongs = member(spec, body, &set.name, &set.members, 0, body.spacing())?;
        let ids: Vec<u32> = body
            .slots()
            .iter()
            .enumerate()
            .filter(|(id, s)| belongs(body.id_of_all(*id), &body.position(**s as usize)))
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
        if let Some(load_map) = load_map
            && by_place
        {
            let belongs = member(spec, body, &set.name, &set.members, 0, load_map.spacing)?;
            let at = |p: &usize| {
                let x = &load_map.position[*p];
                crate::array::from_fn(|a| if a < D { x[a] } else { 0.0 })
            };
            let points = (0..load_map.points()).filter(|p| belongs(*p, &at(p)));
            loaded = points.map(|p| p as u32).collect();
        }
        if loaded.is_empty() && body.count(ids.len() as u64) == 0 {
            return Err(BuildError::empty(
                format!("sets.{}", set.name),
                format!("set `{}` has no points", set.name),
            )
            .help(extent(body)));
        }
        out.push((set.name.clone(), ids));
        kinematic.push((set.name.clone(), loaded));
    }
    Ok((out, kinematic))
}

/// Where the points of a body are, for somebody who missed them all.
fn extent<const D: usize>(body: &Body<D>) -> Message {
    let mut told = Message::from("points lie at ");
    for a in 0..D {
        let all = body.slots().iter().map(|s| body.position(*s as usize)[a]);
        let (low, high) = body.ends(all);
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
            let drawn = Drawn::new(body.all_points(), *part, *seed);
            Box::new(move |id, _| drawn.holds(id))
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

/// Points that are drawn: those with the least numbers, of which each id has one, and of equal ones those with the least ids.
struct Drawn {
    seed: u64,
    /// The number and the id of the last of them.
    last: Option<(f64, usize)>,
}

impl Drawn {
    /// This part of so many points.
    fn new(points: usize, part: f64, seed: u64) -> Drawn {
        /// Equal ranges of numbers, so many that few numbers are in each.
        const RANGES: usize = 1 << 16;
        let range = |x: f64| (x * RANGES as f64) as usize;
        let number = |id: usize| SplitMix::number(seed, id as u64);
        let mut left = (part * points as f64).round() as usize;
        let mut counts = vec![0usize; RANGES];
        (0..points).for_each(|id| counts[range(number(id))] += 1);
        let last = counts.iter().position(|n| {
            let here = left <= *n;
            left -= if here { 0 } else { *n };
            here
        });
        let all = (0..points).map(|id| (number(id), id));
        let mut near: Vec<_> = all.filter(|(x, _)| Some(range(*x)) == last).collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let last = left.checked_sub(1).map(|n| near[n]);
        Drawn { seed, last }
    }

    fn holds(&self, id: usize) -> bool {
        let number = SplitMix::number(self.seed, id as u64);
        self.last.is_some_and(|last| (number, id) <= last)
    }
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
    let of_points = agreed(body, materials_of_points(materials, body, sets))?;
    let density: Vec<f64> = { of_points.iter() }
        .map(|m| materials[*m as usize].density)
        .collect();
    body.give_materials(of_points.iter().copied());
    body.set_densities(&density);
    if body.marks().is_empty() {
        body.set_marks(of_points.into_iter().map(i32::from).collect());
    }
    Ok(())
}

/// The material of each point that is here, by its place among these.
fn materials_of_points<const D: usize>(
    materials: &[MaterialSpec],
    body: &Body<D>,
    sets: &[(String, Vec<u32>)],
) -> Result<Vec<u8>, BuildError> {
    let point = |id: usize| {
        let x = body.position(body.slots()[id] as usize);
        format!("point {} at {x:?}", body.id_of_all(id) + 1)
    };
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
                return Err(BuildError::conflict(
                    format!("materials[{n}].set"),
                    format!(
                        "{} belongs to material `{}` and to material `{}`",
                        point(id as usize),
                        materials[other as usize].name,
                        m.name
                    ),
                )
                .help("make the materials' sets disjoint"));
            }
        }
    }
    let all = of.iter().enumerate();
    let all = all.map(|(id, m)| {
        m.ok_or_else(|| {
            let message = format!("{} belongs to no material", point(id));
            BuildError::missing("materials", message)
                .help("make the materials' sets cover the body")
        })
    });
    all.collect()
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
    let ids = parts::<D>(spec, None)?.1.ids();
    let each = ids.into_iter().map(|ids| {
        let mut of: Vec<usize> = all[ids].iter().map(|(_, m)| *m).collect();
        of.sort_unstable();
        of.dedup();
        of
    });
    Ok(each.collect())
}

fn of_points<const D: usize>(spec: &Spec) -> Result<Vec<(Point, usize)>, BuildError> {
    let (_, mut body) = parts::<D>(spec, None)?;
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
        if slots.is_empty() && names.load_map.is_some() {
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

#[cfg(test)]
mod tests {
    use super::{Drawn, SplitMix};

    #[test]
    fn those_with_the_least_numbers_are_drawn() {
        for (points, seed) in [(1, 0), (10, 3), (1000, 7), (200_000, u64::MAX)] {
            let mut random = SplitMix(seed);
            let numbers: Vec<f64> = (0..points).map(|_| random.unit()).collect();
            let mut order: Vec<usize> = (0..points).collect();
            order.sort_by(|a, b| numbers[*a].total_cmp(&numbers[*b]));
            for part in [0.0, 1e-9, 0.3, 0.5, 0.999, 1.0] {
                let count = (part * points as f64).round() as usize;
                let drawn = Drawn::new(points, part, seed);
                let mut all: Vec<usize> = (0..points).filter(|id| drawn.holds(*id)).collect();
                all.sort_by(|a, b| numbers[*a].total_cmp(&numbers[*b]));
                assert_eq!(all, order[..count], "{points} {seed} {part}");
            }
        }
    }
}
