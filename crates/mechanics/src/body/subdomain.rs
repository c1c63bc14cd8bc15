//! What a part of a body knows of the whole.

use bytemuck::{Pod, cast_slice, pod_read_unaligned};
use peridyne_comm::Comm;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

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
    /// Of each rank, on the first, once somebody asked.
    ids_of_ranks: OnceLock<Vec<Vec<u32>>>,
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
            ids_of_ranks: OnceLock::new(),
        }
    }

    /// Of a cloud: slots of own points, and what the first one is in the whole.
    pub(super) fn of_cloud(self, own: Range<usize>, first: usize) -> Subdomain {
        Subdomain { own, first, ..self }
    }

    /// Without some points of the whole, by their ids in order: those above theirs move down.
    pub(super) fn without(&self, gone: &[u32]) -> Subdomain {
        let below = |id: u32| gone.partition_point(|g| *g < id) as u32;
        let stays = |id: &&u32| gone.binary_search(id).is_err();
        Subdomain {
            comm: self.comm.clone(),
            ids: { self.ids.iter().filter(stays) }
                .map(|id| id - below(*id))
                .collect(),
            // nobody asks who is in a slot of somebody who is gone
            of_slots: self.of_slots.iter().map(|id| id - below(*id)).collect(),
            points: self.points - gone.len(),
            own: self.own.clone(),
            first: self.first,
            ids_of_ranks: OnceLock::new(),
        }
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

    /// Ids among all points of those of each rank, on the first; nothing on the others. All ask at once.
    pub(super) fn ids_of_ranks(&self) -> &[Vec<u32>] {
        self.ids_of_ranks
            .get_or_init(|| self.first(&self.ids).unwrap_or_default())
    }

    /// Numbers of each rank, in their order, on the first. All ask at once.
    pub(super) fn first<T: Pod>(&self, own: &[T]) -> Option<Vec<Vec<T>>> {
        let all = self.comm.first(cast_slice(own).to_vec());
        let all = all.unwrap_or_else(|failure| self.comm.end(failure))?;
        Some(all.iter().map(|bytes| numbers(bytes)).collect())
    }

    /// What the first rank has for each. All ask at once.
    pub(super) fn of_first<T: Pod>(&self, all: Vec<Vec<T>>) -> Vec<T> {
        let all = all.iter().map(|own| cast_slice(own).to_vec()).collect();
        let own = self.comm.of_first(all);
        numbers(&own.unwrap_or_else(|failure| self.comm.end(failure)))
    }

    /// What each rank says, in their order. All ask at once.
    pub(super) fn every<const N: usize>(&self, own: [u8; N]) -> impl Iterator<Item = [u8; N]> {
        let all = self.comm.all_as_long(&own);
        let all = all.unwrap_or_else(|failure| self.comm.end(failure));
        let each = all.as_chunks().0.to_vec();
        each.into_iter()
    }

    /// Points of the whole.
    pub fn points(&self) -> usize {
        self.points
    }
}

/// Numbers, wherever their bytes lie.
pub(super) fn numbers<T: Pod>(bytes: &[u8]) -> Vec<T> {
    let each = bytes.chunks_exact(size_of::<T>());
    each.map(pod_read_unaligned).collect()
}
