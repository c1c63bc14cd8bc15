//! Models that Python leads step by step.

use crate::arrays::{kind, numbers, of_values, vectors};
use crate::error::{mistake, stopped};
use peridyne::condition::driven::Drive;
use peridyne::error::RunError as Stopped;
use peridyne::run::{Options, Simulation as Model, build};
use peridyne_io::deck::{Deck as Read, UnitSystem};
use peridyne_io::drive::refused_threads;
use pyo3::exceptions::{PyKeyError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::ThreadPool;
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};
use std::time::{Duration, Instant};

/// Steps after which energies are looked at: a balance that is lost is told, not followed.
const BALANCED: u64 = 250;
/// Between two looks whether somebody pressed Ctrl-C.
const INTERVAL: Duration = Duration::from_millis(100);

/// A force that Python gives.
struct Force {
    call: Py<PyAny>,
    /// `None`: all points.
    ids: Option<Vec<u32>>,
    every: u64,
    /// What it gave last.
    last: Option<Drive>,
}

enum Held {
    Own(Box<dyn Model>),
    /// Of a run, while it calls Python.
    Lent(*mut (dyn Model + 'static)),
    /// The call is over.
    Gone,
}

// SAFETY: models are sent; what is lent is reached through the lock of its holder, and taken back before the lender goes on
unsafe impl Send for Held {}

struct Inner {
    held: Held,
    started: bool,
    forces: Vec<Force>,
}

impl Inner {
    fn model(&mut self) -> PyResult<&mut dyn Model> {
        match &mut self.held {
            Held::Own(model) => Ok(model.as_mut()),
            // SAFETY: the lender waits until it has taken it back
            Held::Lent(model) => Ok(unsafe { &mut **model }),
            Held::Gone => Err(PyRuntimeError::new_err(
                "this simulation is there during the call of `observe` alone: take what you need as arrays",
            )),
        }
    }

    /// To be changed.
    fn own(&mut self) -> PyResult<&mut dyn Model> {
        if matches!(self.held, Held::Lent(_)) {
            return Err(PyRuntimeError::new_err(
                "the run that called `observe` leads this simulation: it may be asked, not changed",
            ));
        }
        self.model()
    }

    /// The forces of the state, if nobody asked for them yet.
    fn start(&mut self) -> PyResult<()> {
        if !std::mem::replace(&mut self.started, true) {
            self.model()?.start(true);
        }
        Ok(())
    }
}

/// A running model.
///
/// Numbers are in the units of the deck's system (SI: m, kg, s; metal: Å, ps, eV), arrays in the order of point ids. Each array is a copy that nobody
/// else changes. While a thread steps it others cannot ask it: RuntimeError.
#[pyclass(frozen, module = "peridyne")]
pub struct Simulation {
    inner: Mutex<Inner>,
    units: UnitSystem,
    /// `None`: that of the run which lent the model.
    pool: Option<ThreadPool>,
}

/// So many threads, or as many as there are cores.
pub fn pool(threads: Option<usize>) -> PyResult<ThreadPool> {
    let refused = match threads {
        Some(0) => Some("threads=0: at least one thread must run".to_string()),
        threads => threads.and_then(refused_threads),
    };
    if let Some(text) = refused {
        return Err(PyValueError::new_err(text));
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0));
    pool.build()
        .map_err(|e| PyRuntimeError::new_err(format!("no threads: {e}")))
}

impl Simulation {
    pub fn new(deck: &Read, threads: Option<usize>) -> PyResult<Simulation> {
        let pool = pool(threads)?;
        let made = pool.install(|| build(&deck.spec, Options::default()));
        let model = made.map_err(|e| mistake(&deck.explain(&e)))?;
        Ok(Simulation {
            inner: Mutex::new(Inner {
                held: Held::Own(model),
                started: false,
                forces: vec![],
            }),
            units: deck.units,
            pool: Some(pool),
        })
    }

    fn lock(&self) -> PyResult<MutexGuard<'_, Inner>> {
        match self.inner.try_lock() {
            Ok(inner) => Ok(inner),
            Err(TryLockError::WouldBlock) => Err(PyRuntimeError::new_err(
                "this simulation is being stepped or asked: one thread, and one call, at a time",
            )),
            Err(TryLockError::Poisoned(_)) => Err(PyRuntimeError::new_err(
                "this simulation broke within an earlier call: make a new one",
            )),
        }
    }

    /// Asks the model on its threads, and leaves the interpreter to others meanwhile.
    fn ask<T: Send>(
        &self,
        py: Python<'_>,
        ask: impl FnOnce(&mut Inner) -> PyResult<T> + Send,
    ) -> PyResult<T> {
        let mut inner = self.lock()?;
        let inner = &mut *inner;
        py.detach(|| match &self.pool {
            Some(pool) => pool.install(|| ask(inner)),
            None => ask(inner),
        })
    }
}

fn none_such(name: &str, all: &[String]) -> PyErr {
    PyKeyError::new_err(format!(
        "there is no column {name:?}; this model has {}",
        all.join(", ")
    ))
}

fn names(model: &mut dyn Model) -> Vec<String> {
    model.columns().iter().map(|c| c.name.to_string()).collect()
}

impl Force {
    /// What it is now, of a state that the caller holds.
    fn now(&mut self, inner: &mut Inner, (t, step, d): (f64, u64, usize)) -> PyResult<Drive> {
        if let Some(last) = self
            .last
            .as_ref()
            .filter(|_| !step.is_multiple_of(self.every))
        {
            return Ok(last.clone());
        }
        let (x, v) = {
            let model = inner.model()?;
            let (reference, u) = (model.vectors("reference"), model.displacements());
            let place = |x: &[f64; 3], u: &[f64; 3]| std::array::from_fn(|a| x[a] + u[a]);
            let x: Vec<[f64; 3]> = reference.iter().zip(&u).map(|(x, u)| place(x, u)).collect();
            let v = model.velocities();
            match &self.ids {
                None => (x, v),
                Some(ids) => {
                    let of = |all: &[[f64; 3]]| ids.iter().map(|i| all[*i as usize]).collect();
                    (of(&x), of(&v))
                }
            }
        };
        let count = x.len();
        let given = Python::attach(|py| {
            let [x, v] = [x, v].map(|of| of_values(py, peridyne::observe::Values::Vectors(of)));
            let answer = self.call.call1(py, (t, x?, v?))?;
            vectors(answer.bind(py), count, d)
        })?;
        if given.as_flattened().iter().any(|f| !f.is_finite()) {
            return Err(PyValueError::new_err(format!(
                "a force of step {step} is not a finite number"
            )));
        }
        let drive = Drive::AddEach(given.iter().map(|f| f.map(Some)).collect());
        self.last = Some(drive.clone());
        Ok(drive)
    }
}

/// Tells the model what the forces of Python are now.
fn drive(inner: &mut Inner) -> PyResult<()> {
    let mut forces = std::mem::take(&mut inner.forces);
    let now = inner.model().map(|model| {
        let now = model.now();
        (now.time, now.step, model.info().dimension)
    });
    let told = now.and_then(|now| {
        for (n, force) in forces.iter_mut().enumerate() {
            let value = force.now(inner, now)?;
            inner.model()?.drive(n, &value);
        }
        Ok(())
    });
    inner.forces = forces;
    told
}

/// The same where there are others than before.
fn tell_anew(inner: &mut Inner) -> PyResult<()> {
    let nothing = |f: &Force| {
        let count = f.ids.as_ref().map_or(0, Vec::len);
        (Drive::AddEach(vec![[None; 3]; count]), f.ids.clone())
    };
    let driven: Vec<_> = inner.forces.iter().map(nothing).collect();
    inner.model()?.set_driven(&driven);
    drive(inner)?;
    if inner.started {
        inner.model()?.start(true);
    }
    Ok(())
}

fn one_step(inner: &mut Inner) -> PyResult<()> {
    let wrong = |e: Stopped, step: u64| stopped(&e.message(), Some(step), None);
    let step = inner.model()?.now().step;
    if step > 0 && step.is_multiple_of(BALANCED) {
        inner.model()?.ledger().map_err(|e| wrong(e, step))?;
    }
    if inner.forces.is_empty() {
        return inner.model()?.step().map_err(|e| wrong(e, step));
    }
    inner.model()?.depart(&[]).map_err(|e| wrong(e, step))?;
    let told = drive(inner);
    let arrived = inner.model()?.arrive().map_err(|e| wrong(e, step));
    told.and(arrived)
}

#[pymethods]
impl Simulation {
    /// Does n steps (increments of load in statics). Ctrl-C ends it between two of them.
    ///
    /// Raises RunError with the step where the run goes bad; the state is that before it.
    #[pyo3(signature = (n=1))]
    fn step(&self, py: Python<'_>, n: u64) -> PyResult<()> {
        self.ask(py, |inner| {
            inner.own()?;
            if !inner.forces.is_empty() && !inner.started {
                drive(inner)?;
            }
            inner.start()?;
            let mut looked = Instant::now();
            for _ in 0..n {
                one_step(inner)?;
                if looked.elapsed() >= INTERVAL {
                    looked = Instant::now();
                    Python::attach(|py| py.check_signals())?;
                }
            }
            Ok(())
        })
    }

    /// The values of a column (`columns` lists them): `[N]` of scalars, `[N, 3]` of vectors, `[N, 6]` of symmetric tensors (xx yy zz xy xz yz), `[N, 9]` of tensors.
    fn column<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let values = self.ask(py, |inner| {
            inner.start()?;
            let model = inner.model()?;
            match model.column(name) {
                Some(column) => Ok(column.values),
                None => Err(none_such(name, &names(model))),
            }
        })?;
        of_values(py, values)
    }

    /// Sets a column: displacement, velocity, or one that bonds or points remember, `[N, d]` or as `column` gives it. Forces are found anew.
    fn set_column(&self, py: Python<'_>, name: &str, values: &Bound<'_, PyAny>) -> PyResult<()> {
        let (count, d) = self.ask(py, |inner| {
            let info = inner.own()?.info();
            Ok((info.points as usize, info.dimension))
        })?;
        if ["displacement", "velocity"].contains(&name) {
            let given = vectors(values, count, d)?;
            return self.ask(py, |inner| {
                let model = inner.model()?;
                match name {
                    "displacement" => model.set_displacements(&given),
                    _ => model.set_velocities(&given),
                }
                model.start(true);
                inner.started = true;
                Ok(())
            });
        }
        let (given, shape) = numbers(values)?;
        self.ask(py, |inner| {
            inner.start()?;
            let model = inner.model()?;
            if !names(model).iter().any(|n| n == name) {
                return Err(none_such(name, &names(model)));
            }
            if !model.set_column(name, &given) {
                return Err(PyValueError::new_err(format!(
                    "{name}: it follows from others, or has another number of values than {shape:?}"
                )));
            }
            model.start(true);
            Ok(())
        })
    }

    /// Adds a force density (force / volume) that `call(t, x, v)` answers, as `[N, d]` or one for all: t of the end of a step, x places and v velocities there
    /// (`[N, 3]`, of the step's middle) of the points of `set`. It is asked every so many steps and stays in between. Explicit steps alone.
    #[pyo3(signature = (call, *, set="all", every=1))]
    fn add_force(&self, py: Python<'_>, call: Py<PyAny>, set: &str, every: u64) -> PyResult<()> {
        if every == 0 {
            return Err(PyValueError::new_err("every=0: expected 1 or more steps"));
        }
        if !call.bind(py).is_callable() {
            let got = kind(call.bind(py));
            return Err(crate::error::expected(format!(
                "expected a function of (t, x, v), got {got}"
            )));
        }
        self.ask(py, |inner| {
            let model = inner.own()?;
            let stepper = model.info().stepper;
            if stepper.solves() || stepper.statics().is_some() || stepper.rests() {
                return Err(PyValueError::new_err(
                    "a force of Python acts in explicit steps; implicit ones ask for its tangent: write it as [[condition]] force with an expression",
                ));
            }
            let Some(ids) = model.members(set) else {
                return Err(PyKeyError::new_err(format!("there is no set {set:?}")));
            };
            let all = ids.len() as u64 == model.info().points;
            inner.forces.push(Force {
                call,
                ids: (!all).then_some(ids),
                every,
                last: None,
            });
            let told = tell_anew(inner);
            if told.is_err() {
                inner.forces.pop();
                tell_anew(inner)?;
            }
            told
        })
    }

    /// Names of columns.
    #[getter]
    fn columns(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        self.ask(py, |inner| Ok(names(inner.model()?)))
    }

    /// What a column is, in a sentence.
    fn describe(&self, py: Python<'_>, name: &str) -> PyResult<String> {
        self.ask(py, |inner| {
            let model = inner.model()?;
            let found = model.columns().into_iter().find(|c| c.name == name);
            match found {
                Some(column) => Ok(column.doc.to_string()),
                None => Err(none_such(name, &names(model))),
            }
        })
    }

    /// Ids of the points of a set of the deck; "all" is always there.
    fn members<'py>(&self, py: Python<'py>, set: &str) -> PyResult<Bound<'py, PyAny>> {
        let ids = self.ask(py, |inner| Ok(inner.model()?.members(set)))?;
        match ids {
            Some(ids) => of_values(py, peridyne::observe::Values::Counts(ids)),
            None => Err(PyKeyError::new_err(format!("there is no set {set:?}"))),
        }
    }

    /// What the probes of the deck measure now, by name.
    fn probes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (columns, values) = self.ask(py, |inner| {
            inner.start()?;
            let model = inner.model()?;
            Ok((model.probe_columns(), model.measure()))
        })?;
        let all = PyDict::new(py);
        for (column, value) in columns.iter().zip(values) {
            all.set_item(&column.name, value)?;
        }
        Ok(all)
    }

    /// Energies now: kinetic, strain, contact, released, made, dissipated, numerical, work_conditions, work_indenter, initial, and the residual of
    /// their balance.
    fn energies<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let l = self.ask(py, |inner| {
            inner.start()?;
            let model = inner.model()?;
            let step = model.now().step;
            let ledger = model.ledger();
            ledger.map_err(|e| stopped(&e.message(), Some(step), None))
        })?;
        let all = PyDict::new(py);
        for (name, value) in [
            ("kinetic", l.kinetic),
            ("strain", l.strain),
            ("contact", l.contact),
            ("released", l.released),
            ("made", l.made),
            ("dissipated", l.dissipated),
            ("numerical", l.numerical),
            ("work_conditions", l.work_conditions),
            ("work_indenter", l.work_indenter),
            ("initial", l.initial),
            ("residual", l.residual()),
        ] {
            all.set_item(name, value)?;
        }
        Ok(all)
    }

    /// Σ over pairs of distance times force, xx yy zz xy xz yz (energy), of bonds and repulsion: positive where pairs repel.
    fn virial(&self, py: Python<'_>) -> PyResult<[f64; 6]> {
        self.ask(py, |inner| {
            inner.start()?;
            Ok(inner.model()?.virial())
        })
    }

    /// Steps done.
    #[getter]
    fn step_number(&self, py: Python<'_>) -> PyResult<u64> {
        self.ask(py, |inner| Ok(inner.model()?.now().step))
    }

    /// Time; in statics the part of the load.
    #[getter]
    fn time(&self, py: Python<'_>) -> PyResult<f64> {
        self.ask(py, |inner| Ok(inner.model()?.now().time))
    }

    /// Length of a step.
    #[getter]
    fn time_step(&self, py: Python<'_>) -> PyResult<f64> {
        self.ask(py, |inner| Ok(inner.model()?.info().time_step))
    }

    /// Number of points.
    #[getter]
    fn points(&self, py: Python<'_>) -> PyResult<u64> {
        self.ask(py, |inner| Ok(inner.model()?.info().points))
    }

    /// 1, 2 or 3.
    #[getter]
    fn dimension(&self, py: Python<'_>) -> PyResult<usize> {
        self.ask(py, |inner| Ok(inner.model()?.info().dimension))
    }

    /// Directed bonds that broke since the start.
    #[getter]
    fn broken(&self, py: Python<'_>) -> PyResult<u64> {
        self.ask(py, |inner| Ok(inner.model()?.broken()))
    }

    /// Number of fragments: pieces that hang together by whole bonds.
    fn fragments(&self, py: Python<'_>) -> PyResult<u64> {
        self.ask(py, |inner| Ok(inner.model()?.fragments()))
    }

    /// Two numbers that differ when the state or its accounts do, as `run.json` has them: `state_hash` and `ledger_hash`.
    fn state_hash(&self, py: Python<'_>) -> PyResult<(String, Option<String>)> {
        self.ask(py, |inner| {
            inner.start()?;
            let hash = inner.model()?.state_hash();
            let words = |hash: u64| format!("{hash:016x}");
            Ok((words(hash.state), hash.ledger.map(words)))
        })
    }

    /// What looks wrong though it can be run.
    #[getter]
    fn warnings(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        let units = self.units;
        self.ask(py, |inner| {
            let all = &inner.model()?.info().warnings;
            Ok(all.iter().map(|w| units.tell(w)).collect())
        })
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        self.ask(py, |inner| {
            let model = inner.model()?;
            let (points, d) = (model.info().points, model.info().dimension);
            let now = model.now();
            Ok(format!(
                "<peridyne.Simulation of {points} points in {d}-D, step {}, time {:e}>",
                now.step, now.time
            ))
        })
    }
}

/// A model of a run while Python looks at it.
pub struct Lent(Py<Simulation>);

impl Lent {
    pub fn new(py: Python<'_>, sim: &mut dyn Model, units: UnitSystem) -> PyResult<Lent> {
        // SAFETY: the lifetime is that of this value, which takes the model back when it goes
        let model: *mut (dyn Model + 'static) =
            unsafe { std::mem::transmute::<*mut (dyn Model + '_), _>(sim) };
        let simulation = Simulation {
            inner: Mutex::new(Inner {
                held: Held::Lent(model),
                started: true,
                forces: vec![],
            }),
            units,
            pool: None,
        };
        Ok(Lent(Py::new(py, simulation)?))
    }

    pub fn given(&self, py: Python<'_>) -> Py<Simulation> {
        self.0.clone_ref(py)
    }
}

impl Drop for Lent {
    fn drop(&mut self) {
        // another thread may be asking it, and waits for the interpreter before it lets go
        Python::attach(|py| {
            let inner = &self.0.get().inner;
            py.detach(|| {
                let mut inner = inner.lock().unwrap_or_else(PoisonError::into_inner);
                inner.held = Held::Gone;
            });
        });
    }
}
