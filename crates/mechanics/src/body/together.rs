//! What a body says as a whole, whoever has its parts: all ranks ask at once, and hear the same bits on any number of them.

use super::{Body, Layout};
use crate::execute::exact::Exact;
use crate::space::Point;
use bytemuck::{Pod, cast_slice, pod_read_unaligned};
use std::borrow::Cow;

impl<const D: usize> Body<D> {
    /// Sums of what all ranks added to them.
    pub fn sums<const N: usize>(&self, mut sums: [Exact; N]) -> [f64; N] {
        if let Some(of) = self.subdomain() {
            Exact::of_all(&mut sums, of.comm());
        }
        sums.map(|sum| sum.value())
    }

    /// Their sum over the points of all ranks.
    pub fn sum(&self, of_each: impl Iterator<Item = f64>) -> f64 {
        self.sums([of_each.collect()])[0]
    }

    /// As many numbers of each rank, in their order.
    pub fn all_of<T: Pod>(&self, own: &[T]) -> Vec<Vec<T>> {
        let Some(of) = self.subdomain() else {
            return vec![own.to_vec()];
        };
        let all = of.comm().all(cast_slice(own));
        let all = all.unwrap_or_else(|failure| of.comm().end(failure));
        let numbers = |bytes: Vec<u8>| -> Vec<T> {
            let each = bytes.chunks_exact(size_of::<T>());
            each.map(pod_read_unaligned).collect()
        };
        all.into_iter().map(numbers).collect()
    }

    /// How many all ranks have.
    pub fn count(&self, own: u64) -> u64 {
        let Some(of) = self.subdomain() else {
            return own;
        };
        of.every(own.to_le_bytes()).map(u64::from_le_bytes).sum()
    }

    /// The largest that a rank has; not a number where one has none such.
    pub fn most(&self, own: f64) -> f64 {
        let Some(of) = self.subdomain() else {
            return own;
        };
        let all = of.every(own.to_le_bytes()).map(f64::from_le_bytes);
        all.fold(f64::NEG_INFINITY, |most, x| {
            if most.is_nan() || most >= x { most } else { x }
        })
    }

    /// The least.
    pub fn least(&self, own: f64) -> f64 {
        -self.most(-own)
    }

    /// Points of all ranks.
    pub fn all_points(&self) -> usize {
        self.subdomain().map_or(self.points(), |of| of.points())
    }

    /// Reference position of one of the points of all ranks, padded to three components. All ask at once.
    pub fn position_of(&self, id: usize) -> Point {
        let own = match self.subdomain() {
            None => Some(id),
            Some(of) => of.ids().binary_search(&(id as u32)).ok(),
        };
        let x = own.map(|id| self.position(self.slots[id] as usize));
        self.sums(crate::array::from_fn(|a| x.iter().map(|x| x[a]).collect()))
    }

    /// Reference position of the point that a slot is, or is a copy of, padded to three components.
    pub fn home(&self, slot: usize) -> Point {
        match (&self.layout, self.subdomain()) {
            (Layout::Grid(grid), Some(_)) => grid.home(slot),
            (Layout::Several(pieces), Some(_)) => {
                let piece = &pieces[self.piece_of(slot)];
                piece.body.home(slot - piece.first)
            }
            _ => self.position(self.exchange.original(slot)),
        }
    }

    /// Slots of a cloud that are not copies of other ranks' points.
    pub(crate) fn own_slots(&self) -> std::ops::Range<usize> {
        self.subdomain().map_or(0..self.len, |of| of.own_slots())
    }

    /// Of points in the order of the slots of the whole, also where a slot is a part's.
    pub(crate) fn order(&self, slot: usize) -> u64 {
        match (&self.layout, self.subdomain()) {
            (Layout::Grid(grid), Some(_)) => {
                let (sublattice, cell) = grid.place(slot);
                (sublattice as u64) << 40 | cell as u64
            }
            (Layout::Cloud(_), Some(of)) => of.slot_of_all(slot) as u64,
            (Layout::Several(pieces), Some(_)) => {
                let n = self.piece_of(slot);
                (n as u64) << 52 | pieces[n].body.order(slot - pieces[n].first)
            }
            (_, None) => slot as u64,
        }
    }

    /// The id among the points of all ranks of one that is here.
    pub fn id_of_all(&self, id: usize) -> usize {
        self.subdomain().map_or(id, |of| of.ids()[id] as usize)
    }

    /// The id among the points of all ranks of who is in each slot; of another rank's point in its copies, too.
    pub fn ids_of_all(&self) -> Cow<'_, [u32]> {
        match self.subdomain() {
            Some(of) => Cow::Borrowed(of.of_slots()),
            None => Cow::Owned(self.ids_by_slot()),
        }
    }
}
