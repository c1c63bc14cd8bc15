//! peridyne in Python: decks, runs and running models ([`deck`], [`simulation`]), numbers as NumPy's arrays ([`arrays`]), mistakes as exceptions
//! ([`error`]), and the program itself. What is Python's own (results, ASE) is in `python/peridyne`.

mod acting;
mod arrays;
mod asked;
mod deck;
mod error;
mod listener;
mod observers;
mod simulation;
mod tables;

use pyo3::prelude::*;
use std::ffi::OsString;

/// The program with these words after its name; its exit code.
#[pyfunction]
fn program(py: Python<'_>, words: Vec<OsString>) -> u8 {
    let name = OsString::from("peridyne");
    let words = std::iter::once(name).chain(words);
    py.detach(|| peridyne_cli::program(words))
}

#[pymodule]
fn _peridyne(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_function(wrap_pyfunction!(program, module)?)?;
    module.add_function(wrap_pyfunction!(deck::resume, module)?)?;
    module.add_class::<deck::Deck>()?;
    module.add_class::<simulation::Simulation>()?;
    module.add_class::<observers::Every>()?;
    error::add(module)
}
