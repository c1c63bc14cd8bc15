//! `fix move`: atoms that go where they are told.

use super::FixKind;
use super::input::Input;
use super::path::{Path, Start};
use crate::error::Result;
use crate::host::{Kinematics, Motion, Quantity};
use crate::session::Session;
use crate::vector::cross;
use std::f64::consts::TAU;

impl Session<'_> {
    /// Where the atoms are now, not wrapped, with their ids.
    ///
    /// # Errors
    /// There is no box.
    pub fn start_of_motion(&self) -> Result<Start> {
        Ok(Start {
            step: self.progress.step,
            places: self.population.unwrapped()?,
            ids: (0..self.population.count())
                .map(|i| self.population.ids.get(i))
                .collect(),
        })
    }

    /// Atoms that are carried in the coming run.
    pub fn kinematic(&self) -> Vec<u32> {
        let n = self.population.count() as u32;
        let mut all = Vec::new();
        for fix in &self.fixes.all {
            if let FixKind::Move { .. } = fix.kind {
                all.extend((0..n).filter(|i| fix.members.contains(*i as usize)));
            }
        }
        all
    }

    /// Where they are at the end of the step that begins, in displacements from their reference.
    ///
    /// # Errors
    /// A variable cannot be evaluated.
    pub fn carry(&mut self, out: &mut Vec<Motion>) -> Result<()> {
        out.clear();
        for k in 0..self.fixes.all.len() {
            let fix = self.fixes.all[k].clone();
            let FixKind::Move { path, start } = &fix.kind else {
                continue;
            };
            let elapsed = (self.progress.step - start.step.min(self.progress.step)) as f64
                * self.progress.time_step;
            let n = self.population.count();
            let mut told = [const { None }; 6];
            if let Path::Variable(x, v) = path {
                for (values, input) in told.iter_mut().zip(x.iter().chain(v)) {
                    *values = match input {
                        None => None,
                        Some(Input::Number(x)) => Some(vec![*x; n]),
                        Some(Input::Variable(name)) => Some(self.variable_values(name)?),
                    };
                }
            }
            let mut reference = [const { Vec::new() }; 3];
            let mut speed = [const { Vec::new() }; 3];
            for a in 0..3 {
                reference[a] = self.population.raw(Quantity::Reference(a))?;
                if let Path::Variable(..) = path {
                    speed[a] = self.population.raw(Quantity::Velocity(a))?;
                }
            }
            for i in (0..n).filter(|i| fix.members.contains(*i)) {
                let Ok(from) = start.ids.binary_search(&self.population.ids.get(i)) else {
                    out.push([None; 3]);
                    continue;
                };
                let x0 = start.places[from];
                let mut motion = [None; 3];
                for (a, motion) in motion.iter_mut().enumerate() {
                    let next = match path {
                        Path::Linear(v) => v[a].map(|v| (x0[a] + v * elapsed, v)),
                        Path::Wiggle(amplitude, period) => amplitude[a].map(|amplitude| {
                            let omega = TAU / period;
                            let (sin, cos) = libm::sincos(omega * elapsed);
                            (x0[a] + amplitude * sin, amplitude * omega * cos)
                        }),
                        Path::Rotate {
                            point,
                            axis,
                            period,
                        } => {
                            let omega = TAU / period;
                            let (place, v) = turned(x0, *point, *axis, omega, omega * elapsed);
                            Some((place[a], v[a]))
                        }
                        Path::Variable(..) => match (&told[a], &told[a + 3]) {
                            (Some(x), Some(v)) => Some((x0[a] + x[i], v[i])),
                            (Some(x), None) => Some((x0[a] + x[i], speed[a][i])),
                            // as LAMMPS: the velocity is told, the place follows from it
                            (None, Some(v)) => {
                                let here = self.population.one(Quantity::Position(a), i)?;
                                Some((here + v[i] * self.progress.time_step, v[i]))
                            }
                            (None, None) => None,
                        },
                    };
                    *motion = next.map(|(x, velocity)| Kinematics {
                        displacement: x - reference[a][i],
                        velocity,
                    });
                }
                out.push(motion);
            }
        }
        Ok(())
    }
}

/// A place turned by an angle about the axis through a point, and its velocity at that angular velocity.
fn turned(
    x: [f64; 3],
    point: [f64; 3],
    axis: [f64; 3],
    omega: f64,
    angle: f64,
) -> ([f64; 3], [f64; 3]) {
    let d = [0, 1, 2].map(|a| x[a] - point[a]);
    let along: f64 = (0..3).map(|a| d[a] * axis[a]).sum();
    let foot = axis.map(|n| along * n);
    let arm = [0, 1, 2].map(|a| d[a] - foot[a]);
    let side = cross(axis, arm);
    let (sin, cos) = libm::sincos(angle);
    let place = [0, 1, 2].map(|a| point[a] + foot[a] + cos * arm[a] + sin * side[a]);
    let velocity = [0, 1, 2].map(|a| omega * (cos * side[a] - sin * arm[a]));
    (place, velocity)
}
