//! What a run is to write, whom it tells, and what it dies of.

use super::atoms::AtomsPlan;
use super::options::{ExodusPlan, SpaceTimeOptions};
use super::rigid::RigidBodies;

use crate::continuum::run::FieldsPlan;
use crate::deck::{OutputSpec, UnitSystem};
use crate::write::checkpoint::{Asked, ResumeError};
use crate::write::fields::SIZE;
use crate::write::picture::rigid::Placed;
use crate::write::picture::shown::About;
use crate::write::report::ReportError;
use crate::write::run_json::MarkNotes;
use crate::write::{SeriesOptions, WriteError};
use peridyne::error::{RunError, SolveError};
use peridyne::observe::{Ledger, Snapshot};
use peridyne::run::Simulation;
use peridyne_fields::FieldsError;
use std::path::PathBuf;
use std::time::Duration;

/// What to do and what to write.
#[derive(Debug, Clone)]
pub struct Plan {
    pub title: String,
    /// File name of the deck and its text, for the report.
    pub deck: String,
    pub deck_text: String,
    pub dir: PathBuf,
    /// What makes the same run again, what was understood, and where the laws come from: for the report.
    pub command: String,
    pub understood: String,
    pub sources: Vec<String>,
    /// What looks wrong in the deck; the model's own are added.
    pub warnings: Vec<String>,
    /// What pictures and the report show beside the points.
    pub rigid: RigidBodies,
    /// What is done to the body, for the report.
    pub marks: MarkNotes,
    /// May files that the deck names lie outside `dir`?
    pub allow_outside: bool,
    /// What the deck asks for: below is what follows for this model.
    pub output: OutputSpec,
    pub steps: u64,
    /// Of these, increments of statics before motion.
    pub increments: u64,
    /// Steps between frames; `None`: first and last.
    pub every: Option<u64>,
    /// Steps between rows of `history.csv`.
    pub history: u64,
    /// Modes of vibration about the last state.
    pub modes: usize,
    pub series: SeriesOptions,
    /// Fields of a body on a line over place and time.
    pub space_time: Vec<SpaceTimeOptions>,
    /// Frames in an Exodus file.
    pub exodus: Option<ExodusPlan>,
    /// Columns of a frame; [`SIZE`] is added.
    pub fields: Vec<String>,
    /// Of the numbers that are computed, for headers of probes.
    pub units: UnitSystem,
    /// Units of time and energy, for headers.
    pub time_unit: String,
    pub energy_unit: String,
    pub ranks: usize,
    /// Of each rank.
    pub threads: usize,
    /// What atoms have besides.
    pub atoms: Option<AtomsPlan>,
    /// Continuum fields, where any are asked for.
    pub continuum: Option<FieldsPlan>,
    /// What such a state says of how the run was asked for.
    pub asked: Asked,
}

impl Plan {
    /// Columns of a frame beside displacements, of which a model may not have all.
    pub(super) fn frame_fields(&self, sim: &dyn Simulation) -> Vec<String> {
        let mut fields: Vec<&str> = self.fields.iter().map(String::as_str).collect();
        for picture in &self.series.pictures {
            let shown = match &picture.field {
                Some(field) => vec![field.as_str()],
                // what a run is about is known in the end
                None => {
                    let spread = { sim.diffusions().into_iter() }.map(|(q, _)| q.column());
                    let others = [About::Fracture.field(), About::Motion.field()];
                    spread.chain(others).collect()
                }
            };
            for field in shown.into_iter().chain(picture.arrows.as_deref()) {
                if !fields.contains(&field) {
                    fields.push(field);
                }
            }
        }
        fields.into_iter().map(String::from).collect()
    }

    /// Columns that are written beside displacements: those of a frame, and how large points are, without which nobody can draw them.
    pub(super) fn written_fields(&self, sim: &dyn Simulation) -> Vec<String> {
        let mut fields = self.frame_fields(sim);
        if !fields.iter().any(|f| f == SIZE) {
            fields.push(SIZE.into());
        }
        fields
    }

    /// What a frame shows.
    pub(super) fn look(&self, sim: &mut dyn Simulation) -> Snapshot {
        let fields = self.written_fields(sim);
        let fields: Vec<&str> = fields.iter().map(String::as_str).collect();
        sim.snapshot(&fields, self.series.bonds)
    }

    /// Has motion begun? It does with the first step after those of statics.
    pub(super) fn begun(&self, sim: &dyn Simulation) -> bool {
        self.increments == 0 || sim.step_number() > self.increments
    }

    /// Rigid bodies where they are now.
    pub(super) fn placed(&self, sim: &mut dyn Simulation) -> Vec<Placed> {
        let begun = self.begun(sim);
        self.rigid.placed(sim, begun)
    }
}

/// Listens to a run.
pub trait Progress {
    /// Gives the model of a run what its deck does not have, before its first step or, where it `goes_on`, before it has its state; answers what that is, in words.
    /// `None`: that went wrong, and [`Progress::ended`] says how.
    fn prepare(&mut self, _sim: &mut dyn Simulation, _goes_on: bool) -> Option<Vec<String>> {
        Some(vec![])
    }
    /// Makes the next step; false: it was not made, and [`Progress::ended`] says why.
    ///
    /// # Errors
    /// As for [`Simulation::step`](peridyne::run::Simulation).
    fn advance(&mut self, sim: &mut dyn Simulation) -> Result<bool, RunError> {
        sim.step().map(|()| true)
    }
    /// Called often; `stepping` is the time spent in steps alone.
    fn step(&mut self, done: u64, total: u64, stepping: Duration);
    /// The model after a step; nothing of it may be changed.
    fn look(&mut self, _sim: &mut dyn Simulation, _step: u64) {}
    /// A row of the history, `broken` bonds each counted once.
    fn row(&mut self, step: u64, time: f64, ledger: &Ledger, broken: u64);
    /// Something else than steps begins: fields, pictures, the report.
    fn phase(&mut self, _what: &str) {}
    /// Something that the user should know now.
    fn warning(&mut self, message: &str);
    /// Asked before each step: shall the run end here, and who says so? What it has done is then written as at its end.
    /// ([`Simulation::stop_when`] asks within a long increment of statics.)
    fn ended(&mut self) -> Option<String> {
        None
    }
    /// Asked before each step: shall a state to go on from be written now?
    fn wants_checkpoint(&mut self) -> bool {
        false
    }
}

/// Why a run did not end well.
#[derive(Debug, thiserror::Error)]
pub enum DriveError {
    #[error(transparent)]
    Write(#[from] WriteError),
    #[error("{told}\nthe last good state, step {step}, is in {}", dir.display())]
    Run {
        error: RunError,
        /// The error with units.
        told: String,
        step: u64,
        dir: PathBuf,
    },
    #[error(transparent)]
    Resume(#[from] ResumeError),
    #[error("[[fields]]: {0}")]
    Fields(#[from] FieldsError),
    #[error("report.html: {0}")]
    Report(#[from] ReportError),
    #[error("the modes were not found: {error}\nthe last state is in {}", dir.display())]
    Modes { error: SolveError, dir: PathBuf },
}
