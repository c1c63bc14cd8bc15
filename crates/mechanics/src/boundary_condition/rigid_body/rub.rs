//! Friction on the surface of a rigid body, with a memory of sticking as between points ([`crate::interaction::friction`]): the force density `κ ξ` of
//! the elastic part ξ of its path along the point, at most `μ K g²`, with `κ = 2/7 · 2 K |g|`. Where a point goes deeper the force stays, where
//! it comes out ξ does (Mindlin & Deresiewicz 1953), so that neither gives energy.

use super::RigidBody;
use super::surface::Near;
use crate::body::{Body, Field};
use crate::boundary_condition::force_field::power;
use crate::boundary_condition::rigid::Kept;
use crate::execute::exact::Exact;
use crate::interaction::Evaluation;
use crate::interaction::coulomb::{
    Coefficients, TANGENTIAL, begun, follows, length, sliding, slipped,
};
use crate::interaction::friction::Pressed;
use crate::space::full;
use crate::state::words;
use std::collections::HashMap;

/// Where an increment of statics or an implicit step began.
#[derive(Debug, Clone)]
pub(super) struct Departure<const D: usize> {
    pub rigid: Kept,
    pub u: Field<D>,
    /// Points touched there, with the force density on them.
    pub touched: Vec<(u32, [f64; D])>,
    pub pressed: Pressed,
}

/// A point touched at the last evaluation.
#[derive(Debug, Clone, Copy)]
pub(super) struct Touched<const D: usize> {
    pub slot: u32,
    pub near: Near<D>,
    /// Elastic path of the surface along the point (length), the depth that its stiffness is of, and the force density of friction.
    pub way: [f64; D],
    pub depth: f64,
    /// The path over what it would be if nothing slipped.
    pub kept: f64,
    pub rub: [f64; D],
}

words!([const D: usize] Touched<D> {
    slot: u32,
    near: Near<D>,
    way: [f64; D],
    depth: f64,
    kept: f64,
    rub: [f64; D],
});

impl<const D: usize> RigidBody<D> {
    /// Sliding of a point on the surface: along it, of the surface against the point.
    fn sliding(&self, v: &Field<D>, touched: &Touched<D>) -> [f64; D] {
        let Near { arm, normal, .. } = &touched.near;
        let (of, i) = (self.rigid.velocity_at(&full(arm)), touched.slot as usize);
        let relative = crate::array::from_fn(|a| of[a] - v[a][i]);
        let point: [f64; D] = crate::array::from_fn(|a| v[a][i]);
        let speeds = length(&self.rigid.velocity_at(&[0.0; 3])) + length(&point);
        sliding(normal, &relative, speeds)
    }

    /// Friction on all that are touched.
    pub(super) fn rub(
        &mut self,
        body: &Body<D>,
        [u, v]: [&Field<D>; 2],
        f: &mut Field<D>,
        now: Coefficients,
        at: Evaluation,
    ) {
        let dt = at.ended();
        let mut rubbed = std::mem::take(&mut self.rubbed);
        let old = std::mem::take(&mut self.rubbed_before);
        let before: HashMap<u32, &Touched<D>> = old.iter().map(|t| (t.slot, t)).collect();
        self.stored = Exact::ZERO;
        for (n, touched) in rubbed.iter_mut().enumerate() {
            let i = touched.slot as usize;
            let from = at.since(&self.from);
            let held = from.is_some_and(|f| f.pressed == Pressed::Held);
            let depth = match held {
                true => self.pressed.get(&touched.slot).copied().unwrap_or(0.0),
                false => -touched.near.gap,
            };
            if !(depth > 0.0) {
                continue;
            }
            let w = self.sliding(v, touched);
            // in equilibrium nothing has a speed, whatever the increment is divided by
            let speed = match held {
                true => 0.0,
                false => length(&w),
            };
            let most = now.at(speed) * depth / (2.0 * TANGENTIAL);
            let before = before.get(&touched.slot);
            let sticks = before.is_some_and(|t| t.way != [0.0; D]);
            (touched.way, touched.kept) = match at {
                Evaluation::Start { .. } if !sticks => (begun(&w, most), 1.0),
                Evaluation::Start { .. }
                | Evaluation::StepEnd { .. }
                | Evaluation::Trial { .. } => {
                    let start = before.map_or([0.0; D], |t| {
                        // the force stays where the spring grows stiffer
                        let softer = t.depth / depth;
                        t.way.map(|c| c * softer.min(1.0))
                    });
                    let path = match from {
                        Some(from) => self.way_from(from, u, touched),
                        None => w.map(|c| c * dt),
                    };
                    slipped(&start, &touched.near.normal, &path, most)
                }
            };
            let stiffness = 2.0 * TANGENTIAL * self.stiffness * depth;
            touched.rub = touched.way.map(|c| stiffness * c);
            touched.depth = depth;
            let volume = body.volume.at(i);
            let square: f64 = touched.way.iter().map(|c| c * c).sum();
            self.stored.add(0.5 * stiffness * square * volume);
            let force = touched.rub;
            for a in 0..D {
                f[a][i] += force[a];
                self.touched[n].1[a] += force[a];
            }
            self.work.add(0.5 * dt * volume * power(&force, v, i));
            let arm = touched.near.arm;
            self.bear(&arm, &force, volume);
        }
        (self.rubbed, self.rubbed_before) = (rubbed, old);
        self.rub_away(body, v, dt);
    }

    /// The way of the surface against a point since an increment or an implicit step began.
    fn way_from(&self, from: &Departure<D>, u: &Field<D>, touched: &Touched<D>) -> [f64; D] {
        let (arm, i) = (&touched.near.arm, touched.slot as usize);
        let way = self.rigid.way_since(&from.rigid, &full(arm));
        crate::array::from_fn(|a| way[a] - (u[a][i] - from.u[a][i]))
    }

    /// Half of the work of friction within a step, with the velocities of its middle.
    pub(super) fn rub_away(&mut self, body: &Body<D>, v: &Field<D>, dt: f64) {
        for touched in &self.rubbed {
            let w = self.sliding(v, touched);
            let power: f64 = (0..D).map(|a| touched.rub[a] * w[a]).sum();
            let volume = body.volume.at(touched.slot as usize);
            self.rubbed_work.add(0.5 * dt * power * volume);
        }
    }

    /// The same of an increment of statics, by the trapezoidal rule.
    pub(super) fn account_rubbing(&mut self, body: &Body<D>, u: &Field<D>) {
        let Some(from) = &self.from else { return };
        for touched in self.rubbed_before.iter().chain(&self.rubbed) {
            let way = self.way_from(from, u, touched);
            let power: f64 = (0..D).map(|a| touched.rub[a] * way[a]).sum();
            let volume = body.volume.at(touched.slot as usize);
            self.rubbed_work.add(0.5 * power * volume);
        }
    }

    /// In statics what rubs is pressed as it is at this call, until the next (as between points).
    pub fn press(&mut self) {
        let each = self.rubbed.iter().map(|t| (t.slot, -t.near.gap));
        self.pressed = each.collect();
    }

    /// Visits the tangents of friction at the last evaluation, as [`RigidBody::each_tangent`].
    pub(super) fn each_rubbing(
        &self,
        body: &Body<D>,
        visit: &mut dyn FnMut(usize, &[f64; D], [[f64; D]; D]),
    ) {
        for touched in &self.rubbed {
            let i = touched.slot as usize;
            let stiffness = 2.0 * TANGENTIAL * self.stiffness * touched.depth * body.volume.at(i);
            let block = follows(&touched.near.normal, &touched.way, touched.kept);
            visit(
                i,
                &touched.near.arm,
                block.map(|row| row.map(|c| stiffness * c)),
            );
        }
    }

    /// Does anything touch it that it could rub?
    pub fn rubs(&self) -> bool {
        !self.rubbed.is_empty()
    }

    /// What friction took (energy), of the points of all ranks. All ranks ask at once.
    pub fn dissipated(&self, body: &Body<D>) -> f64 {
        let mut taken = self.rubbed_work.clone();
        self.stored.parts().into_iter().for_each(|x| taken.take(x));
        body.sums([taken])[0]
    }
}
