//! The fields of a run: at which steps they are made, and where they go.

use super::live::Live;
use super::plan::{FieldsSpec, Place};
use super::units::Units;
use crate::write::atomic::WriteError;
use crate::write::continuum::{Collected, Origin, examined};
use peridyne::run::Simulation;
use peridyne::spec::Spec;
use peridyne::state::{Archive, Owner};
use peridyne_fields::effort::Effort;
use peridyne_fields::{Cell, FieldsError, Frame, Method, Quantity, Targets};
use std::ffi::OsStr;
use std::path::Path;
use std::time::Instant;

/// What a deck asks for, and of which model.
#[derive(Debug, Clone)]
pub struct FieldsPlan {
    pub asked: Vec<FieldsSpec>,
    pub spec: Spec,
    /// Lower corner of the periods.
    pub corner: [f64; 3],
    pub units: Units,
    /// Has somebody had enough? Fields end then, and so does the run.
    pub stop: fn() -> bool,
}

/// What a deck's fields will be, from a frame of the start.
#[derive(Debug, Clone)]
pub struct Foreseen {
    /// Distance of the points of a grid along each axis that has more than one (length).
    pub grid: Vec<f64>,
    /// Of the fields, and why there are no others.
    pub made: Vec<Quantity>,
    pub missing: Vec<(Quantity, &'static str)>,
    /// What a frame took (seconds).
    pub seconds: f64,
}

/// What one frame of each field will take, and that it can be had.
///
/// # Errors
/// What is asked for makes no sense with this model, or is more than memory holds or a day computes.
pub fn efforts(sim: &mut dyn Simulation, plan: &FieldsPlan) -> Result<Vec<Effort>, FieldsError> {
    let live = Live::new(sim, &plan.spec, plan.corner)?;
    let one = |asked: &FieldsSpec| -> Result<Effort, FieldsError> {
        let cell = live.cell(&asked.place)?;
        let (targets, method) = live.method(asked, &cell)?;
        let effort = live.effort(&mut *sim, &cell, &targets, &method);
        let named = |FieldsError(why)| FieldsError(format!("{}: {why}", asked.name));
        effort.check(&targets, &method).map_err(named)?;
        Ok(effort)
    };
    plan.asked.iter().map(one).collect()
}

/// Makes each field once, of the model as it is now.
///
/// # Errors
/// What is asked for makes no sense with this model.
pub fn foresee(
    sim: &mut dyn Simulation,
    plan: &FieldsPlan,
) -> Result<Vec<Result<Foreseen, FieldsError>>, FieldsError> {
    let live = Live::new(sim, &plan.spec, plan.corner)?;
    let mut all = vec![];
    for asked in &plan.asked {
        let cell = live.cell(&asked.place)?;
        let (targets, method) = live.method(asked, &cell)?;
        let grid = match &asked.place {
            Place::Grid { counts, .. } => { (0..3).filter(|a| counts[*a] > 1) }
                .map(|a| cell.height(a) / counts[a] as f64)
                .collect(),
            Place::Points(_) => vec![],
        };
        let begun = Instant::now();
        let frame = live.frame(sim, &cell);
        all.push(live.fields(sim, &frame, &targets, &method).map(|fields| {
            let (made, missing): (Vec<_>, Vec<_>) = Quantity::ALL
                .into_iter()
                .filter(|q| asked.pressure || *q != Quantity::Pressure)
                .filter(|q| asked.coordinate || !Quantity::PLACES.contains(q))
                .partition(|q| fields.get(*q).is_some());
            Foreseen {
                grid,
                made,
                missing: missing
                    .into_iter()
                    .map(|q| (q, fields.why_not(q)))
                    .collect(),
                seconds: begun.elapsed().as_secs_f64(),
            }
        }));
    }
    Ok(all)
}

/// Fields that are being made.
pub struct RunningFields {
    live: Live,
    each: Vec<One>,
}

struct One {
    asked: FieldsSpec,
    cell: Cell,
    targets: Targets,
    method: Method,
    collected: Collected,
    /// Frames met so far, those passed over too.
    met: u64,
    /// Why there are no more.
    stopped: bool,
}

impl Owner for RunningFields {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        for one in &mut self.each {
            archive.within("field", |archive| {
                archive.one("met", &mut one.met);
                archive.one("stopped", &mut one.stopped);
                let grid = one.grid();
                one.collected.archive(grid, archive);
            });
        }
    }
}

impl RunningFields {
    /// Takes away what came after the state that was read.
    ///
    /// # Errors
    /// The operating system's; a frame is missing.
    pub fn rewind(&mut self) -> Result<(), WriteError> {
        self.each
            .iter_mut()
            .try_for_each(|one| one.collected.rewind())
    }

    /// # Errors
    /// What is asked for makes no sense with this model.
    pub fn new(
        sim: &mut dyn Simulation,
        plan: &FieldsPlan,
        dir: &Path,
    ) -> Result<RunningFields, FieldsError> {
        let live = Live::new(sim, &plan.spec, plan.corner)?;
        let mut each = vec![];
        for asked in &plan.asked {
            let cell = live.cell(&asked.place)?;
            let (targets, mut method) = live.method(asked, &cell)?;
            method.stop = plan.stop;
            live.effort(sim, &cell, &targets, &method)
                .check(&targets, &method)?;
            each.push(One {
                collected: Collected::new(
                    dir.join(&asked.name),
                    plan.units,
                    asked.each,
                    asked.pressure,
                )
                .with_film(asked.film),
                asked: asked.clone(),
                cell,
                targets,
                method,
                met: 0,
                stopped: false,
            });
        }
        Ok(RunningFields { live, each })
    }

    /// Makes what is due at this step. Returns what the user should know: fields that end here, and why.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn look(&mut self, sim: &mut dyn Simulation, step: u64) -> Result<Vec<String>, WriteError> {
        self.take(sim, |one| one.is_due(step))
    }

    /// The same where the run ends: a run that ends before its first frame has its end.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn look_last(&mut self, sim: &mut dyn Simulation) -> Result<Vec<String>, WriteError> {
        self.take(sim, |one| !one.stopped && one.collected.frames() == 0)
    }

    fn take(
        &mut self,
        sim: &mut dyn Simulation,
        due: impl Fn(&mut One) -> bool,
    ) -> Result<Vec<String>, WriteError> {
        let mut said = vec![];
        for one in &mut self.each {
            if !due(one) {
                continue;
            }
            if let Err(why) = one.take(&self.live, sim)? {
                one.stopped = true;
                said.push(format!(
                    "no {} from step {} on: {why}",
                    one.asked.name,
                    sim.step_number()
                ));
            }
        }
        Ok(said)
    }

    /// Writes what stands for all frames; gives the pictures that there are, with their names in the folder of the run. Films are drawn
    /// short where there is a hurry.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn finish(self, hurried: bool) -> Result<Vec<String>, WriteError> {
        let of = self.live.source();
        let mut pictures = vec![];
        for mut one in self.each {
            if hurried {
                one.collected.hurry();
            }
            let made = one.collected.finish("the run", of, &one.method)?;
            let names = made.pictures.iter().filter_map(|p| p.file_name());
            let inside = |n: &OsStr| format!("{}/{}", one.asked.name, n.display());
            pictures.extend(names.map(inside));
        }
        Ok(pictures)
    }
}

impl One {
    /// Counts and cell of a grid.
    fn grid(&self) -> Option<([usize; 3], Cell)> {
        match self.asked.place {
            Place::Grid { counts, .. } => Some((counts, self.cell.clone())),
            Place::Points(_) => None,
        }
    }

    fn is_due(&mut self, step: u64) -> bool {
        if self.stopped {
            return false;
        }
        let due = self
            .asked
            .every
            .is_some_and(|every| step.is_multiple_of(every));
        if due {
            self.met += 1;
        }
        due && self.met > self.asked.skip
    }

    /// A frame, or why there is none.
    fn take(
        &mut self,
        live: &Live,
        sim: &mut dyn Simulation,
    ) -> Result<Result<(), FieldsError>, WriteError> {
        let frame = live.frame(sim, &self.cell);
        let found = match live.fields(sim, &frame, &self.targets, &self.method) {
            Ok(found) => found,
            Err(why) => return Ok(Err(why)),
        };
        let grid = self.grid();
        let origin = Origin {
            index: self.collected.frames(),
            step: Some(sim.step_number()),
            time: Some(sim.clock()),
            cell: &self.cell,
            grid: grid.is_some(),
            force: None,
        };
        let residuals = self.residuals(live, sim, &frame);
        let about = examined(&found, &origin, residuals);
        self.collected.push(&found, about, grid).map(Ok)
    }

    fn residuals(
        &self,
        live: &Live,
        sim: &mut dyn Simulation,
        frame: &Frame,
    ) -> Result<peridyne_fields::residuals::Residuals, String> {
        if self.asked.residuals == 0 {
            return Err("not asked for".into());
        }
        if live.is_static() {
            return Err(
                "in equilibrium nothing changes that the fluxes could be compared with".into(),
            );
        }
        let all = self.targets.positions(&self.cell);
        let step = all.len().div_ceil(self.asked.residuals).max(1);
        let points: Vec<[f64; 3]> = all.into_iter().step_by(step).collect();
        // a small part of the distance over which φ changes
        let h = self.method.kernel.width() / 40.0;
        live.residuals(sim, frame, &self.method, &points, h)
            .map_err(|e| e.to_string())
    }
}
