//! Runs of decks for those who lead them by themselves: a study, a program in another language.

pub use crate::check::checked;

use crate::early;
use crate::failure::Failure;
use crate::run::{go_on, planned};
use peridyne::run::{Options, Simulation, build};
use peridyne_io::deck::Deck;
use peridyne_io::drive::{DriveError, Plan, Progress, RigidBodies, drive};
use peridyne_io::read::source::sums_of;
use peridyne_io::write::checkpoint::Checkpoint;
use peridyne_io::write::history::Column;
use peridyne_io::write::run_json::RunReport;
use std::path::PathBuf;

/// A deck and where its results go.
pub struct Run<'a> {
    pub deck: &'a Deck,
    /// What overrides its keys.
    pub set: &'a [(String, String)],
    /// What makes the run again, for its records.
    pub command: String,
    pub dir: PathBuf,
    pub allow_outside: bool,
}

/// Why a run did not come to its end.
pub enum Stopped {
    /// The deck is wrong.
    Deck(Failure),
    Run(DriveError),
}

impl Run<'_> {
    /// The model and what is to be done with it.
    fn made(&self) -> Result<(Box<dyn Simulation>, Plan), Failure> {
        let deck = self.deck;
        let (rigid, spec) = RigidBodies::watched(&deck.spec);
        let made = build(&spec, Options::default());
        let mut sim = made.map_err(|e| Failure::Input(deck.explain(&e).into()))?;
        let mut plan = planned(deck, sim.as_mut(), self.dir.clone(), self.allow_outside)?;
        (plan.rigid, plan.threads) = (rigid, rayon::current_num_threads());
        let records = [&self.command, deck.file(), deck.text()].map(String::from);
        plan.command = self.command.clone();
        // a program may have read others for other runs
        let files = sums_of(deck.files.clone());
        plan.asked = early::asked_by(deck.file().as_ref(), self.set.to_vec(), records, files);
        Ok((sim, plan))
    }

    /// Columns of its `history.csv`, but for the step.
    ///
    /// # Errors
    /// The deck is wrong.
    pub fn columns(&self) -> Result<Vec<Column>, Failure> {
        let (sim, plan) = self.made()?;
        Ok(plan.columns(sim.as_ref()))
    }

    /// Runs it on the threads of now, from the beginning or from where it was ended.
    ///
    /// # Errors
    /// The deck is wrong, what [`Progress::prepare`] gives is not what the run began with, a file is another one than when the run began, the run goes bad, or a file could not be written.
    pub fn done(
        self,
        from: Option<Checkpoint>,
        progress: &mut dyn Progress,
    ) -> Result<RunReport, Stopped> {
        let (mut sim, mut plan) = self.made().map_err(Stopped::Deck)?;
        let Some(given) = progress.prepare(sim.as_mut(), from.is_some()) else {
            let why = progress.ended().unwrap_or_default();
            return Err(Stopped::Deck(Failure::Run(why)));
        };
        plan.asked.given = given;
        if !plan.asked.given.is_empty() {
            let given = plan.asked.given.join(", ");
            plan.warnings.push(format!(
                "the deck alone does not make this run again: a program gave it {given}"
            ));
        }
        if let Some(from) = &from {
            go_on(&mut plan, &from.asked).map_err(Stopped::Deck)?;
        }
        drive(sim.as_mut(), &plan, progress, from).map_err(Stopped::Run)
    }
}
