//! Decks.

use crate::error::{failed, mistake};
use crate::listener::{Listener, outcome};
use crate::simulation::Simulation;
use crate::tables::{of_json, toml};
use peridyne::run::{Options, build};
use peridyne_cli::runs;
use peridyne_io::deck::Deck as Read;
use peridyne_io::drive::{RigidBodies, default_dir, drive, refused_threads};
use peridyne_io::read::encoding;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// A deck that was read: what is to be run.
///
/// Make one with `Deck.from_toml(path)`, `Deck.from_text(text)` or `Deck.from_dict(dictionary)`. Keys are those of TOML decks; numbers without a
/// unit are in the units of the deck (SI if it does not say otherwise).
#[pyclass(frozen, module = "peridyne")]
pub struct Deck {
    read: Read,
}

/// Keys that override those of a deck, by their dotted names, as TOML.
fn overrides(set: Option<&Bound<'_, PyDict>>) -> PyResult<Vec<(String, String)>> {
    let Some(set) = set else {
        return Ok(vec![]);
    };
    let table = toml(set)?;
    Ok(table.into_iter().map(|(k, v)| (k, v.to_string())).collect())
}

fn parsed(py: Python<'_>, text: &str, name: &str, set: &[(String, String)]) -> PyResult<Deck> {
    let read = py.detach(|| Read::parse(text, name, set));
    Ok(Deck {
        read: read.map_err(|e| mistake(&e))?,
    })
}

/// Does `work` on so many threads of its own; all cores if it is not said.
fn with_threads<T: Send>(
    threads: Option<usize>,
    work: impl FnOnce(usize) -> PyResult<T> + Send,
) -> PyResult<T> {
    if threads == Some(0) {
        let text = "threads=0: at least one thread must run";
        return Err(PyValueError::new_err(text));
    }
    if let Some(text) = threads.and_then(refused_threads) {
        return Err(PyValueError::new_err(text));
    }
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads.unwrap_or(0))
        .build();
    let pool = pool.map_err(|e| PyValueError::new_err(format!("no threads: {e}")))?;
    pool.install(|| work(rayon::current_num_threads()))
}

#[pymethods]
impl Deck {
    /// The deck in a TOML file. `set` overrides keys: `{"run.steps": 100, "material.density": "2440 kg/m^3"}`. Files that the deck names are
    /// relative to its folder.
    ///
    /// Raises DeckError with file, line and help where it is wrong, OSError where the file cannot be read.
    #[staticmethod]
    #[pyo3(signature = (path, *, set=None))]
    fn from_toml(py: Python<'_>, path: PathBuf, set: Option<&Bound<'_, PyDict>>) -> PyResult<Deck> {
        let bytes = std::fs::read(&path)?;
        let text = encoding::text(bytes, 0);
        let text = text.map_err(|e| PyValueError::new_err(e.message))?;
        parsed(py, &text, &path.to_string_lossy(), &overrides(set)?)
    }

    /// The deck in a string of TOML. Files that it names are relative to `folder`, the working folder if it is left out.
    #[staticmethod]
    #[pyo3(signature = (text, *, folder=None, set=None))]
    fn from_text(
        py: Python<'_>,
        text: &str,
        folder: Option<PathBuf>,
        set: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Deck> {
        let name = folder.unwrap_or_default().join("deck.toml");
        parsed(py, text, &name.to_string_lossy(), &overrides(set)?)
    }

    /// The deck in a dictionary: tables are dictionaries, quantities strings with units or plain numbers. What is None is left out.
    #[staticmethod]
    #[pyo3(signature = (deck, *, folder=None, set=None))]
    fn from_dict(
        py: Python<'_>,
        deck: &Bound<'_, PyDict>,
        folder: Option<PathBuf>,
        set: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Deck> {
        Deck::from_text(py, &toml(deck)?.to_string(), folder, set)
    }

    /// The deck as TOML, without what overrides it.
    #[getter]
    fn text(&self) -> &str {
        self.read.text()
    }

    /// Title of the run.
    #[getter]
    fn title(&self) -> &str {
        &self.read.spec.title
    }

    /// What looks wrong though it can be run.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.read.warnings.clone()
    }

    /// What was understood, in words.
    fn describe(&self) -> String {
        self.read.describe()
    }

    fn __repr__(&self) -> String {
        format!("<peridyne.Deck {:?}>", self.read.file())
    }

    /// What would run: points, bonds, moduli that the body really has, stable step, memory, time, warnings, as `peridyne check --json` says it. It builds
    /// the model and does a trial step; nothing is written.
    #[pyo3(signature = (*, threads=None))]
    fn check<'py>(&self, py: Python<'py>, threads: Option<usize>) -> PyResult<Bound<'py, PyAny>> {
        let threads = threads.or(self.read.threads);
        let found = py.detach(|| {
            with_threads(threads, |threads| {
                runs::checked(&self.read, threads).map_err(failed)
            })
        });
        of_json(py, &found?)
    }

    /// A model of the deck, to be led step by step; its results are not written.
    #[pyo3(signature = (*, threads=None))]
    fn simulation(&self, py: Python<'_>, threads: Option<usize>) -> PyResult<Simulation> {
        let threads = threads.or(self.read.threads);
        let deck = &self.read;
        py.detach(|| Simulation::new(deck, threads))
    }

    /// Runs the deck to its end and writes what it asks for into a folder, as `peridyne run` does: a Run, which knows its results. Left out, the folder is that of the
    /// deck, else out/NAME.
    ///
    /// `progress(done, steps, seconds)` is called some ten times a second. `observe(simulation)` is called after each `every` steps, with the model as it is then:
    /// it may ask it anything, and ends the run where it answers True. Ctrl-C and what a call raises end the run as a signal does: its state is written, and
    /// `peridyne.resume(folder)` goes on.
    ///
    /// Raises DeckError where the deck is wrong, RunError with the step and the folder of the last good state where the run goes bad.
    #[pyo3(signature = (out=None, *, threads=None, progress=None, observe=None, every=1, allow_outside=false))]
    #[allow(clippy::too_many_arguments)]
    fn run(
        &self,
        py: Python<'_>,
        out: Option<PathBuf>,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
        observe: Option<Py<PyAny>>,
        every: u64,
        allow_outside: bool,
    ) -> PyResult<Py<PyAny>> {
        if every == 0 {
            return Err(PyValueError::new_err("every=0: expected 1 or more steps"));
        }
        let deck = &self.read;
        let own = out.is_some();
        let dir = out.or(deck.output.dir.clone());
        let dir = dir.unwrap_or_else(|| default_dir(deck.file().as_ref()));
        if !allow_outside {
            deck.stays_inside(own).map_err(|e| mistake(&e))?;
        }
        let mut listener = Listener::new(progress, (observe, every), deck.units);
        let threads = threads.or(deck.threads);
        py.detach(|| {
            with_threads(threads, |threads| {
                let (rigid, spec) = RigidBodies::watched(&deck.spec);
                let made = build(&spec, Options::default());
                let mut sim = made.map_err(|e| mistake(&deck.explain(&e)))?;
                let plan = runs::planned(deck, sim.as_mut(), dir.clone(), allow_outside);
                let mut plan = plan.map_err(failed)?;
                (plan.rigid, plan.threads) = (rigid, threads);
                plan.command = "peridyne.Deck.run (Python)".into();
                plan.asked = runs::asked_of(deck, &plan.command);
                let done = drive(sim.as_mut(), &plan, &mut listener, None);
                outcome(done, listener)
            })
        })?;
        let results = py.import("peridyne.results")?;
        Ok(results.call_method1("Run", (dir,))?.unbind())
    }
}
