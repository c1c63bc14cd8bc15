//! Fields of a body on a line over place and time: recorded while it moves, drawn at the end.

use crate::drive::options::SpaceTimeOptions;
use peridyne::run::Simulation;
use peridyne::state::{Archive, Owner};
use std::time::Instant;

use super::writer::{Made, Now, Writer};
use crate::deck::Dim;
use crate::drive::plan::{DriveError, Plan};
use crate::write::WriteError;
use crate::write::folder::SPACE_TIME;
use crate::write::picture::shown::Shown;
use crate::write::space_time::{DENSITY, Line, SpaceTime};

struct One {
    options: SpaceTimeOptions,
    line: Line,
    image: SpaceTime,
    /// What the field is called, and what it measures.
    name: String,
    dimension: Dim,
}

#[derive(Default)]
pub struct SpaceTimes {
    all: Vec<One>,
}

impl Owner for SpaceTimes {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        for one in &mut self.all {
            archive.within("image", |archive| {
                archive.text("name", &mut one.name);
                archive.one("dimension", &mut one.dimension);
                archive.list("times", &mut one.image.times);
                archive.list("values", &mut one.image.values);
            });
        }
    }
}

impl Writer for SpaceTimes {
    fn open(&mut self, now: &mut Now<'_>, _: bool) -> Result<(), DriveError> {
        let (sim, plan) = (&mut *now.sim, now.plan);
        if plan.space_time.is_empty() || sim.info().stepper.statics().is_some() {
            return Ok(());
        }
        let reference = sim.vectors("reference");
        let several = sim.columns().iter().any(|c| c.name == "body");
        let body = several.then(|| sim.scalars("body"));
        for options in &plan.space_time {
            let line = Line::new(&reference, body.as_deref(), options.period);
            let ends = options.field != DENSITY || options.period.is_some();
            if let Some(image) = SpaceTime::new(&line, &options.window, ends) {
                self.all.push(One {
                    options: options.clone(),
                    line,
                    image,
                    name: options.field.clone(),
                    dimension: Dim::NUMBER,
                });
            }
        }
        Ok(())
    }

    fn rewind(&mut self, _: &mut Now<'_>) -> Result<(), DriveError> {
        Ok(())
    }

    fn look(&mut self, now: &mut Now<'_>) -> Result<(), DriveError> {
        if !now.due.loads && !now.due.last {
            let steps = now.plan.steps - now.plan.increments;
            self.record(now.sim, now.due.moved, steps);
        }
        Ok(())
    }

    fn end(self: Box<Self>, now: &mut Now<'_>, made: &mut Made) -> Result<(), DriveError> {
        let drawing = Instant::now();
        made.pictures.extend(self.draw(now.plan)?);
        now.spent.pictures += drawing.elapsed().as_secs_f64();
        Ok(())
    }
}

impl SpaceTimes {
    /// Looks after so many of all steps of motion.
    fn record(&mut self, sim: &mut dyn Simulation, step: u64, steps: u64) {
        let dt = sim.info().time_step;
        for one in &mut self.all {
            if !one.options.window.is_row(step, steps, dt) {
                continue;
            }
            let values = match one.options.field.as_str() {
                DENSITY => {
                    let u: Vec<f64> = sim.displacements().iter().map(|u| u[0]).collect();
                    one.line.density(&one.line.along(&u))
                }
                field => {
                    let snapshot = sim.snapshot(&[field], false);
                    match Shown::of(&snapshot, field, one.options.component.as_deref()) {
                        Ok(shown) => {
                            (one.name, one.dimension) = (shown.name, shown.dimension);
                            one.line.along(&shown.values)
                        }
                        // there is no such field: who asked was told before
                        Err(_) => continue,
                    }
                }
            };
            one.image.record(sim.clock(), &values);
        }
    }

    /// Draws and saves; names of the pictures.
    fn draw(&self, plan: &Plan) -> Result<Vec<String>, WriteError> {
        let (mut stems, mut names) = (vec![], vec![]);
        // a picture of one time has no axis
        for one in self.all.iter().filter(|one| one.image.times.len() > 1) {
            let (options, image) = (&one.options, &one.image);
            let part = options.component.as_ref().map(|c| format!("_{c}"));
            let stem = format!("{SPACE_TIME}{}{}", options.field, part.unwrap_or_default());
            stems.push(stem.clone());
            let name = match stems.iter().filter(|s| **s == stem).count() {
                1 => stem,
                n => format!("{stem}_{n}"),
            };
            let [length, unit] = [Dim::LENGTH, one.dimension].map(|d| plan.units.unit(d));
            let range = options.range.unwrap_or_else(|| image.range(&options.field));
            image
                .map(
                    &plan.title,
                    &one.name,
                    [&length, &plan.time_unit, &unit],
                    range,
                )
                .save(&plan.dir, &name)?;
            image.save(&plan.dir.join(format!("{name}.npz")), &options.field)?;
            names.push(format!("{name}.png"));
        }
        Ok(names)
    }
}
