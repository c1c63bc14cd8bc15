//! Conditions of a spec as loads and constraints on the slots of a body.

use super::LoadInfo;
use super::names::Names;
use super::system::System;
use crate::body::Body;
use crate::boundary_condition::Program;
use crate::boundary_condition::applied::AppliedForces;
use crate::boundary_condition::condensed::Condensed;
use crate::boundary_condition::constraint::{Constraint, Kind};
use crate::boundary_condition::load::{Load, LoadKind};
use crate::boundary_condition::point_force::{Placed, PointForce};
use crate::boundary_condition::rigid_body::RigidBody;
use crate::error::BuildError;
use crate::execute::exact::Exact;
use crate::expression::Expression;
use crate::message;
use crate::quantity::{Dimension, place};
use crate::space::Point;
use crate::spec::{ConditionKind, ConditionSpec, ForceSpec, LoadMap, RigidBodySpec};
use std::collections::HashMap;
use std::sync::Arc;

/// Times up to the end at which a load is looked at.
const LOOKS: u32 = 16;

/// The value of a load that adds force densities, and the area of a traction; `None`: another condition.
fn density(kind: &ConditionKind) -> Option<(&[Option<Expression>; 3], Option<Option<f64>>)> {
    match kind {
        ConditionKind::BodyForce(e) => Some((e, None)),
        ConditionKind::Traction { value, area } => Some((value, Some(*area))),
        ConditionKind::SetForce(_)
        | ConditionKind::Damping(_)
        | ConditionKind::Force(_)
        | ConditionKind::Displacement(_)
        | ConditionKind::Velocity(_) => None,
    }
}

/// A traction as a force density: what acts on an area, over the volume of each point. All ranks ask at once.
fn spread<const D: usize>(
    body: &Body<D>,
    traction: Program<D>,
    (areas, volumes): (&[f64], &[f64]),
    [area, volume]: [f64; 2],
) -> Program<D> {
    let same = area / volume;
    let each = areas.iter().zip(volumes).map(|(a, v)| a / v);
    let each: Vec<f64> = each.collect();
    let other = each.iter().any(|w| !((w - same).abs() <= 1e-12 * same));
    match !body.exchange().any(other) {
        true => traction.scaled(same),
        false => traction.weighted(each),
    }
}

/// What a force adds on these of its points, and what of it resists velocities. All ranks ask at once.
pub(super) fn named<const D: usize>(
    body: &Body<D>,
    force: Arc<dyn PointForce>,
    which: &[u32],
) -> Vec<LoadKind<D>> {
    let viscosity = which
        .iter()
        .map(|k| [Some(force.viscosity(*k as usize)), None, None]);
    let viscosity: Vec<_> = viscosity.collect();
    let resists = viscosity.iter().any(|c| c[0] != Some(0.0));
    let mut kinds = vec![LoadKind::Named(force)];
    if body.exchange().any(resists) {
        kinds.push(LoadKind::Damping(Program::listed(&viscosity)));
    }
    kinds
}

impl<const D: usize> Names<D> {
    /// A load on points of the finer body from which this one was condensed.
    fn condensed(
        &self,
        body: &Body<D>,
        load_map: &LoadMap<D>,
        set: &str,
        value: &[Option<Expression>; 3],
        traction: Option<Option<f64>>,
    ) -> Result<Load<D>, BuildError> {
        let named = self.loaded_sets.iter().find(|(name, _)| name == set);
        let members: Vec<u32> = match (set, named) {
            ("all", _) => (0..load_map.points() as u32).collect(),
            (_, Some((_, members))) => members.clone(),
            (_, None) => {
                return Err(BuildError::unknown(
                    "",
                    set,
                    format!("there is no set `{set}`"),
                ));
            }
        };
        let lost = members
            .iter()
            .filter(|p| !load_map.carries(**p as usize))
            .count();
        if lost > 0 || members.is_empty() {
            return Err(BuildError::conflict(
                "",
                format!(
                    "{lost} of {} points of `{set}` carry no load: the body was condensed for other loads",
                    members.len()
                ),
            )
            .help("coarsen again, from a deck with this load on this set"));
        }
        let (mut condensed, ids) = Condensed::new(load_map, &members);
        let mut program = Program::new(value, condensed.points());
        let mut whole = None;
        if let Some(area) = traction {
            let period = &body.period();
            let areas = self
                .faces
                .condensed(load_map, period, set, &members, area)?;
            whole = Some(areas.iter().sum());
            let volumes = members.iter().map(|p| load_map.volume[*p as usize]);
            let volumes: Vec<f64> = volumes.collect();
            // every rank has all points that carry loads
            let totals = [&areas, &volumes].map(|of| of.iter().copied().collect::<Exact>().value());
            program = spread(body, program, (&areas, &volumes), totals);
        }
        let (whose, mut here, mut slots) = (body.whose(), vec![], vec![]);
        for (k, id) in ids.into_iter().enumerate() {
            if let Some(place) = whose.place(id) {
                here.push(k);
                slots.push(body.slots()[place]);
            }
        }
        condensed.pick(&here);
        let mut load = Load::condensed(program, slots, condensed);
        load.of = Some((0, whole));
        Ok(load)
    }

    /// A force of the registry on these points: what it adds, and what of it resists velocities; and which of the points of all ranks these are. All ranks ask
    /// at once.
    fn force(
        &self,
        body: &Body<D>,
        force: &ForceSpec,
        slots: &[u32],
        points: &[Point],
    ) -> Result<(Vec<LoadKind<D>>, Vec<u32>), BuildError> {
        let ids = body.ids_of_all();
        let each = slots.iter().zip(points).map(|(s, [x, y, z])| {
            let density = body.density().at(*s as usize);
            [f64::from(ids[*s as usize]), *x, *y, *z, density]
        });
        let own: Vec<[f64; 5]> = each.collect();
        let mut all = body.all_of(&own).concat();
        let mut which: Vec<u32> = (0..own.len() as u32).collect();
        if body.exchange().is_shared() {
            all.sort_by(|a, b| a[0].total_cmp(&b[0]));
            let place = |p: &[f64; 5]| all.partition_point(|q| q[0] < p[0]) as u32;
            which = own.iter().map(place).collect();
        }
        let on = Placed {
            dimension: D,
            points: &all
                .iter()
                .map(|[_, x, y, z, _]| [*x, *y, *z])
                .collect::<Vec<_>>(),
            density: &all.iter().map(|p| p[4]).collect::<Vec<_>>(),
            spacing: body.spacing(),
        };
        let made = self.registry.force(force, &on)?;
        Ok((named(body, made, &which), which))
    }

    /// All that acts, and constraints.
    pub(super) fn acting(
        &self,
        body: &Body<D>,
        conditions: &[ConditionSpec],
        rigid: &[RigidBodySpec],
        sets: &[(String, Vec<u32>)],
    ) -> Result<(AppliedForces<D>, Vec<Constraint<D>>), BuildError> {
        let (mut loads, mut constraints) = (vec![], vec![]);
        for (n, c) in conditions.iter().enumerate() {
            let (slots, points) = body
                .slots_of(&c.set, sets)
                .map_err(|e| e.at(format!("conditions[{n}].set")))?;
            let load = |kind| Load::new(kind, slots.clone(), points.clone());
            if let Some(load_map) = &self.load_map
                && let Some((value, area)) = density(&c.kind)
            {
                let made = self.condensed(body, load_map, &c.set, value, area);
                let mut made = made.map_err(|e| e.at(format!("conditions[{n}]")))?;
                made.of = made.of.map(|(_, area)| (n, area));
                loads.push(made);
                continue;
            }
            // groups of scripts may be empty
            if self.load_map.is_some() && body.count(slots.len() as u64) == 0 {
                return Err(BuildError::empty(
                    format!("conditions[{n}].set"),
                    format!("no point of `{}` was retained", c.set),
                )
                .help(
                    "peridyne coarsen --supports kept retains points whose motion is prescribed",
                ));
            }
            match &c.kind {
                ConditionKind::BodyForce(e) => {
                    let mut made = load(LoadKind::Body(Program::new(e, &points)));
                    made.of = Some((n, None));
                    loads.push(made);
                }
                ConditionKind::SetForce(e) => {
                    loads.push(load(LoadKind::Replace(Program::new(e, &points))))
                }
                ConditionKind::Damping(e) => loads.push(load(LoadKind::Damping(Program::new(
                    &[Some(e.clone()), None, None],
                    &points,
                )))),
                ConditionKind::Force(force) => {
                    let path = format!("conditions[{n}]");
                    let made = self.force(body, force, &slots, &points);
                    let (made, which) = made.map_err(|e| e.within(&path))?;
                    loads.extend(made.into_iter().map(|kind| load(kind).which(&which)));
                }
                ConditionKind::Traction { value, area } => {
                    let areas = { self.faces.areas(body, &c.set, &slots, *area) }
                        .map_err(|e| e.at(format!("conditions[{n}]")))?;
                    let volumes = slots.iter().map(|s| body.volume().at(*s as usize));
                    let volumes: Vec<f64> = volumes.collect();
                    let totals = [&areas, &volumes].map(|of| body.sum(of.iter().copied()));
                    let program = Program::new(value, &points);
                    let program = spread(body, program, (&areas, &volumes), totals);
                    let mut made = load(LoadKind::Body(program));
                    made.of = Some((n, Some(totals[0])));
                    loads.push(made);
                }
                ConditionKind::Displacement(e) => constraints.push(Constraint::new(
                    Kind::Displacement,
                    Program::new(e, &points),
                    slots,
                    points,
                )),
                ConditionKind::Velocity(e) => constraints.push(Constraint::new(
                    Kind::Velocity,
                    Program::new(e, &points),
                    slots,
                    points,
                )),
            }
        }
        let rigid = rigid.iter().map(RigidBody::new).collect();
        Ok((AppliedForces::new(rigid, loads), constraints))
    }
}

impl<const D: usize> System<D> {
    /// Refuses conditions that ask different motions of one point: the last would win without a word. Looked at are a few
    /// times up to `end`.
    pub(super) fn check_agreement(
        &self,
        conditions: &[ConditionSpec],
        end: f64,
    ) -> Result<(), BuildError> {
        let moves = |c: &ConditionSpec| {
            matches!(
                c.kind,
                ConditionKind::Displacement(_) | ConditionKind::Velocity(_)
            )
        };
        let number: Vec<usize> = (0..conditions.len())
            .filter(|n| moves(&conditions[*n]))
            .collect();
        let times = [0.0, 0.25, 0.5, 1.0].map(|part| part * end);
        // who holds a component of a slot: constraint, and place in its list
        let mut holders: HashMap<(usize, usize), (usize, usize)> = HashMap::new();
        let constraints = &self.prescribed.constraints;
        for (c, constraint) in constraints.iter().enumerate() {
            for (k, slot, a) in constraint.each() {
                let Some(&(other, j)) = holders.get(&(slot, a)) else {
                    holders.insert((slot, a), (c, k));
                    continue;
                };
                let first = &constraints[other];
                let both = first.disagree(constraint, (a, j, k), &times, self.clock.dt());
                let Some([first, second]) = both else {
                    continue;
                };
                let (n, m) = (number[other], number[c]);
                let x = self.body.position(slot);
                let axis = ["x", "y", "z"][a];
                let dimension = match (&conditions[n].kind, &conditions[m].kind) {
                    (ConditionKind::Displacement(_), ConditionKind::Displacement(_)) => {
                        Dimension::LENGTH
                    }
                    // where one is a velocity both are told as such
                    _ => Dimension::VELOCITY,
                };
                let message = message![
                    format!(
                        "two boundary conditions, on `{}` and on `{}`, prescribe different motions of the point at ",
                        conditions[n].set, conditions[m].set
                    ),
                    place(&x[..D]),
                    format!(" along {axis}: "),
                    dimension.of(first),
                    " and ",
                    dimension.of(second),
                ];
                return Err(BuildError::conflict(format!("conditions[{m}]"), message)
                    .help("make their sets disjoint, or leave this component out of one of them"));
            }
        }
        Ok(())
    }
}

/// What loads come to in all, each at the time up to `end` at which it is largest.
pub(super) fn tell_loads<const D: usize>(
    body: &Body<D>,
    loads: &mut [Load<D>],
    conditions: &[ConditionSpec],
    end: f64,
) -> Vec<LoadInfo> {
    let size = |f: &[f64; 3]| f.iter().map(|c| c * c).sum::<f64>();
    let mut told: Vec<(usize, LoadInfo)> = { loads.iter_mut() }
        .filter_map(|load| {
            let (n, area) = load.of?;
            let times = (0..=LOOKS).map(|k| end * f64::from(k) / f64::from(LOOKS));
            let most = times.filter_map(|t| load.total(body, t));
            let most = most.max_by(|a, b| size(a).total_cmp(&size(b)))?;
            let c = &conditions[n];
            Some((
                n,
                LoadInfo {
                    what: match area {
                        Some(_) => "traction",
                        None => "body force",
                    },
                    set: c.set.clone(),
                    area,
                    force: Some(most),
                    power: None,
                    varies: c.kind.depends_on_time(),
                },
            ))
        })
        .collect();
    told.sort_by_key(|(n, _)| *n);
    told.into_iter().map(|(_, told)| told).collect()
}
