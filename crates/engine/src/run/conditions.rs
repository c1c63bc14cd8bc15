//! Conditions of a spec as loads and constraints on the slots of a body.

use super::model::Model;
use crate::condition::Program;
use crate::condition::constraint::{Constraint, Prescribed};
use crate::condition::load::{Load, LoadKind};
use crate::error::BuildError;
use crate::spec::{ConditionKind, ConditionSpec};

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
                    let face = self
                        .body
                        .volume
                        .at(slots.first().map_or(0, |s| *s as usize))
                        / self.body.spacing;
                    let area = area.unwrap_or(face * slots.len() as f64);
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
}
