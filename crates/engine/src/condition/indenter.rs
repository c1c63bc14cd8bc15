//! Rigid spheres that push points out: force density `K (r − R)²` away from the centre for r < R (LAMMPS's
//! `fix indent`; sandia2010 ch. 3, The Projectile).

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
}

#[derive(Debug, Clone)]
pub struct Indenter<const D: usize> {
    stiffness: f64,
    radius: f64,
    motion: Motion,
    pub center: [f64; 3],
    /// Points touched last time, with the force density on them.
    touched: Vec<(u32, [f64; D])>,
    /// Points that can be touched before anything moved by `slack`.
    candidates: Vec<u32>,
    slack: f64,
    /// Work done on the body (energy).
    pub work: f64,
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
        Indenter {
            stiffness: spec.stiffness,
            radius: spec.radius,
            motion,
            center,
            touched: vec![],
            candidates: vec![],
            slack: 0.0,
            work: 0.0,
        }
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
        let path = (0..D)
            .map(|a| (self.center[a] - before[a]).powi(2))
            .sum::<f64>()
            .sqrt();
        self.slack -= moved + path;
    }

    /// Add the force density at the current positions to `f`; `dt` is 0 at the start of a run.
    pub fn add(&mut self, body: &Body<D>, u: &Field<D>, v: &Field<D>, f: &mut Field<D>, dt: f64) {
        let offset = |i: usize| -> ([f64; D], f64) {
            let x = body.position(i);
            let d: [f64; D] = std::array::from_fn(|a| x[a] + u[a][i] - self.center[a]);
            (d, d.iter().map(|c| c * c).sum::<f64>().sqrt())
        };
        if self.slack <= 0.0 {
            // two spacings: a fast indenter looks around every few dozen steps
            self.slack = 2.0 * body.spacing;
            let reach = self.radius + self.slack;
            self.candidates.clear();
            self.candidates
                .extend(body.slots.iter().filter(|&&s| offset(s as usize).1 < reach));
        }
        self.touched.clear();
        let mut total = [0.0; 3];
        for &s in &self.candidates {
            let i = s as usize;
            let (d, r) = offset(i);
            if r >= self.radius || r == 0.0 {
                continue;
            }
            let push = self.stiffness * (r - self.radius) * (r - self.radius) / r;
            let force = d.map(|c| push * c);
            let volume = body.volume.at(i);
            for a in 0..D {
                f[a][i] += force[a];
                total[a] -= force[a] * volume;
                self.work += 0.5 * dt * volume * force[a] * v[a][i];
            }
            self.touched.push((s, force));
        }
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
            Motion::Kinematic(_) => 0.0,
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
