//! The role of what tells points where they go, whatever forces say.

use crate::body::Field;

/// Who tells points where they go.
pub trait Prescribed<const D: usize> {
    /// A step from t on, dt long (time), begins: the coming pass moves the points by no force (`f`), with the velocity of the step's middle (`v`).
    /// `whole`: does `v` hold the velocities of the whole step?
    fn before_drift(
        &mut self,
        u: &Field<D>,
        v: &mut Field<D>,
        f: &mut Field<D>,
        step: [f64; 2],
        whole: bool,
    );
    /// After the drift of a step that ends at t and was dt long (time): displacements exactly as told.
    fn after_drift(&self, u: &mut Field<D>, step: [f64; 2]);
    /// Velocities of the whole step at t between steps dt long (time), after the last half kick.
    fn whole_velocity(&self, v: &mut Field<D>, step: [f64; 2]);
    /// Visits slots and axes that forces do not move.
    fn each_held(&self, visit: &mut dyn FnMut(usize, usize));
    /// Points have the slots that `keep` holds for only, from now on.
    fn retain(&mut self, keep: &dyn Fn(u32) -> bool);
}
