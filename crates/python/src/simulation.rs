//! Models that Python leads step by step.

use crate::acting::{Acting, Force, NotMade, axes_of, is_function};
use crate::arrays::{numbers, of_values, vectors};
use crate::error::{caught, mistake, stopped};
use peridyne::boundary_condition::constraint::Kind;
use peridyne::error::RunError as Stopped;
use peridyne::run::{Options, Simulation as Model, build};
use peridyne_io::deck::{Deck as Read, UnitSystem, each_once};
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

enum Held {
    Own(Box<dyn Model>),
    /// Of a run, while it calls Python.
    Lent(*mut (dyn Model + 'static), Loan),
    /// The call is over.
    Gone,
    /// The engine gave up in the middle of something.
    Broken,
}

/// What a run lends its model for.
#[derive(Clone, Copy, PartialEq)]
pub enum Loan {
    /// Between two steps.
    Observe,
    /// Before the first.
    Prepare,
    /// Before its state is read from a file.
    GoOn,
}

// SAFETY: models are sent; what is lent is reached through the lock of its holder, and taken back before the lender goes on
unsafe impl Send for Held {}

struct Inner {
    held: Held,
    started: bool,
    acting: Acting,
}

impl Inner {
    fn model(&mut self) -> PyResult<&mut dyn Model> {
        self.parts().map(|(model, _)| model)
    }

    /// The model, and what Python gave it.
    fn parts(&mut self) -> PyResult<(&mut dyn Model, &mut Acting)> {
        let model = match &mut self.held {
            Held::Own(model) => model.as_mut(),
            // SAFETY: the lender waits until it has taken it back
            Held::Lent(model, _) => unsafe { &mut **model },
            Held::Gone => {
                return Err(PyRuntimeError::new_err(
                    "this simulation is there during the call of `observe` or `prepare` alone: take what you need as arrays",
                ));
            }
            Held::Broken => {
                return Err(PyRuntimeError::new_err(
                    "this simulation broke within an earlier call: make a new one",
                ));
            }
        };
        Ok((model, &mut self.acting))
    }

    fn loan(&self) -> Option<Loan> {
        match self.held {
            Held::Lent(_, loan) => Some(loan),
            Held::Own(_) | Held::Gone | Held::Broken => None,
        }
    }

    /// To be changed.
    fn changed(&mut self) -> PyResult<&mut dyn Model> {
        if self.loan() == Some(Loan::Observe) {
            return Err(PyRuntimeError::new_err(
                "the run that called `observe` leads this simulation: it may be asked, not changed",
            ));
        }
        self.model()
    }

    /// To be led.
    fn led(&mut self) -> PyResult<&mut dyn Model> {
        if self.loan().is_some_and(|loan| loan != Loan::Observe) {
            return Err(PyRuntimeError::new_err(
                "the run that called `prepare` leads this simulation: it may be changed, not stepped",
            ));
        }
        self.changed()
    }

    /// Something was changed.
    fn start_anew(&mut self) -> PyResult<()> {
        // a run starts its model itself
        if self.loan().is_none() {
            let (model, acting) = self.parts()?;
            acting.anew();
            model.start(true);
            self.started = true;
        }
        self.heard()
    }

    /// The forces of the state, if nobody asked for them yet.
    fn start(&mut self) -> PyResult<()> {
        if std::mem::replace(&mut self.started, true) {
            return Ok(());
        }
        self.model()?.start(true);
        self.heard()
    }

    /// What a function raised that the first forces asked for; they are none then.
    fn heard(&mut self) -> PyResult<()> {
        let raised = self.acting.raised().map_or(Ok(()), Err);
        if self.loan().is_none() {
            self.started &= raised.is_ok();
        }
        raised
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
                acting: Acting::default(),
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

    /// What is known without any work: neither threads nor the interpreter wait for it.
    fn known<T>(&self, of: impl FnOnce(&dyn Model) -> T) -> PyResult<T> {
        let mut inner = self.lock()?;
        inner.model().map(|model| of(model))
    }

    /// Asks the model on its threads, and leaves the interpreter to others meanwhile.
    fn ask<T: Send>(
        &self,
        py: Python<'_>,
        ask: impl FnOnce(&mut Inner) -> PyResult<T> + Send,
    ) -> PyResult<T> {
        let mut inner = self.lock()?;
        let inner = &mut *inner;
        let asked = py.detach(|| {
            caught(None, || match &self.pool {
                Some(pool) => pool.install(|| ask(&mut *inner)),
                None => ask(&mut *inner),
            })
        });
        asked.unwrap_or_else(|broken| {
            inner.held = Held::Broken;
            Err(broken)
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

/// Sets of points by their names.
fn set_of(model: &mut dyn Model, set: &str) -> PyResult<Vec<u32>> {
    let none = || PyKeyError::new_err(format!("there is no set {set:?}"));
    model.members(set).ok_or_else(none)
}

fn one_step(inner: &mut Inner) -> PyResult<()> {
    let (model, acting) = inner.parts()?;
    let step = model.now().step;
    let wrong = |e: Stopped| stopped(&e.message(), Some(step), None);
    if step > 0 && step.is_multiple_of(BALANCED) {
        model.ledger().map_err(wrong)?;
    }
    acting.step(model).map_err(|why| match why {
        NotMade::Raised(error) => error,
        NotMade::Run(error) => wrong(error),
    })?;
    acting.raised().map_or(Ok(()), Err)
}

#[pymethods]
impl Simulation {
    /// Does n steps (increments of load in statics). Ctrl-C ends it between two of them.
    ///
    /// Raises RunError with the step where the run goes bad; the state is that before it.
    #[pyo3(signature = (n=1))]
    fn step(&self, py: Python<'_>, n: u64) -> PyResult<()> {
        self.ask(py, |inner| {
            inner.led()?;
            if !inner.started {
                let (model, acting) = inner.parts()?;
                acting.begin(model)?;
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
            let info = inner.changed()?.info();
            Ok((info.points as usize, info.dimension))
        })?;
        if ["displacement", "velocity"].contains(&name) {
            let given = vectors(values, count, d)?;
            if given.as_flattened().iter().any(|x| !x.is_finite()) {
                return Err(PyValueError::new_err(format!(
                    "{name}: expected finite numbers"
                )));
            }
            return self.ask(py, |inner| {
                inner.acting.tell(format!("a column {name}"));
                // the state to come has its own
                if inner.loan() == Some(Loan::GoOn) {
                    return Ok(());
                }
                let model = inner.model()?;
                match name {
                    "displacement" => model.set_displacements(&given),
                    _ => model.set_velocities(&given),
                }
                inner.start_anew()
            });
        }
        let (given, shape) = numbers(values)?;
        self.ask(py, |inner| {
            inner.start()?;
            inner.acting.tell(format!("a column {name}"));
            let goes_on = inner.loan() == Some(Loan::GoOn);
            let model = inner.model()?;
            if !names(model).iter().any(|n| n == name) {
                return Err(none_such(name, &names(model)));
            }
            if !goes_on && !model.set_column(name, &given) {
                return Err(PyValueError::new_err(format!(
                    "{name}: it follows from others, or has another number of values than {shape:?}"
                )));
            }
            inner.start_anew()
        })
    }

    /// Adds a force density (force / volume) that `call(t, x, v)` answers, as `[N, d]` or one for all: t of the end of a step, x places and v velocities there
    /// (`[N, 3]`, of the step's middle) of the points of `set`. It is asked every so many steps and stays in between.
    ///
    /// Implicit steps and increments of statics (t: the factor of the load) end in balance with it: it is asked at every trial, of which v are the velocities there (0 in
    /// statics), and once more for each axis, near it, for how it changes with x and v of each point. So it is a function of these alone.
    ///
    /// Where it raises something, the step is not made: the state is that before it.
    #[pyo3(signature = (call, *, set="all", every=1))]
    fn add_force(&self, py: Python<'_>, call: Py<PyAny>, set: &str, every: u64) -> PyResult<()> {
        if every == 0 {
            return Err(PyValueError::new_err("every=0: expected 1 or more steps"));
        }
        is_function(call.bind(py), "(t, x, v)")?;
        self.ask(py, |inner| {
            let model = inner.changed()?;
            let stepper = model.info().stepper;
            if stepper.rests() {
                return Err(PyValueError::new_err(
                    "points stand still in these steps: no force moves them",
                ));
            }
            let ids = set_of(model, set)?;
            if stepper.solves() {
                let (model, acting) = inner.parts()?;
                acting.ask_for_force(model, (call, every), &ids)?;
                acting.tell(format!("a force on `{set}`"));
                return match inner.started {
                    true => inner.start_anew(),
                    false => Ok(()),
                };
            }
            let all = ids.len() as u64 == model.info().points;
            let force = Force::new(call, (!all).then_some(ids), every);
            let now = inner.started && inner.loan().is_none();
            let (model, acting) = inner.parts()?;
            acting.add_force(model, force, now)?;
            acting.tell(format!("a force on `{set}`"));
            Ok(())
        })
    }

    /// Prescribes the motion of the points of `set` along `axes` (a word of x, y and z; all if it is left out): `call(t, x)` answers their displacement (length) or, with
    /// `of="velocity"`, their velocity (length / time), as `[N, k]` or `[k]` for all alike, k the number of axes; of one axis `[N]` or a number, too. x are their places in the
    /// reference (`[N, 3]`). Other axes are free.
    ///
    /// It is a condition like one of a deck: probes of reactions see it, and its work is among `work_boundary_conditions`. So it is a function of time and place alone: it is asked for
    /// times up to two steps ahead and one before now, and each time once; in statics for the factor t of the load. Of a deck with statics before its motion it is of the motion.
    ///
    /// Raises ValueError where a component is held already. Where the call raises something, the step is not made.
    #[pyo3(signature = (call, *, set="all", axes=None, of="displacement"))]
    fn add_motion(
        &self,
        py: Python<'_>,
        call: Py<PyAny>,
        set: &str,
        axes: Option<&str>,
        of: &str,
    ) -> PyResult<()> {
        is_function(call.bind(py), "(t, x)")?;
        let kind = match of {
            "displacement" => Kind::Displacement,
            "velocity" => Kind::Velocity,
            _ => {
                return Err(PyValueError::new_err(format!(
                    "of={of:?}: expected \"displacement\" or \"velocity\""
                )));
            }
        };
        self.ask(py, |inner| {
            let model = inner.changed()?;
            let axes = axes_of(axes, model.info().dimension)?;
            let ids = set_of(model, set)?;
            let (model, acting) = inner.parts()?;
            acting.add_motion(model, (kind, call), &ids, &axes)?;
            let along: String = axes.iter().map(|a| ["x", "y", "z"][*a]).collect();
            acting.tell(format!("the {of} of `{set}` along {along}"));
            if inner.started {
                inner.start_anew()?;
            }
            Ok(())
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
        let ids = self.ask(py, |inner| set_of(inner.model()?, set))?;
        of_values(py, peridyne::observe::Values::Counts(ids))
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

    /// Energies now: kinetic, strain, contact, dissipated_by_breakage, created_by_breakage, dissipated, numerical, work_boundary_conditions,
    /// work_rigid_bodies, initial, balance_error: as in `run.json`.
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
            ("dissipated_by_breakage", l.released),
            ("created_by_breakage", l.made),
            ("dissipated", l.dissipated),
            ("numerical", l.numerical),
            ("work_boundary_conditions", l.work_boundary_conditions),
            ("work_rigid_bodies", l.work_rigid_bodies),
            ("initial", l.initial),
            ("balance_error", l.residual()),
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
    fn step_number(&self) -> PyResult<u64> {
        self.known(|model| model.now().step)
    }

    /// Time; in statics the part of the load.
    #[getter]
    fn time(&self) -> PyResult<f64> {
        self.known(|model| model.now().time)
    }

    /// Length of a step.
    #[getter]
    fn time_step(&self) -> PyResult<f64> {
        self.known(|model| model.info().time_step)
    }

    /// Number of points.
    #[getter]
    fn points(&self) -> PyResult<u64> {
        self.known(|model| model.info().points)
    }

    /// 1, 2 or 3.
    #[getter]
    fn dimension(&self) -> PyResult<usize> {
        self.known(|model| model.info().dimension)
    }

    /// Bonds that broke since the start.
    #[getter]
    fn broken_bonds(&self, py: Python<'_>) -> PyResult<u64> {
        self.ask(py, |inner| Ok(each_once(inner.model()?.broken())))
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

    /// Gives up as the engine would on a defect of its own: for tests of what Python sees then.
    fn _give_up(&self, py: Python<'_>) -> PyResult<()> {
        self.ask(py, |_| panic!("asked to"))
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
    pub fn new(
        py: Python<'_>,
        sim: &mut dyn Model,
        units: UnitSystem,
        loan: Loan,
    ) -> PyResult<Lent> {
        // SAFETY: the lifetime is that of this value, which takes the model back when it goes
        let model: *mut (dyn Model + 'static) =
            unsafe { std::mem::transmute::<*mut (dyn Model + '_), _>(sim) };
        let simulation = Simulation {
            inner: Mutex::new(Inner {
                held: Held::Lent(model, loan),
                started: true,
                acting: Acting::default(),
            }),
            units,
            pool: None,
        };
        Ok(Lent(Py::new(py, simulation)?))
    }

    pub fn given(&self, py: Python<'_>) -> Py<Simulation> {
        self.0.clone_ref(py)
    }

    /// What it was given meanwhile.
    pub fn acting(&self) -> PyResult<Acting> {
        Ok(std::mem::take(&mut self.0.get().lock()?.acting))
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
