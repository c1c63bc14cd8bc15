//! What functions of Python do to a model: forces and motion.

use crate::arrays::{kind, numbers, of_values, vectors};
use crate::asked::Asked;
use crate::error::{expected, wrong_call};
use peridyne::boundary_condition::constraint::Kind;
use peridyne::boundary_condition::driven::Drive;
use peridyne::boundary_condition::external::ExternalValues;
use peridyne::error::{BuildError, RunError};
use peridyne::observe::Values;
use peridyne::run::{Given, Simulation as Model};
use peridyne::space::Point;
use peridyne::spec::{Control, Stepper};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// What t of a motion is now, and the length of its steps; before a motion that follows statics it is that of its beginning.
fn motion_begins(model: &dyn Model) -> [f64; 2] {
    let now = model.now();
    let t = if now.clock == now.time { now.time } else { 0.0 };
    [t, model.info().time_step]
}

/// Times whose values a motion keeps: those that conditions ask for in a step, and those of the step before.
const KEPT: usize = 12;

/// Is it one?
pub fn is_function(call: &Bound<'_, PyAny>, of: &str) -> PyResult<()> {
    match call.is_callable() {
        true => Ok(()),
        false => Err(expected(format!(
            "expected a function of {of}, got {}",
            kind(call)
        ))),
    }
}

/// The axes of a word.
pub fn axes_of(word: Option<&str>, dimension: usize) -> PyResult<Vec<usize>> {
    let all = &"xyz"[..dimension];
    let word = word.unwrap_or(all);
    let found: Option<Vec<usize>> = word.chars().map(|c| all.find(c)).collect();
    let once = |axes: &Vec<usize>| axes.windows(2).all(|w| w[0] < w[1]) && !axes.is_empty();
    found.filter(once).ok_or_else(|| {
        PyValueError::new_err(format!(
            "axes={word:?}: expected some of {all:?}, in this order"
        ))
    })
}

/// A force.
pub struct Force {
    call: Py<PyAny>,
    /// `None`: all points.
    ids: Option<Vec<u32>>,
    every: u64,
    /// Was it asked already?
    asked: bool,
}

impl Force {
    pub fn new(call: Py<PyAny>, ids: Option<Vec<u32>>, every: u64) -> Force {
        Force {
            call,
            ids,
            every,
            asked: false,
        }
    }

    /// What it is now; `None`: what it was.
    fn now(&self, model: &mut dyn Model) -> PyResult<Option<Drive>> {
        let now = model.now();
        let [t, _] = motion_begins(model);
        if self.asked && !now.step.is_multiple_of(self.every) {
            return Ok(None);
        }
        let (reference, u) = (model.vectors("reference"), model.displacements());
        let place = |x: &Point, u: &Point| std::array::from_fn(|a| x[a] + u[a]);
        let x: Vec<Point> = reference.iter().zip(&u).map(|(x, u)| place(x, u)).collect();
        let v = model.velocities();
        let [x, v] = match &self.ids {
            None => [x, v],
            Some(ids) => {
                let of = |all: &[Point]| ids.iter().map(|i| all[*i as usize]).collect();
                [of(&x), of(&v)]
            }
        };
        let (count, d) = (x.len(), model.info().dimension);
        let given = Python::attach(|py| {
            let [x, v] = [x, v].map(|of| of_values(py, Values::Vectors(of)));
            let answer = self.call.call1(py, (t, x?, v?))?;
            vectors(answer.bind(py), count, d)
        })?;
        if given.as_flattened().iter().any(|f| !f.is_finite()) {
            return Err(PyValueError::new_err(format!(
                "a force of step {} is not a finite number",
                now.step
            )));
        }
        let each = given.iter().map(|f| f.map(Some)).collect();
        Ok(Some(Drive::AddEach(each)))
    }
}

/// What a motion answered.
#[derive(Debug, Default)]
struct Known {
    /// By time, the newest last.
    values: VecDeque<(f64, Vec<f64>)>,
    raised: Option<PyErr>,
}

impl Known {
    fn of(&self, t: f64) -> Option<&[f64]> {
        let found = self.values.iter().rev().find(|(time, _)| *time == t);
        found.map(|(_, values)| &values[..])
    }
}

/// A motion.
#[derive(Debug)]
pub struct Motion {
    call: Py<PyAny>,
    /// Places in the reference, as Python sees them, and how many.
    x: Py<PyAny>,
    count: usize,
    kind: Kind,
    axes: Vec<usize>,
    stepper: Stepper,
    known: Mutex<Known>,
}

impl Motion {
    fn known(&self) -> MutexGuard<'_, Known> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Asks Python, `[count][axes]`.
    fn ask(&self, t: f64) -> PyResult<Vec<f64>> {
        let (n, k) = (self.count, self.axes.len());
        let (all, shape) = Python::attach(|py| {
            let answer = self.call.call1(py, (t, &self.x))?;
            numbers(answer.bind(py))
        })?;
        if all.iter().any(|x| !x.is_finite()) {
            return Err(wrong_call(&format!(
                "a motion at t = {t:e} is not a finite number"
            )));
        }
        match shape[..] {
            [rows, columns] if [rows, columns] == [n, k] => Ok(all),
            [rows] if k == 1 && rows == n => Ok(all),
            [columns] if columns == k => Ok(all.repeat(n)),
            [] if k == 1 => Ok(all.repeat(n)),
            _ => {
                let alone = if k == 1 {
                    format!(", ({n},) or ()")
                } else {
                    String::new()
                };
                Err(wrong_call(&format!(
                    "expected an array of shape ({n}, {k}), ({k},){alone}, got {shape:?}"
                )))
            }
        }
    }

    /// Makes sure that values of a time are known.
    fn learn(&self, t: f64) -> PyResult<()> {
        if self.known().of(t).is_some() {
            return Ok(());
        }
        let values = self.ask(t)?;
        let mut known = self.known();
        if known.values.len() == KEPT {
            known.values.pop_front();
        }
        known.values.push_back((t, values));
        Ok(())
    }

    /// What the next step will ask for.
    fn look_ahead(&self, [t, dt]: [f64; 2]) -> PyResult<()> {
        let times = match (self.stepper.statics(), self.kind) {
            // a load whose factor is sought is that of 1
            (Some(statics), _) if statics.control != Control::Load => [1.0; 2],
            (Some(_), _) => [t + dt; 2],
            (None, Kind::Displacement) => [t + dt, t + 2.0 * dt],
            (None, Kind::Velocity) => [t + 0.5 * dt, t + dt],
        };
        times.into_iter().try_for_each(|t| self.learn(t))
    }
}

impl ExternalValues for Motion {
    fn at(&self, axis: usize, k: usize, t: f64) -> f64 {
        let place = self.axes.iter().position(|a| *a == axis).unwrap_or(0);
        let place = self.axes.len() * k + place;
        if let Some(values) = self.known().of(t) {
            return values[place];
        }
        if self.known().raised.is_none()
            && let Err(error) = self.learn(t)
        {
            self.known().raised = Some(error);
        }
        let known = self.known();
        if let Some(values) = known.of(t) {
            return values[place];
        }
        // no solver takes that for a solution, and the step is not made
        if self.stepper.solves() {
            return f64::NAN;
        }
        let apart = |(time, _): &&(f64, Vec<f64>)| (time - t).abs();
        // where it raised something the run ends, at rest
        let nearest = known.values.iter().rev();
        let nearest = nearest.min_by(|a, b| apart(a).total_cmp(&apart(b)));
        nearest.map_or(0.0, |(_, values)| values[place])
    }
}

/// The model cannot take it.
fn refused(error: &BuildError) -> PyErr {
    let help = { error.help.as_ref() }.map_or(String::new(), |h| format!("; {h}"));
    PyValueError::new_err(format!("{}{help}", error.message))
}

/// Why a step was not made.
pub enum NotMade {
    Raised(PyErr),
    Run(RunError),
}

/// All that Python gave a model.
#[derive(Default)]
pub struct Acting {
    forces: Vec<Force>,
    /// Did the motion just begin that they act in?
    begins: bool,
    /// Forces of steps that end with the solution of equations.
    asked: Vec<Arc<Asked>>,
    motions: Vec<Arc<Motion>>,
    /// The same in words.
    told: Vec<String>,
}

impl Acting {
    /// One more thing, in words.
    pub fn tell(&mut self, what: String) {
        self.told.push(what);
    }

    pub fn told(&self) -> &[String] {
        &self.told
    }

    /// What a function raised within a step.
    pub fn raised(&self) -> Option<PyErr> {
        let motions = self.motions.iter().map(|m| m.known().raised.take());
        let all = motions.chain(self.asked.iter().map(|f| f.raised()));
        // of all, so that none is left
        all.fold(None, Option::or)
    }

    /// The state was changed from outside: forces are found anew.
    pub fn anew(&self) {
        self.asked.iter().for_each(|f| f.anew());
    }

    /// A force of steps that end with the solution of equations.
    pub fn ask_for_force(
        &mut self,
        model: &mut dyn Model,
        (call, every): (Py<PyAny>, u64),
        ids: &[u32],
    ) -> PyResult<()> {
        let force = Arc::new(Asked::new(call, every, model.info()));
        let [t, _] = motion_begins(model);
        force.try_out(model, ids, t)?;
        let given = model.give(ids, Given::Force(force.clone()));
        given.map_err(|e| refused(&e))?;
        self.asked.push(force);
        Ok(())
    }

    /// `now`: of a model that goes already.
    pub fn add_force(&mut self, model: &mut dyn Model, force: Force, now: bool) -> PyResult<()> {
        self.forces.push(force);
        let told = self.tell_forces(model, now);
        if told.is_err() {
            self.forces.pop();
            self.tell_forces(model, now)?;
        }
        told
    }

    /// Forces are others than before.
    fn tell_forces(&mut self, model: &mut dyn Model, now: bool) -> PyResult<()> {
        let nothing = |f: &Force| {
            let count = f.ids.as_ref().map_or(0, Vec::len);
            (Drive::AddEach(vec![[None; 3]; count]), f.ids.clone())
        };
        let driven: Vec<_> = self.forces.iter().map(nothing).collect();
        model.set_driven(&driven);
        self.forces.iter_mut().for_each(|f| f.asked = false);
        if now {
            self.begin(model)?;
            model.start(true);
        }
        Ok(())
    }

    pub fn add_motion(
        &mut self,
        model: &mut dyn Model,
        (kind, call): (Kind, Py<PyAny>),
        ids: &[u32],
        axes: &[usize],
    ) -> PyResult<()> {
        let reference = model.vectors("reference");
        let x: Vec<Point> = ids.iter().map(|i| reference[*i as usize]).collect();
        let x = Python::attach(|py| {
            let x = of_values(py, Values::Vectors(x))?;
            // it is shown again and again
            x.call_method1("setflags", (false,))?;
            PyResult::Ok(x.unbind())
        })?;
        let motion = Arc::new(Motion {
            call,
            x,
            count: ids.len(),
            kind,
            axes: axes.to_vec(),
            stepper: model.info().stepper,
            known: Mutex::default(),
        });
        // what is wrong with it shows before it acts
        let times = motion_begins(model);
        motion.learn(times[0])?;
        motion.look_ahead(times)?;
        let on = std::array::from_fn(|a| axes.contains(&a));
        let held = model.give(ids, Given::Motion(kind, on, motion.clone()));
        if let Some(error) = motion.known().raised.take() {
            return Err(error);
        }
        held.map_err(|e| refused(&e))?;
        self.motions.push(motion);
        Ok(())
    }

    /// Tells the model what forces are now.
    pub fn begin(&mut self, model: &mut dyn Model) -> PyResult<()> {
        let now: PyResult<Vec<_>> = self.forces.iter().map(|f| f.now(model)).collect();
        for (n, value) in now?.into_iter().enumerate() {
            if let Some(value) = value {
                model.drive(n, &value);
                self.forces[n].asked = true;
            }
        }
        Ok(())
    }

    /// Makes a step, or leaves the state as it is. What a motion raises within an explicit one, [`Acting::raised`] has.
    pub fn step(&mut self, model: &mut dyn Model) -> Result<(), NotMade> {
        let before = self.raised().map_or(Ok(()), Err);
        before.map_err(NotMade::Raised)?;
        let times = motion_begins(model);
        let mut ahead = self.motions.iter().map(|m| m.look_ahead(times));
        ahead.try_for_each(|m| m).map_err(NotMade::Raised)?;
        if self.forces.is_empty() {
            let step = model.now().step + 1;
            self.asked.iter().for_each(|f| f.begin(step));
            let made = model.step();
            return made.map_err(|e| self.raised().map_or(NotMade::Run(e), NotMade::Raised));
        }
        self.begins |= model.begin_motion().map_err(NotMade::Run)?;
        if self.begins {
            self.forces.iter_mut().for_each(|f| f.asked = false);
            self.begin(model).map_err(NotMade::Raised)?;
            self.begins = false;
        }
        let now = model.now();
        // statics before the motion that they act in
        if now.clock != now.time {
            return model.step().map_err(NotMade::Run);
        }
        model.depart(&[]).map_err(NotMade::Run)?;
        if let Err(error) = self.begin(model) {
            model.turn_back();
            return Err(NotMade::Raised(error));
        }
        model.arrive().map_err(NotMade::Run)
    }
}
