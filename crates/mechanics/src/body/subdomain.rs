//! What a part of a body knows of the whole.

use peridyne_comm::Comm;
use std::ops::Range;
use std::sync::Arc;

/// What a part of a body knows of the whole.
#[derive(Debug)]
pub struct Subdomain {
    comm: Arc<Comm>,
    ids: Vec<u32>,
    of_slots: Vec<u32>,
    points: usize,
    /// Of a cloud: slots of own points, and what the first one is in the whole.
    own: Range<usize>,
    first: usize,
}

impl Subdomain {
    pub(super) fn new(
        comm: &Arc<Comm>,
        ids: Vec<u32>,
        of_slots: Vec<u32>,
        points: usize,
    ) -> Subdomain {
        Subdomain {
            comm: comm.clone(),
            ids,
            of_slots,
            points,
            own: 0..0,
            first: 0,
        }
    }

    /// Of a cloud: slots of own points, and what the first one is in the whole.
    pub(super) fn of_cloud(self, own: Range<usize>, first: usize) -> Subdomain {
        Subdomain { own, first, ..self }
    }

    /// The slots that points of this part of a cloud lie in.
    pub(crate) fn own_slots(&self) -> Range<usize> {
        self.own.clone()
    }

    /// What a slot of this part of a cloud is in the whole.
    pub(super) fn slot_of_all(&self, slot: usize) -> usize {
        self.first + slot - self.own.start
    }

    /// The ranks that have the other parts.
    pub fn comm(&self) -> &Arc<Comm> {
        &self.comm
    }

    /// Ids among all points, in the order of ids here.
    pub fn ids(&self) -> &[u32] {
        &self.ids
    }

    /// The id among all points of who is in each slot, copies too.
    pub(crate) fn of_slots(&self) -> &[u32] {
        &self.of_slots
    }

    /// What each rank says, in their order. All ask at once.
    pub(super) fn every<const N: usize>(&self, own: [u8; N]) -> impl Iterator<Item = [u8; N]> {
        let all = self.comm.all(&own);
        let all = all.unwrap_or_else(|failure| self.comm.end(failure));
        let as_many = |bytes: Vec<u8>| bytes.try_into().expect("all ranks say as much");
        all.into_iter().map(as_many)
    }

    /// Points of the whole.
    pub fn points(&self) -> usize {
        self.points
    }
}
