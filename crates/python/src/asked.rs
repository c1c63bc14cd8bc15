//! Forces by functions of Python in steps that end with the solution of equations: a function is asked at every trial, and how it changes there.

use crate::arrays::{of_values, vectors};
use peridyne::boundary_condition::point_force::{LocalForce, PointForce, Seen, Stiffness};
use peridyne::observe::Values;
use peridyne::run::{Info, Simulation as Model};
use peridyne::space::Point;
use peridyne::spec::Stepper;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Part of a spacing by which points are moved to see how their forces change.
const MOVED: f64 = 1e-6;
/// States whose forces are kept: a solver looks at one more than once.
const KEPT: usize = 3;

/// What a function is asked about.
#[derive(Debug, Default, PartialEq)]
struct State {
    t: f64,
    x: Vec<Point>,
    v: Vec<Point>,
}

/// What it answered.
#[derive(Debug, Default)]
struct ForcesAt {
    state: State,
    /// Not a number where it raised something.
    force: Vec<Point>,
    /// `−∂f/∂x`, by rows of f.
    stiffness: Vec<[Point; 3]>,
}

#[derive(Debug, Default)]
struct Known {
    /// Is the force of this step's end that of before?
    stays: bool,
    now: Arc<ForcesAt>,
    /// Where the step began.
    began: Arc<ForcesAt>,
    earlier: VecDeque<Arc<ForcesAt>>,
    raised: Option<PyErr>,
}

impl Known {
    fn of(&self, state: &State) -> Option<Arc<ForcesAt>> {
        let mut all = self.earlier.iter().chain([&self.began]);
        all.find(|a| a.state == *state).cloned()
    }
}

#[derive(Debug)]
pub struct Asked {
    call: Py<PyAny>,
    dimension: usize,
    every: u64,
    /// How far points are moved to see how their forces change (length).
    by: f64,
    /// By how much velocities change with displacements of a step's end (1 / time).
    rate: f64,
    known: Mutex<Known>,
}

impl Asked {
    pub fn new(call: Py<PyAny>, every: u64, info: &Info) -> Asked {
        Asked {
            call,
            dimension: info.dimension,
            every,
            by: MOVED * info.spacing,
            rate: match info.stepper {
                Stepper::Newmark(of) => of.gamma / (of.beta * info.time_step),
                Stepper::Verlet | Stepper::Still | Stepper::Statics(_) => 0.0,
            },
            known: Mutex::default(),
        }
    }

    fn known(&self) -> MutexGuard<'_, Known> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub fn raised(&self) -> Option<PyErr> {
        self.known().raised.take()
    }

    /// What is wrong with it shows before it acts.
    pub fn try_out(&self, model: &mut dyn Model, ids: &[u32], t: f64) -> PyResult<()> {
        let (reference, u) = (model.vectors("reference"), model.displacements());
        let v = model.velocities();
        let place = |i: usize| std::array::from_fn(|a| reference[i][a] + u[i][a]);
        let x = ids.iter().map(|i| place(*i as usize)).collect();
        let v = ids.iter().map(|i| v[*i as usize]).collect();
        self.ask(State { t, x, v }).map(drop)
    }

    /// A step that ends as this one begins.
    pub fn begin(&self, step: u64) {
        let mut known = self.known();
        known.stays = !step.is_multiple_of(self.every);
        // after a step that was not made it begins where that began
        if !known.now.force.is_empty() {
            known.began = known.now.clone();
        }
    }

    /// The state was changed from outside.
    pub fn anew(&self) {
        self.known().stays = false;
    }

    fn forces(&self, t: f64, x: &[Point], v: &[Point]) -> PyResult<Vec<Point>> {
        let count = x.len();
        let given = Python::attach(|py| {
            let [x, v] = [x, v].map(|of| of_values(py, Values::Vectors(of.to_vec())));
            let force = self.call.call1(py, (t, x?, v?))?;
            vectors(force.bind(py), count, self.dimension)
        })?;
        if given.as_flattened().iter().any(|f| !f.is_finite()) {
            return Err(PyValueError::new_err(format!(
                "a force at t = {t:e} is not a finite number"
            )));
        }
        Ok(given)
    }

    fn ask(&self, state: State) -> PyResult<ForcesAt> {
        let State { t, x, v } = &state;
        let force = self.forces(*t, x, v)?;
        let mut stiffness = vec![[[0.0; 3]; 3]; force.len()];
        for b in 0..self.dimension {
            let moved = |of: &[Point], by: f64| {
                let mut of = of.to_vec();
                of.iter_mut().for_each(|of| of[b] += by);
                of
            };
            let near = self.forces(*t, &moved(x, self.by), &moved(v, self.rate * self.by))?;
            for (block, (f, near)) in stiffness.iter_mut().zip(force.iter().zip(&near)) {
                for (row, (f, near)) in block.iter_mut().zip(f.iter().zip(near)) {
                    row[b] = (f - near) / self.by;
                }
            }
        }
        Ok(ForcesAt {
            state,
            force,
            stiffness,
        })
    }
}

impl PointForce for Asked {
    /// The force, for steps in which it stays.
    fn memory(&self) -> usize {
        3
    }

    fn looks(&self) -> bool {
        true
    }

    fn look(&self, all: &[Seen]) {
        let Some(first) = all.first() else {
            return;
        };
        let place = |s: &Seen| std::array::from_fn(|a| s.reference[a] + s.displacement[a]);
        let state = State {
            t: first.time,
            x: all.iter().map(place).collect(),
            v: all.iter().map(|s| s.velocity).collect(),
        };
        let mut known = self.known();
        if known.stays {
            return;
        }
        if let Some(same) = known.of(&state) {
            known.now = same;
            return;
        }
        let raised = known.raised.is_some();
        // nobody waits for Python who holds what another waits for
        drop(known);
        let asked = (!raised).then(|| self.ask(state));
        let mut known = self.known();
        match asked {
            Some(Ok(answered)) => {
                known.now = Arc::new(answered);
                let now = known.now.clone();
                known.earlier.push_back(now);
                if known.earlier.len() > KEPT {
                    known.earlier.pop_front();
                }
            }
            Some(Err(error)) => {
                known.raised = Some(error);
                known.now = Arc::default();
            }
            None => known.now = Arc::default(),
        }
    }

    fn force(&self, k: usize, _: &Seen, memory: &mut [f64]) -> LocalForce {
        let known = self.known();
        if known.stays {
            return LocalForce {
                force: std::array::from_fn(|a| memory[a]),
                stiffness: [[0.0; 3]; 3],
            };
        }
        // where it raised something no trial is a solution, and the step is not made
        let force = known.now.force.get(k).copied().unwrap_or([f64::NAN; 3]);
        memory.copy_from_slice(&force);
        let stiffness = known.now.stiffness.get(k).copied();
        LocalForce {
            force,
            stiffness: stiffness.unwrap_or_default(),
        }
    }

    fn stiffness(&self) -> Stiffness {
        Stiffness::Known
    }

    fn viscosity(&self, _: usize) -> f64 {
        0.0
    }
}
