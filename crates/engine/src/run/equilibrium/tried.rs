//! What Newton's method tries: displacements, and within a step in time the velocities and accelerations that go with them.

use super::problem::Problem;
use crate::body::Body;
use crate::boundary_condition::rigid::{NewmarkStep, Wrench};
use crate::run::inertia::masses::CoupledMasses;
use crate::statics::{Imbalance, Sums, Support};
use std::sync::Arc;

/// A state on trial, in order of ids.
#[derive(Debug, Clone)]
pub(in crate::run) struct Tried<const D: usize> {
    /// Displacements (length).
    pub x: Vec<[f64; D]>,
    /// Velocities; empty in equilibrium.
    pub v: Vec<[f64; D]>,
    /// Accelerations; empty in equilibrium.
    pub a: Vec<[f64; D]>,
    /// `(m a, dL/dt)` of rigid bodies with mass.
    pub bodies: Vec<Wrench>,
}

/// Where a step of Newton's method goes.
#[derive(Debug, Clone)]
pub(in crate::run) struct Onward<const D: usize> {
    /// Displacements.
    pub x: Vec<[f64; D]>,
    /// Of rigid bodies with mass.
    pub bodies: Vec<Wrench>,
    /// How far the fastest of them goes (length).
    pub far: f64,
}

impl<const D: usize> Tried<D> {
    pub fn at_rest(x: Vec<[f64; D]>) -> Self {
        Tried {
            x,
            v: vec![],
            a: vec![],
            bodies: vec![],
        }
    }

    /// `part` of a step of the displacements further. Accelerations are no difference of displacements: round-off of
    /// these divided by Δt² would be all that is left of small ones.
    pub fn along(&self, step: &Onward<D>, part: f64, inertia: Option<&Inertia<D>>) -> Self {
        let further = |of: &[[f64; D]], rate: f64| {
            let both = of.iter().zip(&step.x);
            both.map(|(x, s)| crate::array::from_fn(|a| x[a] + part * (rate * s[a])))
                .collect()
        };
        let [v, a] = inertia.map_or([0.0; 2], |m| [m.velocity, m.acceleration]);
        Tried {
            x: further(&self.x, 1.0),
            v: further(&self.v, v),
            a: further(&self.a, a),
            bodies: { self.bodies.iter().zip(&step.bodies) }
                .map(|(z, s)| crate::array::from_fn(|k| z[k] + part * s[k]))
                .collect(),
        }
    }
}

/// What a step in time adds to the equations of equilibrium: `f(u, v, t) = (m a + α f₀)/(1 + α)`, with v and a that follow u.
pub(in crate::run) struct Inertia<const D: usize> {
    /// `1/(1 + α)`
    pub weight: f64,
    /// `[N]` over `1 + α`.
    pub mass: Vec<f64>,
    /// Masses that couple points, in place of those; not over `1 + α`.
    pub coupled: Option<Arc<CoupledMasses<D>>>,
    /// `[N]` `α f₀/(1 + α)` (force); empty: α is 0.
    pub past: Vec<[f64; D]>,
    /// `[N]` what it adds to the stiffness (force / length): `m ∂a/∂u/(1 + α) + c ∂v/∂u`, c what damping takes per velocity; without
    /// masses that couple points.
    pub added: Vec<f64>,
    /// `∂v/∂u = γ/(βΔt)`
    pub velocity: f64,
    /// `∂a/∂u = 1/(βΔt²)`
    pub acceleration: f64,
    /// Δt
    pub step: f64,
    /// Of rigid bodies with mass: `(m a, dL/dt)` where the step began, and as `past`.
    pub bodies: Vec<Wrench>,
    pub bodies_before: Vec<Wrench>,
}

impl<const D: usize> Inertia<D> {
    pub fn newmark(&self) -> NewmarkStep {
        let beta = 1.0 / (self.acceleration * self.step * self.step);
        NewmarkStep {
            beta,
            gamma: self.velocity * beta * self.step,
            step: self.step,
        }
    }

    /// Takes `m a` from the forces on the free components: what is left of them, and how large it and `m v/Δt` are.
    pub fn take(
        &self,
        body: &Body<D>,
        tried: &Tried<D>,
        (r, sums): (&mut [[f64; D]], &Sums),
        support: &Support<D>,
    ) -> Imbalance {
        let coupled = self.coupled.as_ref().map(|m| m.times(body, &tried.a));
        let inertia = |n: usize, a: usize| match &coupled {
            None => self.mass[n] * tried.a[n][a],
            Some(force) => self.weight * force[n][a],
        };
        for (n, r) in r.iter_mut().enumerate() {
            for a in (0..D).filter(|a| support.free[n][*a]) {
                r[a] -= inertia(n, a) + self.past.get(n).map_or(0.0, |f| f[a]);
            }
        }
        let squares = sums.each(r.len(), |n| {
            let free = (0..D).filter(|a| support.free[n][*a]);
            let momentum = |a: usize| self.mass[n] * tried.v[n][a] / self.step;
            let taken = free.map(|a| inertia(n, a).powi(2) + momentum(a).powi(2));
            [r[n].iter().map(|c| c * c).sum(), taken.sum()]
        });
        let [size, scale] = squares.map(f64::sqrt);
        Imbalance { size, scale }
    }
}

impl<const D: usize> Problem<'_, D> {
    /// There, whatever was tried last.
    pub(in crate::run) fn go_to(&mut self, found: &Tried<D>, inertia: &Inertia<D>) {
        self.system.set_values(&found.x);
        self.set_velocities_of(found);
        self.place_bodies(found, inertia);
    }

    pub(super) fn set_velocities_of(&mut self, tried: &Tried<D>) {
        for (v, &s) in tried.v.iter().zip(self.system.body.slots()) {
            for a in 0..D {
                self.system.v[a][s as usize] = v[a];
            }
        }
    }
}
