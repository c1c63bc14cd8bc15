//! All motion that is told: constraints, points that stand still, points that are carried.

use super::constraint::Constraint;
use super::kinematic::KinematicPoints;
use super::prescribed::Prescribed;
use super::still::Still;
use crate::body::{Body, Field};
use crate::execute::exact::Exact;
use crate::state::Archive;

/// In the order in which they tell it.
#[derive(Debug, Clone, Default)]
pub struct PrescribedMotion<const D: usize> {
    pub constraints: Vec<Constraint<D>>,
    pub still: Still<D>,
    pub kinematic: KinematicPoints,
}

impl<const D: usize> PrescribedMotion<D> {
    /// Passes what it remembers through an archive.
    pub fn archive(&mut self, body: &Body<D>, archive: &mut Archive<'_>) {
        archive.each("constraints", &mut self.constraints, |c, a| {
            c.archive(body, a);
        });
    }

    /// Everybody, in turn.
    pub fn all(&self) -> impl Iterator<Item = &dyn Prescribed<D>> {
        let constraints = self.constraints.iter().map(|c| c as &dyn Prescribed<D>);
        constraints.chain([&self.still as &dyn Prescribed<D>, &self.kinematic])
    }

    /// The same, of those who are about to change.
    pub fn all_mut(&mut self) -> impl Iterator<Item = &mut dyn Prescribed<D>> {
        let constraints = self.constraints.iter_mut();
        let constraints = constraints.map(|c| c as &mut dyn Prescribed<D>);
        constraints.chain([
            &mut self.still as &mut dyn Prescribed<D>,
            &mut self.kinematic,
        ])
    }

    /// Put points where they belong at the start of a run.
    pub fn start(&self, u: &mut Field<D>, v: &mut Field<D>, [t, dt]: [f64; 2]) {
        for c in &self.constraints {
            c.place(u, t);
            c.whole_velocity(v, [t, dt]);
        }
    }

    /// The step that began was refused, and its drift and kick are taken back.
    pub fn refused(&self, v: &mut Field<D>, step: [f64; 2]) {
        self.still.whole_velocity(v, step);
    }

    /// With the forces of a step's end: work of the constraints, as [`Constraint::end`].
    pub fn after_forces(
        &mut self,
        body: &Body<D>,
        [u, f]: [&Field<D>; 2],
        gained: &dyn Fn(usize, usize, [f64; 2]) -> f64,
        step: [f64; 2],
    ) {
        for c in &mut self.constraints {
            c.end(body, u, f, gained, step);
        }
    }

    /// Displacements as prescribed at a time.
    pub fn place(&self, u: &mut Field<D>, t: f64) {
        self.constraints.iter().for_each(|c| c.place(u, t));
    }

    /// Slots, axes and displacements as prescribed at a time.
    pub fn displaced(&self, t: f64) -> impl Iterator<Item = (usize, usize, f64)> {
        self.constraints.iter().flat_map(move |c| {
            c.each()
                .filter_map(move |(k, slot, a)| Some((slot, a, c.displaced(a, k, t)?)))
        })
    }

    /// Work done on the points of this rank (energy).
    pub fn work(&self) -> impl Iterator<Item = &Exact> {
        self.constraints.iter().map(|c| &c.work)
    }
}
