//! A row of the history: what is measured of the whole body at one time.

use peridyne::observe::{Ledger, ProbeColumn, SpeedColumn};
use peridyne::quantity::Dimension;
use peridyne::run::Simulation;
use peridyne::spec::Stepper;
use peridyne::state::{Archive, Owner};

use super::plan::Plan;
use crate::deck::{UnitSystem, each_once};
use crate::write::history::{
    Column, diffusion_columns, diffusion_values, ledger_columns, ledger_values,
};

/// Does the method take energy of its own?
fn is_implicit(sim: &dyn Simulation) -> bool {
    matches!(sim.info().stepper, Stepper::Newmark(_))
}

impl Plan {
    /// Columns of `history.csv` behind the step; the first is time.
    pub fn columns(&self, sim: &dyn Simulation) -> Vec<Column> {
        let mut columns = vec![Column::new("time", &self.time_unit)];
        columns.extend(ledger_columns(&self.energy_unit));
        if is_implicit(sim) {
            columns.push(Column::new("numerical dissipation", &self.energy_unit));
        }
        columns.push(Column::new("broken_bonds", ""));
        if sim.solved().is_some() {
            columns.push(Column::new("iterations", ""));
            columns.push(Column::new("solver_residual", ""));
        }
        if sim.cycles().is_some() {
            columns.push(Column::new("cycles", ""));
        }
        for (quantity, account) in sim.diffusions() {
            columns.extend(diffusion_columns(quantity, &account, &self.energy_unit));
        }
        if let Some(atoms) = &self.atoms {
            columns.push(Column::new("temperature", &atoms.temperature_unit));
            columns.push(Column::new("pressure", &atoms.pressure_unit));
        }
        for probe in probes(sim, self) {
            let unit = match (probe.rooted, probe.moment, self.units) {
                (true, _, units) => units.root_unit(probe.dimension),
                (false, true, UnitSystem::Si) => "N m".into(),
                (false, _, units) => units.unit(probe.dimension),
            };
            columns.push(Column::new(probe.name, &unit));
            let speed = probe.speed.filter(|_| moves(sim));
            let unit = self.units.unit(Dimension::VELOCITY);
            columns.extend(speed.map(|s| Column::new(s.name, unit)));
        }
        columns
    }
}

/// Columns of the probes of a deck; behind these are those of rigid bodies that are drawn.
fn probes(sim: &dyn Simulation, plan: &Plan) -> Vec<ProbeColumn> {
    let mut probes = sim.probe_columns();
    probes.truncate(probes.len().saturating_sub(plan.rigid.columns()));
    probes
}

/// Is there a time that things take?
fn moves(sim: &dyn Simulation) -> bool {
    sim.info().stepper.statics().is_none()
}

/// How far something has come in the rows so far, and how fast it is.
#[derive(Debug)]
pub(super) struct Way {
    /// Part of the way over which speed is a mean (length).
    over: f64,
    times: Vec<f64>,
    lengths: Vec<f64>,
}

impl Way {
    /// Of all that has a speed, in the order of its columns.
    pub fn all(sim: &dyn Simulation, plan: &Plan) -> Vec<Way> {
        let speeds = probes(sim, plan).into_iter().filter_map(|c| c.speed);
        let speeds = speeds.filter(|_| moves(sim));
        let way = |s: SpeedColumn| Way {
            over: s.over,
            times: vec![],
            lengths: vec![],
        };
        speeds.map(way).collect()
    }

    /// Speed at a time at which it has come so far: slope of the line through the rows since the last one at which it was farther behind than the
    /// part, or since it began to move, with the smallest squares of what these miss.
    fn speed(&mut self, time: f64, length: f64) -> f64 {
        self.times.push(time);
        self.lengths.push(length);
        let behind = |l: &f64| *l <= length - self.over;
        let stood = |l: &f64| *l == self.lengths[0];
        let from = { self.lengths.iter().rposition(behind) }
            .or_else(|| self.lengths.iter().rposition(stood));
        let (t, l) = (
            &self.times[from.unwrap_or(0)..],
            &self.lengths[from.unwrap_or(0)..],
        );
        let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
        let (mt, ml) = (mean(t), mean(l));
        let squares: f64 = t.iter().map(|t| (t - mt).powi(2)).sum();
        let both: f64 = t.iter().zip(l).map(|(t, l)| (t - mt) * (l - ml)).sum();
        match squares > 0.0 {
            true => both / squares,
            false => 0.0,
        }
    }
}

impl Owner for Way {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.list("times", &mut self.times);
        archive.list("lengths", &mut self.lengths);
    }
}

/// Their values now.
pub(super) fn row(
    sim: &mut dyn Simulation,
    plan: &Plan,
    ledger: &Ledger,
    ways: &mut [Way],
) -> Vec<f64> {
    let mut row = vec![sim.clock()];
    row.extend(ledger_values(ledger));
    if is_implicit(sim) {
        row.push(ledger.numerical);
    }
    row.push(each_once(sim.broken()) as f64);
    if let Some(solved) = sim.solved() {
        row.extend([solved.iterations as f64, solved.residual]);
    }
    row.extend(sim.cycles());
    for (_, account) in sim.diffusions() {
        row.extend(diffusion_values(&account));
    }
    if let Some(atoms) = &plan.atoms {
        row.extend(atoms.thermo(sim, ledger.kinetic));
    }
    let (measured, time) = (sim.measure(), sim.clock());
    let mut ways = ways.iter_mut();
    for (column, value) in probes(sim, plan).into_iter().zip(measured) {
        row.push(value);
        if column.speed.is_some() {
            row.extend(ways.next().map(|way| way.speed(time, value)));
        }
    }
    row
}

#[cfg(test)]
mod tests {
    use super::*;

    fn way(over: f64) -> Way {
        Way {
            over,
            times: vec![],
            lengths: vec![],
        }
    }

    #[test]
    fn speed_is_that_of_the_last_part_of_the_way() {
        // it stands until t = 5, comes along by 0.5 in every fourth row from then on, and stands from t = 105 on
        let mut tip = way(3.0);
        let length = |row: u32| 0.5 * f64::from(row.clamp(5, 105).saturating_sub(5) / 4);
        let speeds: Vec<f64> = { 0..=205 }
            .map(|row| tip.speed(f64::from(row), length(row)))
            .collect();
        assert!(speeds[..=8].iter().all(|v| *v == 0.0));
        // 0.5 in one row at first, as it stood in the one before
        assert_eq!(speeds[9], 0.5);
        // 0.5 in 4 rows
        for (row, speed) in speeds.iter().enumerate().take(106).skip(40) {
            assert!((speed - 0.125).abs() < 0.009, "{row}: {speed}");
        }
        // of a tip that stands little is left: less than 3 in 100 rows
        assert!(speeds[205] > 0.0 && speeds[205] < 0.03);
    }

    #[test]
    fn the_first_row_has_no_speed() {
        assert_eq!(way(1.0).speed(0.0, 7.0), 0.0);
    }
}
