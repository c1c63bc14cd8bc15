//! Constraints: points that move as told. Their work is the kinetic energy they gain minus what the internal force
//! gave them.

use super::Program;
use super::prescribed::Prescribed;
use crate::body::{Body, Field};
use crate::execute::exact::Exact;
use crate::space::Point;
use crate::state::Archive;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Displacement,
    Velocity,
}

#[derive(Debug, Clone)]
pub struct Constraint<const D: usize> {
    kind: Kind,
    program: Program<D>,
    slots: Vec<u32>,
    points: Vec<Point>,
    /// Displacement, velocity and force density at the last whole step.
    last: Vec<[[f64; 3]; D]>,
    /// Work done on the points of this rank (energy).
    pub work: Exact,
}

impl<const D: usize> Constraint<D> {
    /// Passes what it remembers through an archive.
    pub fn archive(&mut self, body: &Body<D>, archive: &mut Archive<'_>) {
        body.archive_list(archive, "last", &self.slots, &mut self.last);
        archive.part("work", &mut self.work);
    }

    pub fn new(kind: Kind, program: Program<D>, slots: Vec<u32>, points: Vec<Point>) -> Self {
        let last = vec![[[0.0; 3]; D]; slots.len()];
        Constraint {
            kind,
            program,
            slots,
            points,
            last,
            work: Exact::ZERO,
        }
    }

    fn velocity(&self, a: usize, k: usize, t: f64, dt: f64) -> f64 {
        match self.kind {
            Kind::Velocity => self.program.at(a, k, &self.points[k], t),
            Kind::Displacement => {
                let g = |t| self.program.at(a, k, &self.points[k], t);
                (g(t + dt) - g(t - dt)) / (2.0 * dt)
            }
        }
    }

    /// Whether two constraints ask the same of a point, `k` and `j` of their lists, at these times; what each asks, where not:
    /// displacements, or velocities where one of them is one.
    pub fn disagree(
        &self,
        other: &Self,
        (a, k, j): (usize, usize, usize),
        times: &[f64],
        dt: f64,
    ) -> Option<[f64; 2]> {
        let prescribed = |c: &Self, k: usize, t: f64| match (self.kind, other.kind) {
            (Kind::Displacement, Kind::Displacement) => c.program.at(a, k, &c.points[k], t),
            (Kind::Velocity, _) | (_, Kind::Velocity) => c.velocity(a, k, t, dt),
        };
        times.iter().find_map(|t| {
            let both = [prescribed(self, k, *t), prescribed(other, j, *t)];
            // round-off of two ways to write the same
            let near = 1e-9 * both[0].abs().max(both[1].abs());
            ((both[0] - both[1]).abs() > near).then_some(both)
        })
    }

    /// Every component that is held: place in the list of points, slot, axis.
    pub fn each(&self) -> impl Iterator<Item = (usize, usize, usize)> {
        self.slots.iter().enumerate().flat_map(move |(k, s)| {
            let held = (0..D).filter(|a| self.program.acts(*a));
            held.map(move |a| (k, *s as usize, a))
        })
    }

    /// Acceleration as prescribed at `t`, between the middles of the steps before and after (length / time²).
    pub fn acceleration(&self, a: usize, k: usize, t: f64, dt: f64) -> f64 {
        let at = |t: f64| self.program.at(a, k, &self.points[k], t);
        match self.kind {
            Kind::Displacement => (at(t + dt) - 2.0 * at(t) + at(t - dt)) / (dt * dt),
            Kind::Velocity => (at(t + 0.5 * dt) - at(t - 0.5 * dt)) / dt,
        }
    }

    pub fn is_velocity(&self) -> bool {
        self.kind == Kind::Velocity
    }

    /// The displacement along axis `a` that point `k` of the list has at time `t`; `None`: its velocity is told.
    pub fn displaced(&self, a: usize, k: usize, t: f64) -> Option<f64> {
        match self.kind {
            Kind::Displacement => Some(self.program.at(a, k, &self.points[k], t)),
            Kind::Velocity => None,
        }
    }

    /// Displacements as prescribed at time `t`.
    pub fn place(&self, u: &mut Field<D>, t: f64) {
        for (k, i, a) in self.each() {
            if let Some(x) = self.displaced(a, k, t) {
                u[a][i] = x;
            }
        }
    }

    /// Displacement at `t`, from `from` one step before.
    fn target(&self, a: usize, k: usize, from: f64, t: f64, dt: f64) -> f64 {
        match self.kind {
            Kind::Displacement => self.program.at(a, k, &self.points[k], t),
            Kind::Velocity => from + dt * self.velocity(a, k, t - 0.5 * dt, dt),
        }
    }

    /// What a component of a point gained of its own kinetic energy (energy density).
    pub fn gained(body: &Body<D>, i: usize, [v0, v1]: [f64; 2]) -> f64 {
        0.5 * body.density.at(i) * (v1 * v1 - v0 * v0)
    }

    /// With the force of the step's end: account for the work. `gained` says of a slot, an axis and the velocities of the step's start
    /// and end how much kinetic energy was gained (energy density).
    pub fn end(
        &mut self,
        body: &Body<D>,
        u: &Field<D>,
        f: &Field<D>,
        gained: &dyn Fn(usize, usize, [f64; 2]) -> f64,
        [t, dt]: [f64; 2],
    ) {
        for (k, &s) in self.slots.iter().enumerate() {
            let i = s as usize;
            let volume = body.volume.at(i);
            for a in (0..D).filter(|a| self.program.acts(*a)) {
                let [u0, v0, f0] = self.last[k][a];
                let v1 = self.velocity(a, k, t, dt);
                let gained = gained(i, a, [v0, v1]);
                let given = 0.5 * (f0 + f[a][i]) * (u[a][i] - u0);
                self.work.add(volume * (gained - given));
            }
        }
    }
}

impl<const D: usize> Prescribed<D> for Constraint<D> {
    /// It remembers the state of the whole step, too.
    fn before_drift(
        &mut self,
        u: &Field<D>,
        v: &mut Field<D>,
        f: &mut Field<D>,
        [t, dt]: [f64; 2],
        _: bool,
    ) {
        for (k, &s) in self.slots.iter().enumerate() {
            let i = s as usize;
            for a in (0..D).filter(|a| self.program.acts(*a)) {
                self.last[k][a] = [u[a][i], self.velocity(a, k, t, dt), f[a][i]];
                f[a][i] = 0.0;
                v[a][i] = (self.target(a, k, u[a][i], t + dt, dt) - u[a][i]) / dt;
            }
        }
    }

    fn after_drift(&self, u: &mut Field<D>, [t, dt]: [f64; 2]) {
        for (k, i, a) in self.each() {
            u[a][i] = self.target(a, k, self.last[k][a][0], t, dt);
        }
    }

    fn whole_velocity(&self, v: &mut Field<D>, [t, dt]: [f64; 2]) {
        for (k, i, a) in self.each() {
            v[a][i] = self.velocity(a, k, t, dt);
        }
    }

    fn each_held(&self, visit: &mut dyn FnMut(usize, usize)) {
        self.each().for_each(|(_, i, a)| visit(i, a));
    }

    fn retain(&mut self, keep: &dyn Fn(u32) -> bool) {
        let all = 0..self.slots.len();
        let kept: Vec<usize> = all.filter(|k| keep(self.slots[*k])).collect();
        self.slots = kept.iter().map(|k| self.slots[*k]).collect();
        self.points = kept.iter().map(|k| self.points[*k]).collect();
        self.last = kept.iter().map(|k| self.last[*k]).collect();
        self.program.pick(&kept);
    }
}
