//! Loads: body force, traction, damping, and forces replaced on a set.

use super::Program;
use super::carried::Carried;
use crate::body::{Body, Field};
use crate::space::Point;

#[derive(Debug, Clone)]
pub enum LoadKind<const D: usize> {
    /// Force density (force / volume).
    Body(Program<D>),
    /// Force density −c v at the end of the step, all other loads added; `c`, component 0, in mass / volume / time.
    Damping(Program<D>),
    /// The force density becomes this, whatever else acts.
    Replace(Program<D>),
}

/// A load on a set of points.
#[derive(Debug, Clone)]
pub struct Load<const D: usize> {
    pub kind: LoadKind<D>,
    slots: Vec<u32>,
    points: Vec<Point>,
    /// Of a condensed body: where this load acts.
    carried: Option<Carried<D>>,
    /// Force density added last time, for the work of the next step.
    last: Vec<[f64; D]>,
    /// Work done on the body (energy).
    pub work: f64,
}

impl<const D: usize> Load<D> {
    pub fn new(kind: LoadKind<D>, slots: Vec<u32>, points: Vec<Point>) -> Self {
        let last = vec![[0.0; D]; slots.len()];
        Load {
            kind,
            slots,
            points,
            carried: None,
            last,
            work: 0.0,
        }
    }

    /// A force density on points of a finer body, which reaches these slots.
    pub fn carried(density: Program<D>, slots: Vec<u32>, carried: Carried<D>) -> Self {
        Load {
            carried: Some(carried),
            ..Load::new(LoadKind::Body(density), slots, vec![])
        }
    }

    /// Work of the force of the step's start over half its path (the other half is [`Load::add`]'s).
    pub fn begin(&mut self, body: &Body<D>, v: &Field<D>, dt: f64) {
        for (f, &s) in self.last.iter().zip(&self.slots) {
            let i = s as usize;
            let power: f64 = (0..D).map(|a| f[a] * v[a][i]).sum();
            self.work += 0.5 * dt * power * body.volume.at(i);
        }
    }

    /// Add the force density at time `t` to `f`; `v` is the velocity of the step's middle, `dt` 0 at the start of a run.
    pub fn add(&mut self, body: &Body<D>, v: &Field<D>, f: &mut Field<D>, t: f64, dt: f64) {
        if let (LoadKind::Body(density), Some(carried)) = (&self.kind, &mut self.carried) {
            carried.evaluate(density, t);
        }
        for (k, &s) in self.slots.iter().enumerate() {
            let i = s as usize;
            let mut power = 0.0;
            for a in 0..D {
                let added = match &self.kind {
                    LoadKind::Body(p) => match &self.carried {
                        None => p.at(a, k, &self.points[k], t),
                        Some(carried) => carried.reaching(k, a) / body.volume.at(i),
                    },
                    // v at the whole step: the middle's and half a kick, of which this force is a part
                    LoadKind::Damping(c) => {
                        let half = 0.5 * dt / body.density.at(i);
                        let c = c.at(0, k, &self.points[k], t);
                        -c * (v[a][i] + half * f[a][i]) / (1.0 + half * c)
                    }
                    LoadKind::Replace(p) if p.acts(a) => p.at(a, k, &self.points[k], t) - f[a][i],
                    LoadKind::Replace(_) => 0.0,
                };
                f[a][i] += added;
                self.last[k][a] = added;
                power += added * v[a][i];
            }
            self.work += 0.5 * dt * power * body.volume.at(i);
        }
    }

    pub fn is_damping(&self) -> bool {
        matches!(self.kind, LoadKind::Damping(_))
    }
}
