//! A state on its way: how long its steps are, and what they add to it.
//!
//! Two solutions go side by side, one in whole steps and one in halves of them. Where errors fall with the power p ≥ 1 of the step, e_whole ≈ 2^p e_half, so that their
//! difference d bounds the error of the one in halves, and 2d that of the other, whatever p is. Both come from the same start and see what the law does to small
//! differences, so d is the error of the run and not of a step.

use crate::measure;
use crate::operator::Operator;
use crate::step::{Method, RunError, Stepper, stable_step};
use peridyne::state::{Archive, Owner};

/// How long steps are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StepSize {
    /// A part of what is stable, of the state as it is.
    Part(f64),
    /// The same always; unstable ones are refused unless forced.
    Fixed { step: f64, force_unstable: bool },
    /// A part of what is stable or shorter, made in two halves, so that steps add no more than `tolerance` times the largest |u| in `duration`, evenly over time.
    Within {
        part: f64,
        tolerance: f64,
        duration: f64,
    },
}

/// Part of `duration` below which a step is taken as it is: where u or what is given jumps in time, no step is short enough.
const SHORTEST: f64 = 1e-9;

/// Of the largest |u|: what a step may add by round-off.
const ROUND_OFF: f64 = 8.0 * f64::EPSILON;

/// The other solution.
#[derive(Debug)]
struct Other {
    u: Vec<f64>,
    /// It is not finite any more.
    lost: bool,
    /// Largest difference now and so far.
    now: f64,
    most: f64,
    /// Largest |u| so far.
    scale: f64,
    /// Both after the step, and one that starts where the answer is.
    halves: Vec<f64>,
    whole: Vec<f64>,
    local: Vec<f64>,
}

impl Other {
    fn new(u: &[f64], scale: f64) -> Other {
        Other {
            u: u.to_vec(),
            lost: false,
            now: 0.0,
            most: 0.0,
            scale,
            halves: vec![],
            whole: vec![],
            local: vec![],
        }
    }

    fn see(&mut self, difference: f64) {
        self.now = if self.lost { f64::INFINITY } else { difference };
        self.most = self.most.max(self.now);
    }
}

/// A state on its way.
#[derive(Debug)]
pub struct Evolution {
    pub operator: Operator,
    pub u: Vec<f64>,
    pub time: f64,
    /// Steps done.
    pub steps: u64,
    size: StepSize,
    stepper: Stepper,
    other: Option<Other>,
    /// Longest step that the error allows, as far as it is known.
    allowed: f64,
}

impl Owner for Evolution {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.all("u", &mut self.u);
        archive.one("time", &mut self.time);
        archive.one("steps", &mut self.steps);
        archive.one("allowed", &mut self.allowed);
        let start = Other::new(&self.u, 0.0);
        archive.option(
            "other",
            &mut self.other,
            || start,
            |other, archive| {
                archive.all("u", &mut other.u);
                archive.one("lost", &mut other.lost);
                archive.one("now", &mut other.now);
                archive.one("most", &mut other.most);
                archive.one("scale", &mut other.scale);
            },
        );
    }
}

impl Evolution {
    pub fn new(operator: Operator, u: Vec<f64>, method: Method, size: StepSize) -> Evolution {
        let mut evolution = Evolution {
            operator,
            u,
            time: 0.0,
            steps: 0,
            size,
            stepper: Stepper::new(method),
            other: None,
            allowed: f64::INFINITY,
        };
        if let StepSize::Within { .. } = size {
            evolution.estimate();
        }
        evolution
    }

    /// From now on the error of steps is estimated, by a second solution in steps half as long, which costs twice what the first does; steps stay as they are. Steps within a
    /// tolerance have their estimate anyway.
    pub fn estimate(&mut self) {
        let [low, high] = self.operator.extremes(&self.u, self.time);
        let scale = low.abs().max(high.abs());
        self.other.get_or_insert_with(|| Other::new(&self.u, scale));
    }

    pub fn method(&self) -> Method {
        self.stepper.method
    }

    pub fn size(&self) -> StepSize {
        self.size
    }

    /// What steps have added to u, at most: now, and the largest so far; `None` where nobody estimates, infinite where the other solution is not finite any more.
    pub fn error(&self) -> Option<[f64; 2]> {
        let factor = match self.size {
            StepSize::Within { .. } => 1.0,
            StepSize::Part(_) | StepSize::Fixed { .. } => 2.0,
        };
        let other = self.other.as_ref()?;
        Some([factor * other.now, factor * other.most])
    }

    /// Largest |u| so far, collars too, where errors are estimated.
    pub fn scale(&self) -> Option<f64> {
        self.other.as_ref().map(|o| o.scale)
    }

    /// Longest stable step of the state as it is.
    pub fn stable_step(&self) -> f64 {
        self.stable_until(0.0)
    }

    /// The same, with collars as they will be too: at the middle and the end of a step of that length.
    fn stable_until(&self, step: f64) -> f64 {
        let at = |later: f64| {
            let t = self.time + later;
            stable_step(&self.operator, self.stepper.method, &self.u, t)
        };
        let now = at(0.0);
        match step > 0.0 && !self.operator.law().periodic() {
            // what is no number stays none
            true => [at(0.5 * step), at(step)]
                .into_iter()
                .fold(now, |least, s| if s >= least { least } else { s }),
            false => now,
        }
    }

    /// The next step on the way to a time: whole ones until there.
    ///
    /// # Errors
    /// A fixed step that is unstable; no step that is stable.
    pub fn next_step(&self, end: f64) -> Result<f64, RunError> {
        let left = end - self.time;
        let none = |stable: f64| match stable > 1e-15 * left {
            true => Ok(stable),
            false => Err(RunError::NoStep {
                stable,
                time: self.time,
            }),
        };
        let step = match self.size {
            StepSize::Part(part) | StepSize::Within { part, .. } => {
                // a collar that rises from nothing would leave the whole time for a step
                let first = left.min(part * none(self.stable_step())?).min(self.allowed);
                first.min(part * none(self.stable_until(first))?)
            }
            StepSize::Fixed {
                step,
                force_unstable,
            } => {
                let stable = self.stable_until(step.min(left));
                if !force_unstable && !(step <= stable * (1.0 + 1e-9)) {
                    return Err(RunError::Unstable {
                        step,
                        stable,
                        time: self.time,
                    });
                }
                step
            }
        };
        Ok(left / (left / step - 1e-9).ceil().max(1.0))
    }

    /// Steps that a duration takes at least, as far as the first one says, and operations of them and of the other solution.
    ///
    /// # Errors
    /// See [`Evolution::next_step`].
    pub fn work(&self, duration: f64) -> Result<[f64; 2], RunError> {
        let whole = (duration / self.next_step(duration)?).ceil();
        let steps = match self.size {
            StepSize::Within { .. } => 2.0 * whole,
            StepSize::Part(_) | StepSize::Fixed { .. } => whole,
        };
        let stages = f64::from(self.stepper.method.stages());
        Ok([steps, 3.0 * whole * stages * self.operator.operations()])
    }

    /// A step of that length, whatever it adds.
    ///
    /// # Errors
    /// See [`Stepper::step`].
    pub fn step(&mut self, dt: f64) -> Result<(), RunError> {
        let Some(mut other) = self.other.take() else {
            self.stepper
                .step(&mut self.operator, &mut self.u, self.time, dt)?;
            self.steps += 1;
            self.time += dt;
            return Ok(());
        };
        let done = self.both(&mut other, dt);
        if done.is_ok() {
            self.take(&mut other, dt);
        }
        self.other = Some(other);
        done
    }

    /// The next step on the way to a time, within the tolerance where there is one.
    ///
    /// # Errors
    /// See [`Evolution::next_step`] and [`Stepper::step`].
    pub fn step_to(&mut self, end: f64) -> Result<(), RunError> {
        let StepSize::Within {
            tolerance,
            duration,
            ..
        } = self.size
        else {
            let dt = self.next_step(end)?;
            return self.step(dt);
        };
        loop {
            let dt = self.next_step(end)?;
            let Some(mut other) = self.other.take() else {
                return self.step(dt);
            };
            let shortest = dt <= SHORTEST * duration;
            let part = (tolerance * dt / duration).max(ROUND_OFF);
            let done = self.attempt(&mut other, dt, part);
            let good = matches!(done, Ok(fits) if fits || shortest);
            if good {
                self.take(&mut other, dt);
            }
            self.other = Some(other);
            match done {
                _ if good => return Ok(()),
                Ok(_) => {}
                Err(RunError::NotFinite { .. } | RunError::NotSolved { .. }) if !shortest => {
                    self.allowed = 0.25 * dt;
                }
                Err(error) => return Err(error),
            }
        }
    }

    /// Both solutions after a step; `part` of the largest |u| is what it may add. Does it add less? How long the next one may be follows.
    fn attempt(&mut self, other: &mut Other, dt: f64, part: f64) -> Result<bool, RunError> {
        /// A step that changes the difference by so much less than it may add needs no closer look.
        const LITTLE: f64 = 1.0 / 32.0;
        self.both(other, dt)?;
        // what comes in through collars until then counts, also where u is still 0
        let [low, high] = self.operator.extremes(&self.u, self.time + dt);
        let most = part * other.scale.max(low.abs()).max(high.abs());
        let each = self.u.iter().zip(&other.u);
        let both = other.halves.iter().zip(&other.whole);
        let change = { each.zip(both) }
            .map(|((a, b), (c, d))| ((c - d) - (a - b)).abs())
            .fold(0.0, f64::max);
        let mut local = change;
        if other.lost || !(change <= LITTLE * most) {
            // the difference itself may grow: only what this step adds can be made less by shorter ones
            other.local.clone_from(&self.u);
            let stepper = &mut self.stepper;
            local = match stepper.step(&mut self.operator, &mut other.local, self.time, dt) {
                Ok(()) => measure::distance(&other.halves, &other.local),
                Err(error @ RunError::Ended { .. }) => return Err(error),
                Err(_) => f64::INFINITY,
            };
        }
        let order = f64::from(self.stepper.method.order());
        let factor = (0.9 * libm::pow(most / local, 1.0 / order)).clamp(0.1, 5.0);
        let fits = local <= most;
        // of what neither adds nor may add anything
        let next = if local > 0.0 { factor * dt } else { 5.0 * dt };
        self.allowed = match fits && next >= dt {
            true => self.allowed.max(next),
            false => next,
        };
        Ok(fits)
    }

    /// Makes both solutions after a step.
    fn both(&mut self, other: &mut Other, dt: f64) -> Result<(), RunError> {
        let (operator, stepper, t) = (&mut self.operator, &mut self.stepper, self.time);
        let answer_in_halves = matches!(self.size, StepSize::Within { .. });
        let (whole, halves) = match answer_in_halves {
            true => (&other.u, &self.u),
            false => (&self.u, &other.u),
        };
        other.whole.clone_from(whole);
        other.halves.clone_from(halves);
        let (halves, whole, lost) = (&mut other.halves, &mut other.whole, other.lost);
        let mut in_whole = |operator: &mut Operator, stepper: &mut Stepper| match lost {
            true if answer_in_halves => Ok(()),
            _ => stepper.step(operator, whole, t, dt),
        };
        let mut in_halves = |operator: &mut Operator, stepper: &mut Stepper| match lost {
            true if !answer_in_halves => Ok(()),
            _ => stepper
                .step(operator, halves, t, 0.5 * dt)
                .and_then(|()| stepper.step(operator, halves, t + 0.5 * dt, 0.5 * dt)),
        };
        let [first, second] = match answer_in_halves {
            true => [in_halves(operator, stepper), in_whole(operator, stepper)],
            false => [in_whole(operator, stepper), in_halves(operator, stepper)],
        };
        first?;
        match second {
            Err(error @ RunError::Ended { .. }) => return Err(error),
            Err(_) => other.lost = true,
            Ok(()) => {}
        }
        Ok(())
    }

    /// Takes both solutions as they were made.
    fn take(&mut self, other: &mut Other, dt: f64) {
        let difference = measure::distance(&other.halves, &other.whole);
        let (answer, second, steps) = match self.size {
            StepSize::Within { .. } => (&mut other.halves, &mut other.whole, 2),
            StepSize::Part(_) | StepSize::Fixed { .. } => (&mut other.whole, &mut other.halves, 1),
        };
        std::mem::swap(&mut self.u, answer);
        std::mem::swap(&mut other.u, second);
        self.time += dt;
        self.steps += steps;
        other.see(difference);
        let [low, high] = self.operator.extremes(&self.u, self.time);
        other.scale = other.scale.max(low.abs()).max(high.abs());
    }

    /// To a time, in as many steps as it takes.
    ///
    /// # Errors
    /// See [`Evolution::step_to`].
    pub fn run_to(&mut self, end: f64) -> Result<(), RunError> {
        while self.time < end * (1.0 - 1e-12) {
            self.step_to(end)?;
        }
        Ok(())
    }

    /// How fast `∫u²/2` changes now, as the steps make it: from two trial steps of `dt`, which leave no trace, by
    /// `(−3E₀ + 4E₁ − E₂)/2dt`, of order 2.
    ///
    /// # Errors
    /// See [`Stepper::step`].
    pub fn energy_slope(&mut self, dt: f64) -> Result<f64, RunError> {
        let cell = self.operator.law().grid.cell();
        let energy = |u: &[f64]| measure::energy(u, cell);
        let mut trial = self.u.clone();
        let before = energy(&trial);
        self.stepper
            .step(&mut self.operator, &mut trial, self.time, dt)?;
        let first = energy(&trial);
        self.stepper
            .step(&mut self.operator, &mut trial, self.time + dt, dt)?;
        Ok((4.0 * (first - before) - (energy(&trial) - before)) / (2.0 * dt))
    }
}
