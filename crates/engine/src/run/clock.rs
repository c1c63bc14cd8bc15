//! The time of a model: steps of one length from an origin on, one of which may be done in parts; before a motion, increments of statics.

use crate::interaction::Evaluation;
use crate::spec::PreloadSpec;
use crate::state::{Archive, Owner};

/// A step in parts.
#[derive(Debug, Clone, Copy)]
struct Parts {
    /// Time at its start.
    begin: f64,
    /// Its length (time), and how many parts are done.
    whole: f64,
    done: u32,
}

/// Increments of statics before motion.
#[derive(Debug, Clone, Copy)]
struct Before {
    increments: u64,
    /// What records show of each (time), all before t = 0.
    shown: f64,
    /// Length of a step of the motion (time).
    dt: f64,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Clock {
    /// Length of a step, or of a part of it (time).
    dt: f64,
    step: u64,
    /// Step and time from which time is counted in whole steps.
    origin: (u64, f64),
    parts: Option<Parts>,
    before: Option<Before>,
}

impl Owner for Clock {
    /// Between two steps.
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.one("step", &mut self.step);
        archive.one("origin", &mut self.origin);
        archive.one("time_step", &mut self.dt);
        archive.given("motion", &mut self.before, |before, archive| {
            archive.one("time_step", &mut before.dt);
        });
    }
}

impl Clock {
    /// Steps of this length (time) from 0 on.
    pub fn new(dt: f64) -> Clock {
        Clock {
            dt,
            step: 0,
            origin: (0, 0.0),
            parts: None,
            before: None,
        }
    }

    pub fn step(&self) -> u64 {
        self.step
    }

    /// Length of a step, or of a part of the one that is done in parts (time).
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// How much time passes in an increment of statics (time); before a motion none, if t is the factor of the load.
    pub fn passes(&self, timed: bool) -> f64 {
        match self.before.is_some() && !timed {
            true => 0.0,
            false => self.dt,
        }
    }

    /// Length of a step of the motion, which may be still to come (time).
    pub fn dt_of_motion(&self) -> f64 {
        self.before.as_ref().map_or(self.dt, |before| before.dt)
    }

    /// Forces of now are those of a state that no step led to.
    pub fn start(&self) -> Evaluation {
        Evaluation::Start { next: self.dt }
    }

    /// They are those of the end of an explicit step.
    pub fn step_end(&self) -> Evaluation {
        Evaluation::StepEnd { dt: self.dt }
    }

    /// They are those of an increment or an implicit step, or on its way.
    pub fn trial(&self) -> Evaluation {
        Evaluation::Trial { step: self.dt }
    }

    pub fn time(&self) -> f64 {
        match &self.parts {
            Some(parts) => parts.begin + f64::from(parts.done) * self.dt,
            None => self.origin.1 + (self.step - self.origin.0) as f64 * self.dt,
        }
    }

    /// Time from which whole steps are counted.
    pub fn origin(&self) -> f64 {
        self.origin.1
    }

    /// Has it gone on since then?
    pub fn has_gone_on(&self) -> bool {
        self.step > self.origin.0
    }

    /// Time as records show it: motion begins at 0, and statics is before.
    pub fn shown(&self) -> f64 {
        match &self.before {
            Some(before) => (self.step as f64 - before.increments as f64) * before.shown,
            None => self.time(),
        }
    }

    /// Time of a frame, which only grows: the number of the equilibrium where t is a factor of the load that may fall.
    pub fn of_frame(&self, load_may_fall: bool) -> f64 {
        match load_may_fall {
            true => self.step as f64,
            false => self.shown(),
        }
    }

    /// One more step, or part of one.
    pub fn forward(&mut self) {
        match &mut self.parts {
            Some(parts) => parts.done += 1,
            None => self.step += 1,
        }
    }

    /// And back.
    pub fn back(&mut self) {
        match &mut self.parts {
            Some(parts) => parts.done -= 1,
            None => self.step -= 1,
        }
    }

    /// The next step is done in so many parts.
    pub fn divide(&mut self, parts: u32) {
        self.parts = Some(Parts {
            begin: self.time(),
            whole: self.dt,
            done: 0,
        });
        self.dt /= f64::from(parts);
    }

    /// The parts are one step; where not `all` of them went well time is that of the last one that did.
    pub fn join(&mut self, all: bool) {
        let now = self.time();
        let Some(parts) = self.parts.take() else {
            return;
        };
        match all {
            true => self.step += 1,
            false => self.origin = (self.step, now),
        }
        self.dt = parts.whole;
    }

    /// It is this time now.
    pub fn set(&mut self, time: f64) {
        self.origin = (self.step, time);
    }

    /// The number of the step of now.
    pub fn set_step(&mut self, step: u64) {
        self.step = step;
    }

    /// From now on steps of the motion have this length.
    pub fn set_time_step(&mut self, dt: f64) {
        if let Some(before) = &mut self.before {
            before.dt = dt;
            return;
        }
        self.set(self.time());
        self.dt = dt;
    }

    /// What was to come is the motion, with increments of statics before it.
    pub fn load_first(&mut self, preload: &PreloadSpec) {
        let increments = preload.increments as f64;
        self.before = Some(Before {
            increments: preload.increments,
            shown: match preload.duration {
                Some(all) => all / increments,
                None => self.dt,
            },
            dt: self.dt,
        });
        self.dt = preload.end() / increments;
    }

    /// The increments are done: motion begins at 0.
    pub fn begin_motion(&mut self) {
        self.set(0.0);
        if let Some(before) = self.before.take() {
            self.dt = before.dt;
        }
    }
}
