//! What writes of a run while it goes on.

use crate::drive::plan::{DriveError, Plan, Progress};
use crate::drive::row;
use crate::write::picture::rigid::Placed;
use crate::write::picture::shown::About;
use crate::write::run_json::{RigidNote, Spent};
use peridyne::error::RunError;
use peridyne::observe::{Ledger, Snapshot};
use peridyne::run::Simulation;
use peridyne::state::{Archive, Owner};
use std::sync::Arc;

/// What is due after a step, or before the first.
#[derive(Debug, Clone, Copy)]
pub(in crate::drive) struct Due {
    /// Steps done, those of statics before motion too.
    pub step: u64,
    /// Of these, steps of motion.
    pub moved: u64,
    /// Is the body loaded by statics before its motion?
    pub loads: bool,
    pub row: bool,
    pub frame: bool,
    /// The run ends here: whoever has something of every run's last state writes it now.
    pub last: bool,
}

/// What is known of a run so far, and goes on with it.
#[derive(Debug, Default)]
pub(in crate::drive) struct Known {
    pub ledger: Ledger,
    /// The last row of the history that was measured, and its step.
    pub row: Option<(u64, Vec<f64>)>,
    /// What is how far, in the rows so far.
    pub ways: Vec<row::Way>,
    pub warnings: Vec<String>,
    /// Directed bonds broken when it began.
    pub broken: u64,
    /// Time spent in steps (s).
    pub stepping: f64,
    /// When a state is written: what was spent up to it.
    pub spent: Spent,
}

impl Owner for Known {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.one("ledger", &mut self.ledger);
        let none = || (0, vec![]);
        archive.option("row", &mut self.row, none, |(step, row), archive| {
            archive.one("step", step);
            archive.list("values", row);
        });
        archive.parts("ways", &mut self.ways);
        archive.items("warnings", &mut self.warnings, String::new, |text, a| {
            a.text("text", text);
        });
        archive.one("broken", &mut self.broken);
        archive.one("stepping", &mut self.stepping);
        archive.part("spent", &mut self.spent);
    }
}

/// Where a run is.
pub(in crate::drive) struct Now<'a> {
    pub sim: &'a mut dyn Simulation,
    pub plan: &'a Plan,
    pub progress: &'a mut dyn Progress,
    pub known: &'a mut Known,
    pub spent: &'a mut Spent,
    pub due: Due,
    /// Why it goes no further.
    pub stopped: &'a mut Option<RunError>,
    /// Was it ended early, by somebody who does not wait long?
    pub hurried: bool,
    snapshot: Option<Arc<Snapshot>>,
    placed: Option<Arc<Vec<Placed>>>,
}

impl<'a> Now<'a> {
    pub fn new(
        (sim, plan, progress): (&'a mut dyn Simulation, &'a Plan, &'a mut dyn Progress),
        (known, spent): (&'a mut Known, &'a mut Spent),
        stopped: &'a mut Option<RunError>,
        (due, hurried): (Due, bool),
    ) -> Now<'a> {
        Now {
            sim,
            plan,
            progress,
            known,
            spent,
            due,
            stopped,
            hurried,
            snapshot: None,
            placed: None,
        }
    }

    /// Something that the user should know.
    pub fn warn(&mut self, text: String) {
        self.progress.warning(&text);
        self.known.warnings.push(text);
    }

    /// A frame of this state.
    pub fn snapshot(&mut self) -> Arc<Snapshot> {
        let (sim, plan) = (&mut *self.sim, self.plan);
        let made = self.snapshot.get_or_insert_with(|| plan.look(sim).into());
        made.clone()
    }

    /// Rigid bodies in this state.
    pub fn placed(&mut self) -> Arc<Vec<Placed>> {
        let (sim, plan) = (&mut *self.sim, self.plan);
        let made = self.placed.get_or_insert_with(|| plan.placed(sim).into());
        made.clone()
    }

    /// The row of the history of this state, and its ledger; `None`: there is none, and the run stops for it.
    pub fn row(&mut self) -> Option<Vec<f64>> {
        let step = self.sim.step_number();
        if let Some((_, row)) = self.known.row.as_ref().filter(|(at, _)| *at == step) {
            return Some(row.clone());
        }
        match self.sim.ledger() {
            Ok(ledger) => {
                self.known.ledger = ledger;
                let ways = &mut self.known.ways;
                let row = row::row(self.sim, self.plan, &ledger, ways);
                self.known.row = Some((step, row.clone()));
                Some(row)
            }
            Err(error) => {
                self.stopped.get_or_insert(error);
                None
            }
        }
    }

    /// What the run was about.
    pub fn about(&self) -> About {
        let stepper = self.sim.info().stepper;
        if self.sim.broken() > self.known.broken {
            return About::Fracture;
        }
        if stepper.statics().is_some() {
            return About::Equilibrium;
        }
        match self.sim.diffusions().first() {
            Some((quantity, _)) if stepper.rests() => About::Spread(quantity.column()),
            Some(_) | None => About::Motion,
        }
    }
}

/// What was made for the record of the run.
#[derive(Debug, Default)]
pub(in crate::drive) struct Made {
    pub pictures: Vec<String>,
    pub slices: Vec<String>,
    pub paths: Vec<RigidNote>,
}

/// Writes of a run while it goes on. What it must know to go on with a run is its state ([`Owner`]).
pub(in crate::drive) trait Writer: Owner {
    /// Opens its files; of a run that goes on those that are there, and leaves them as they are.
    fn open(&mut self, now: &mut Now<'_>, goes_on: bool) -> Result<(), DriveError>;
    /// Takes away what it has written since the state that was just read.
    fn rewind(&mut self, now: &mut Now<'_>) -> Result<(), DriveError>;
    /// Writes what is due.
    fn look(&mut self, now: &mut Now<'_>) -> Result<(), DriveError>;
    /// The run ends in this state.
    fn end(self: Box<Self>, now: &mut Now<'_>, made: &mut Made) -> Result<(), DriveError>;
}
