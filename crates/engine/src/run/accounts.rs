//! The accounts of a model: energies now, and whether they still add up.

pub(super) mod state;

use super::system::System;
use crate::body::view;
use crate::boundary_condition::driven::Driven;
use crate::constitutive::Laws;
use crate::error::RunError;
use crate::execute::exact::Exact;
use crate::interaction::BondStatus;
use crate::observe::Ledger;

impl<const D: usize> System<D> {
    /// Energies of a state with whole velocities.
    pub(super) fn energy_now(&mut self) -> Ledger {
        self.refresh_images();
        let [strain, contact] = match self.left_linearly() {
            true => self.quadratic_energy(),
            false => self.interaction.energy(&self.body, view(&self.u)),
        };
        let mut touching = Exact::ZERO;
        if let Some(pairs) = &mut self.contact {
            pairs.find(&self.body, &self.u, self.interaction.as_ref());
            touching = pairs.central.energy(&self.body, &self.u);
        }
        let mut ledger = Ledger {
            strain,
            contact,
            ..self.accounts.ledger()
        };
        let swept = &self.accounts.swept;
        let (mut conditions, mut rigid_bodies) = (Exact::ZERO, Exact::ZERO);
        let mut damping = Exact::ZERO;
        for load in &self.applied.loads {
            match load.is_damping() {
                true => damping.merge(&load.work),
                false => conditions.merge(&load.work),
            }
        }
        self.prescribed
            .work()
            .for_each(|work| conditions.merge(work));
        { self.applied.rigid.iter() }.for_each(|i| rigid_bodies.merge(&i.work));
        for d in &self.applied.driven {
            match d {
                Driven::RigidBody(i) => rigid_bodies.merge(&i.work),
                Driven::Load(l) => conditions.merge(&l.work),
            }
        }
        let mut friction = [Exact::ZERO; 2];
        if let Some(of) = self.contact.as_ref().and_then(|c| c.friction.as_ref()) {
            friction = [&of.work, &of.energy].map(Exact::clone);
        }
        let [rubbed, stored] = friction;
        let swept = [&swept.lost, &swept.made, &swept.dissipated].map(Exact::clone);
        let [lost, made, dissipated] = swept;
        let sums = [
            kinetic(self),
            lost,
            made,
            dissipated,
            damping,
            conditions,
            rigid_bodies,
            touching,
            rubbed,
            stored,
        ];
        let sums = self.body.sums(sums);
        let [
            kinetic,
            lost,
            made,
            dissipated,
            damping,
            conditions,
            rigid_bodies,
            touching,
            rubbed,
            stored,
        ] = sums;
        ledger.kinetic = self.coupled_kinetic().unwrap_or(kinetic);
        ledger.contact += touching;
        ledger.released += lost;
        ledger.made += made;
        ledger.dissipated += dissipated - damping;
        ledger.work_boundary_conditions += conditions;
        ledger.work_rigid_bodies += rigid_bodies;
        ledger.contact += stored;
        ledger.dissipated -= rubbed + stored;
        ledger
    }

    /// The balance now, or why the run cannot be trusted.
    pub(super) fn balance(&mut self) -> Result<Ledger, RunError> {
        if let Some(fault) = self.fault {
            return Err(fault.explained(self.clock.step()));
        }
        let ledger = self.energy_now();
        if let Some((i, j)) = self.crossed_chain() {
            return Err(RunError::Crossing {
                step: self.clock.step(),
                i,
                j,
            });
        }
        let before = ledger.initial.abs()
            + ledger.work_boundary_conditions.abs()
            + ledger.work_rigid_bodies.abs();
        let after = ledger.held() - self.last_kick();
        if !(after <= 10.0 * before + f64::MIN_POSITIVE) && self.clock.has_gone_on() {
            if self.regime.equilibrium {
                return Err(RunError::Unbalanced {
                    step: self.clock.step(),
                    before,
                    after,
                });
            }
            return Err(RunError::Unstable {
                step: self.clock.step(),
                before,
                after,
                time_step: self.clock.dt(),
                contact: (ledger.contact > ledger.strain
                    || self.clock.dt() > self.info.contact_step)
                    .then_some(self.info.contact_step),
            });
        }
        Ok(ledger)
    }

    /// Kinetic energy that the last half kick gave, point by point and never less than 0. A force that acts for the
    /// first time has done no work yet: what it gave is no sign of instability.
    fn last_kick(&self) -> f64 {
        // the trapezoidal rule counts its work
        if self.regime.implicit {
            return 0.0;
        }
        let f = self.inertia.as_ref().map_or(&self.f, |i| &i.push);
        self.body.sum(self.body.slots().iter().map(|s| {
            let i = *s as usize;
            let (rho, volume) = (self.body.density().at(i), self.body.volume().at(i));
            let (mut now, mut before) = (0.0, 0.0);
            for a in 0..D {
                let v = self.v[a][i];
                now += v * v;
                before += (v - 0.5 * self.clock.dt() / rho * f[a][i]).powi(2);
            }
            0.5 * rho * volume * f64::max(now - before, 0.0)
        }))
    }

    /// Neighbours of a chain of solids that went through each other, the first of all ranks: numbers of both points.
    fn crossed_chain(&self) -> Option<(u64, u64)> {
        if D != 1 {
            return None;
        }
        // linear springs may go through each other, atoms are looked at in every step
        let counts = |slot: usize| match self.constitutive.at(&self.body, slot).laws {
            Laws::Bond(_) | Laws::Solid(_) => true,
            Laws::Springs(_) | Laws::Atoms(_) | Laws::Micromoduli(_) => false,
        };
        let mut crossed = None;
        self.interaction
            .each_bond(&self.body, &mut |i, j, xi, state| {
                if crossed.is_none()
                    && state == BondStatus::Whole
                    && counts(i)
                    && xi[0].abs() < 1.5 * self.body.spacing_at(i)
                    && (xi[0] + self.u[0][j] - self.u[0][i]) * xi[0] <= 0.0
                {
                    crossed = Some((i, j));
                }
            });
        let own = crossed.map(|(i, j)| [self.body.number(i), self.body.number(j)]);
        let all = self.body.all_of(&[own.unwrap_or([0; 2])]);
        let found = all.concat().into_iter().filter(|ends| ends[0] > 0).min();
        found.map(|[i, j]| (i, j))
    }
}

/// Kinetic energy of this rank's points, each on its own.
fn kinetic<const D: usize>(system: &System<D>) -> Exact {
    let (body, v) = (&system.body, &system.v);
    let each = body.slots().iter().map(|s| {
        let i = *s as usize;
        let v2: f64 = (0..D).map(|a| v[a][i] * v[a][i]).sum();
        0.5 * body.density().at(i) * body.volume().at(i) * v2
    });
    each.collect()
}
