//! Rigid spheres that push points out: force density `K (r − R)²` away from the centre for r < R (LAMMPS's
//! `fix indent`; sandia2010 ch. 3, The Projectile).

use super::driven::Reaction;
use crate::body::{Body, Field};
use crate::expression::Expression;
use crate::spec::{IndenterMotion, IndenterSpec};

#[derive(Debug, Clone)]
enum Motion {
    Kinematic([Expression; 3]),
    Free {
        mass: f64,
        velocity: [f64; 3],
        force: [f64; 3],
    },
    /// Where the centre is next, set from outside.
    Driven([f64; 3]),
}

#[derive(Debug, Clone)]
pub struct Indenter<const D: usize> {
    stiffness: f64,
    radius: f64,
    motion: Motion,
    pub center: [f64; 3],
    /// Points it can touch; `None`: all.
    members: Option<Vec<u32>>,
    /// Points touched last time, with the force density on them.
    touched: Vec<(u32, [f64; D])>,
    /// Points that can be touched before anything moved by `slack`.
    candidates: Vec<u32>,
    slack: f64,
    /// Work done on the body (energy).
    pub work: f64,
    pub reaction: Reaction,
}

impl<const D: usize> Indenter<D> {
    pub fn new(spec: &IndenterSpec) -> Self {
        let (motion, center) = match &spec.motion {
            IndenterMotion::Kinematic(c) => (
                Motion::Kinematic(c.clone()),
                std::array::from_fn(|a| c[a].eval(&[0.0; 3], 0.0)),
            ),
            IndenterMotion::Free {
                mass,
                center,
                velocity,
            } => (
                Motion::Free {
                    mass: *mass,
                    velocity: *velocity,
                    force: [0.0; 3],
                },
                *center,
            ),
        };
        Self::with(spec.stiffness, spec.radius, motion, center)
    }

    /// A sphere whose values come from outside, touching the points in `members`.
    pub fn driven(stiffness: f64, center: [f64; 3], radius: f64, members: Vec<u32>) -> Self {
        Indenter {
            members: Some(members),
            ..Self::with(stiffness, radius, Motion::Driven(center), center)
        }
    }

    fn with(stiffness: f64, radius: f64, motion: Motion, center: [f64; 3]) -> Self {
        Indenter {
            stiffness,
            radius,
            motion,
            center,
            members: None,
            touched: vec![],
            candidates: vec![],
            slack: 0.0,
            work: 0.0,
            reaction: Reaction::default(),
        }
    }

    /// Values for the coming force evaluation.
    pub fn drive(&mut self, stiffness: f64, center: [f64; 3], radius: f64) {
        self.slack -= (radius - self.radius).max(0.0);
        self.stiffness = stiffness;
        self.radius = radius;
        self.motion = Motion::Driven(center);
    }

    /// Move to the end of a step and account for half of the old force's work. `moved` bounds the path of any point.
    pub fn begin(&mut self, body: &Body<D>, v: &Field<D>, t: f64, dt: f64, moved: f64) {
        for (s, f) in &self.touched {
            let i = *s as usize;
            self.work += 0.5 * dt * body.volume.at(i) * (0..D).map(|a| f[a] * v[a][i]).sum::<f64>();
        }
        let before = self.center;
        match &mut self.motion {
            Motion::Kinematic(c) => self.center = std::array::from_fn(|a| c[a].eval(&[0.0; 3], t)),
            Motion::Driven(next) => self.center = *next,
            Motion::Free {
                mass,
                velocity,
                force,
            } => {
                for a in 0..D {
                    velocity[a] += 0.5 * dt * force[a] / *mass;
                    self.center[a] += dt * velocity[a];
                }
            }
        }
        let path = (0..3)
            .map(|a| (self.center[a] - before[a]).powi(2))
            .sum::<f64>()
            .sqrt();
        self.slack -= moved + path;
    }

    /// Add the force density at the current positions to `f`; `dt` is 0 at the start of a run.
    pub fn add(&mut self, body: &Body<D>, u: &Field<D>, v: &Field<D>, f: &mut Field<D>, dt: f64) {
        if let Motion::Driven(next) = self.motion {
            self.center = next;
        }
        // the centre may lie off a plane or line of points
        let aside: f64 = self.center[D..].iter().map(|c| c * c).sum();
        let offset = |i: usize| -> ([f64; D], f64) {
            let x = body.position(i);
            let d: [f64; D] = std::array::from_fn(|a| {
                let d = x[a] + u[a][i] - self.center[a];
                body.period[a].map_or(d, |p| d - p * (d / p).round())
            });
            (d, (d.iter().map(|c| c * c).sum::<f64>() + aside).sqrt())
        };
        if self.slack <= 0.0 {
            // two spacings: a fast indenter looks around every few dozen steps
            self.slack = 2.0 * body.spacing;
            let reach = self.radius + self.slack;
            self.candidates.clear();
            let all = self.members.as_ref().unwrap_or(&body.slots);
            self.candidates
                .extend(all.iter().filter(|&&s| offset(s as usize).1 < reach));
        }
        self.touched.clear();
        let mut total = [0.0; 3];
        let mut reaction = Reaction::default();
        for &s in &self.candidates {
            let i = s as usize;
            let (d, r) = offset(i);
            if r >= self.radius || r == 0.0 {
                continue;
            }
            let push = self.stiffness * (r - self.radius) * (r - self.radius) / r;
            let force = d.map(|c| push * c);
            let volume = body.volume.at(i);
            reaction.energy += self.stiffness / 3.0 * (self.radius - r).powi(3);
            for a in 0..D {
                reaction.force[a] -= force[a];
                f[a][i] += force[a];
                total[a] -= force[a] * volume;
                self.work += 0.5 * dt * volume * force[a] * v[a][i];
            }
            self.touched.push((s, force));
        }
        self.reaction = reaction;
        if let Motion::Free {
            mass,
            velocity,
            force,
        } = &mut self.motion
        {
            *force = total;
            for a in 0..D {
                velocity[a] += 0.5 * dt * force[a] / *mass;
            }
        }
    }

    /// Kinetic energy of an indenter with mass.
    pub fn kinetic(&self) -> f64 {
        match &self.motion {
            Motion::Kinematic(_) | Motion::Driven(_) => 0.0,
            Motion::Free { mass, velocity, .. } => {
                0.5 * mass * velocity.iter().map(|v| v * v).sum::<f64>()
            }
        }
    }

    /// Forget which points are near, after something else moved them.
    pub fn look_again(&mut self) {
        self.slack = 0.0;
    }
}
