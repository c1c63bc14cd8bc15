//! Constraints: points that move as told. Their work is the kinetic energy they gain minus what the internal force
//! gave them.

use super::Program;
use crate::body::{Body, Field};
use crate::space::Point;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Prescribed {
    Displacement,
    Velocity,
}

#[derive(Debug, Clone)]
pub struct Constraint<const D: usize> {
    kind: Prescribed,
    program: Program<D>,
    slots: Vec<u32>,
    points: Vec<Point>,
    /// Displacement, velocity and force density at the last whole step.
    last: Vec<[[f64; 3]; D]>,
    /// Work done on the body (energy).
    pub work: f64,
}

impl<const D: usize> Constraint<D> {
    pub fn new(kind: Prescribed, program: Program<D>, slots: Vec<u32>, points: Vec<Point>) -> Self {
        let last = vec![[[0.0; 3]; D]; slots.len()];
        Constraint {
            kind,
            program,
            slots,
            points,
            last,
            work: 0.0,
        }
    }

    fn velocity(&self, a: usize, k: usize, t: f64, dt: f64) -> f64 {
        match self.kind {
            Prescribed::Velocity => self.program.at(a, k, &self.points[k], t),
            Prescribed::Displacement => {
                let g = |t| self.program.at(a, k, &self.points[k], t);
                (g(t + dt) - g(t - dt)) / (2.0 * dt)
            }
        }
    }

    /// Whether two constraints ask the same of a point, `k` and `j` of their lists, at these times; what each asks, where not:
    /// displacements, or velocities where one of them is one.
    pub(crate) fn disagree(
        &self,
        other: &Self,
        (a, k, j): (usize, usize, usize),
        times: &[f64],
        dt: f64,
    ) -> Option<[f64; 2]> {
        let prescribed = |c: &Self, k: usize, t: f64| match (self.kind, other.kind) {
            (Prescribed::Displacement, Prescribed::Displacement) => {
                c.program.at(a, k, &c.points[k], t)
            }
            (Prescribed::Velocity, _) | (_, Prescribed::Velocity) => c.velocity(a, k, t, dt),
        };
        times.iter().find_map(|t| {
            let both = [prescribed(self, k, *t), prescribed(other, j, *t)];
            // round-off of two ways to write the same
            let near = 1e-9 * both[0].abs().max(both[1].abs());
            ((both[0] - both[1]).abs() > near).then_some(both)
        })
    }

    /// Slots, and which of their components are held.
    pub fn holds(&self) -> impl Iterator<Item = (usize, [bool; D])> {
        let held = std::array::from_fn(|a| self.program.acts(a));
        self.slots.iter().map(move |s| (*s as usize, held))
    }

    /// Every component that is held: place in the list of points, slot, axis.
    pub fn each(&self, mut visit: impl FnMut(usize, usize, usize)) {
        for (k, &s) in self.slots.iter().enumerate() {
            (0..D)
                .filter(|a| self.program.acts(*a))
                .for_each(|a| visit(k, s as usize, a));
        }
    }

    /// Acceleration as prescribed at `t`, between the middles of the steps before and after (length / time²).
    pub fn acceleration(&self, a: usize, k: usize, t: f64, dt: f64) -> f64 {
        let at = |t: f64| self.program.at(a, k, &self.points[k], t);
        match self.kind {
            Prescribed::Displacement => (at(t + dt) - 2.0 * at(t) + at(t - dt)) / (dt * dt),
            Prescribed::Velocity => (at(t + 0.5 * dt) - at(t - 0.5 * dt)) / dt,
        }
    }

    pub fn is_velocity(&self) -> bool {
        self.kind == Prescribed::Velocity
    }

    /// The displacement along axis `a` that point `k` of the list has at time `t`; `None`: its velocity is told.
    pub fn displaced(&self, a: usize, k: usize, t: f64) -> Option<f64> {
        match self.kind {
            Prescribed::Displacement => Some(self.program.at(a, k, &self.points[k], t)),
            Prescribed::Velocity => None,
        }
    }

    /// Displacements as prescribed at time `t`.
    pub fn place(&self, u: &mut Field<D>, t: f64) {
        if self.kind == Prescribed::Displacement {
            for (k, &s) in self.slots.iter().enumerate() {
                for a in (0..D).filter(|a| self.program.acts(*a)) {
                    u[a][s as usize] = self.program.at(a, k, &self.points[k], t);
                }
            }
        }
    }

    /// Put the points where they belong at the start of a run.
    pub fn start(&mut self, u: &mut Field<D>, v: &mut Field<D>, t: f64, dt: f64) {
        self.place(u, t);
        self.settle(v, t, dt);
    }

    /// Remember the state of the whole step that begins at `t`, and let the coming pass carry the points: no force,
    /// and the velocity of the step's middle.
    pub fn begin(&mut self, u: &Field<D>, v: &mut Field<D>, f: &mut Field<D>, t: f64, dt: f64) {
        for (k, &s) in self.slots.iter().enumerate() {
            let i = s as usize;
            for a in (0..D).filter(|a| self.program.acts(*a)) {
                self.last[k][a] = [u[a][i], self.velocity(a, k, t, dt), f[a][i]];
                f[a][i] = 0.0;
                v[a][i] = (self.target(a, k, u[a][i], t + dt, dt) - u[a][i]) / dt;
            }
        }
    }

    /// Displacement at `t`, from `from` one step before.
    fn target(&self, a: usize, k: usize, from: f64, t: f64, dt: f64) -> f64 {
        match self.kind {
            Prescribed::Displacement => self.program.at(a, k, &self.points[k], t),
            Prescribed::Velocity => from + dt * self.velocity(a, k, t - 0.5 * dt, dt),
        }
    }

    /// After the drift of the step that ends at `t`: displacements exactly as prescribed.
    pub fn drift(&self, u: &mut Field<D>, t: f64, dt: f64) {
        for (k, &s) in self.slots.iter().enumerate() {
            for a in (0..D).filter(|a| self.program.acts(*a)) {
                u[a][s as usize] = self.target(a, k, self.last[k][a][0], t, dt);
            }
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
        t: f64,
        dt: f64,
    ) {
        for (k, &s) in self.slots.iter().enumerate() {
            let i = s as usize;
            let volume = body.volume.at(i);
            for a in (0..D).filter(|a| self.program.acts(*a)) {
                let [u0, v0, f0] = self.last[k][a];
                let v1 = self.velocity(a, k, t, dt);
                let gained = gained(i, a, [v0, v1]);
                let given = 0.5 * (f0 + f[a][i]) * (u[a][i] - u0);
                self.work += volume * (gained - given);
            }
        }
    }

    /// Velocities of the whole step at `t`, after the last half kick.
    pub fn settle(&self, v: &mut Field<D>, t: f64, dt: f64) {
        for (k, &s) in self.slots.iter().enumerate() {
            for a in (0..D).filter(|a| self.program.acts(*a)) {
                v[a][s as usize] = self.velocity(a, k, t, dt);
            }
        }
    }
}
