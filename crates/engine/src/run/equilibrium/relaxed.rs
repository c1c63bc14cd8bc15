//! How one increment finds its equilibrium by dynamic relaxation or FIRE, friction included: what presses is held while the points move, and taken anew
//! until nothing moves. Held, friction has a potential; with the pressure of every trial it has none, and points may circle for ever.

use super::problem::Problem;
use super::state::StaticState;
use crate::body::view;
use crate::boundary_condition::load::Load;
use crate::boundary_condition::rigid_body::RigidBody;
use crate::dynamics::stable_step::largest_ratio;
use crate::error::SolveError;
use crate::interaction::friction::Friction;
use crate::spec::Method;
use crate::statics::fire::minimize;
use crate::statics::relaxation::relax;
use crate::statics::{Solved, Support};

/// How often pressure is taken anew.
const PRESSINGS: usize = 100;
/// Iterations between looks whether pairs of a family repel. They do much stiffer than bonds pull, and few bodies need the weight for it.
const LOOK: usize = 20;

impl<const D: usize> Problem<'_, D> {
    pub(super) fn relax(
        &mut self,
        state: &mut StaticState<D>,
        support: &Support<D>,
    ) -> Result<Solved, SolveError> {
        let goal = self.goal(state.options);
        // direct stiffness of every point as its mass, scaled so that a step of 1 is well below the limit
        let mut sum = vec![0.0; self.system.body.len()];
        let reference = self.system.body.at_rest();
        let body = &self.system.body;
        self.system
            .interaction
            .tangents(body, view(&reference), &mut |bond| {
                let trace: f64 = (0..D).map(|a| bond.stiffness[a][a].abs()).sum();
                sum[bond.i] += body.volume().at(bond.i) * trace;
            });
        let mut own = self.system.body.by_id(|i| sum[i]);
        let least = self.sums.most(own.iter().copied().fold(0.0, f64::max)) * 1e-3;
        own.iter_mut().for_each(|m| *m = m.max(least));
        let top = largest_ratio(&self.system.body, self.system.interaction.as_mut(), &own);
        // a step of 1 is stable to 4; half of that leaves room for stiffening
        own.iter_mut().for_each(|m| *m *= 0.5 * top);
        // what has flowed yields at the reference, softer than it is when it is unloaded: the stiffness of before it flowed stays
        let path = !self.system.forgets();
        if path {
            for (own, before) in own.iter_mut().zip(&state.masses) {
                *own = own.max(*before);
            }
            state.masses.clone_from(&own);
        }
        let reference = self.residual_of_reference(support);
        let mut x = self.system.body.values(&self.system.u);
        let mut r = vec![[0.0; D]; x.len()];
        let mut total = Solved::default();
        // where points were when no pair of a family repelled yet
        let (mut safe, mut repels) = (x.clone(), false);
        for _ in 0..PRESSINGS {
            self.press();
            let mut calls = 0;
            let masses = own.clone();
            let goal = (goal, &self.sums.clone());
            let force = |x: &mut [[f64; D]], f: &mut [[f64; D]], mass: &mut [f64]| {
                let mut found = self.imbalance(x, &mut r, support);
                found.scale = libm::hypot(found.scale, reference);
                if calls % LOOK == 0 {
                    if !repels && self.repels_inside() {
                        repels = true;
                        self.weigh_families(&mut own);
                        mass.copy_from_slice(&own);
                        x.copy_from_slice(&safe);
                        return None;
                    }
                    safe.copy_from_slice(x);
                }
                calls += 1;
                f.copy_from_slice(&r);
                self.weigh(&mut sum, &own, mass);
                Some(found)
            };
            let solved = match state.options.method {
                Method::Fire => minimize(&mut x, masses, goal, force)?,
                Method::Linear | Method::Newton | Method::Relaxation => {
                    relax(&mut x, masses, goal, path, force)?
                }
            };
            total.iterations += solved.iterations;
            total.residual = solved.residual;
            let rubs = self.rubs();
            if !self.sums.any(rubs) || solved.iterations == 0 {
                return Ok(total);
            }
        }
        Err(goal.missed(total.iterations, total.residual))
    }

    /// Raises masses where points touch or forces hold them: they stay light enough to settle elsewhere. `sum` is room for a number per slot.
    fn weigh(&self, sum: &mut [f64], own: &[f64], mass: &mut [f64]) {
        let system = &*self.system;
        let springs = system.applied.loads.iter().any(Load::has_stiffness);
        if system.contact.is_none() && system.applied.rigid.is_empty() && !springs {
            return;
        }
        sum.fill(0.0);
        system.applied.each_stiffness(|slot, block| {
            let size: f64 = block.as_flattened().iter().map(|k| k.abs()).sum();
            sum[slot] += system.body.volume().at(slot) * size;
        });
        if let Some(contact) = &system.contact {
            contact.central.add_stiffness(&system.body, &system.u, sum);
        }
        for rigid_body in &system.applied.rigid {
            rigid_body.add_stiffness(&system.body, &system.u, sum);
        }
        for ((m, own), &s) in mass.iter_mut().zip(own).zip(system.body.slots()) {
            *m = m.max(own + sum[s as usize]);
        }
    }

    /// Do points repel that are in each other's family?
    fn repels_inside(&mut self) -> bool {
        let system = &mut *self.system;
        system.contact.is_some()
            && system.interaction.energy(&system.body, view(&system.u))[1] > 0.0
    }

    /// Raises masses by what repulsion inside families resists with.
    fn weigh_families(&self, own: &mut [f64]) {
        let system = &*self.system;
        let Some(contact) = &system.contact else {
            return;
        };
        let mut sum = vec![0.0; system.body.len()];
        system
            .interaction
            .each_partner(&system.body, &mut |i, j, xi, _| {
                let r0 = xi.iter().map(|c| c * c).sum::<f64>().sqrt();
                if let Some(stiffness) = contact.central.first_stiffness(&system.body, [i, j], r0) {
                    sum[i] += stiffness;
                }
            });
        for (m, &s) in own.iter_mut().zip(system.body.slots()) {
            *m += sum[s as usize];
        }
    }

    /// What rubs is pressed as it is now.
    fn press(&mut self) {
        let system = &mut *self.system;
        if let Some(friction) = system.contact.as_mut().and_then(|c| c.friction.as_mut()) {
            friction.press();
        }
        system.applied.rigid.iter_mut().for_each(RigidBody::press);
    }

    fn rubs(&self) -> bool {
        let system = &*self.system;
        let friction = system.contact.as_ref().and_then(|c| c.friction.as_ref());
        friction.is_some_and(Friction::rubs) || system.applied.rigid.iter().any(RigidBody::rubs)
    }
}
