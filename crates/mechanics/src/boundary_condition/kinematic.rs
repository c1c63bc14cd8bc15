//! Points that are carried: where they are at the end of a step, and how fast, is told from outside before it (LAMMPS's
//! `fix move`). Components that are not told move as forces say.

use super::prescribed::Prescribed;
use crate::body::Field;

/// Where a point is next on one axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Kinematics {
    /// Displacement at the end of the step.
    pub displacement: f64,
    /// Velocity there.
    pub velocity: f64,
}

/// A point's next place; `None`: forces move it on this axis.
pub type Motion = [Option<Kinematics>; 3];

/// Motions as numbers, of which [`motions`] makes them again.
pub fn numbers(motions: &[Motion]) -> Vec<f64> {
    let known = |carry: &Option<Kinematics>| match carry {
        Some(c) => [1.0, c.displacement, c.velocity],
        None => [0.0; 3],
    };
    motions.as_flattened().iter().flat_map(known).collect()
}

/// The motions of these numbers.
pub fn motions(numbers: &[f64]) -> Vec<Motion> {
    let known = |[is, displacement, velocity]: &[f64; 3]| {
        (*is == 1.0).then_some(Kinematics {
            displacement: *displacement,
            velocity: *velocity,
        })
    };
    let all: Vec<Option<Kinematics>> = numbers.as_chunks().0.iter().map(known).collect();
    all.as_chunks().0.to_vec()
}

#[derive(Debug, Clone, Default)]
pub struct KinematicPoints {
    slots: Vec<u32>,
    next: Vec<Motion>,
}

impl KinematicPoints {
    pub fn new(slots: Vec<u32>) -> Self {
        KinematicPoints {
            next: vec![[None; 3]; slots.len()],
            slots,
        }
    }

    /// Places for the end of the next step, one for each point.
    pub fn tell(&mut self, next: &[Motion]) {
        self.next.copy_from_slice(next);
    }

    /// Slots and axes that are told.
    fn each<const D: usize>(&self) -> impl Iterator<Item = (usize, usize, Kinematics)> {
        self.slots.iter().zip(&self.next).flat_map(|(s, next)| {
            let told = |(a, c): (usize, &Option<Kinematics>)| c.map(|c| (*s as usize, a, c));
            next.iter().enumerate().take(D).filter_map(told)
        })
    }
}

impl<const D: usize> Prescribed<D> for KinematicPoints {
    fn before_drift(
        &mut self,
        u: &Field<D>,
        v: &mut Field<D>,
        f: &mut Field<D>,
        [_, dt]: [f64; 2],
        _: bool,
    ) {
        for (i, a, c) in self.each::<D>() {
            f[a][i] = 0.0;
            v[a][i] = (c.displacement - u[a][i]) / dt;
        }
    }

    fn after_drift(&self, u: &mut Field<D>, _: [f64; 2]) {
        for (i, a, c) in self.each::<D>() {
            u[a][i] = c.displacement;
        }
    }

    fn whole_velocity(&self, v: &mut Field<D>, _: [f64; 2]) {
        for (i, a, c) in self.each::<D>() {
            v[a][i] = c.velocity;
        }
    }

    fn each_held(&self, visit: &mut dyn FnMut(usize, usize)) {
        self.each::<D>().for_each(|(i, a, _)| visit(i, a));
    }

    fn retain(&mut self, keep: &dyn Fn(u32) -> bool) {
        let mut kept = self.slots.iter().map(|s| keep(*s));
        self.next.retain(|_| kept.next().unwrap_or(false));
        self.slots.retain(|s| keep(*s));
    }
}
