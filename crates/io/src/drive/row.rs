//! A row of the history: what is measured of the whole body at one time.

use peridyne::observe::Ledger;
use peridyne::run::Simulation;
use peridyne::spec::Stepper;

use super::plan::Plan;
use crate::deck::UnitSystem;
use crate::write::history::{
    Column, ledger_columns, ledger_values, transfer_columns, transfer_values,
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
        columns.push(Column::new("broken_directed_bonds", ""));
        if sim.solved().is_some() {
            columns.push(Column::new("iterations", ""));
            columns.push(Column::new("solver_residual", ""));
        }
        if sim.cycles().is_some() {
            columns.push(Column::new("cycles", ""));
        }
        for (quantity, account) in sim.transfers() {
            columns.extend(transfer_columns(quantity, &account, &self.energy_unit));
        }
        if let Some(atoms) = &self.atoms {
            columns.push(Column::new("temperature", &atoms.temperature_unit));
            columns.push(Column::new("pressure", &atoms.pressure_unit));
        }
        let mut probes = sim.probe_columns();
        probes.truncate(probes.len().saturating_sub(self.rigid.columns()));
        columns.extend(probes.into_iter().map(|c| {
            let unit = match (c.rooted, c.moment, self.units) {
                (true, _, units) => units.root_unit(c.dimension),
                (false, true, UnitSystem::Si) => "N m".into(),
                (false, _, units) => units.unit(c.dimension),
            };
            Column::new(c.name, &unit)
        }));
        columns
    }
}

/// Their values now.
pub(super) fn row(sim: &mut dyn Simulation, plan: &Plan, ledger: &Ledger) -> Vec<f64> {
    let mut row = vec![sim.clock()];
    row.extend(ledger_values(ledger));
    if is_implicit(sim) {
        row.push(ledger.numerical);
    }
    row.push(sim.broken() as f64);
    if let Some(solved) = sim.solved() {
        row.extend([solved.iterations as f64, solved.residual]);
    }
    row.extend(sim.cycles());
    for (_, account) in sim.transfers() {
        row.extend(transfer_values(&account));
    }
    if let Some(atoms) = &plan.atoms {
        row.extend(atoms.thermo(sim, ledger.kinetic));
    }
    let mut measured = sim.measure();
    measured.truncate(measured.len().saturating_sub(plan.rigid.columns()));
    row.extend(measured);
    row
}
