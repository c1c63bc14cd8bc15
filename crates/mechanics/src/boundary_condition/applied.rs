//! All conditions that add to the forces on points: rigid bodies, loads, and what comes from outside.

use super::driven::Driven;
use super::force_field::ForceField;
use super::load::Load;
use super::rigid_body::RigidBody;
use crate::body::{Body, Field, zeros};
use crate::interaction::Evaluation;
use crate::state::Archive;

/// In the order in which they act.
#[derive(Debug, Clone, Default)]
pub struct AppliedForces<const D: usize> {
    pub rigid: Vec<RigidBody<D>>,
    /// By [`Load::rank`], of one rank as they were given.
    pub loads: Vec<Load<D>>,
    /// In the order of whoever drives them.
    pub driven: Vec<Driven<D>>,
}

impl<const D: usize> AppliedForces<D> {
    /// Passes what they remember through an archive.
    pub fn archive(&mut self, body: &Body<D>, archive: &mut Archive<'_>) {
        archive.each("rigid_bodies", &mut self.rigid, |x, a| x.archive(body, a));
        archive.each("loads", &mut self.loads, |x, a| x.archive(body, a));
        archive.each("driven", &mut self.driven, |x, a| x.archive(body, a));
    }

    pub fn new(rigid: Vec<RigidBody<D>>, mut loads: Vec<Load<D>>) -> Self {
        loads.sort_by_key(Load::rank);
        AppliedForces {
            rigid,
            loads,
            driven: vec![],
        }
    }

    /// Everybody, in turn.
    pub fn all(&mut self) -> impl Iterator<Item = &mut dyn ForceField<D>> {
        let rigid = self.rigid.iter_mut().map(|i| i as &mut dyn ForceField<D>);
        let loads = self.loads.iter_mut().map(|l| l as &mut dyn ForceField<D>);
        rigid
            .chain(loads)
            .chain(self.driven.iter_mut().map(Driven::field))
    }

    /// Force densities of the loads alone, at rest.
    pub fn external(&mut self, body: &Body<D>, u: &Field<D>, t: f64, at: Evaluation) -> Field<D> {
        let (mut f, v) = (zeros(body.len), zeros(body.len));
        for load in &mut self.loads {
            load.add(body, [u, &v], &mut f, t, at, None);
        }
        f
    }

    /// What of these an implicit step cannot take: the first that has no tangent.
    pub fn without_tangent(&self) -> Option<&'static str> {
        let mut driven = self.driven.iter().map(Driven::load);
        let driven = driven.any(|l| l.is_none_or(|l| l.without_tangent().is_some()));
        let own = self.loads.iter().find_map(Load::without_tangent);
        own.or(driven.then_some("a rigid body or a force from outside"))
    }

    /// Rigid bodies that move by the forces on them.
    pub fn free(&self) -> impl Iterator<Item = &RigidBody<D>> {
        self.rigid.iter().filter(|i| i.is_free())
    }

    /// Stiffness of the loads against displacements in the last trial, by slot: `visit(slot, −∂f/∂u)` (force / volume / length).
    pub fn each_stiffness(&self, mut visit: impl FnMut(usize, &[[f64; D]; D])) {
        self.loads.iter().for_each(|l| l.each_stiffness(&mut visit));
    }

    /// Viscosity that resists velocities at time `t`, by slot (mass / volume / time).
    pub fn viscosity(&self, body: &Body<D>, t: f64) -> Vec<f64> {
        let mut sum = vec![0.0; body.len];
        let driven = self.driven.iter().filter_map(Driven::load);
        for load in self.loads.iter().chain(driven) {
            load.each_viscosity(t, |slot, c| sum[slot] += c);
        }
        sum
    }
}
