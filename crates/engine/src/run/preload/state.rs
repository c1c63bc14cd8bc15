//! What waits for the motion while a body is loaded.

use crate::body::Field;
use crate::condition::constraint::Constraint;
use crate::condition::indenter::Indenter;
use crate::condition::load::Load;
use crate::fracture::precrack::Crack;
use crate::interaction::contact::Contact;
use crate::interaction::friction::Friction;
use crate::run::implicit::state::Implicit;

/// What waits for the motion while a body is loaded.
pub(in crate::run) struct Preload<const D: usize> {
    pub increments: u64,
    /// What records show of an increment (time), all before t = 0.
    pub shown: f64,
    pub loads: Vec<Load<D>>,
    pub constraints: Vec<Constraint<D>>,
    pub indenters: Vec<Indenter<D>>,
    /// Where Newton's method does not know it.
    pub contact: Option<Contact<D>>,
    pub friction: Option<Friction<D>>,
    pub velocity: Field<D>,
    /// Of motion.
    pub dt: f64,
    pub implicit: Option<Implicit<D>>,
    pub cuts: Vec<Crack<D>>,
}
