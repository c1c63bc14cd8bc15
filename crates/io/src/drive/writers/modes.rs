//! Modes of vibration as files.

use super::writer::{Made, Now, Writer};
use crate::deck::Dim;
use crate::drive::plan::{DriveError, Plan};
use crate::write::earlier::sweep_frames;
use crate::write::picture::{self, shown::About};
use crate::write::table::Table;
use crate::write::{Series, SeriesOptions, WriteError};
use peridyne::observe::{Snapshot, Values};
use peridyne::state::{Archive, Owner};
use std::fs;
use std::path::Path;

/// Modes that get a picture.
const PICTURED: usize = 12;

/// Where their shapes are.
const FOLDER: &str = "modes";

/// Those about the last state, or about that in which motion begins.
pub struct Modes;

impl Owner for Modes {
    fn archive(&mut self, _: &mut Archive<'_>) {}
}

impl Writer for Modes {
    fn open(&mut self, now: &mut Now<'_>, goes_on: bool) -> Result<(), DriveError> {
        match goes_on {
            true => Ok(()),
            false => Ok(sweep_modes(&now.plan.dir)?),
        }
    }

    fn rewind(&mut self, _: &mut Now<'_>) -> Result<(), DriveError> {
        Ok(())
    }

    fn look(&mut self, now: &mut Now<'_>) -> Result<(), DriveError> {
        let plan = now.plan;
        let begins = plan.increments > 0 && now.due.step == plan.increments && !now.due.last;
        match plan.modes > 0 && begins {
            true => write_modes(now),
            false => Ok(()),
        }
    }

    fn end(self: Box<Self>, now: &mut Now<'_>, _: &mut Made) -> Result<(), DriveError> {
        let plan = now.plan;
        let whole = now.stopped.is_none() && !now.hurried;
        match plan.modes > 0 && plan.increments == 0 && whole {
            true => write_modes(now),
            false => Ok(()),
        }
    }
}

/// Removes the shapes of an earlier run, and their pictures.
fn sweep_modes(dir: &Path) -> Result<(), WriteError> {
    let folder = dir.join(FOLDER);
    if !folder.join("points.pvd").is_file() {
        return Ok(());
    }
    sweep_frames(&folder, "points", &[])?;
    let pictures = (1..=PICTURED).map(|n| folder.join(picture_of(n)));
    for path in pictures
        .chain([dir.join("modes.csv")])
        .filter(|p| p.is_file())
    {
        fs::remove_file(&path).map_err(WriteError::at("remove the earlier run's", &path))?;
    }
    Ok(())
}

fn picture_of(mode: usize) -> String {
    format!("mode_{mode:02}.png")
}

/// `modes.csv`, and the shapes as `points_<mode>.vtu` and `points.pvd` in the folder `modes`, frequencies in place of times.
fn write_modes(now: &mut Now<'_>) -> Result<(), DriveError> {
    let (state, plan): (_, &Plan) = (now.snapshot(), now.plan);
    let modes = now
        .sim
        .modes(plan.modes)
        .map_err(|error| DriveError::Modes {
            error,
            dir: plan.dir.clone(),
        })?;
    let numbers: Vec<f64> = (1..=modes.len()).map(|n| n as f64).collect();
    let per_time = |power: &str| match plan.time_unit.as_str() {
        "" => String::new(),
        unit => format!("1/{unit}{power}"),
    };
    Table::new()
        .column("mode", "", numbers)
        .column(
            "frequency",
            &per_time(""),
            modes.iter().map(|m| m.frequency),
        )
        .column(
            "angular frequency squared",
            &per_time("²"),
            modes.iter().map(|m| m.square),
        )
        .save(&plan.dir.join("modes.csv"))?;
    let options = SeriesOptions {
        pictures: vec![],
        dump: None,
        bonds: false,
        points: true,
        cells: plan.series.cells.clone(),
        units: plan.units,
    };
    let mut series = Series::new(plan.dir.join(FOLDER), options)?;
    for (n, mode) in modes.into_iter().enumerate() {
        let mut shape = Snapshot::clone(&state);
        shape.step = n as u64 + 1;
        shape.time = mode.frequency;
        let displacement = shape
            .columns
            .iter_mut()
            .find(|c| c.name() == "displacement");
        if let Some(column) = displacement {
            column.values = Values::Vectors(mode.shape);
        }
        series.write(&shape, &[])?;
        if let Some(options) = plan.series.pictures.first().filter(|_| n < PICTURED) {
            let frequency = plan.units.show(mode.frequency, Dim::FREQUENCY);
            let title = format!("mode {}, {frequency}", n + 1);
            let options = options.of_shape(&shape, title);
            let path = plan.dir.join(FOLDER).join(picture_of(n + 1));
            picture::write(&path, &shape, &[], &options, About::Equilibrium)?;
        }
    }
    Ok(())
}
