//! What a body says as a whole, whoever has its parts: all ranks ask at once, and hear the same bits on any number of them.

use super::runs::{RunsOfIds, put};
use super::subdomain::numbers;
use super::{Body, Field, Layout, cut};
use crate::execute::exact::Exact;
use crate::space::Point;
use crate::state::{Archive, Whose, Word};
use bytemuck::{Pod, cast_slice};
use std::borrow::Cow;

impl<const D: usize> Body<D> {
    /// Sums of what all ranks added to them.
    pub fn sums<const N: usize>(&self, mut sums: [Exact; N]) -> [f64; N] {
        if let Some(of) = self.subdomain() {
            Exact::of_all(&mut sums, of.comm());
        }
        sums.map(|sum| sum.value())
    }

    /// The same of as many as all have.
    pub fn sums_of(&self, mut sums: Vec<Exact>) -> Vec<f64> {
        if let Some(of) = self.subdomain() {
            Exact::of_all(&mut sums, of.comm());
        }
        sums.iter().map(Exact::value).collect()
    }

    /// Their sum over the points of all ranks.
    pub fn sum(&self, of_each: impl Iterator<Item = f64>) -> f64 {
        self.sums([of_each.collect()])[0]
    }

    /// Whose points are here.
    pub fn whose(&self) -> Whose<'_> {
        Whose {
            ids: self.subdomain().map(|of| of.ids()),
            points: self.all_points(),
        }
    }

    /// Passes `each` words of every point through an archive, of those that lie `at(slot, n)`, or none where there are none; copies are not filled.
    pub fn archive_points<T: Word>(
        &self,
        archive: &mut Archive<'_>,
        name: &str,
        (values, each): (&mut [T], usize),
        at: impl Fn(usize, usize) -> usize,
    ) {
        let slots = self.slots.iter().map(|s| *s as usize);
        let at = &at;
        let places = slots.flat_map(|slot| (0..each).map(move |n| at(slot, n)));
        archive.points(name, self.whose(), each, (values, places));
    }

    /// The same of vectors.
    pub fn archive_field(&self, archive: &mut Archive<'_>, name: &str, field: &mut Field<D>) {
        for column in field {
            self.archive_points(archive, name, (column, 1), |slot, _| slot);
        }
    }

    /// Passes what every point has by id through an archive, or that no point has anything; `none` is what it has before it is read.
    pub fn archive_if_any<T: Word>(
        &self,
        archive: &mut Archive<'_>,
        name: &str,
        values: &mut Vec<T>,
        none: T,
    ) {
        let mut there = self.exchange.any(!values.is_empty());
        archive.within(name, |archive| {
            archive.one("there", &mut there);
            if archive.loads() {
                *values = vec![none; if there { self.points() } else { 0 }];
            }
            if there {
                let places = 0..self.points();
                archive.points("of_points", self.whose(), 1, (values, places));
            }
        });
    }

    /// Passes what a list has of these slots through an archive.
    pub(crate) fn archive_list<T: Word>(
        &self,
        archive: &mut Archive<'_>,
        name: &str,
        slots: &[u32],
        values: &mut [T],
    ) {
        let ids = self.ids_of_all();
        let of = |k: usize| ids[slots[k] as usize];
        let mut order: Vec<usize> = (0..slots.len()).collect();
        order.sort_by_key(|k| of(*k));
        let mut entries: Vec<(u32, T)> = order.iter().map(|k| (of(*k), values[*k])).collect();
        archive.entries(name, self.whose(), &mut entries);
        if archive.loads() {
            let found = entries.iter().map(|(id, _)| *id);
            if !found.eq(order.iter().map(|k| of(*k))) {
                return archive.refuse(name);
            }
            for (k, (_, x)) in order.into_iter().zip(entries) {
                values[k] = x;
            }
        }
    }

    /// Passes a list of slots and what they have through an archive, as long as the state says; in order of slots where it was read.
    pub(crate) fn archive_some<T: Word>(
        &self,
        archive: &mut Archive<'_>,
        name: &str,
        list: &mut Vec<(u32, T)>,
    ) {
        let ids = self.ids_of_all();
        let named = list.iter().map(|(slot, x)| (ids[*slot as usize], *x));
        let mut entries: Vec<(u32, T)> = named.collect();
        let whose = self.whose();
        archive.entries(name, whose, &mut entries);
        if archive.loads() {
            let lie = |(id, x)| Some((self.slots[whose.place(id)?], x));
            *list = entries.into_iter().filter_map(lie).collect();
            list.sort_by_key(|(slot, _)| *slot);
        }
    }

    /// As many numbers of each rank, in their order.
    pub fn all_of<T: Pod>(&self, own: &[T]) -> Vec<Vec<T>> {
        let Some(of) = self.subdomain() else {
            return vec![own.to_vec()];
        };
        let all = of.comm().all(cast_slice(own));
        let all = all.unwrap_or_else(|failure| of.comm().end(failure));
        all.iter().map(|bytes| numbers(bytes)).collect()
    }

    /// A number of every point by id, of those of the points that are here: those of all ranks, on all.
    pub fn everywhere<T: Pod>(&self, own: Vec<T>) -> Vec<T> {
        let Some(of) = self.subdomain() else {
            return own;
        };
        let mut all = vec![T::zeroed(); of.points()];
        let ids = self.all_of(of.ids()).concat();
        for (id, x) in ids.into_iter().zip(self.all_of(&own).concat()) {
            all[id as usize] = x;
        }
        all
    }

    /// Does this rank have what is brought together?
    pub fn is_first(&self) -> bool {
        self.subdomain().is_none_or(|of| of.comm().rank() == 0)
    }

    /// `each` numbers of every point by id, of those of the points that are here: those of all ranks, on the first.
    pub fn whole<T: Pod>(&self, each: usize, own: Vec<T>) -> Option<Vec<T>> {
        let Some(of) = self.subdomain() else {
            return Some(own);
        };
        let ids = of.ids_of_ranks();
        let said = cast_slice(&own).to_vec();
        drop(own);
        let all = { of.comm().first(said) }.unwrap_or_else(|failure| of.comm().end(failure))?;
        let mut whole = vec![T::zeroed(); each * of.points()];
        for (ids, bytes) in ids.iter().zip(all) {
            put(&mut whole, (each, 0), ids.iter().copied(), &bytes);
        }
        Some(whole)
    }

    /// A rank's share of all ids, in runs of so many of which none is divided.
    pub fn runs_of_ids(&self, run: usize) -> RunsOfIds<'_> {
        let (points, of) = (self.all_points(), self.subdomain());
        RunsOfIds::new(of, points, run)
    }

    /// Those of the points that are here, of what the first rank has of all points.
    ///
    /// # Panics
    /// The first rank has nothing.
    pub fn part_of<T: Pod>(&self, each: usize, whole: Option<Vec<T>>) -> Vec<T> {
        let Some(of) = self.subdomain() else {
            return whole.expect("the only rank has all");
        };
        let ids = of.ids_of_ranks();
        let part = |ids: &Vec<u32>| {
            let whole = whole.as_ref().expect("the first rank has all");
            let each_of = |id: &u32| &whole[each * *id as usize..each * (*id as usize + 1)];
            ids.iter().flat_map(each_of).copied().collect()
        };
        of.of_first(ids.iter().map(part).collect())
    }

    /// Lists of all ranks one after the other, on the first.
    pub fn joined<T: Pod>(&self, own: Vec<T>) -> Option<Vec<T>> {
        match self.subdomain() {
            None => Some(own),
            Some(of) => Some(of.first(&own)?.concat()),
        }
    }

    /// What the first rank says.
    ///
    /// # Panics
    /// It says nothing.
    pub fn told<T: Pod>(&self, first: Option<T>) -> T {
        let Some(of) = self.subdomain() else {
            return first.expect("the only rank knows");
        };
        let all = first.map_or(vec![], |x| vec![vec![x]; of.comm().ranks()]);
        of.of_first(all)[0]
    }

    /// Of points in the same block of work, all of which one rank has.
    pub fn block(&self, slot: usize) -> u64 {
        match &self.layout {
            Layout::Grid(grid) => {
                let (sublattice, cell) = grid.place(slot);
                (sublattice as u64) << 40 | (cell / cut::CELLS) as u64
            }
            Layout::Cloud(_) => self.order(slot) / cut::CELLS as u64,
            Layout::Several(_) => {
                let (n, piece) = (self.piece_of(slot), self.piece_at(slot));
                (n as u64) << 52 | piece.body.block(slot - piece.first)
            }
        }
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

    /// The least and the largest of the numbers of all ranks.
    pub fn ends(&self, of_each: impl Iterator<Item = f64>) -> (f64, f64) {
        let (low, high) = of_each.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        (self.least(low), self.most(high))
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
            (Layout::Several(_), Some(_)) => {
                let piece = self.piece_at(slot);
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
    pub fn order(&self, slot: usize) -> u64 {
        match (&self.layout, self.subdomain()) {
            (Layout::Grid(grid), Some(_)) => {
                let (sublattice, cell) = grid.place(slot);
                (sublattice as u64) << 40 | cell as u64
            }
            (Layout::Cloud(_), Some(of)) => of.slot_of_all(slot) as u64,
            (Layout::Several(_), Some(_)) => {
                let (n, piece) = (self.piece_of(slot), self.piece_at(slot));
                (n as u64) << 52 | piece.body.order(slot - piece.first)
            }
            (_, None) => slot as u64,
        }
    }

    /// Which of several bodies has the point at this place in that [order](Self::order), of a body that ranks share.
    pub(crate) fn piece_of_order(order: u64) -> usize {
        (order >> 52) as usize
    }

    /// The id among the points of all ranks of one that is here.
    pub fn id_of_all(&self, id: usize) -> usize {
        self.subdomain().map_or(id, |of| of.ids()[id] as usize)
    }

    /// By id among the points of all ranks: a slot that it has here, its own or that of a copy; [`NOWHERE`](Self::NOWHERE) of who has none.
    pub(crate) fn slots_of_ids(&self) -> Vec<u32> {
        let ids = self.ids_of_all();
        let mut slots = vec![Self::NOWHERE; self.all_points()];
        let own = self.slots.iter().map(|s| *s as usize);
        // own ones after copies of them
        for slot in self.exchange.copies().chain(own) {
            slots[ids[slot] as usize] = slot as u32;
        }
        slots
    }

    /// Slots of all points that are here, their own or those of copies, in the order of ids among all.
    pub fn slots_by_id(&self) -> Vec<u32> {
        match self.subdomain() {
            None => self.slots.clone(),
            Some(_) => {
                let mut here = self.slots_of_ids();
                here.retain(|slot| *slot != Self::NOWHERE);
                here
            }
        }
    }

    /// No slot.
    pub(crate) const NOWHERE: u32 = u32::MAX;

    /// Which id among the points of all ranks who is in a slot has; those of other ranks that have no copy here are called by their ids after all slots.
    pub fn id_of(&self) -> impl Fn(usize) -> u32 + use<D> {
        let (ids, slots) = (self.ids_of_all().into_owned(), self.len);
        move |n| match n.checked_sub(slots) {
            None => ids[n],
            Some(id) => id as u32,
        }
    }

    /// The id among the points of all ranks of who is in each slot; of another rank's point in its copies, too.
    pub fn ids_of_all(&self) -> Cow<'_, [u32]> {
        match self.subdomain() {
            Some(of) => Cow::Borrowed(of.of_slots()),
            None => Cow::Owned(self.ids_by_slot()),
        }
    }
}
