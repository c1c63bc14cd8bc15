//! Points that are carried: where they are at the end of a step, and how fast, is told from outside before it (LAMMPS's
//! `fix move`). Components that are not told move as forces say.

use crate::body::Field;

/// Where a point is next on one axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Carry {
    /// Displacement at the end of the step.
    pub displacement: f64,
    /// Velocity there.
    pub velocity: f64,
}

/// A point's next place; `None`: forces move it on this axis.
pub type Motion = [Option<Carry>; 3];

#[derive(Debug, Clone, Default)]
pub(crate) struct Carried {
    slots: Vec<u32>,
    next: Vec<Motion>,
}

impl Carried {
    pub fn new(slots: Vec<u32>) -> Self {
        Carried {
            next: vec![[None; 3]; slots.len()],
            slots,
        }
    }

    /// Places for the end of the next step, one for each point.
    pub fn tell(&mut self, next: &[Motion]) {
        self.next.copy_from_slice(next);
    }

    pub fn retain(&mut self, keep: impl Fn(u32) -> bool) {
        let mut kept = self.slots.iter().map(|s| keep(*s));
        self.next.retain(|_| kept.next().unwrap_or(false));
        self.slots.retain(|s| keep(*s));
    }

    /// Slots and axes that are told.
    pub fn holds(&self) -> impl Iterator<Item = (usize, usize)> {
        self.each().map(|(i, a, _)| (i, a))
    }

    fn each(&self) -> impl Iterator<Item = (usize, usize, Carry)> {
        self.slots.iter().zip(&self.next).flat_map(|(s, next)| {
            let told = |(a, c): (usize, &Option<Carry>)| c.map(|c| (*s as usize, a, c));
            next.iter().enumerate().filter_map(told)
        })
    }

    /// Let the coming pass carry the points: no force, and the velocity of the step's middle.
    pub fn begin<const D: usize>(&self, u: &Field<D>, v: &mut Field<D>, f: &mut Field<D>, dt: f64) {
        for (i, a, c) in self.each().filter(|(_, a, _)| *a < D) {
            f[a][i] = 0.0;
            v[a][i] = (c.displacement - u[a][i]) / dt;
        }
    }

    /// After the drift: displacements exactly as told.
    pub fn drift<const D: usize>(&self, u: &mut Field<D>) {
        for (i, a, c) in self.each().filter(|(_, a, _)| *a < D) {
            u[a][i] = c.displacement;
        }
    }

    /// Velocities of the whole step, after the last half kick.
    pub fn settle<const D: usize>(&self, v: &mut Field<D>) {
        for (i, a, c) in self.each().filter(|(_, a, _)| *a < D) {
            v[a][i] = c.velocity;
        }
    }
}
