//! The rows of `history.csv`, and the balance of energy that they tell of.

use peridyne::spec::Stepper;
use peridyne::state::{Archive, Owner};

use super::writer::{Made, Now, Writer};

use super::inside;
use crate::balance::BalanceWatch;
use crate::deck::each_once;
use crate::drive::plan::DriveError;
use crate::write::WriteError;
use crate::write::history::{Column, History};

pub struct Rows {
    columns: Vec<Column>,
    open: Option<History>,
    balance: BalanceWatch,
    /// The step that the last row tells of.
    told: Option<u64>,
}

impl Rows {
    pub fn new(columns: &[Column]) -> Rows {
        Rows {
            columns: columns.to_vec(),
            open: None,
            balance: BalanceWatch::default(),
            told: None,
        }
    }
}

impl Owner for Rows {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.given("history", &mut self.open, |history, a| history.archive(a));
        archive.part("balance", &mut self.balance);
        archive.one("told", &mut self.told);
    }
}

impl Writer for Rows {
    fn open(&mut self, now: &mut Now<'_>, goes_on: bool) -> Result<(), DriveError> {
        let path = inside(now.plan, "history.csv");
        self.open = Some(match goes_on {
            true => History::reopen(&path, &self.columns)?,
            false => History::create(&path, &self.columns)?,
        });
        Ok(())
    }

    fn rewind(&mut self, _: &mut Now<'_>) -> Result<(), DriveError> {
        Ok(self.open.as_mut().map_or(Ok(()), History::rewind)?)
    }

    fn look(&mut self, now: &mut Now<'_>) -> Result<(), DriveError> {
        let step = now.sim.step_number();
        let due = now.due;
        if !(due.row || due.last) || self.told == Some(step) {
            return Ok(());
        }
        let (Some(row), Some(history)) = (now.row(), &mut self.open) else {
            return Ok(());
        };
        history.push(step, &row)?;
        self.told = Some(step);
        let ledger = now.known.ledger;
        now.progress
            .row(step, now.sim.clock(), &ledger, each_once(now.sim.broken()));
        let stepper = now.sim.info().stepper;
        let statics = due.loads || stepper.statics().is_some();
        let mut wrong = self.balance.row(step, &ledger, statics);
        // the work of expansion over an increment is that of its ends
        if wrong.is_none() && statics && now.sim.diffusions().is_empty() {
            wrong = self.balance.equilibrium(step, &ledger);
        }
        if let Some(wrong) = wrong {
            now.warn(now.plan.units.tell(&wrong));
        }
        if matches!(stepper, Stepper::Verlet) && !due.loads {
            *now.stopped = self.balance.gone(step, &ledger, now.sim.info());
        }
        Ok(())
    }

    fn end(self: Box<Self>, _: &mut Now<'_>, _: &mut Made) -> Result<(), DriveError> {
        let finished: Result<(), WriteError> = self.open.map_or(Ok(()), History::finish);
        Ok(finished?)
    }
}
