//! Rigid bodies that push points: force density `K g²` along the normal where the gap g between point and surface is negative
//! (LAMMPS's `fix indent`; sandia2010 ch. 3, The Projectile).
//!
//! A surface may rub ([`rub`]). It may pull what is near ([`CohesionSpec`]): the traction acts on the
//! face of a point, so the force density is that over its spacing. What points feel the body feels with the other sign, at the place of the
//! point: momentum and angular momentum of both together stay as they are.

mod rub;
mod surface;

use super::force_field::{ForceField, power};
use super::reaction::ReactionSums;
use super::rigid::{Kept, NewmarkStep, Path, Rigid, Wrench};
use crate::body::{Body, Field, zeros};
use crate::execute::exact::Exact;
use crate::interaction::Evaluation;
use crate::interaction::coulomb::Coefficients;
use crate::interaction::friction::Pressed;
use crate::space::rigid::RigidShape;
use crate::space::{cross, full};
use crate::spec::{CohesionSpec, FrictionSpec, RigidBodySpec};
use crate::state::Archive;
use rub::{Departure, Touched};
use std::collections::HashMap;
pub use surface::{Form, Push};
use surface::{Near, Surface};

/// Force and torque of no points.
const NOTHING: [Exact; 6] = [const { Exact::ZERO }; 6];

#[derive(Debug, Clone)]
pub struct RigidBody<const D: usize> {
    pub name: String,
    stiffness: f64,
    surface: Surface,
    friction: Option<FrictionSpec>,
    cohesion: Option<CohesionSpec>,
    pub rigid: Rigid<D>,
    /// Points it can touch; `None`: all.
    members: Option<Vec<u32>>,
    /// Points touched last time, with the force density on them.
    touched: Vec<(u32, [f64; D])>,
    /// The same as they are rubbed, and as they were when the step began.
    rubbed: Vec<Touched<D>>,
    rubbed_before: Vec<Touched<D>>,
    /// How deep points were at the last [`RigidBody::press`], in statics.
    pressed: HashMap<u32, f64>,
    /// Points that can be touched before anything moved by `slack`.
    candidates: Vec<u32>,
    slack: f64,
    /// Work done on the points of this rank (energy).
    pub work: Exact,
    /// Work of friction on both (energy), and what of it its springs hold; of the points of this rank, as what follows.
    rubbed_work: Exact,
    stored: Exact,
    /// Of what is driven from outside.
    pub reaction: Option<Box<ReactionSums>>,
    /// Of points on the rigid body (force), and about its centre (force · length).
    felt: [Exact; 6],
    /// The most that contact adds to `M⁻¹K` (1 / time²).
    stiff: f64,
    kept: Option<(Kept, Exact, Exact)>,
    /// Of an increment of statics: where it and the points were.
    from: Option<Departure<D>>,
}

impl<const D: usize> RigidBody<D> {
    /// Passes what it remembers through an archive.
    pub fn archive(&mut self, body: &Body<D>, archive: &mut Archive<'_>) {
        archive.part("rigid", &mut self.rigid);
        body.archive_some(archive, "touched", &mut self.touched);
        for (name, all) in [
            ("rubbed", &mut self.rubbed),
            ("rubbed_before", &mut self.rubbed_before),
        ] {
            let nowhere = |t: &Touched<D>| (t.slot, Touched { slot: 0, ..*t });
            let mut list: Vec<_> = all.iter().map(nowhere).collect();
            body.archive_some(archive, name, &mut list);
            let there = |(slot, t)| Touched { slot, ..t };
            *all = list.into_iter().map(there).collect();
        }
        let mut pressed: Vec<(u32, f64)> = self.pressed.iter().map(|(s, d)| (*s, *d)).collect();
        body.archive_some(archive, "pressed", &mut pressed);
        archive.most("stiffest", &mut self.stiff);
        for (name, x) in [
            ("work", &mut self.work),
            ("work_of_friction", &mut self.rubbed_work),
            ("stored", &mut self.stored),
        ] {
            archive.part(name, x);
        }
        for x in &mut self.felt {
            archive.part("felt", x);
        }
        let rigid = self.rigid.keep();
        let departure = || Departure {
            rigid,
            u: zeros(body.len),
            touched: vec![],
            pressed: Pressed::Now,
        };
        archive.option("departure", &mut self.from, departure, |from, archive| {
            archive.one("rigid", &mut from.rigid);
            body.archive_field(archive, "displacement", &mut from.u);
            let mut held = from.pressed == Pressed::Held;
            archive.one("held", &mut held);
            from.pressed = if held { Pressed::Held } else { Pressed::Now };
        });
        if archive.loads() {
            self.pressed = pressed.into_iter().collect();
            self.invalidate_neighbours();
        }
    }

    pub fn new(spec: &RigidBodySpec) -> Self {
        let surface = match (&spec.shape, &spec.cohesion) {
            // in the order of operations of LAMMPS, to the last bit
            (RigidShape::Sphere { radius }, None) => {
                Surface::Aligned(Form::Sphere, Push::Out, *radius)
            }
            (shape, _) => {
                let mut shape = shape.clone();
                if let RigidShape::Box { half } = &mut shape {
                    half[D..].fill(f64::INFINITY);
                }
                Surface::Turned(shape)
            }
        };
        RigidBody {
            name: spec.name.clone(),
            friction: spec.friction.clone(),
            cohesion: spec.cohesion,
            ..Self::with(spec.stiffness, surface, Rigid::new(spec))
        }
    }

    /// A surface whose values come from outside, touching the points in `members`; a plane has the radius 0.
    pub fn driven(
        stiffness: f64,
        (form, push): (Form, Push),
        center: [f64; 3],
        radius: f64,
        members: Vec<u32>,
    ) -> Self {
        let surface = Surface::Aligned(form, push, radius);
        RigidBody {
            members: Some(members),
            ..Self::with(stiffness, surface, Rigid::co_simulation(center))
        }
    }

    fn with(stiffness: f64, surface: Surface, rigid: Rigid<D>) -> Self {
        RigidBody {
            name: String::new(),
            stiffness,
            surface,
            friction: None,
            cohesion: None,
            rigid,
            members: None,
            touched: vec![],
            rubbed: vec![],
            rubbed_before: vec![],
            pressed: HashMap::new(),
            candidates: vec![],
            slack: 0.0,
            work: Exact::ZERO,
            rubbed_work: Exact::ZERO,
            stored: Exact::ZERO,
            reaction: None,
            felt: NOTHING,
            stiff: 0.0,
            kept: None,
            from: None,
        }
    }

    /// Values for the coming force evaluation.
    pub fn drive(&mut self, stiffness: f64, center: [f64; 3], radius: f64) {
        if let Surface::Aligned(_, _, old) = &mut self.surface {
            self.slack -= (radius - *old).abs();
            *old = radius;
        }
        self.stiffness = stiffness;
        self.rigid.steer(center);
    }

    /// Its form and which way it pushes, of one that is driven.
    pub fn form(&self) -> Option<(Form, Push)> {
        match self.surface {
            Surface::Aligned(form, push, _) => Some((form, push)),
            Surface::Turned(_) => None,
        }
    }

    /// The gap below which the surface does something.
    fn range(&self) -> f64 {
        self.cohesion.as_ref().map_or(0.0, CohesionSpec::range)
    }

    /// It has gone so far since the last look around.
    fn went(&mut self, path: Path) {
        self.slack -= path.way;
        if let Surface::Turned(shape) = &self.surface
            && path.angle > 0.0
        {
            // what turns comes no nearer than its furthest place goes; a plane has none
            self.slack -= path.angle * shape.reach(D);
        }
    }

    /// Looks for the points that may be touched soon.
    pub fn look_around(&mut self, body: &Body<D>, u: &Field<D>) {
        // what turns without an end is looked at in every step
        let endless = matches!(self.surface, Surface::Turned(RigidShape::Plane { .. }));
        if self.slack > 0.0 && !(endless && self.rigid.turns()) {
            return;
        }
        // two spacings: a fast rigid_body looks around every few dozen steps
        self.slack = 2.0 * body.spacing;
        let most = self.slack + self.range();
        let mut candidates = std::mem::take(&mut self.candidates);
        candidates.clear();
        let all = self.members.as_ref().unwrap_or(&body.slots);
        let close = |s: &&u32| {
            let near = self.surface.near(&self.rigid, body, u, **s as usize, most);
            near.is_some_and(|n| n.gap < most)
        };
        candidates.extend(all.iter().filter(close));
        self.candidates = candidates;
    }

    /// Energy density that cohesion holds below that of a point out of its range where the point touches: w/h of a point of spacing h.
    fn adhesion(&self, body: &Body<D>, i: usize) -> f64 {
        let of = |c: &CohesionSpec| c.energy / body.spacing_at(i);
        self.cohesion.as_ref().map_or(0.0, of)
    }

    /// What pulls a point at a gap within the range: force density, its greatest slope, and the energy density.
    fn pull(&self, body: &Body<D>, i: usize, gap: f64) -> (f64, f64, f64) {
        let Some(cohesion) = &self.cohesion else {
            return (0.0, 0.0, 0.0);
        };
        let (h, range) = (body.spacing_at(i), cohesion.range());
        let s = gap / range;
        let pull = 27.0 / 4.0 * cohesion.strength * s * (1.0 - s) * (1.0 - s);
        // 12 ∫ s (1 − s)² ds from s on, and w in all
        let left = (1.0 - s).powi(3) * (1.0 + 3.0 * s);
        let slope = 27.0 / 4.0 * cohesion.strength / range;
        (-pull / h, slope / h, -cohesion.energy * left / h)
    }

    /// What the pull of [`RigidBody::pull`] grows by with the gap (force density / length).
    fn pull_slope(&self, body: &Body<D>, i: usize, gap: f64) -> f64 {
        let range = self.range();
        if !(gap < range) {
            return 0.0;
        }
        let s = gap / range;
        self.pull(body, i, gap).1 * (1.0 - s) * (1.0 - 3.0 * s)
    }

    /// The body feels what it does to a point.
    fn bear(&mut self, arm: &[f64; D], force: &[f64; D], volume: f64) {
        let turn = cross(&full(arm), &full(force));
        for a in 0..D {
            self.felt[a].take(force[a] * volume);
        }
        for a in 0..3 {
            self.felt[3 + a].take(turn[a] * volume);
        }
    }

    /// What the points of all ranks do to it, about its centre. All ranks ask at once.
    pub fn wrench(&self, body: &Body<D>) -> Wrench {
        body.sums(self.felt.clone())
    }

    /// The eigenvalue of `M⁻¹K` that a step must meet with this contact, of a body whose bonds alone have `bonds` (1 / time²): points at a surface
    /// have half a family. Contact counts four times: a blow is short, and its steps are half of those that are stable. 0: nothing touches.
    pub fn stiffened(&self, bonds: f64) -> f64 {
        match self.stiff > 0.0 {
            true => 0.5 * bonds + 4.0 * self.stiff,
            false => 0.0,
        }
    }

    /// Where it is at this time, in statics; what is near is looked for again.
    pub fn place(&mut self, t: f64) {
        if self.rigid.place(t) {
            self.slack = 0.0;
        }
    }

    /// Adds what it resists with at each point that it pushes or pulls (force / length) to sums by slot, at the displacements of the last
    /// [`ForceField::add`].
    pub fn add_stiffness(&self, body: &Body<D>, u: &Field<D>, sum: &mut [f64]) {
        for &s in &self.candidates {
            let i = s as usize;
            let Some(near) = self.surface.near(&self.rigid, body, u, i, self.range()) else {
                continue;
            };
            let mut slope = 2.0 * self.stiffness * (-near.gap).max(0.0);
            if near.gap >= 0.0 && near.gap < self.range() {
                slope = self.pull(body, i, near.gap).1;
            }
            sum[i] += slope * body.volume.at(i);
        }
    }

    /// Visits points (slots) with the arm of their place on the body and what resists there (force / length), at the displacements of the last
    /// [`ForceField::add`]; without what would not be positive: how the normal turns with the surface, and cohesion beyond its greatest pull.
    pub fn each_tangent(
        &self,
        body: &Body<D>,
        u: &Field<D>,
        mut visit: impl FnMut(usize, &[f64; D], [[f64; D]; D]),
    ) {
        for &s in &self.candidates {
            let i = s as usize;
            let Some(near) = self.surface.near(&self.rigid, body, u, i, self.range()) else {
                continue;
            };
            let slope = match near.gap < 0.0 {
                true => -2.0 * self.stiffness * near.gap,
                false => self.pull_slope(body, i, near.gap).max(0.0),
            };
            if slope > 0.0 {
                let per = slope * body.volume.at(i);
                visit(
                    i,
                    &near.arm,
                    near.normal.map(|m| near.normal.map(|n| per * m * n)),
                );
            }
        }
        self.each_rubbing(body, &mut visit);
    }

    /// The end of an implicit step of a body with mass, as [`Rigid::step_implicitly`], from where [`ForceField::depart`] left it.
    pub fn step_implicitly(&mut self, ends: [&Wrench; 2], by: NewmarkStep) {
        let Some(from) = &self.from else { return };
        let path = self.rigid.step_implicitly(&from.rigid, ends, by);
        self.went(path);
    }

    /// What acted on it where the step began.
    pub fn departed_under(&self) -> Wrench {
        self.from.as_ref().map_or([0.0; 6], |f| f.rigid.wrench())
    }

    /// Does it move by the forces on it?
    pub fn is_free(&self) -> bool {
        self.rigid.is_free()
    }

    /// Forget which points are near, after something else moved them.
    fn invalidate_neighbours(&mut self) {
        self.slack = 0.0;
    }
}

impl<const D: usize> ForceField<D> for RigidBody<D> {
    /// It moves to the end of the step, too.
    fn begin_step(&mut self, body: &Body<D>, v: &Field<D>, [t, dt]: [f64; 2], moved: f64) {
        self.kept = Some((
            self.rigid.keep(),
            self.work.clone(),
            self.rubbed_work.clone(),
        ));
        for (s, f) in &self.touched {
            let i = *s as usize;
            let power = power(f, v, i);
            self.work.add(0.5 * dt * body.volume.at(i) * power);
        }
        self.rigid.kick(dt);
        self.rub_away(body, v, dt);
        std::mem::swap(&mut self.rubbed, &mut self.rubbed_before);
        let path = self.rigid.advance(t, dt);
        self.slack -= moved;
        self.went(path);
    }

    fn add(
        &mut self,
        body: &Body<D>,
        [u, v]: [&Field<D>; 2],
        f: &mut Field<D>,
        t: f64,
        at: Evaluation,
        _: Option<&Field<D>>,
    ) {
        self.rigid.arrive();
        let (at, dt) = (at.of(self.from.is_some()), at.ended());
        match at {
            Evaluation::Start { next } => {
                self.rigid.look_ahead(t, next);
                std::mem::swap(&mut self.rubbed, &mut self.rubbed_before);
            }
            Evaluation::Trial { step } => self.rigid.look_ahead(t, step),
            Evaluation::StepEnd { .. } => {}
        }
        self.look_around(body, u);
        self.touched.clear();
        self.rubbed.clear();
        (self.felt, self.stiff) = (NOTHING, 0.0);
        if let Some(reaction) = &mut self.reaction {
            **reaction = ReactionSums::default();
        }
        let (range, mut mobile) = (self.range(), Exact::ZERO);
        let candidates = std::mem::take(&mut self.candidates);
        for &s in &candidates {
            let i = s as usize;
            let Some(near) = self.surface.near(&self.rigid, body, u, i, range) else {
                continue;
            };
            let Near {
                arm,
                r,
                gap,
                normal,
            } = near;
            if gap >= range || r == 0.0 {
                continue;
            }
            let volume = body.volume.at(i);
            // force density along the normal, its slope, and the energy density
            let (along, slope, energy) = match gap < 0.0 {
                true => {
                    let deep = self.stiffness * gap * gap;
                    let energy = self.stiffness / 3.0 * (-gap).powi(3);
                    (
                        deep,
                        -2.0 * self.stiffness * gap,
                        energy - self.adhesion(body, i),
                    )
                }
                false => self.pull(body, i, gap),
            };
            let force: [f64; D] = match &self.surface {
                Surface::Aligned(form, push, _) => form.force(*push, self.stiffness, &near),
                Surface::Turned(_) => normal.map(|c| along * c),
            };
            if let Some(reaction) = &mut self.reaction {
                reaction.add_energy(energy);
                reaction.add_force(force.map(|f| -f));
            }
            (0..D).for_each(|a| f[a][i] += force[a]);
            self.work.add(0.5 * dt * volume * power(&force, v, i));
            self.bear(&arm, &force, volume);
            let square: f64 = arm.iter().map(|c| c * c).sum();
            mobile.add(slope * volume * self.rigid.mobility(square));
            self.stiff = self.stiff.max(slope / body.density.at(i));
            self.touched.push((s, force));
            if self.friction.is_some() {
                self.rubbed.push(Touched {
                    slot: s,
                    near,
                    way: [0.0; D],
                    depth: 0.0,
                    kept: 1.0,
                    rub: [0.0; D],
                });
            }
        }
        self.candidates = candidates;
        if let Some(law) = &self.friction {
            let now = Coefficients::new(law, t);
            self.rub(body, [u, v], f, now, at);
        }
        // what goes its own way feels nothing
        if self.rigid.is_free() {
            let [x, y, z, about_x, about_y, about_z] = self.wrench(body);
            self.rigid
                .push([x, y, z], [about_x, about_y, about_z], t, dt);
            self.stiff = body.most(self.stiff) + body.sums([mobile])[0];
        }
    }

    fn depart(&mut self, u: &Field<D>, pressed: Pressed) {
        self.kept = Some((
            self.rigid.keep(),
            self.work.clone(),
            self.rubbed_work.clone(),
        ));
        std::mem::swap(&mut self.rubbed, &mut self.rubbed_before);
        self.from = Some(Departure {
            rigid: self.rigid.keep(),
            u: u.clone(),
            touched: self.touched.clone(),
            pressed,
        });
    }

    fn arrive(&mut self, body: &Body<D>, [_, u]: [&Field<D>; 2]) {
        let Some(from) = &self.from else { return };
        for (s, f) in from.touched.iter().chain(&self.touched) {
            let i = *s as usize;
            let path = (0..D).map(|a| f[a] * (u[a][i] - from.u[a][i]));
            self.work.add(0.5 * body.volume.at(i) * path.sum::<f64>());
        }
        self.account_rubbing(body, u);
    }

    fn retreat(&mut self) {
        if let Some((rigid, work, rubbed)) = self.kept.take() {
            self.rigid.retreat(&rigid);
            std::mem::swap(&mut self.rubbed, &mut self.rubbed_before);
            (self.work, self.rubbed_work) = (work, rubbed);
            self.invalidate_neighbours();
        }
    }

    fn moved(&mut self, path: f64) {
        self.slack -= path;
    }

    fn retain(&mut self, keep: &dyn Fn(u32) -> bool) {
        if let Some(members) = &mut self.members {
            members.retain(|s| keep(*s));
        }
        self.touched.retain(|(s, _)| keep(*s));
        self.rubbed.clear();
        self.rubbed_before.clear();
        self.invalidate_neighbours();
    }
}
