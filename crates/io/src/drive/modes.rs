//! Modes of vibration as files.

use super::{DriveError, Plan};
use crate::deck::Dim;
use crate::write::picture::{self, shown::About};
use crate::write::table::Table;
use crate::write::{Series, SeriesOptions};
use peridyne::observe::{Snapshot, Values};
use peridyne::run::Simulation;

/// Modes that get a picture.
const PICTURED: usize = 12;

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
    };
    let mut series = Series::new(plan.dir.join("modes"), options)?;
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
        series.write(&shape)?;
        if let Some(options) = plan.series.pictures.first().filter(|_| n < PICTURED) {
            let frequency = plan.units.show(mode.frequency, Dim::FREQUENCY);
            let title = format!("mode {}, {frequency}", n + 1);
            let options = options.of_shape(&shape, title);
            let path = plan.dir.join(format!("modes/mode_{:02}.png", n + 1));
            picture::write(&path, &shape, &options, About::Equilibrium)?;
        }
    }
    Ok(())
}
