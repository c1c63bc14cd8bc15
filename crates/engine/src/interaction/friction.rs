//! Coulomb friction of points that touch: force density `μ K (d − r) V_j` on i along the tangential velocity of j against i,
//! `w = (1 − n⊗n)(v_j − v_i)` with n from i to j, and the opposite force on j. K (d − r) is what they repel with. μ may depend on |w| and on
//! time ([`FrictionSpec`]).
//!
//! Momentum is kept, and what friction does is dissipated. A pair that sticks has no direction: the force is never more than
//! what takes an equal part of w from every partner within one step, `m |w| / (z Δt)` with the reduced mass `m = m_i m_j/(m_i + m_j)`
//! and z the greater number of partners of the two. Sticking points so creep with z accelerations of a step, and friction
//! turns no motion around: without the bound it would do so in every step, by as much as `μ N Δt/m`.

use super::contact::{Contact, Touch};
use crate::body::{Body, Field, zeros};
use crate::expression::Expression;
use crate::spec::FrictionSpec;

/// Friction outside the families, and what it has dissipated.
#[derive(Debug, Clone)]
pub struct Friction<const D: usize> {
    law: FrictionSpec,
    now: Coefficients,
    /// Force density of the last evaluation.
    force: Field<D>,
    /// `[slots]`: with how many a point is in touch.
    partners: Vec<u32>,
    /// Work done on the bodies (energy): what is dissipated, negative.
    pub work: f64,
}

/// Coefficients of a law at a time; what is below 0 counts as 0.
#[derive(Debug, Clone, Copy, Default)]
pub struct Coefficients {
    /// μ_k
    kinetic: f64,
    /// μ_s − μ_k
    more: f64,
    /// 1/v_c
    slowness: f64,
}

impl Coefficients {
    pub fn new(law: &FrictionSpec, t: f64) -> Coefficients {
        let at = |e: &Expression| match e.eval(&[0.0; 3], t) {
            x if x < 0.0 => 0.0,
            x => x,
        };
        let kinetic = at(&law.kinetic);
        let (more, slowness) = match &law.at_rest {
            None => (0.0, 0.0),
            Some(rest) => (at(&rest.coefficient) - kinetic, 1.0 / rest.speed),
        };
        Coefficients {
            kinetic,
            more,
            slowness,
        }
    }

    /// μ at a sliding speed.
    pub fn at(&self, speed: f64) -> f64 {
        match self.more {
            0.0 => self.kinetic,
            more => self.kinetic + more * (-speed * self.slowness).exp(),
        }
    }
}

impl<const D: usize> Friction<D> {
    pub fn new(law: FrictionSpec, body: &Body<D>) -> Self {
        Friction {
            law,
            now: Coefficients::default(),
            force: zeros(body.len),
            partners: vec![0; body.len],
            work: 0.0,
        }
    }

    /// Half of the work of the old force; `v` is the velocity of the middle of the step that ends now.
    pub fn begin(&mut self, body: &Body<D>, v: &Field<D>, dt: f64) {
        self.half_path(body, v, dt);
    }

    /// Adds the force density at the displacements of the contact's last update to `f`. `v` is the velocity of the step's middle,
    /// `dt` the step that ends, 0 at the start of a run, `step` the one that begins, `t` the time.
    pub fn add(
        &mut self,
        contact: &Contact<D>,
        body: &Body<D>,
        [u, v]: [&Field<D>; 2],
        f: &mut Field<D>,
        t: f64,
        [dt, step]: [f64; 2],
    ) {
        self.now = Coefficients::new(&self.law, t);
        self.partners.fill(0);
        contact.each_contact(u, |touch| {
            self.partners[touch.i] += 1;
            self.partners[touch.j] += 1;
        });
        self.force.iter_mut().for_each(|c| c.fill(0.0));
        contact.each_contact(u, |touch| {
            let Some(force) = self.between(body, v, &touch, step) else {
                return;
            };
            let [vi, vj] = [touch.i, touch.j].map(|s| body.volume.at(s));
            for a in 0..D {
                self.force[a][touch.i] += force[a] / vi;
                self.force[a][touch.j] -= force[a] / vj;
            }
        });
        for a in 0..D {
            for (f, own) in f[a].iter_mut().zip(self.force[a].iter()) {
                *f += own;
            }
        }
        self.half_path(body, v, dt);
    }

    /// The force on i; `None`: nothing rubs.
    fn between(
        &self,
        body: &Body<D>,
        v: &Field<D>,
        touch: &Touch<D>,
        step: f64,
    ) -> Option<[f64; D]> {
        let &Touch { i, j, y, r, .. } = touch;
        let mut w: [f64; D] = std::array::from_fn(|a| v[a][j] - v[a][i]);
        let across = (0..D).map(|a| w[a] * y[a]).sum::<f64>() / (r * r);
        for a in 0..D {
            w[a] -= across * y[a];
        }
        let speed = w.iter().map(|c| c * c).sum::<f64>().sqrt();
        if !(r > 0.0 && speed > 0.0) {
            return None;
        }
        let [mi, mj] = [i, j].map(|s| body.density.at(s) * body.volume.at(s));
        let z = self.partners[i].max(self.partners[j]);
        let most = mi * mj / (mi + mj) * speed / (f64::from(z) * step);
        let normal = touch.stiffness * (touch.d - r) * body.volume.at(i) * body.volume.at(j);
        let force = (self.now.at(speed) * normal).min(most);
        Some(w.map(|c| force * c / speed))
    }

    fn half_path(&mut self, body: &Body<D>, v: &Field<D>, dt: f64) {
        if dt == 0.0 {
            return;
        }
        for &s in &body.slots {
            let i = s as usize;
            let power: f64 = (0..D).map(|a| self.force[a][i] * v[a][i]).sum();
            self.work += 0.5 * dt * power * body.volume.at(i);
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        (8 * D + 4) * self.partners.len()
    }
}
