//! Decks.

use crate::error::{DeckError, caught, failed, mistake};
use crate::listener::{Listener, outcome};
use crate::observers::observers;
use crate::simulation::{Simulation, pool};
use crate::tables::{of_json, toml};
use peridyne_cli::runs;
use peridyne_io::deck::Deck as Read;
use peridyne_io::drive::default_dir;
use peridyne_io::read::encoding;
use peridyne_io::write::checkpoint::Checkpoint;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::{Path, PathBuf};

/// A deck that was read: what is to be run.
///
/// Make one with `Deck.from_toml(path)`, `Deck.from_text(text)` or `Deck.from_dict(dictionary)`. Keys are those of TOML decks; numbers without a
/// unit are in the units of the deck (SI if it does not say otherwise).
#[pyclass(frozen, module = "peridyne")]
pub struct Deck {
    read: Read,
    /// What overrides its keys.
    set: Vec<(String, String)>,
}

/// Keys that override those of a deck, by their dotted names, as TOML.
fn overrides(set: Option<&Bound<'_, PyDict>>) -> PyResult<Vec<(String, String)>> {
    let Some(set) = set else {
        return Ok(vec![]);
    };
    let table = toml(set)?;
    Ok(table.into_iter().map(|(k, v)| (k, v.to_string())).collect())
}

fn parsed(py: Python<'_>, text: &str, name: &Path, set: Vec<(String, String)>) -> PyResult<Deck> {
    let read = py.detach(|| Read::parse(text, &name.to_string_lossy(), &set));
    let read = read.map_err(|e| mistake(&e))?;
    Ok(Deck { read, set })
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
        parsed(py, &text, &path, overrides(set)?)
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
        // a run that goes on may do so elsewhere
        let name = std::path::absolute(folder.unwrap_or_default().join("deck.toml"))?;
        parsed(py, text, &name, overrides(set)?)
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
            let pool = pool(threads)?;
            let threads = pool.current_num_threads();
            pool.install(|| runs::checked(&self.read, threads).map_err(failed))
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
    /// `progress(done, steps, seconds)` is called some ten times a second.
    ///
    /// `observe(simulation)` is called after each `every` steps, with the model as it is then: it may ask it anything, and ends the run where it answers True. Several, each at an
    /// interval of its own, are a list of `peridyne.Every(interval, call)`; an interval is a number of steps or a time ("2 us").
    ///
    /// `prepare(simulation)` is called once before the first step, and may change the model: `set_column`, `add_force`, `add_motion`. What it gave is no part of the deck, and
    /// the run says so (`record["warnings"]`).
    ///
    /// Ctrl-C and what a call raises end the run as a signal does: its state is written, and `peridyne.resume(folder)` goes on.
    ///
    /// Raises DeckError where the deck is wrong, RunError with the step and the folder of the last good state where the run goes bad.
    #[pyo3(signature = (out=None, *, threads=None, progress=None, observe=None, every=None, prepare=None, allow_outside=false))]
    #[allow(clippy::too_many_arguments)]
    fn run<'py>(
        &self,
        py: Python<'py>,
        out: Option<PathBuf>,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
        observe: Option<Bound<'py, PyAny>>,
        every: Option<Bound<'py, PyAny>>,
        prepare: Option<Py<PyAny>>,
        allow_outside: bool,
    ) -> PyResult<Py<PyAny>> {
        let own = out.is_some();
        let dir = out.or(self.read.output.dir.clone());
        let dir = dir.unwrap_or_else(|| default_dir(self.read.file().as_ref()));
        let observers = observers(observe, every, self.read.units)?;
        let listener = Listener::new(py, [progress, prepare], observers, self.read.units)?;
        let files = Files {
            dir,
            own,
            allow_outside,
        };
        self.driven(py, files, threads, (listener, None))
    }
}

/// Goes on with a run that was ended before its last step, bit for bit, in its folder: its Run. The deck is that which it began with, as its state has it; the other arguments
/// are those of `Deck.run`. Functions are in no state: a run that was given forces or motions by `prepare` is given them again, by the same `prepare`; columns that it sets are
/// left as the state has them.
///
/// Raises DeckError where there is no state to go on from, files that the deck names are others now, or `prepare` gives other things than at the beginning.
#[pyfunction]
#[pyo3(signature = (folder, *, threads=None, progress=None, observe=None, every=None, prepare=None, allow_outside=false))]
#[allow(clippy::too_many_arguments)]
pub fn resume<'py>(
    py: Python<'py>,
    folder: PathBuf,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
    observe: Option<Bound<'py, PyAny>>,
    every: Option<Bound<'py, PyAny>>,
    prepare: Option<Py<PyAny>>,
    allow_outside: bool,
) -> PyResult<Py<PyAny>> {
    let newest = Checkpoint::newest(&folder);
    let from = newest.map_err(|e| DeckError::new_err(e.to_string()))?;
    let asked = from.asked.clone();
    let deck = parsed(py, &asked.text, &asked.deck, asked.set)?;
    let observers = observers(observe, every, deck.read.units)?;
    let listener = Listener::new(py, [progress, prepare], observers, deck.read.units)?;
    let files = Files {
        dir: folder,
        own: true,
        allow_outside,
    };
    deck.driven(py, files, threads, (listener, Some(from)))
}

/// Where a run writes.
struct Files {
    dir: PathBuf,
    /// Was the folder given by the caller?
    own: bool,
    allow_outside: bool,
}

impl Deck {
    fn driven(
        &self,
        py: Python<'_>,
        files: Files,
        threads: Option<usize>,
        (mut listener, from): (Listener, Option<Checkpoint>),
    ) -> PyResult<Py<PyAny>> {
        let deck = &self.read;
        let (dir, allow_outside) = (files.dir, files.allow_outside);
        if !allow_outside {
            deck.stays_inside(files.own).map_err(|e| mistake(&e))?;
        }
        let folder = dir.clone();
        let work = || {
            pool(threads.or(deck.threads))?.install(|| {
                let run = runs::Run {
                    deck,
                    set: &self.set,
                    command: "peridyne.Deck.run (Python)".into(),
                    dir: dir.clone(),
                    allow_outside,
                };
                let done = run.done(from, &mut listener);
                outcome(done, listener)
            })
        };
        py.detach(|| caught(Some(&folder), work))??;
        let results = py.import("peridyne.results")?;
        Ok(results.call_method1("Run", (dir,))?.unbind())
    }
}
