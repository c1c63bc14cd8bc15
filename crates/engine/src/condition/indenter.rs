//! Rigid spheres, cylinders and planes that push points: force density `K g²` along the normal where the gap g between
//! point and surface is negative (LAMMPS's `fix indent`; sandia2010 ch. 3, The Projectile).

use super::reaction::Reaction;
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

/// The surface of an indenter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// About a centre.
    Sphere,
    /// About the line through the centre along this axis.
    Cylinder(usize),
    /// Across this axis, through the centre.
    Plane(usize),
}

/// Which way an indenter pushes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Push {
    /// Out of a sphere or cylinder; up what is below a plane.
    Out,
    /// Back into a sphere or cylinder; down what is above a plane.
    In,
}

impl Form {
    /// Length of `d`, the way from the centre, across the form; `aside` is squared on axes that the body does not have.
    fn distance<const D: usize>(self, d: &[f64; D], aside: f64) -> f64 {
        match self {
            Form::Sphere => (d.iter().map(|c| c * c).sum::<f64>() + aside).sqrt(),
            Form::Cylinder(axis) => {
                let across = (0..D).filter(|a| *a != axis).map(|a| d[a] * d[a]);
                (across.sum::<f64>() + aside).sqrt()
            }
            Form::Plane(axis) => d.get(axis).copied().unwrap_or(0.0),
        }
    }

    /// The way from the centre to a point, and its length across the form.
    fn offset<const D: usize>(
        self,
        center: &[f64; 3],
        body: &Body<D>,
        u: &Field<D>,
        i: usize,
    ) -> ([f64; D], f64) {
        // the centre may lie off a plane or line of points
        let off = (D..3).filter(|a| self != Form::Cylinder(*a));
        let aside: f64 = off.map(|a| center[a] * center[a]).sum();
        let x = body.position(i);
        let d: [f64; D] = std::array::from_fn(|a| {
            let d = x[a] + u[a][i] - center[a];
            match (self, body.period[a]) {
                (Form::Sphere | Form::Cylinder(_), Some(p)) => d - p * (d / p).round(),
                (Form::Plane(_), _) | (_, None) => d,
            }
        });
        (d, self.distance(&d, aside))
    }
}

impl Push {
    /// From a surface of this radius to a point at this distance; negative where it is pushed.
    fn gap(self, distance: f64, radius: f64) -> f64 {
        match self {
            Push::Out => distance - radius,
            Push::In => radius - distance,
        }
    }
}

#[derive(Debug, Clone)]
pub struct Indenter<const D: usize> {
    stiffness: f64,
    form: Form,
    push: Push,
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
        let form = (Form::Sphere, Push::Out);
        Self::with(spec.stiffness, form, spec.radius, motion, center)
    }

    /// A surface whose values come from outside, touching the points in `members`; a plane has the radius 0.
    pub fn driven(
        stiffness: f64,
        form: (Form, Push),
        center: [f64; 3],
        radius: f64,
        members: Vec<u32>,
    ) -> Self {
        Indenter {
            members: Some(members),
            ..Self::with(stiffness, form, radius, Motion::Driven(center), center)
        }
    }

    fn with(
        stiffness: f64,
        (form, push): (Form, Push),
        radius: f64,
        motion: Motion,
        center: [f64; 3],
    ) -> Self {
        Indenter {
            stiffness,
            form,
            push,
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
        self.slack -= (radius - self.radius).abs();
        self.stiffness = stiffness;
        self.radius = radius;
        self.motion = Motion::Driven(center);
    }

    /// Its form and which way it pushes.
    pub fn form(&self) -> (Form, Push) {
        (self.form, self.push)
    }

    /// Points have the slots that `keep` holds for only, from now on.
    pub fn retain(&mut self, keep: impl Fn(u32) -> bool) {
        if let Some(members) = &mut self.members {
            members.retain(|s| keep(*s));
        }
        self.touched.retain(|(s, _)| keep(*s));
        self.look_again();
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
        let (form, push) = (self.form, self.push);
        let (center, radius) = (self.center, self.radius);
        let offset = |i: usize| form.offset(&center, body, u, i);
        let gap = |r: f64| push.gap(r, radius);
        if self.slack <= 0.0 {
            // two spacings: a fast indenter looks around every few dozen steps
            self.slack = 2.0 * body.spacing;
            self.candidates.clear();
            let all = self.members.as_ref().unwrap_or(&body.slots);
            self.candidates.extend(
                all.iter()
                    .filter(|&&s| gap(offset(s as usize).1) < self.slack),
            );
        }
        self.touched.clear();
        let mut total = [0.0; 3];
        let mut reaction = Reaction::default();
        for &s in &self.candidates {
            let i = s as usize;
            let (d, r) = offset(i);
            let gap = gap(r);
            if gap >= 0.0 || (r == 0.0 && !matches!(form, Form::Plane(_))) {
                continue;
            }
            let strength = match push {
                Push::Out => self.stiffness * gap * gap,
                Push::In => -self.stiffness * gap * gap,
            };
            let force: [f64; D] = std::array::from_fn(|a| match form {
                Form::Sphere => strength / r * d[a],
                Form::Cylinder(axis) if a == axis => 0.0,
                Form::Cylinder(_) => strength / r * d[a],
                Form::Plane(axis) if a == axis => strength,
                Form::Plane(_) => 0.0,
            });
            let volume = body.volume.at(i);
            reaction.energy += self.stiffness / 3.0 * (-gap).powi(3);
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

    /// No point has gone further than `path` (length) since the last call.
    pub fn moved(&mut self, path: f64) {
        self.slack -= path;
    }

    /// Where it is at this time, in statics; what is near is looked for again.
    pub fn place(&mut self, t: f64) {
        if let Motion::Kinematic(c) = &self.motion {
            self.center = std::array::from_fn(|a| c[a].eval(&[0.0; 3], t));
            self.slack = 0.0;
        }
    }

    /// Adds what it resists with at each point that it pushes (force / length), 2 K |g| V, to sums by slot.
    pub fn add_stiffness(&self, body: &Body<D>, u: &Field<D>, sum: &mut [f64]) {
        for &s in self.members.as_ref().unwrap_or(&body.slots) {
            let i = s as usize;
            let (_, r) = self.form.offset(&self.center, body, u, i);
            let deep = -self.push.gap(r, self.radius);
            sum[i] += 2.0 * self.stiffness * deep.max(0.0) * body.volume.at(i);
        }
    }

    /// Does it move by the forces on it?
    pub fn radius(&self) -> f64 {
        self.radius
    }

    pub fn is_free(&self) -> bool {
        matches!(self.motion, Motion::Free { .. })
    }

    /// The points that it pushes, with the force densities on them.
    pub fn pushed(&self) -> &[(u32, [f64; D])] {
        &self.touched
    }

    /// Work over an increment of statics by the trapezoidal rule: forces of before and of now, displacements of before and of now.
    pub fn account(&mut self, before: &[(u32, [f64; D])], body: &Body<D>, u: [&Field<D>; 2]) {
        for (s, f) in before.iter().chain(&self.touched) {
            let i = *s as usize;
            let path = (0..D).map(|a| f[a] * (u[1][a][i] - u[0][a][i]));
            self.work += 0.5 * body.volume.at(i) * path.sum::<f64>();
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
