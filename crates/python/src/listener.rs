//! What Python hears of a run that writes its results, and how it ends it.

use crate::error::{driven, failed};
use crate::simulation::Lent;
use peridyne::observe::Ledger;
use peridyne::run::Simulation;
use peridyne_cli::runs::Stopped;
use peridyne_io::deck::UnitSystem;
use peridyne_io::drive::Progress;
use peridyne_io::write::run_json::RunReport;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::time::{Duration, Instant};

/// Between two looks whether somebody pressed Ctrl-C, and between two calls of `progress`.
const INTERVAL: Duration = Duration::from_millis(100);

pub struct Listener {
    /// Called with steps done, steps in all and seconds of stepping.
    progress: Option<Py<PyAny>>,
    /// Called with the model; what is true ends the run.
    observe: Option<Py<PyAny>>,
    every: u64,
    units: UnitSystem,
    looked: Instant,
    ended: Option<String>,
    /// What Python raised.
    raised: Option<PyErr>,
}

impl Listener {
    pub fn new(
        progress: Option<Py<PyAny>>,
        (observe, every): (Option<Py<PyAny>>, u64),
        units: UnitSystem,
    ) -> PyResult<Listener> {
        if every == 0 {
            return Err(PyValueError::new_err("every=0: expected 1 or more steps"));
        }
        Ok(Listener {
            progress,
            observe,
            every,
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
        if !step.is_multiple_of(self.every) || self.ended.is_some() {
            return;
        }
        let Some(call) = &self.observe else {
            return;
        };
        let said = Python::attach(|py| {
            let lent = Lent::new(py, sim, self.units)?;
            let answer = call.call1(py, (lent.given(py),))?;
            answer.is_truthy(py)
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
