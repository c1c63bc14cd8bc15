//! Fields of a body on a line over place and time: recorded while it moves, drawn at the end.

use peridyne::run::Simulation;
use peridyne::spec::Stepper;

use super::Plan;
use crate::deck::Dim;
use crate::write::WriteError;
use crate::write::folder::SPACE_TIME;
use crate::write::picture::shown::Shown;
use crate::write::space_time::{DENSITY, Line, SpaceTime, Window};

/// A field over place and time.
#[derive(Debug, Clone)]
pub struct SpaceTimeOptions {
    /// [`DENSITY`] or a field of points.
    pub field: String,
    pub component: Option<String>,
    /// Ends of the colours.
    pub range: Option<[f64; 2]>,
    pub window: Window,
    /// After which the body repeats.
    pub period: Option<f64>,
}

struct One {
    options: SpaceTimeOptions,
    line: Line,
    image: SpaceTime,
    /// What the field is called, and what it measures.
    name: String,
    dimension: Dim,
}

pub(super) struct SpaceTimes {
    all: Vec<One>,
    steps: u64,
}

impl SpaceTimes {
    pub fn new(sim: &mut dyn Simulation, plan: &Plan) -> SpaceTimes {
        let mut all = vec![];
        if !plan.space_time.is_empty() && !matches!(sim.info().stepper, Stepper::Statics(_)) {
            let reference = sim.vectors("reference");
            let several = sim.columns().iter().any(|c| c.name == "body");
            let body = several.then(|| sim.scalars("body"));
            for options in &plan.space_time {
                let line = Line::new(&reference, body.as_deref(), options.period);
                let ends = options.field != DENSITY || options.period.is_some();
                if let Some(image) = SpaceTime::new(&line, &options.window, ends) {
                    all.push(One {
                        options: options.clone(),
                        line,
                        image,
                        name: options.field.clone(),
                        dimension: Dim::NUMBER,
                    });
                }
            }
        }
        SpaceTimes {
            all,
            steps: plan.steps - plan.increments,
        }
    }

    /// Looks after so many steps of motion.
    pub fn look(&mut self, sim: &mut dyn Simulation, step: u64) {
        let dt = sim.info().time_step;
        for one in &mut self.all {
            if !one.options.window.is_row(step, self.steps, dt) {
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
    pub fn finish(self, plan: &Plan) -> Result<Vec<String>, WriteError> {
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
