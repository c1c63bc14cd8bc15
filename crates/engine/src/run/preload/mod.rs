//! Statics before motion: increments of load under conditions of their own, and the passage from the last equilibrium to motion. The
//! ledger goes on through it: what loads and reactions did in statics is the strain energy that motion begins with.

use super::agreed::agreed;
use super::conditions::tell_loads;
use super::model::Model;
use super::names::Names;
use super::stages::{Stage, Stages};
use super::stepper::{self, Stepper};
use super::system::System;
use crate::body::view;
use crate::boundary_condition::prescribed_motion::PrescribedMotion;
use crate::error::{BuildError, RunError};
use crate::fracture::precrack::Crack;
use crate::message;
use crate::quantity::{Dimension, place};
use crate::spec::{CrackKind, PreloadSpec, Spec, Statics, Stepper as Kind};
use crate::statics::Solved;
use std::collections::{HashMap, VecDeque};

/// Distances (spacings) that are round-off.
const NEAR: f64 = 1e-9;

/// What cannot begin in equilibrium.
pub(super) fn possible(spec: &Spec, preload: &PreloadSpec) -> Result<(), BuildError> {
    if preload.increments == 0 {
        return Err(BuildError::invalid(
            "preload.statics",
            "no increments: nothing brings the body into equilibrium before motion begins",
        )
        .help("write increments = 1 or more, or leave the stage of statics out"));
    }
    if !(preload.end() > 0.0 && preload.end().is_finite()) {
        return Err(BuildError::invalid(
            "preload.duration",
            format!(
                "the stage of statics lasts {}, expected a positive number",
                preload.end()
            ),
        ));
    }
    match spec.run.schedule.stepper {
        Kind::Verlet | Kind::Newmark(_) => Ok(()),
        Kind::Still | Kind::Statics(_) => Err(BuildError::unsupported(
            "schedule.integrator",
            "statics before motion, and no motion follows",
        )
        .help("take integrator = \"verlet\" or \"newmark\"")),
    }
}

impl<const D: usize> System<D> {
    /// The system is ready for its motion: sets that aside, and makes it ready for the statics before it.
    pub(super) fn prepare_preload(
        &mut self,
        preload: &PreloadSpec,
        names: &Names<D>,
        motion: Box<dyn Stepper<D>>,
    ) -> Result<Stages<D>, BuildError> {
        let statics = Statics {
            timed: preload.duration.is_some(),
            ..preload.statics
        };
        let cuts = preload.cuts.iter().enumerate().map(|(n, cut)| {
            Crack::new(&cut.shape, self.body.period())
                .map_err(|e| e.at(format!("preload.cuts[{n}]")))
        });
        let cuts = cuts.collect::<Result<Vec<_>, _>>()?;
        let within = |e: BuildError| e.within("preload");
        let (conditions, rigid_bodies) = (&preload.conditions, &preload.rigid_bodies);
        let (forces, constraints) = names
            .acting(&self.body, conditions, rigid_bodies, &names.sets)
            .map_err(within)?;
        let prescribed = PrescribedMotion {
            constraints,
            ..PrescribedMotion::default()
        };
        agreed(&self.body, self.agrees(&prescribed, preload.end()))?;
        let knows_contact = statics.method.minimizes();
        let next = Stage {
            stepper: motion,
            begin: preload.increments,
            applied: std::mem::replace(&mut self.applied, forces),
            prescribed: std::mem::replace(&mut self.prescribed, prescribed),
            contact: self.contact.take_if(|_| !knows_contact),
            friction: self.contact.as_mut().and_then(|c| c.friction.take()),
            velocity: self.v.clone(),
            cuts,
        };
        self.clock.load_first(preload);
        agreed(&self.body, self.check_agreement(conditions, preload.end())).map_err(within)?;
        let statics = stepper::before_motion(statics, self).map_err(within)?;
        let loads = &mut self.applied.loads;
        let told = tell_loads(&self.body, loads, conditions, preload.end());
        self.info.loads.splice(0..0, told);
        self.regime = statics.regime();
        Ok(Stages {
            now: statics,
            coming: VecDeque::from([next]),
            before: Some(Solved::default()),
        })
    }

    /// Do points that both stages hold begin their motion where statics leaves them?
    fn agrees(&self, before: &PrescribedMotion<D>, end: f64) -> Result<(), BuildError> {
        let left = before.displaced(end).map(|(slot, a, x)| ((slot, a), x));
        let left: HashMap<_, _> = left.collect();
        let jump = self.prescribed.displaced(0.0).find_map(|(slot, a, x)| {
            let from = *left.get(&(slot, a))?;
            self.differ(x, from).then_some((slot, a, x, from))
        });
        let Some((slot, a, x, from)) = jump else {
            return Ok(());
        };
        let axis = ["x", "y", "z"][a];
        Err(BuildError::conflict(
            "conditions",
            message![
                "motion begins with a displacement of ",
                Dimension::LENGTH.of(x),
                format!(" along {axis} at the point "),
                place(&self.body.position(slot)[..D]),
                ", the statics before it ends with ",
                Dimension::LENGTH.of(from),
            ],
        )
        .help("t of the motion begins at 0 again: write the last displacement of the statics as the first of the motion, or a velocity"))
    }

    fn differ(&self, x: f64, y: f64) -> bool {
        !((x - y).abs() <= NEAR * (self.body.spacing() + x.abs().max(y.abs())))
    }

    /// Does motion begin where statics ended?
    fn can_move(&mut self, next: &mut Stage<D>) -> Result<(), RunError> {
        let mut told = next.prescribed.displaced(0.0);
        let jump = told.find(|(slot, axis, asked)| self.differ(*asked, self.u[*axis][*slot]));
        let own = jump.map(|(slot, axis, asked)| {
            let id = self.body.number(slot) as f64 - 1.0;
            [id, axis as f64, asked, self.u[axis][slot]]
        });
        let all = self.body.all_of(own.as_slice()).concat();
        if let Some(&[id, axis, asked, found]) = all.first() {
            return Err(RunError::Jump {
                step: self.clock.step(),
                position: self.body.position_of(id as usize),
                axis: ["x", "y", "z"][axis as usize],
                asked,
                found,
            });
        }
        if let Some(contact) = &mut next.contact {
            contact.central.invalidate_neighbours();
            contact.find(&self.body, &self.u, self.interaction.as_ref());
            // those that attract each other, too
            let mut pairs = 0;
            contact
                .central
                .each_once(&self.body, &self.u, |_| pairs += 1);
            let pairs = self.body.count(pairs) as usize;
            if pairs > 0 {
                return Err(RunError::Touching {
                    step: self.clock.step(),
                    pairs,
                });
            }
        }
        Ok(())
    }

    /// Motion begins where statics ended: cracks are cut, and first forces found.
    fn set_in_motion(&mut self, cuts: &[Crack<D>]) {
        if !cuts.is_empty() {
            let held: f64 = self
                .interaction
                .energy(&self.body, view(&self.u))
                .iter()
                .sum();
            for crack in cuts {
                let crosses = |from, to| crack.crosses(&from, &to);
                let cut = self
                    .interaction
                    .cut(&self.body, CrackKind::Broken, &crosses);
                self.info.cut += self.body.count(cut);
            }
            let kept: f64 = self
                .interaction
                .energy(&self.body, view(&self.u))
                .iter()
                .sum();
            self.accounts.released.book(held - kept);
        }
        let step = [self.clock.time(), self.clock.dt()];
        self.prescribed.start(&mut self.u, &mut self.v, step);
        self.invalidate_neighbours();
        self.forces(true, self.given());
        // velocities were given, not made by forces
        let given = self.energy_now().kinetic;
        if let Some(initial) = &mut self.accounts.initial {
            *initial += given;
        }
    }
}

impl<const D: usize> Model<D> {
    /// From the last step of a stage to the next stage, where that is due: what waited takes the place of what acted. On an error nothing
    /// is changed.
    pub(super) fn next_stage(&mut self) -> Result<(), RunError> {
        if self.stages.due(self.system.clock.step()).is_none() {
            return Ok(());
        }
        let Some(mut next) = self.stages.coming.pop_front() else {
            return Ok(());
        };
        if let Err(error) = self.system.can_move(&mut next) {
            self.stages.coming.push_front(next);
            return Err(error);
        }
        self.finish();
        let now = self.system.energy_now();
        self.stages.before = self.stages.solved();
        self.system.accounts.pass(&now);
        let cuts = self.stages.take_over(&mut self.system, next);
        self.system.set_in_motion(&cuts);
        Ok(())
    }
}
