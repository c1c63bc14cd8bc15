//! Drives a simulation through its steps: observers at their intervals, files as they come, a report at the end.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use peridyne::error::RunError;
use peridyne::observe::Ledger;
use peridyne::run::{Simulation, SnapshotOptions};

use crate::write::history::{Column, History, ledger_columns, ledger_values};
use crate::write::run_json::{self, EnergyReport, RunReport, Status};
use crate::write::{Series, SeriesOptions, WriteError};

/// What to do and what to write.
#[derive(Debug, Clone)]
pub struct Plan {
    pub title: String,
    /// File name of the deck and its text, for the report.
    pub deck: String,
    pub deck_text: String,
    pub dir: PathBuf,
    pub steps: u64,
    /// Steps between frames; `None`: first and last.
    pub every: Option<u64>,
    /// Steps between rows of `history.csv`.
    pub history: u64,
    pub series: SeriesOptions,
    pub snapshot: SnapshotOptions,
    /// Units of time and energy, for headers.
    pub time_unit: String,
    pub energy_unit: String,
    pub threads: usize,
}

/// Listens to a run.
pub trait Progress {
    /// Called often; `stepping` is the time spent in steps alone.
    fn step(&mut self, done: u64, total: u64, stepping: Duration);
    /// A row of the history.
    fn row(&mut self, step: u64, time: f64, ledger: &Ledger, broken: u64);
}

/// Why a run did not end well.
#[derive(Debug, thiserror::Error)]
pub enum DriveError {
    #[error(transparent)]
    Write(#[from] WriteError),
    #[error("{error}\nthe last good state, step {step}, is in {}", dir.display())]
    Run {
        error: RunError,
        step: u64,
        dir: PathBuf,
    },
}

/// Run and write. On a [`RunError`] the last good state is written like a last frame and `run.json` says why.
///
/// # Errors
/// What stopped the run, or the first file that could not be written.
pub fn drive(
    sim: &mut dyn Simulation,
    plan: &Plan,
    progress: &mut dyn Progress,
) -> Result<RunReport, DriveError> {
    let mut series = Series::new(&plan.dir, plan.series.clone())?;
    let mut columns = vec![Column::new("time", &plan.time_unit)];
    columns.extend(ledger_columns(&plan.energy_unit));
    columns.push(Column::new("residual", &plan.energy_unit));
    columns.push(Column::new("broken_directed_bonds", ""));
    let mut history = History::create(&plan.dir.join("history.csv"), &columns)?;
    sim.start(true);
    let mut stepping = Duration::ZERO;
    let mut stopped = None;
    let mut ledger = Ledger::default();
    for n in 0..=plan.steps {
        if n > 0 {
            let begin = Instant::now();
            let result = sim.step();
            stepping += begin.elapsed();
            if let Err(error) = result {
                stopped = Some(error);
                break;
            }
            progress.step(n, plan.steps, stepping);
        }
        let last = n == plan.steps;
        if n % plan.history == 0 || last {
            match sim.ledger() {
                Ok(l) => ledger = l,
                Err(error) => {
                    stopped = Some(error);
                    break;
                }
            }
            let mut row = vec![sim.time()];
            row.extend(ledger_values(&ledger));
            row.push(ledger.residual());
            row.push(sim.broken() as f64);
            history.push(sim.step_number(), &row)?;
            progress.row(sim.step_number(), sim.time(), &ledger, sim.broken());
        }
        if !last
            && (n == 0 || plan.every.is_some_and(|e| n % e == 0))
            && (plan.series.points || plan.series.bonds)
        {
            series.write(&sim.snapshot(plan.snapshot))?;
        }
    }
    let snapshot = sim.snapshot(plan.snapshot);
    series.write(&snapshot)?;
    series.finish(&snapshot)?;
    history.finish()?;
    let status = match &stopped {
        None => Status::Done,
        Some(error) => Status::Stopped(error.to_string()),
    };
    let info = sim.info();
    let report = RunReport {
        version: env!("CARGO_PKG_VERSION").to_string(),
        deck: plan.deck.clone(),
        deck_hash: run_json::deck_hash(plan.deck_text.as_bytes()),
        title: plan.title.clone(),
        status,
        particles: info.points,
        directed_bonds: info.directed_bonds,
        steps: sim.step_number(),
        time_step: info.time_step,
        seconds_stepping: stepping.as_secs_f64(),
        ns_per_bond_step: run_json::ns_per_bond_step(
            stepping.as_secs_f64(),
            info.directed_bonds,
            sim.step_number(),
        ),
        peak_memory_bytes: run_json::peak_memory_bytes(),
        broken_directed_bonds: sim.broken(),
        fragments: Some(sim.fragments()),
        threads: plan.threads,
        simd: info.simd.to_string(),
        energy: EnergyReport::from(&ledger),
        warnings: info.warnings.clone(),
    };
    report.write(&plan.dir.join("run.json"))?;
    match stopped {
        None => Ok(report),
        Some(error) => Err(DriveError::Run {
            error,
            step: sim.step_number(),
            dir: plan.dir.to_path_buf(),
        }),
    }
}

/// The folder a deck's results go to if nobody says otherwise: `out/<deck name>`.
pub fn default_dir(deck: &Path) -> PathBuf {
    let name = deck
        .file_stem()
        .map_or_else(|| "run".into(), |s| s.to_string_lossy().into_owned());
    Path::new("out").join(name)
}
