//! Conditions of a spec as loads and constraints on the slots of a body.

use super::model::Model;
use crate::condition::Program;
use crate::condition::constraint::{Constraint, Prescribed};
use crate::condition::load::{Load, LoadKind};
use crate::error::BuildError;
use crate::spec::{ConditionKind, ConditionSpec};
use std::collections::HashMap;

impl<const D: usize> Model<D> {
    /// Loads in the order in which they act, and constraints.
    pub(super) fn loads_and_constraints(
        &self,
        conditions: &[ConditionSpec],
        sets: &[(String, Vec<u32>)],
    ) -> Result<(Vec<Load<D>>, Vec<Constraint<D>>), BuildError> {
        let (mut loads, mut constraints) = (vec![], vec![]);
        for (n, c) in conditions.iter().enumerate() {
            let (slots, points) = self.slots_of(&c.set, sets).map_err(|e| BuildError {
                path: format!("conditions[{n}].set"),
                ..e
            })?;
            let load = |kind| Load::new(kind, slots.clone(), points.clone());
            match &c.kind {
                ConditionKind::BodyForce(e) => {
                    loads.push(load(LoadKind::Body(Program::new(e, &points))))
                }
                ConditionKind::SetForce(e) => {
                    loads.push(load(LoadKind::Replace(Program::new(e, &points))))
                }
                ConditionKind::Damping(e) => loads.push(load(LoadKind::Damping(Program::new(
                    &[Some(e.clone()), None, None],
                    &points,
                )))),
                ConditionKind::Traction { value, area } => {
                    let volume: f64 = slots.iter().map(|s| self.body.volume.at(*s as usize)).sum();
                    let face = |slot: u32| {
                        let slot = slot as usize;
                        self.body.volume.at(slot) / self.body.spacing_at(slot)
                    };
                    let first = slots.first().map_or(0.0, |s| face(*s));
                    let area =
                        area.unwrap_or_else(|| match slots.iter().all(|s| face(*s) == first) {
                            true => first * slots.len() as f64,
                            false => slots.iter().map(|s| face(*s)).sum(),
                        });
                    loads.push(load(LoadKind::Body(
                        Program::new(value, &points).scaled(area / volume),
                    )));
                }
                ConditionKind::Displacement(e) => constraints.push(Constraint::new(
                    Prescribed::Displacement,
                    Program::new(e, &points),
                    slots,
                    points,
                )),
                ConditionKind::Velocity(e) => constraints.push(Constraint::new(
                    Prescribed::Velocity,
                    Program::new(e, &points),
                    slots,
                    points,
                )),
            }
        }
        // damping looks at what was added, and a replaced force is replaced whatever else there is
        loads.sort_by_key(|l: &Load<D>| match l.kind {
            LoadKind::Body(_) => 0,
            LoadKind::Damping(_) => 1,
            LoadKind::Replace(_) => 2,
        });
        Ok((loads, constraints))
    }
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
        for (c, constraint) in self.constraints.iter().enumerate() {
            for (k, (slot, held)) in constraint.holds().enumerate() {
                for a in (0..D).filter(|a| held[*a]) {
                    let Some(&(other, j)) = holders.get(&(slot, a)) else {
                        holders.insert((slot, a), (c, k));
                        continue;
                    };
                    let other_constraint = &self.constraints[other];
                    let both = other_constraint.disagree(constraint, (a, j, k), &times, self.dt);
                    if let Some([first, second]) = both {
                        let (n, m) = (number[other], number[c]);
                        let x = self.body.position(slot);
                        let axis = ["x", "y", "z"][a];
                        let message = format!(
                            "two conditions, on `{}` and on `{}`, ask different motions of the point at {:?} along {axis}: {first:e} and {second:e}",
                            conditions[n].set,
                            conditions[m].set,
                            &x[..D]
                        );
                        return Err(BuildError::new(format!("conditions[{m}]"), message).help(
                            "make their sets disjoint, or leave this component out of one of them",
                        ));
                    }
                }
            }
        }
        Ok(())
    }
}
