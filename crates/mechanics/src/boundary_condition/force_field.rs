//! The role of what adds to the forces on points.

use crate::body::{Body, Field};
use crate::interaction::Evaluation;
use crate::interaction::friction::Pressed;

/// Power of a force density on a slot (energy / time / volume).
pub(super) fn power<const D: usize>(force: &[f64; D], v: &Field<D>, slot: usize) -> f64 {
    (0..D).map(|a| force[a] * v[a][slot]).sum()
}

/// Who adds to the force density.
pub trait ForceField<const D: usize> {
    /// Before the forces at the end, at t, of an explicit step dt long (time): half of the old force's work, with the velocities of the step's
    /// middle. `path` bounds the path of any point (length).
    fn begin_step(&mut self, body: &Body<D>, v: &Field<D>, step: [f64; 2], path: f64);
    /// Adds the force density at time `t`, at displacements and velocities, to `f`. `push` is `ρ a` of the step's start where masses couple
    /// points and forces on one of them do not say how it is accelerated.
    fn add(
        &mut self,
        body: &Body<D>,
        state: [&Field<D>; 2],
        f: &mut Field<D>,
        t: f64,
        at: Evaluation,
        push: Option<&Field<D>>,
    );
    /// An increment of statics (`Held`) or an implicit step (`Now`) begins, from these displacements.
    fn depart(&mut self, u: &Field<D>, pressed: Pressed);
    /// It ends: work from displacements of then to those of now, by the trapezoidal rule.
    fn arrive(&mut self, body: &Body<D>, between: [&Field<D>; 2]);
    /// Back to before the last [`ForceField::begin_step`] or [`ForceField::depart`].
    fn retreat(&mut self);
    /// No point has gone further than `path` (length) since the last call; ∞: they may be anywhere.
    fn moved(&mut self, path: f64);
    /// Points have the slots that `keep` holds for only, from now on.
    fn retain(&mut self, keep: &dyn Fn(u32) -> bool);
}
