//! The motion of a rigid body: where its centre is, how it is turned, and how it goes on.
//!
//! A free body has mass and moments of inertia. Its momentum and its angular momentum L about the centre are kicked by forces and torques in
//! half steps, as the points of a body are; between them the centre goes straight on, and the body turns about its principal axes one after the
//! other, `1(Δt/2) 2(Δt/2) 3(Δt) 2(Δt/2) 1(Δt/2)`, by `Δt L_k/I_k` each: the exact flows of the three parts `½ L_k²/I_k` of its energy (Dullweber,
//! Leimkuhler & McLachlan 1997). L stays as it is in space to the last bit, the energy is off by second order and does not drift.

mod implicit;

use crate::expression::Expression;
use crate::law::material::tensor;
use crate::space::rigid::RigidShape;
use crate::space::rotation::{Axes, Quaternion, times, transposed_times};
use crate::space::{Point, cross, dot, length};
use crate::spec::{FreeSpec, RigidBodyMotion, RigidBodySpec, TurnSpec};
use crate::state::{Archive, Owner, words};

#[derive(Debug, Clone)]
enum Motion {
    Kinematic {
        center: [Expression; 3],
        turn: Option<TurnSpec>,
    },
    Free(Box<Free>),
    /// Where the centre is next, set from outside.
    Driven(Point),
}

#[derive(Debug, Clone)]
struct Free {
    mass: f64,
    /// Principal moments of inertia (mass · length²), and their axes in columns along those of the shape.
    moments: Point,
    principal: Axes,
    /// From principal axes to space.
    turned: Quaternion,
    /// L about the centre, in space (mass · length² / time).
    spin: Point,
    /// Force, torque, and acceleration.
    outside: [[Expression; 3]; 3],
    /// Of the last evaluation, points and outside together.
    force: Point,
    torque: Point,
}

/// Where a rigid body is, and how it moves.
#[derive(Debug, Clone)]
pub struct Rigid<const D: usize> {
    motion: Motion,
    pub center: Point,
    pub axes: Axes,
    /// Of the centre (length / time), and of the turn (1 / time); of a driven body over the last step.
    pub velocity: Point,
    pub turning: Point,
}

/// A state that a step may have to go back to.
#[derive(Debug, Clone, Copy)]
pub struct Kept {
    center: Point,
    axes: Axes,
    velocity: Point,
    turning: Point,
    /// Of a free body.
    turned: Quaternion,
    spin: Point,
    force: Point,
    torque: Point,
}

words!([] Kept {
    center: Point,
    axes: Axes,
    velocity: Point,
    turning: Point,
    turned: Quaternion,
    spin: Point,
    force: Point,
    torque: Point,
});

/// Force and torque about the centre, axes of space.
pub type Wrench = [f64; 6];

/// Of a step of Newmark's method.
#[derive(Debug, Clone, Copy)]
pub struct NewmarkStep {
    pub beta: f64,
    pub gamma: f64,
    pub step: f64,
}

impl Kept {
    /// What acted on a free body.
    pub fn wrench(&self) -> Wrench {
        wrench(&self.force, &self.torque)
    }
}

fn wrench(force: &Point, torque: &Point) -> Wrench {
    crate::array::from_fn(|k| if k < 3 { force[k] } else { torque[k - 3] })
}

/// How far a step took a body.
#[derive(Debug, Clone, Copy)]
pub struct Path {
    /// Of the centre (length).
    pub way: f64,
    /// Radians.
    pub angle: f64,
}

impl<const D: usize> Owner for Rigid<D> {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        let mut now = self.keep();
        archive.one("motion", &mut now);
        if archive.loads() {
            self.retreat(&now);
        }
        if let Motion::Driven(next) = &mut self.motion {
            archive.one("next", next);
        }
    }
}

impl<const D: usize> Rigid<D> {
    pub fn new(spec: &RigidBodySpec) -> Self {
        let of = |t: &TurnSpec| Quaternion::about(&t.axis, t.angle.eval(&[0.0; 3], 0.0));
        let start = spec.turn.as_ref().map_or(Quaternion::ONE, of);
        let mut rigid = match &spec.motion {
            RigidBodyMotion::Kinematic(center) => Rigid {
                motion: Motion::Kinematic {
                    center: center.clone(),
                    turn: spec.turn.clone(),
                },
                ..Rigid::co_simulation(center.each_ref().map(|c| c.eval(&[0.0; 3], 0.0)))
            },
            RigidBodyMotion::Free(free) => Rigid {
                motion: Motion::Free(Box::new(Free::new::<D>(free, &spec.shape, start))),
                velocity: free.velocity,
                ..Rigid::co_simulation(free.center)
            },
        };
        rigid.axes = start.axes();
        rigid.look();
        rigid
    }

    /// One whose centre is set from outside.
    pub fn co_simulation(center: Point) -> Self {
        Rigid {
            motion: Motion::Driven(center),
            center,
            axes: Quaternion::ONE.axes(),
            velocity: [0.0; 3],
            turning: [0.0; 3],
        }
    }

    /// Where the centre is next.
    pub fn steer(&mut self, center: Point) {
        self.motion = Motion::Driven(center);
    }

    /// Takes the place that was said, where one was said.
    pub fn arrive(&mut self) {
        if let Motion::Driven(next) = self.motion {
            self.center = next;
        }
    }

    /// The state now.
    pub fn keep(&self) -> Kept {
        let (turned, spin, force, torque) = match &self.motion {
            Motion::Free(free) => (free.turned, free.spin, free.force, free.torque),
            Motion::Kinematic { .. } | Motion::Driven(_) => {
                (Quaternion::ONE, [0.0; 3], [0.0; 3], [0.0; 3])
            }
        };
        Kept {
            center: self.center,
            axes: self.axes,
            velocity: self.velocity,
            turning: self.turning,
            turned,
            spin,
            force,
            torque,
        }
    }

    pub fn retreat(&mut self, to: &Kept) {
        (self.center, self.axes) = (to.center, to.axes);
        (self.velocity, self.turning) = (to.velocity, to.turning);
        if let Motion::Free(free) = &mut self.motion {
            (free.turned, free.spin) = (to.turned, to.spin);
            (free.force, free.torque) = (to.force, to.torque);
        }
    }

    /// Does it move by the forces on it?
    pub fn is_free(&self) -> bool {
        matches!(self.motion, Motion::Free(_))
    }

    /// Does it turn?
    pub fn turns(&self) -> bool {
        match &self.motion {
            Motion::Kinematic { turn, .. } => {
                turn.as_ref().is_some_and(|t| t.angle.depends_on_time())
            }
            Motion::Free(_) => D > 1,
            Motion::Driven(_) => false,
        }
    }

    /// Where it is told to be at `t`; false: nobody tells it.
    pub fn place(&mut self, t: f64) -> bool {
        let Motion::Kinematic { center, turn } = &self.motion else {
            return false;
        };
        self.center = crate::array::from_fn(|a| center[a].eval(&[0.0; 3], t));
        if let Some(turn) = turn {
            self.axes = Quaternion::about(&turn.axis, turn.angle.eval(&[0.0; 3], t)).axes();
        }
        true
    }

    /// Velocities of a driven body as the mean over the time from `t` on; the velocity of nothing over no time.
    pub fn look_ahead(&mut self, t: f64, dt: f64) {
        let Motion::Kinematic { center, turn } = &self.motion else {
            return;
        };
        if !(dt > 0.0) {
            return;
        }
        let rate = |e: &Expression| (e.eval(&[0.0; 3], t + dt) - e.eval(&[0.0; 3], t)) / dt;
        self.velocity = crate::array::from_fn(|a| rate(&center[a]));
        if let Some(turn) = turn {
            let speed = rate(&turn.angle);
            self.turning = turn.axis.map(|c| speed * c);
        }
    }

    /// Half a kick of the old forces: velocities of the middle of a step.
    pub fn kick(&mut self, dt: f64) {
        let Motion::Free(free) = &mut self.motion else {
            return;
        };
        for a in 0..D {
            self.velocity[a] += 0.5 * dt * free.force[a] / free.mass;
        }
        free.kick(0.5 * dt);
        self.look();
    }

    /// The step that ends at `t`, after its first kick.
    pub fn advance(&mut self, t: f64, dt: f64) -> Path {
        let before = self.center;
        let mut angle = 0.0;
        match &mut self.motion {
            Motion::Kinematic { .. } => {
                self.look_ahead(t - dt, dt);
                self.place(t);
                angle = dt * length(&self.turning);
            }
            Motion::Driven(next) => self.center = *next,
            Motion::Free(free) => {
                for a in 0..D {
                    self.center[a] += dt * self.velocity[a];
                }
                angle = free.turn(dt);
                self.look();
            }
        }
        let way = length(&crate::array::from_fn(|a| self.center[a] - before[a]));
        Path { way, angle }
    }

    /// The force and torque of points at the end of the step, and half a kick of them.
    pub fn push(&mut self, force: Point, torque: Point, t: f64, dt: f64) {
        let Motion::Free(free) = &mut self.motion else {
            return;
        };
        let [f, m, g] = &free.outside;
        free.force = crate::array::from_fn(|a| {
            force[a] + (f[a].eval(&[0.0; 3], t) + free.mass * g[a].eval(&[0.0; 3], t))
        });
        free.torque = crate::array::from_fn(|a| torque[a] + m[a].eval(&[0.0; 3], t));
        self.kick(dt);
    }

    /// Axes and angular velocity of a free body from its angular momentum.
    fn look(&mut self) {
        if let Motion::Free(free) = &self.motion {
            self.axes = free.axes();
            self.turning = free.turning();
        }
    }

    /// Where a place of the shape is.
    pub fn in_space(&self, x: &Point) -> Point {
        let arm = times(&self.axes, x);
        crate::array::from_fn(|a| self.center[a] + arm[a])
    }

    /// The way from where it was then to where it is, of what is at `arm` from the centre now.
    pub fn way_since(&self, then: &Kept, arm: &Point) -> Point {
        let before = times(&then.axes, &transposed_times(&self.axes, arm));
        crate::array::from_fn(|a| (self.center[a] + arm[a]) - (then.center[a] + before[a]))
    }

    /// Velocity of what is at `arm` from the centre.
    pub fn velocity_at(&self, arm: &Point) -> Point {
        let turn = cross(&self.turning, arm);
        crate::array::from_fn(|a| self.velocity[a] + turn[a])
    }

    /// `1/m + r²/I` with the least moment of inertia: the most that a force at this distance from the centre accelerates the place where it acts
    /// (1 / mass). 0 of a driven body.
    pub fn mobility(&self, square: f64) -> f64 {
        match &self.motion {
            Motion::Free(free) => {
                let axes = if D == 3 { 0..3 } else { 2..3 };
                let least = free.moments[axes]
                    .iter()
                    .copied()
                    .fold(f64::INFINITY, f64::min);
                1.0 / free.mass + square / least
            }
            Motion::Kinematic { .. } | Motion::Driven(_) => 0.0,
        }
    }

    /// Kinetic energy of a body with mass.
    pub fn kinetic(&self) -> f64 {
        match &self.motion {
            Motion::Kinematic { .. } | Motion::Driven(_) => 0.0,
            Motion::Free(free) => {
                let straight = dot(&self.velocity, &self.velocity);
                let about = transposed_times(&free.turned.axes(), &free.spin);
                let turn = (0..3).map(|k| about[k] * about[k] / free.moments[k]);
                0.5 * (free.mass * straight + turn.sum::<f64>())
            }
        }
    }

    /// Angular momentum about the centre of a body with mass.
    pub fn spin(&self) -> Point {
        match &self.motion {
            Motion::Kinematic { .. } | Motion::Driven(_) => [0.0; 3],
            Motion::Free(free) => free.spin,
        }
    }

    /// How it is turned: axis times angle, from 0 to π.
    pub fn turn(&self) -> Point {
        Quaternion::of(&self.axes).vector()
    }
}

impl Free {
    fn new<const D: usize>(spec: &FreeSpec, shape: &RigidShape, start: Quaternion) -> Free {
        let inertia = spec
            .inertia
            .unwrap_or_else(|| shape.inertia(D).map(|row| row.map(|c| spec.mass * c)));
        let (moments, mut principal) = match D {
            3 if !matches!(shape, RigidShape::Plane { .. }) => tensor::eigen::<3>(inertia),
            _ => {
                // a body of a plane turns about z alone, one of a line not at all
                let about = if D == 2 { inertia[2][2] } else { f64::INFINITY };
                (
                    [f64::INFINITY, f64::INFINITY, about],
                    Quaternion::ONE.axes(),
                )
            }
        };
        // a rotation, not a reflection
        let column = |k: usize| -> Point { crate::array::from_fn(|r| principal[r][k]) };
        let third = cross(&column(0), &column(1));
        for (row, c) in principal.iter_mut().zip(third) {
            row[2] = c;
        }
        let turned = start.after(Quaternion::of(&principal)).normalized();
        let about = transposed_times(&turned.axes(), &spec.spin);
        let finite = |k: usize| {
            if moments[k].is_finite() {
                moments[k] * about[k]
            } else {
                0.0
            }
        };
        let spin = times(&turned.axes(), &crate::array::from_fn(finite));
        Free {
            mass: spec.mass,
            moments,
            principal,
            turned,
            spin,
            outside: [
                spec.force.clone(),
                spec.torque.clone(),
                spec.gravity.clone(),
            ],
            force: [0.0; 3],
            torque: [0.0; 3],
        }
    }

    fn kick(&mut self, time: f64) {
        for a in 0..3 {
            if self.moments.iter().any(|i| i.is_finite()) {
                self.spin[a] += time * self.torque[a];
            }
        }
    }

    /// Turns by its own momentum; the sum of the angles.
    fn turn(&mut self, dt: f64) -> f64 {
        let mut about = transposed_times(&self.turned.axes(), &self.spin);
        let mut sum = 0.0;
        for (k, part) in [(0, 0.5), (1, 0.5), (2, 1.0), (1, 0.5), (0, 0.5)] {
            let angle = part * dt * about[k] / self.moments[k];
            let mut axis = [0.0; 3];
            axis[k] = 1.0;
            self.turned = self.turned.after(Quaternion::about(&axis, angle));
            // the momentum stays in space: seen from the body it turns the other way
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let (sine, cosine) = libm::sincos(angle);
            (about[i], about[j]) = (
                cosine * about[i] + sine * about[j],
                cosine * about[j] - sine * about[i],
            );
            sum += angle.abs();
        }
        self.turned = self.turned.normalized();
        sum
    }

    fn axes(&self) -> Axes {
        let turned = self.turned.axes();
        crate::array::from_fn(|r| times(&self.principal, &turned[r]))
    }

    fn turning(&self) -> Point {
        let turned = self.turned.axes();
        let about = transposed_times(&turned, &self.spin);
        times(
            &turned,
            &crate::array::from_fn(|k| about[k] / self.moments[k]),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn brick(spin: Point) -> Rigid<3> {
        let shape = RigidShape::Box {
            half: [1.0, 2.0, 3.0],
        };
        let mut free = FreeSpec::new(2.0, [0.0; 3], [0.0; 3]);
        free.spin = spin;
        let motion = RigidBodyMotion::Free(free);
        let mut spec = RigidBodySpec::new(1.0, shape, motion);
        spec.turn = Some(TurnSpec {
            axis: [0.36, 0.48, 0.8],
            angle: Expression::constant(1.1),
        });
        Rigid::new(&spec)
    }

    #[test]
    fn a_free_brick_keeps_its_angular_momentum_and_at_second_order_its_energy() {
        // about the middle axis, around which it turns over
        let off = |dt: f64| {
            let mut rigid = brick([0.3, 1.2, -0.7]);
            let (spin, energy) = (rigid.spin(), rigid.kinetic());
            let mut worst = 0.0f64;
            let mut late = 0.0f64;
            let steps = (400.0 / dt) as usize;
            for n in 0..steps {
                rigid.advance(0.0, dt);
                assert_eq!(rigid.spin(), spin);
                let off = (rigid.kinetic() / energy - 1.0).abs();
                worst = worst.max(off);
                if n > steps * 3 / 4 {
                    late = late.max(off);
                }
            }
            // no drift
            assert!(late < 1.1 * worst && worst < 1.1 * late, "{worst} {late}");
            worst
        };
        let (coarse, fine) = (off(0.1), off(0.05));
        println!("energy of a free brick: {coarse:.1e} {fine:.1e}");
        assert!((3.5..4.5).contains(&(coarse / fine)), "{coarse} {fine}");
    }

    #[test]
    fn a_symmetric_top_goes_round_as_in_closed_form() {
        // the symmetry axis goes around L at L/I of the axes across it
        let end = |dt: f64| {
            let shape = RigidShape::Cylinder {
                radius: 1.0,
                half: 0.2,
                axis: [0.0, 0.0, 1.0],
            };
            let mut free = FreeSpec::new(3.0, [0.0; 3], [0.0; 3]);
            free.spin = [0.5, 0.0, 2.0];
            let motion = RigidBodyMotion::Free(free);
            let mut rigid = Rigid::<3>::new(&RigidBodySpec::new(1.0, shape, motion));
            let l = rigid.spin();
            let size = length(&l);
            let time = 5.0;
            (0..(time / dt) as usize).for_each(|_| {
                rigid.advance(0.0, dt);
            });
            let across = 3.0 * (0.25 + 0.04 / 3.0);
            let n = l.map(|c| c / size);
            let turned = Quaternion::about(&n, size / across * time).axes();
            let exact = times(&turned, &[0.0, 0.0, 1.0]);
            let axis = times(&rigid.axes, &[0.0, 0.0, 1.0]);
            length(&crate::array::from_fn(|a| axis[a] - exact[a]))
        };
        let (coarse, fine) = (end(0.05), end(0.025));
        println!("axis of a free top: {coarse:.1e} {fine:.1e}");
        assert!(
            fine < 1e-2 && (3.5..4.5).contains(&(coarse / fine)),
            "{coarse} {fine}"
        );
    }
}
