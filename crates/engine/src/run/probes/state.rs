//! Probes as a model keeps them.

use super::rectangle::JIntegral;
use crate::observe::ProbeColumn;
use crate::space::Point;
use crate::spec::{CrackTipSpec, Fold, RigidQuantity};

/// A probe that knows its points.
pub(in crate::run) struct Probe {
    /// Ids.
    pub(super) ids: Vec<u32>,
    pub(super) kind: Kind,
    pub(super) columns: Vec<ProbeColumn>,
}

impl Probe {
    /// What it writes.
    pub fn columns(&self) -> &[ProbeColumn] {
        &self.columns
    }
}

pub(super) enum Kind {
    Reaction,
    Moment(Point),
    Energy,
    /// Components by number; `None`: the magnitude.
    Over(Fold, String, Vec<Option<usize>>),
    JIntegral(Box<JIntegral>),
    CrackTip(CrackTipSpec),
    /// Between two points, each on the rank that has it.
    Opening([Vec<u32>; 2]),
    /// Of so many points at least.
    Fragments(u32),
    /// Of the rigid body of this number.
    Rigid(usize, Vec<RigidQuantity>),
}
