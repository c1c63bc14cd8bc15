//! What a part of a body knows of the whole.

use peridyne_comm::Comm;
use std::sync::Arc;

/// What a part of a body knows of the whole.
#[derive(Debug)]
pub struct Subdomain {
    comm: Arc<Comm>,
    ids: Vec<u32>,
    points: usize,
}

impl Subdomain {
    pub(super) fn new(comm: &Arc<Comm>, ids: Vec<u32>, points: usize) -> Subdomain {
        Subdomain {
            comm: comm.clone(),
            ids,
            points,
        }
    }

    /// The ranks that have the other parts.
    pub fn comm(&self) -> &Arc<Comm> {
        &self.comm
    }

    /// Ids among all points, in the order of ids here.
    pub fn ids(&self) -> &[u32] {
        &self.ids
    }

    /// Points of the whole.
    pub fn points(&self) -> usize {
        self.points
    }
}
