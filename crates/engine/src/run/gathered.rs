//! What all ranks have of something, brought together on the first.

use crate::observe::Values;
use bytemuck::{Pod, cast_slice, pod_read_unaligned};
use peridyne_comm::Comm;
use std::sync::Arc;

/// Who has the points of a body.
pub(in crate::run) enum Gathered {
    /// This model, all of them.
    Own,
    /// Many ranks; the first gathers.
    First(Everyone),
}

/// The points of all ranks.
pub(in crate::run) struct Everyone {
    comm: Arc<Comm>,
    points: usize,
    /// Ids of the points of each rank, on the first.
    ids: Vec<Vec<u32>>,
}

impl Everyone {
    /// All ranks come here at once.
    pub fn of(comm: &Arc<Comm>, ids: &[u32], points: usize) -> Everyone {
        let mut all = Everyone {
            comm: comm.clone(),
            points,
            ids: vec![],
        };
        all.ids = all.gather(ids).unwrap_or_default();
        all
    }

    fn gather<T: Pod>(&self, own: &[T]) -> Option<Vec<Vec<T>>> {
        let all = self.comm.first(cast_slice(own).to_vec());
        let all = all.unwrap_or_else(|failure| self.comm.end(failure))?;
        let numbers = |bytes: Vec<u8>| -> Vec<T> {
            let each = bytes.chunks_exact(size_of::<T>());
            each.map(pod_read_unaligned).collect()
        };
        Some(all.into_iter().map(numbers).collect())
    }
}

impl Gathered {
    /// Does this rank gather?
    pub fn is_first(&self) -> bool {
        match self {
            Gathered::Own => true,
            Gathered::First(all) => all.comm.rank() == 0,
        }
    }

    /// `each` values of every point by id, of those of the points that are here; `None` on ranks that gather nothing.
    pub fn columns<T: Pod>(&self, each: usize, own: Vec<T>) -> Option<Vec<T>> {
        let all = match self {
            Gathered::Own => return Some(own),
            Gathered::First(all) => all,
        };
        let of = all.gather(&own)?;
        let mut whole = vec![T::zeroed(); each * all.points];
        for (ids, values) in all.ids.iter().zip(&of) {
            for (id, value) in ids.iter().zip(values.chunks_exact(each)) {
                whole[each * *id as usize..each * (*id as usize + 1)].copy_from_slice(value);
            }
        }
        Some(whole)
    }

    /// The same of the values of a column.
    pub fn values(&self, own: Values) -> Option<Values> {
        Some(match own {
            Values::Scalars(v) => Values::Scalars(self.columns(1, v)?),
            Values::Vectors(v) => Values::Vectors(self.columns(1, v)?),
            Values::Symmetric(v) => Values::Symmetric(self.columns(1, v)?),
            Values::Tensors(v) => Values::Tensors(self.columns(1, v)?),
            Values::Integers(v) => Values::Integers(self.columns(1, v)?),
            Values::Counts(v) => Values::Counts(self.columns(1, v)?),
        })
    }

    /// Lists of all ranks, one after the other.
    pub fn lists<T: Pod>(&self, own: Vec<T>) -> Option<Vec<T>> {
        match self {
            Gathered::Own => Some(own),
            Gathered::First(all) => Some(all.gather(&own)?.concat()),
        }
    }
}
