//! Functions that look at a run at their own intervals.

use crate::acting::is_function;
use crate::arrays::kind;
use crate::error::expected;
use peridyne::run::Simulation as Model;
use peridyne_io::deck::{Dim, UnitSystem, split, unit};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyFloat, PyInt, PyList, PyString, PyTuple};

/// A function that is called at an interval of its own: `peridyne.Every(100, call)`, `peridyne.Every("2 us", call)`.
///
/// interval: a whole number of steps; or a time, with its unit ("2 us") or as a float in that of the deck: then after the first step that reaches each multiple of it.
/// call: `call(simulation)`; where it answers True the run ends.
#[pyclass(frozen, module = "peridyne")]
pub struct Every {
    #[pyo3(get)]
    interval: Py<PyAny>,
    #[pyo3(get)]
    call: Py<PyAny>,
}

#[pymethods]
impl Every {
    #[new]
    fn new(py: Python<'_>, interval: Py<PyAny>, call: Py<PyAny>) -> PyResult<Every> {
        is_function(call.bind(py), "a Simulation")?;
        Ok(Every { interval, call })
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (interval, call) = (self.interval.bind(py).repr()?, self.call.bind(py).repr()?);
        Ok(format!("peridyne.Every({interval}, {call})"))
    }
}

enum Interval {
    Steps(u64),
    /// Time.
    Time(f64),
}

impl Interval {
    fn of(given: &Bound<'_, PyAny>, units: UnitSystem) -> PyResult<Interval> {
        let wrong = |text: String| {
            PyValueError::new_err(format!(
                "every={text}: expected 1 or more steps, or a time above 0 (\"2 us\", or a float in the units of the deck)"
            ))
        };
        let repr = || given.repr().map_or_else(|_| kind(given), |r| r.to_string());
        if given.is_instance_of::<PyInt>() && !given.is_instance_of::<PyBool>() {
            let steps: Option<u64> = given.extract().ok().filter(|n| *n > 0);
            return steps.map(Interval::Steps).ok_or_else(|| wrong(repr()));
        }
        let time = if let Ok(text) = given.cast::<PyString>() {
            let text = text.to_string();
            let read = split(&text).and_then(|(value, name)| {
                let unit = unit(name).ok()?;
                (unit.dim == Dim::TIME && units.has_units()).then(|| unit.si(value))
            });
            read.map(|si| si / units.to_si(1.0, Dim::TIME))
        } else if given.is_instance_of::<PyFloat>() {
            Some(given.extract::<f64>()? * units.plain_factor(Dim::TIME))
        } else {
            let text = format!(
                "every={}: expected steps or a time, got {}",
                repr(),
                kind(given)
            );
            return Err(expected(text));
        };
        let time = time.filter(|t| t.is_finite() && *t > 0.0);
        time.map(Interval::Time).ok_or_else(|| wrong(repr()))
    }

    /// After a step that led to this time and was dt long.
    fn is_due(&self, step: u64, [t, dt]: [f64; 2]) -> bool {
        match self {
            Interval::Steps(n) => step.is_multiple_of(*n),
            Interval::Time(every) => {
                // multiples that rounding leaves a little behind a step are reached
                let passed = |t: f64| ((t + 1e-6 * dt) / every).floor();
                passed(t) > passed(t - dt)
            }
        }
    }
}

pub struct Observer {
    interval: Interval,
    pub call: Py<PyAny>,
}

impl Observer {
    pub fn is_due(&self, sim: &mut dyn Model, step: u64) -> bool {
        self.interval
            .is_due(step, [sim.now().time, sim.info().time_step])
    }
}

/// A function, an [`Every`], or a list of these; functions alone are called at the interval `every`.
pub fn observers(
    given: Option<Bound<'_, PyAny>>,
    every: Option<Bound<'_, PyAny>>,
    units: UnitSystem,
) -> PyResult<Vec<Observer>> {
    let usual = || match &every {
        Some(every) => Interval::of(every, units),
        None => Ok(Interval::Steps(1)),
    };
    // a wrong one is told where nobody is called, too
    usual()?;
    let Some(given) = given else {
        return Ok(vec![]);
    };
    let one = |given: Bound<'_, PyAny>| {
        if let Ok(of) = given.cast::<Every>() {
            let of = of.get();
            return Ok(Observer {
                interval: Interval::of(of.interval.bind(given.py()), units)?,
                call: of.call.clone_ref(given.py()),
            });
        }
        if !given.is_callable() {
            return Err(expected(format!(
                "observe: expected a function of a Simulation, a peridyne.Every(interval, function), or a list of these, got {}",
                kind(&given)
            )));
        }
        Ok(Observer {
            interval: usual()?,
            call: given.unbind(),
        })
    };
    match given.is_instance_of::<PyList>() || given.is_instance_of::<PyTuple>() {
        true => given.try_iter()?.map(|each| one(each?)).collect(),
        false => Ok(vec![one(given)?]),
    }
}
