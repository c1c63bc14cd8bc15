//! Shares of all points by their ids, for what is written or summed in the order of ids without one rank that has all.

use super::subdomain::Subdomain;
use bytemuck::{Pod, cast_slice, cast_slice_mut, pod_read_unaligned};

/// Each rank's share of all ids, whoever has their points: as many in a row.
pub struct RunsOfIds<'a> {
    of: Option<&'a Subdomain>,
    points: usize,
    /// Of each rank but the last ones.
    share: usize,
}

impl<'a> RunsOfIds<'a> {
    /// Of so many points, in runs of so many ids.
    pub(super) fn new(of: Option<&'a Subdomain>, points: usize, run: usize) -> RunsOfIds<'a> {
        let ranks = of.map_or(1, |of| of.comm().ranks());
        let share = points.div_ceil(run).div_ceil(ranks) * run;
        RunsOfIds { of, points, share }
    }

    /// The first id of a rank's share.
    fn begin(&self, rank: usize) -> usize {
        (rank * self.share).min(self.points)
    }

    fn rank(&self) -> usize {
        self.of.map_or(0, |of| of.comm().rank())
    }

    /// The first id of this rank's share.
    pub fn first(&self) -> usize {
        self.begin(self.rank())
    }

    /// Points of this rank's share.
    pub fn points(&self) -> usize {
        self.begin(self.rank() + 1) - self.begin(self.rank())
    }

    /// `each` numbers of every point of this rank's share by id, of those of the points that are here. All ask at once.
    pub fn of<T: Pod>(&self, each: usize, own: Vec<T>) -> Vec<T> {
        let Some(of) = self.of else {
            return own;
        };
        let (ids, comm) = (of.ids(), of.comm());
        let place = |rank: usize| ids.partition_point(|id| (*id as usize) < self.begin(rank));
        let said = (0..comm.ranks()).map(|rank| {
            let own_ids = &ids[place(rank)..place(rank + 1)];
            let numbers = &own[each * place(rank)..each * place(rank + 1)];
            [cast_slice::<u32, u8>(own_ids), cast_slice(numbers)].concat()
        });
        let said = comm.to_each(said.collect());
        drop(own);
        let mut share = vec![T::zeroed(); each * self.points()];
        for bytes in said.unwrap_or_else(|failure| comm.end(failure)) {
            let points = bytes.len() / (size_of::<u32>() + each * size_of::<T>());
            let (ids, numbers) = bytes.split_at(points * size_of::<u32>());
            let ids = ids.chunks_exact(4).map(pod_read_unaligned::<u32>);
            put(&mut share, (each, self.begin(self.rank())), ids, numbers);
        }
        share
    }
}

/// Puts `each` numbers of points by their ids, counted from a first one, wherever their bytes lie.
pub(super) fn put<T: Pod>(
    all: &mut [T],
    (each, first): (usize, usize),
    ids: impl Iterator<Item = u32>,
    bytes: &[u8],
) {
    let each_of = bytes.chunks_exact(each * size_of::<T>());
    for (id, numbers) in ids.zip(each_of) {
        let to = &mut all[each * (id as usize - first)..][..each];
        cast_slice_mut(to).copy_from_slice(numbers);
    }
}
