//! Rigid bodies with mass in an implicit step: their few unknowns border the equations of the points,
//!
//! `[A C; Cᵀ S] (δu, δX) = (r, R)`, `C = −B G`, `S = Σ GᵀBG + M ∂²/∂t²`
//!
//! with B the tangents of what they touch, `G_i` what a place at a point does when the body moves (axes) and turns about its centre (axes in space),
//! and M its mass and moments of inertia. So `δX = (S − CᵀA⁻¹C)⁻¹ (R − CᵀA⁻¹r)`, with a solution for each unknown of a body.
//!
//! What is sought of a body is `(m a, dL/dt)` at the end of the step; its place follows as in [`Rigid::step_implicitly`](crate::boundary_condition::rigid::Rigid::step_implicitly).

use super::problem::Problem;
use super::system::{Border, unknowns};
use super::tried::{Inertia, Tried};
use crate::boundary_condition::rigid::Wrench;
use crate::boundary_condition::rigid_body::RigidBody;
use crate::execute::exact::Exact;
use crate::space::{cross, full};

/// Where a place at `arm` goes when its body does what unknown `k` is, in D axes.
fn moves<const D: usize>(k: usize, arm: &[f64; D]) -> [f64; D] {
    let mut axis = [0.0; 3];
    axis[k % 3] = 1.0;
    let way = match k < 3 {
        true => axis,
        false => cross(&axis, &full(arm)),
    };
    crate::array::from_fn(|a| way[a])
}

impl<const D: usize> Problem<'_, D> {
    /// What bodies with mass add to the equations of now.
    pub(super) fn border(&self, inertia: &Inertia<D>) -> Border<D> {
        let each = unknowns(D);
        let id = self.system.body.ids_by_slot();
        let mut border = Border {
            columns: vec![],
            own: vec![],
            inertia: vec![],
            radius: vec![],
        };
        let bodies: Vec<&RigidBody<D>> = self.system.applied.free().collect();
        let all = bodies.len() * each.len();
        for (n, body) in bodies.iter().enumerate() {
            let mass = body.rigid.inertia(inertia.acceleration);
            for &unknown in each {
                let mut column = vec![[0.0; D]; self.system.body.points()];
                let mut own = vec![Exact::ZERO; all];
                body.each_tangent(&self.system.body, &self.system.u, |slot, arm, block| {
                    let way = moves(unknown, arm);
                    // force on the point if the place goes there
                    let force: [f64; D] =
                        crate::array::from_fn(|a| (0..D).map(|b| block[a][b] * way[b]).sum());
                    for a in 0..D {
                        column[id[slot] as usize][a] -= force[a];
                    }
                    for (other, &unknown) in each.iter().enumerate() {
                        let way = moves(unknown, arm);
                        own[n * each.len() + other].add((0..D).map(|a| force[a] * way[a]).sum());
                    }
                });
                let mut own = self.system.body.sums_of(own);
                for (other, &row) in each.iter().enumerate() {
                    own[n * each.len() + other] += inertia.weight * mass[row][unknown];
                }
                border.columns.push(column);
                border.own.push(own);
            }
            border.inertia.push(mass);
            border.radius.push(body.rigid.gyration());
        }
        border
    }

    /// Bodies with mass go where they are tried.
    pub(in crate::run) fn place_bodies(&mut self, tried: &Tried<D>, inertia: &Inertia<D>) {
        let free = self.system.applied.rigid.iter_mut().filter(|i| i.is_free());
        for ((body, start), end) in free.zip(&inertia.bodies).zip(&tried.bodies) {
            body.step_implicitly([start, end], inertia.newmark());
        }
    }

    /// What is missing of the equations of bodies with mass, and what it is compared with, torques over radii of gyration.
    pub(super) fn missing_of_bodies(
        &self,
        tried: &Tried<D>,
        inertia: &Inertia<D>,
    ) -> (Vec<Wrench>, [f64; 2]) {
        let free = self.system.applied.free();
        let (mut rest, mut left, mut scale) = (vec![], 0.0f64, 0.0f64);
        for (n, (body, end)) in free.zip(&tried.bodies).enumerate() {
            let (acting, radius) = (body.rigid.wrench(), body.rigid.gyration());
            let past = inertia.bodies_before.get(n);
            let mut missing = [0.0; 6];
            for &k in unknowns(D) {
                let per = if k < 3 { 1.0 } else { 1.0 / radius };
                let takes = inertia.weight * end[k] + past.map_or(0.0, |f| f[k]);
                missing[k] = acting[k] - takes;
                left = libm::hypot(left, per * missing[k]);
                scale = libm::hypot(libm::hypot(scale, per * acting[k]), per * takes);
            }
            rest.push(missing);
        }
        (rest, [left, scale])
    }
}
