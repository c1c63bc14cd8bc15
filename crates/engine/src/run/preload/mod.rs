//! Statics before motion: increments of load under conditions of their own, and the passage from the last equilibrium to motion. The
//! ledger goes on through it: what loads and reactions did in statics is the strain energy that motion begins with.

pub(super) mod state;

use self::state::Preload;
use super::Simulation;
use super::constitutive::Laws;
use super::equilibrium::state::StaticState;
use super::model::Model;
use crate::condition::constraint::Constraint;
use crate::condition::indenter::Indenter;
use crate::error::{BuildError, RunError};
use crate::fracture::precrack::Crack;
use crate::message;
use crate::quantity::{Dimension, place};
use crate::spec::{Control, CrackKind, Method, PreloadSpec, Spec, Statics, Stepper};
use crate::statics::Solved;

/// Distances (spacings) that are round-off.
const NEAR: f64 = 1e-9;

/// What cannot begin in equilibrium.
pub(super) fn possible(spec: &Spec, preload: &PreloadSpec) -> Result<(), BuildError> {
    let refused = |path: &str, message: &str, help: &str| {
        Err(BuildError::unsupported(path, message.to_string()).help(help.to_string()))
    };
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
    match spec.schedule.stepper {
        Stepper::Verlet | Stepper::Newmark(_) => {}
        Stepper::Still | Stepper::Statics(_) => {
            return refused(
                "schedule.integrator",
                "statics before motion, and no motion follows",
                "take integrator = \"verlet\" or \"newmark\"",
            );
        }
    }
    if !spec.transfers.is_empty() {
        return refused(
            "preload.statics",
            "heat or a species spreads in time, and statics before motion has none",
            "leave [statics] out and load the body in time, or leave out what spreads",
        );
    }
    if !spec.pairs.is_empty() {
        return refused(
            "pairs",
            "pairs of materials with constants of their own have no tangents: there is no statics before their motion",
            "leave [statics] out",
        );
    }
    Ok(())
}

impl<const D: usize> Model<D> {
    /// The model is ready for its motion: sets that aside, and makes it ready for the statics before it.
    pub(super) fn prepare_preload(
        &mut self,
        preload: &PreloadSpec,
        sets: &[(String, Vec<u32>)],
    ) -> Result<(), BuildError> {
        let statics = Statics {
            timed: preload.duration.is_some(),
            ..preload.statics
        };
        if statics.control != Control::Load {
            return Err(BuildError::unsupported(
                "preload.statics.control",
                "statics whose load is what the body bears ends anywhere, not where motion could begin",
            )
            .help("leave control out"));
        }
        let linear = |l: &Laws| matches!(l, Laws::Springs(_) | Laws::Micromoduli(_));
        if statics.method == Method::Linear && !self.constitutive.all().all(|m| linear(&m.laws)) {
            return Err(BuildError::unsupported(
                "preload.statics.method",
                "a linear solution is no equilibrium of the law that moves the body: motion would begin with a jolt",
            )
            .help("leave method out, or write method = \"newton\""));
        }
        let cuts = preload.cuts.iter().enumerate().map(|(n, cut)| {
            if cut.kind == CrackKind::Absent {
                return Err(BuildError::unsupported(
                    format!("preload.cuts[{n}]"),
                    "bonds that are loaded cannot be made never to have been",
                )
                .help("write kind = \"broken\", or leave it out"));
            }
            Crack::new(&cut.shape, self.body.period).map_err(|e| e.at(format!("preload.cuts[{n}]")))
        });
        let cuts = cuts.collect::<Result<Vec<_>, _>>()?;
        let within = |e: BuildError| e.within("preload");
        let (loads, constraints) = self
            .loads_and_constraints(&preload.conditions, sets)
            .map_err(within)?;
        self.agrees(&constraints, preload.end())?;
        let indenters = preload.indenters.iter().map(Indenter::new).collect();
        let knows_contact = statics.method == Method::Relaxation;
        let waits = Preload {
            increments: preload.increments,
            shown: match preload.duration {
                Some(all) => all / preload.increments as f64,
                None => self.dt,
            },
            loads: std::mem::replace(&mut self.loads, loads),
            constraints: std::mem::replace(&mut self.constraints, constraints),
            indenters: std::mem::replace(&mut self.indenters, indenters),
            contact: match knows_contact {
                true => None,
                false => self.contact.take(),
            },
            friction: self.friction.take(),
            velocity: self.v.clone(),
            dt: self.dt,
            implicit: self.implicit.take(),
            cuts,
        };
        self.dt = preload.end() / preload.increments as f64;
        self.check_agreement(&preload.conditions, preload.end())
            .map_err(within)?;
        self.check_statics(statics).map_err(within)?;
        let told = Self::tell_loads(
            &self.body,
            &mut self.loads,
            &preload.conditions,
            preload.end(),
        );
        self.info.loads.splice(0..0, told);
        self.statics = Some(StaticState::new(statics));
        self.loaded = Some(Solved::default());
        self.preload = Some(waits);
        Ok(())
    }

    /// Do points that both stages hold begin their motion where statics leaves them?
    fn agrees(&self, before: &[Constraint<D>], end: f64) -> Result<(), BuildError> {
        let mut left = std::collections::HashMap::new();
        for c in before {
            c.each(|k, slot, a| {
                if let Some(x) = c.displaced(a, k, end) {
                    left.insert((slot, a), x);
                }
            });
        }
        let mut jump = None;
        for c in &self.constraints {
            c.each(|k, slot, a| {
                if let (Some(x), Some(from)) = (c.displaced(a, k, 0.0), left.get(&(slot, a)))
                    && self.apart(x, *from)
                    && jump.is_none()
                {
                    jump = Some((slot, a, x, *from));
                }
            });
        }
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

    fn apart(&self, x: f64, y: f64) -> bool {
        !((x - y).abs() <= NEAR * (self.body.spacing + x.abs().max(y.abs())))
    }

    /// Is the next step the first of the motion?
    pub(super) fn is_loaded(&self) -> bool {
        { self.preload.as_ref() }.is_some_and(|p| self.step >= p.increments)
    }

    /// Time as records show it: motion begins at 0, and statics is before.
    pub(super) fn shown_time(&self) -> f64 {
        match &self.preload {
            Some(p) => (self.step as f64 - p.increments as f64) * p.shown,
            None => self.time(),
        }
    }

    /// Time of a frame, which only grows: where t is a factor that may fall, the number of the equilibrium.
    pub(super) fn frame_time(&self) -> f64 {
        let falls = |s: &StaticState<D>| s.options.control != Control::Load;
        match self.statics.as_ref().is_some_and(falls) {
            true => self.step as f64,
            false => self.shown_time(),
        }
    }

    /// From the last equilibrium to motion: what waited takes the place of what loaded the body. On an error nothing is changed.
    pub(super) fn set_in_motion(&mut self) -> Result<(), RunError> {
        let Some(mut waits) = self.preload.take() else {
            return Ok(());
        };
        if let Err(error) = self.can_move(&mut waits) {
            self.preload = Some(waits);
            return Err(error);
        }
        let now = self.energy_now();
        if let Some(state) = self.statics.take() {
            self.loaded = Some(state.solved);
        }
        self.past_work = [now.dissipated, now.work_conditions, now.work_indenter];
        self.driven.clear();
        self.loads = waits.loads;
        self.constraints = waits.constraints;
        self.indenters = waits.indenters;
        if waits.contact.is_some() {
            self.contact = waits.contact;
        }
        self.friction = waits.friction;
        self.implicit = waits.implicit;
        self.dt = waits.dt;
        self.origin = (self.step, 0.0);
        self.v = waits.velocity;
        if !waits.cuts.is_empty() {
            let held: f64 = self.interaction.energy(&self.body, &self.u).iter().sum();
            for crack in &waits.cuts {
                self.info.cut +=
                    self.interaction
                        .cut(&self.body, CrackKind::Broken, &|from, to| {
                            crack.crosses(&from, &to)
                        });
            }
            let kept: f64 = self.interaction.energy(&self.body, &self.u).iter().sum();
            self.released.book(held - kept);
        }
        let (t, dt) = (self.time(), self.dt);
        for c in &mut self.constraints {
            c.start(&mut self.u, &mut self.v, t, dt);
        }
        self.look_again();
        self.forces(true, 0.0);
        // velocities were given, not made by forces
        let given = self.energy_now().kinetic;
        if let Some(initial) = &mut self.initial_energy {
            *initial += given;
        }
        Ok(())
    }

    /// Does motion begin where statics ended?
    fn can_move(&mut self, waits: &mut Preload<D>) -> Result<(), RunError> {
        let mut jump = None;
        for c in &waits.constraints {
            c.each(|k, slot, axis| {
                if let Some(asked) = c.displaced(axis, k, 0.0)
                    && self.apart(asked, self.u[axis][slot])
                    && jump.is_none()
                {
                    jump = Some(RunError::Jump {
                        step: self.step,
                        position: self.body.position(slot),
                        axis: ["x", "y", "z"][axis],
                        asked,
                        found: self.u[axis][slot],
                    });
                }
            });
        }
        if let Some(jump) = jump {
            return Err(jump);
        }
        if let Some(contact) = &mut waits.contact {
            let (body, interaction) = (&self.body, &self.interaction);
            contact.look_again();
            contact.update(body, &self.u, &|i, j| interaction.in_family(body, i, j));
            // those that attract each other, too
            let mut pairs = 0;
            contact.each_pull(&self.u, |_| pairs += 1);
            if pairs > 0 {
                return Err(RunError::Touching {
                    step: self.step,
                    pairs,
                });
            }
        }
        Ok(())
    }
}
