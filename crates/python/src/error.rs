//! Mistakes as exceptions.

use peridyne_cli::Failure;
use peridyne_io::deck::DeckError as Mistake;
use peridyne_io::drive::DriveError;
use pyo3::create_exception;
use pyo3::exceptions::{PyException, PyTypeError, PyValueError};
use pyo3::prelude::*;
use std::fmt::Display;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

create_exception!(
    peridyne,
    Error,
    PyException,
    "What peridyne raises: a DeckError or a RunError."
);
create_exception!(
    peridyne,
    DeckError,
    Error,
    "A deck is wrong. `message` says how, `help` what to write instead (or None), `file` and `line` where (or None)."
);
create_exception!(
    peridyne,
    RunError,
    Error,
    "A run stopped, or its results could not be written. `step` and `folder` say where its last good state is (or None)."
);

pub fn add(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    module.add("Error", py.get_type::<Error>())?;
    module.add("DeckError", py.get_type::<DeckError>())?;
    module.add("RunError", py.get_type::<RunError>())
}

/// A deck error that says more than its words.
struct Parts<'a> {
    message: &'a str,
    help: Option<&'a str>,
    file: Option<&'a str>,
    line: Option<usize>,
}

fn deck_error(parts: &Parts<'_>) -> PyErr {
    let place = match (parts.file, parts.line) {
        (Some(file), Some(line)) => format!("{file}:{line}: "),
        (Some(file), None) => format!("{file}: "),
        (None, _) => String::new(),
    };
    let help = parts.help.map_or(String::new(), |h| format!("\nhelp: {h}"));
    let error = DeckError::new_err(format!("{place}{}{help}", parts.message));
    Python::attach(|py| {
        let value = error.value(py);
        value.setattr("message", parts.message)?;
        value.setattr("help", parts.help)?;
        value.setattr("file", parts.file)?;
        value.setattr("line", parts.line)?;
        Ok(error.clone_ref(py))
    })
    .unwrap_or_else(|error: PyErr| error)
}

/// A mistake in a deck.
pub fn mistake(error: &Mistake) -> PyErr {
    deck_error(&Parts {
        message: &error.message,
        help: error.help.as_deref(),
        file: Some(&error.file),
        line: error.line,
    })
}

/// How a verb of the program ended badly.
pub fn failed(failure: Failure) -> PyErr {
    match failure {
        Failure::Input(report) => match report.downcast_ref::<Mistake>() {
            Some(error) => mistake(error),
            None => deck_error(&Parts {
                message: &report.to_string(),
                help: report.help().map(|h| h.to_string()).as_deref(),
                file: None,
                line: None,
            }),
        },
        Failure::Run(message) => stopped(&message, None, None),
        Failure::Ended(_) | Failure::Elsewhere => stopped(&"ended", None, None),
    }
}

/// A run stopped.
pub fn stopped(message: &dyn Display, step: Option<u64>, folder: Option<&str>) -> PyErr {
    let message = message.to_string();
    let error = RunError::new_err(message.clone());
    Python::attach(|py| {
        let value = error.value(py);
        value.setattr("message", message)?;
        value.setattr("step", step)?;
        value.setattr("folder", folder)?;
        Ok(error.clone_ref(py))
    })
    .unwrap_or_else(|error: PyErr| error)
}

/// The same of a run with files.
pub fn driven(error: &DriveError) -> PyErr {
    match error {
        DriveError::Run { step, dir, .. } => {
            stopped(error, Some(*step), Some(&dir.to_string_lossy()))
        }
        other => stopped(other, None, None),
    }
}

/// What was given is of another kind.
pub fn expected(what: impl Display) -> PyErr {
    PyTypeError::new_err(what.to_string())
}

/// An answer of a function is not what it should be.
pub fn wrong_call(what: &str) -> PyErr {
    PyValueError::new_err(what.to_string())
}

/// What was done, or the defect on which the engine gave up: an exception, not the end of the program. `folder`: where the run writes.
pub fn caught<T>(folder: Option<&Path>, work: impl FnOnce() -> T) -> PyResult<T> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|payload| {
        let text = payload.downcast_ref::<String>().map(String::as_str);
        let text = text.or_else(|| payload.downcast_ref::<&str>().copied());
        let state = match folder {
            Some(_) => "; the last state that the run wrote is as it was (peridyne.resume)",
            None => "",
        };
        let message = format!(
            "the engine gave up: {}; this is a defect of peridyne, not of what you wrote: please report it with the deck{state}",
            text.unwrap_or("it does not say why")
        );
        let folder = folder.map(|f| f.to_string_lossy().into_owned());
        stopped(&message, None, folder.as_deref())
    })
}
