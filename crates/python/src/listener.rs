//! What Python hears of a run that writes its results, and how it ends it.

use crate::acting::{Acting, NotMade, is_function};
use crate::error::{driven, failed};
use crate::observers::Observer;
use crate::simulation::{Lent, Loan};
use peridyne::error::RunError;
use peridyne::observe::Ledger;
use peridyne::run::Simulation;
use peridyne_cli::runs::Stopped;
use peridyne_io::deck::UnitSystem;
use peridyne_io::drive::Progress;
use peridyne_io::write::run_json::RunReport;
use pyo3::prelude::*;
use std::time::{Duration, Instant};

/// Between two looks whether somebody pressed Ctrl-C, and between two calls of `progress`.
const INTERVAL: Duration = Duration::from_millis(100);

pub struct Listener {
    /// Called with steps done, steps in all and seconds of stepping.
    progress: Option<Py<PyAny>>,
    /// Called with the model before the first step.
    prepare: Option<Py<PyAny>>,
    acting: Acting,
    /// Called with the model; what is true ends the run.
    observers: Vec<Observer>,
    units: UnitSystem,
    looked: Instant,
    ended: Option<String>,
    /// What Python raised.
    raised: Option<PyErr>,
}

impl Listener {
    pub fn new(
        py: Python<'_>,
        [progress, prepare]: [Option<Py<PyAny>>; 2],
        observers: Vec<Observer>,
        units: UnitSystem,
    ) -> PyResult<Listener> {
        if let Some(call) = &progress {
            is_function(call.bind(py), "(done, steps, seconds)")?;
        }
        if let Some(call) = &prepare {
            is_function(call.bind(py), "a Simulation")?;
        }
        Ok(Listener {
            progress,
            prepare,
            acting: Acting::default(),
            observers,
            units,
            looked: Instant::now(),
            ended: None,
            raised: None,
        })
    }

    /// Ends the run where Python raised something.
    fn hear<T>(&mut self, said: PyResult<T>) -> Option<T> {
        said.map_err(|error| {
            self.ended = Some(format!("{error}"));
            self.raised = Some(error);
        })
        .ok()
    }
}

impl Progress for Listener {
    fn prepare(&mut self, sim: &mut dyn Simulation, goes_on: bool) -> Option<Vec<String>> {
        let Some(call) = &self.prepare else {
            return Some(vec![]);
        };
        let loan = match goes_on {
            true => Loan::GoOn,
            false => Loan::Prepare,
        };
        let said = Python::attach(|py| {
            let lent = Lent::new(py, sim, self.units, loan)?;
            call.call1(py, (lent.given(py),))?;
            lent.acting()
        });
        self.acting = self.hear(said)?;
        if !goes_on {
            let begun = self.acting.begin(sim);
            self.hear(begun)?;
        }
        Some(self.acting.told().to_vec())
    }

    fn advance(&mut self, sim: &mut dyn Simulation) -> Result<bool, RunError> {
        match self.acting.step(sim) {
            Ok(()) => {
                let raised = self.acting.raised().map_or(Ok(()), Err);
                self.hear(raised);
                Ok(true)
            }
            Err(NotMade::Run(error)) => Err(error),
            Err(NotMade::Raised(error)) => {
                self.hear::<()>(Err(error));
                Ok(false)
            }
        }
    }

    fn step(&mut self, done: u64, total: u64, stepping: Duration) {
        if self.looked.elapsed() < INTERVAL && done < total {
            return;
        }
        self.looked = Instant::now();
        let said = Python::attach(|py| {
            py.check_signals()?;
            match &self.progress {
                Some(call) => call
                    .call1(py, (done, total, stepping.as_secs_f64()))
                    .map(drop),
                None => Ok(()),
            }
        });
        self.hear(said);
    }

    fn look(&mut self, sim: &mut dyn Simulation, step: u64) {
        if self.ended.is_some() {
            return;
        }
        let due = self.observers.iter().map(|o| o.is_due(sim, step));
        let due: Vec<bool> = due.collect();
        if !due.contains(&true) {
            return;
        }
        let said = Python::attach(|py| {
            let lent = Lent::new(py, sim, self.units, Loan::Observe)?;
            let mut ends = false;
            // who writes is called though another one ends the run
            for (observer, _) in self.observers.iter().zip(due).filter(|(_, due)| *due) {
                let answer = observer.call.call1(py, (lent.given(py),))?;
                ends |= answer.is_truthy(py)?;
            }
            Ok(ends)
        });
        if self.hear(said) == Some(true) {
            self.ended = Some(format!("observe, after step {step}"));
        }
    }

    fn row(&mut self, _: u64, _: f64, _: &Ledger, _: u64) {}

    fn warning(&mut self, message: &str) {
        let said = Python::attach(|py| {
            let warnings = py.import("warnings")?;
            warnings.call_method1("warn", (message,)).map(drop)
        });
        self.hear(said);
    }

    fn ended(&mut self) -> Option<String> {
        self.ended.clone()
    }
}

/// What Python raised comes before what that led to.
pub fn outcome(done: Result<RunReport, Stopped>, listener: Listener) -> PyResult<()> {
    if let Some(raised) = listener.raised {
        return Err(raised);
    }
    done.map(drop).map_err(|why| match why {
        Stopped::Deck(failure) => failed(failure),
        Stopped::Run(error) => driven(&error),
    })
}
