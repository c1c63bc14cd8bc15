//! Modes of vibration as files.

use super::{DriveError, Plan};
use crate::deck::Dim;
use crate::write::earlier::sweep_frames;
use crate::write::picture::{self, shown::About};
use crate::write::table::Table;
use crate::write::{Series, SeriesOptions, WriteError};
use peridyne::observe::{Snapshot, Values};
use peridyne::run::Simulation;
use std::fs;
use std::path::Path;

/// Modes that get a picture.
const PICTURED: usize = 12;

/// Where their shapes are.
const FOLDER: &str = "modes";

/// Removes the shapes of an earlier run, and their pictures.
pub(super) fn sweep_modes(dir: &Path) -> Result<(), WriteError> {
    let folder = dir.join(FOLDER);
    if !folder.join("points.pvd").is_file() {
        return Ok(());
    }
    sweep_frames(&folder, "points")?;
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
pub(super) fn write_modes(
    sim: &mut dyn Simulation,
    plan: &Plan,
    state: &Snapshot,
) -> Result<(), DriveError> {
    let modes = sim.modes(plan.modes).map_err(|error| DriveError::Modes {
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
    };
    let mut series = Series::new(plan.dir.join(FOLDER), options)?;
    for (n, mode) in modes.into_iter().enumerate() {
        let mut shape = state.clone();
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
