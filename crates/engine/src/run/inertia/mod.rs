//! Masses that couple points: accelerations are those of all forces together, `M a = F`, and velocity Verlet has `ρ a` in the place of the
//! force density. Where motion is prescribed so are accelerations, and `M_ff a_f = F_f − M_fc a_c`.

pub(super) mod masses;
pub(super) mod state;

use self::state::Inertia;
use super::system::System;
use crate::body::{Field, zeros};
use crate::boundary_condition::constraint::Constraint;

impl<const D: usize> System<D> {
    /// Accelerations of the forces of now.
    pub(super) fn accelerate(&mut self) {
        if self.regime.equilibrium {
            return;
        }
        let Some(mut inertia) = self.inertia.take() else {
            return;
        };
        let a = self.accelerations(&mut inertia);
        // who holds points asks what these take
        let held = !self.prescribed.constraints.is_empty();
        let taken = match self.body.exchange().any(held) {
            true => inertia.masses.times(&self.body, &a),
            false => vec![],
        };
        inertia.taken.swap(0, 1);
        for (n, &s) in self.body.slots().iter().enumerate() {
            let i = s as usize;
            let (rho, volume) = (self.body.density().at(i), self.body.volume().at(i));
            for axis in 0..D {
                inertia.taken[0][axis][i] = taken.get(n).map_or(0.0, |t| t[axis] / volume);
                inertia.push[axis][i] = match inertia.support.free[n][axis] {
                    true => rho * a[n][axis],
                    false => 0.0,
                };
            }
        }
        self.inertia = Some(inertia);
    }

    /// `[N]` of the forces of now, and as prescribed where motion is.
    pub(super) fn accelerations(&self, inertia: &mut Inertia<D>) -> Vec<[f64; D]> {
        let support = self.held();
        let mut a = vec![[0.0; D]; self.body.points()];
        self.prescribed_accelerations(&mut a);
        let volume = |i: usize| self.body.volume().at(i);
        let force = self
            .body
            .by_id(|i| crate::array::from_fn(|axis| volume(i) * self.f[axis][i]));
        inertia.accelerate(&self.body, &support, &force, &mut a);
        a
    }

    /// Those of now, of components whose motion is prescribed; points that stand still, or are carried from outside, have none.
    pub(super) fn prescribed_accelerations(&self, a: &mut [[f64; D]]) {
        let id = self.body.ids_by_slot();
        let (t, dt) = (self.clock.time(), self.clock.dt());
        for c in &self.prescribed.constraints {
            for (k, slot, axis) in c.each() {
                a[id[slot] as usize][axis] = c.acceleration(axis, k, t, dt);
            }
        }
    }

    /// Were points held or released since accelerations were found?
    pub(super) fn holds_others(&self) -> bool {
        let inertia = self.inertia.as_ref();
        inertia.is_some_and(|i| self.body.exchange().any(i.support != self.held()))
    }

    /// Kinetic energy of masses that couple points; `None`: of points.
    pub(super) fn coupled_kinetic(&self) -> Option<f64> {
        let masses = &self.inertia.as_ref()?.masses;
        let v = self.body.values(&self.v);
        Some(0.5 * masses.dot(&self.body, &v, &v))
    }

    /// `M (v₁ − v₀)` over volumes (momentum density), where masses couple points.
    pub(super) fn coupled_change(&self, before: &Field<D>) -> Option<Field<D>> {
        let masses = &self.inertia.as_ref()?.masses;
        let mut change = self.body.values(&self.v);
        for (v, before) in change.iter_mut().zip(self.body.values(before)) {
            *v = crate::array::from_fn(|a| v[a] - before[a]);
        }
        let mut field = zeros(self.body.len());
        let gained = masses.times(&self.body, &change);
        for (m, &s) in gained.iter().zip(self.body.slots()) {
            for a in 0..D {
                field[a][s as usize] = m[a] / self.body.volume().at(s as usize);
            }
        }
        Some(field)
    }

    /// Accounts of the constraints at the end of a step; `change` as [`System::coupled_change`]. What held components gain of the kinetic
    /// energy is `½ (v₀ + v₁)` times their part of it.
    pub(super) fn account_constraints(&mut self, t: f64, dt: f64, change: Option<&Field<D>>) {
        let body = &self.body;
        let gained = |i: usize, a: usize, v: [f64; 2]| match change {
            None => Constraint::<D>::gained(body, i, v),
            Some(change) => 0.5 * (v[0] + v[1]) * change[a][i],
        };
        let state = [&self.u, &self.f];
        self.prescribed.after_forces(body, state, &gained, [t, dt]);
    }
}
