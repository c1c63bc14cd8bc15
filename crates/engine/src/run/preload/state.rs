//! What waits for the motion while a body is loaded.

use crate::body::Field;
use crate::condition::applied::AppliedForces;
use crate::condition::prescribed_motion::PrescribedMotion;
use crate::fracture::precrack::Crack;
use crate::interaction::ContactForces;
use crate::interaction::friction::Friction;
use crate::run::implicit::state::Implicit;

/// What waits for the motion while a body is loaded.
pub(in crate::run) struct Preload<const D: usize> {
    pub applied: AppliedForces<D>,
    pub prescribed: PrescribedMotion<D>,
    /// Where Newton's method does not know it; else its friction, which has no place in the statics before motion.
    pub contact: Option<ContactForces<D>>,
    pub friction: Option<Friction<D>>,
    pub velocity: Field<D>,
    pub implicit: Option<Implicit<D>>,
    pub cuts: Vec<Crack<D>>,
}
