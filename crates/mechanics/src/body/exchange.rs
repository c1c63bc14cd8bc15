//! Who copies from whom. A sweep finds every partner at its own place, so some slots repeat a point that lies elsewhere: the periodic images
//! of lattice bodies and, where many ranks share a body, the points of others near by ([`Subdomain`](super::Subdomain)). Nobody else knows;
//! whoever has written what partners read asks the [`Exchange`] of its body to fill the copies before the next pass.
//!
//! # What is filled before what
//!
//! | what the points have | filled before |
//! |---|---|
//! | materials, factors, constants of places and families (once they are known) | the first sweep |
//! | displacements | every sweep |
//! | velocities, strains of expansion | sweeps that end a step; every sweep |
//! | what points made of their sums (pressures, slopes of embedding, [`Material::point_update`](crate::law::material::Material::point_update)) | after each pass, before the next and the forces |
//! | what bonds remember, which the far end answers with | the forces after what they remembered changed |
//! | critical stretches, damage, integrity | the next search for bonds that break; the forces |
//!
//! A law declares what that takes by its types: the numbers of its points, of its bonds' memory, and how many passes there are.
//!
//! # What ranks must keep
//!
//! - *One fill is enough.* What a copy repeats is a point of the body, never a copy: in corners, too. Copies come in the order of their slots.
//! - *One fill is one message* to each neighbour: fields, numbers of points and memories are filled as a whole, displacements and velocities together.
//! - *Nobody waits who can work.* What needs no copies of others' points is computed while these are on their way ([`Exchange::fill_during`]): of laws on
//!   stencils all blocks but those whose bonds lead there.
//! - *All ranks fill, or none.* Whether there is a fill must follow from the model and from what all ranks know. What is left out where no bond
//!   breaks (`BondState::find_breaking`) follows from the broken bonds of all of them ([`Exchange::any`]).
//! - *Nothing is added back.* Every point gathers all its bonds, so a bond across a border is computed at both ends, from the same numbers and in the
//!   same order of operations, and the forces of a point are summed in the order of its bonds, wherever the partners are. What copies would have is not written.
//! - *Sums over the body* are those of fixed blocks, of which a rank owns whole ones. What blocks say is added without rounding
//!   ([`Exact`](crate::execute::exact::Exact)), so it shows neither in which order nor who had which. What steps add up (what sweeps report,
//!   [`Tally`](crate::interaction::Tally), and the work of what acts) stays such a sum of this rank's points, and ranks add theirs when somebody asks.
//! - *Ids and slots of originals* name the ends of bonds for whoever walks over them ([`Exchange::original`]).
//!
//! Clouds have no copies of periodic images: their lists move a partner by whole periods to where it is nearest. Lists of near atoms make theirs anew with every list
//! ([`near`](crate::family::neighbours::near)), which says what ranks need for that.

use bytemuck::{Pod, bytes_of, bytes_of_mut, cast_slice, cast_slice_mut};
use peridyne_comm::Comm;
use std::collections::BTreeMap;
use std::ops::{DerefMut, Range};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Copies that lie side by side, whose originals do, too: the first slots, and how many there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Run {
    copy: usize,
    original: usize,
    len: usize,
}

impl Run {
    /// The same so many slots further on.
    fn moved(&self, by: usize) -> Run {
        Run {
            copy: by + self.copy,
            original: by + self.original,
            len: self.len,
        }
    }
}

/// One more copy, in a later slot than all others.
fn push(runs: &mut Vec<Run>, copy: usize, original: usize) {
    let next = |r: &&mut Run| r.copy + r.len == copy && r.original + r.len == original;
    match runs.last_mut().filter(next) {
        Some(run) => run.len += 1,
        None => runs.push(Run {
            copy,
            original,
            len: 1,
        }),
    }
}

/// Slots that are copies of others, in their order.
#[derive(Debug, Clone, Default)]
pub struct Exchange {
    /// Of points that are here.
    runs: Vec<Run>,
    /// Of points that other ranks have.
    others: Option<Arc<Others>>,
}

impl Exchange {
    /// One more copy, in a later slot than all others; the original is none.
    pub(super) fn push(&mut self, copy: usize, original: usize) {
        push(&mut self.runs, copy, original);
    }

    /// Of bodies side by side, by their first slots.
    pub(super) fn joined<'a>(bodies: impl Iterator<Item = (usize, &'a Exchange)>) -> Exchange {
        let mut joined = Exchange::default();
        let mut others: Option<Joined> = None;
        for (first, of) in bodies {
            joined.runs.extend(of.runs.iter().map(|r| r.moved(first)));
            if let Some(of) = &of.others {
                others
                    .get_or_insert_with(|| Joined::none(of))
                    .push(first, of);
            }
        }
        joined.others = others.map(|all| Arc::new(all.end()));
        joined
    }

    /// Of a part of a body. All ranks come here at once.
    pub(super) fn among(comm: &Arc<Comm>, copies: Copies) -> Exchange {
        Exchange {
            others: Some(Arc::new(Others::new(comm, copies.of, copies.names))),
            runs: copies.own,
        }
    }

    /// No slot is a copy, on any rank.
    pub fn is_empty(&self) -> bool {
        self.runs.is_empty() && self.others.is_none()
    }

    /// Slots of copies with those of their originals, which are here.
    pub fn pairs(&self) -> impl Iterator<Item = (usize, usize)> {
        let each = |r: &Run| {
            let (copy, original) = (r.copy, r.original);
            (0..r.len).map(move |k| (copy + k, original + k))
        };
        self.runs.iter().flat_map(each)
    }

    /// Slots of copies, those of points that other ranks have among them.
    pub fn copies(&self) -> impl Iterator<Item = usize> {
        self.pairs().map(|(copy, _)| copy).chain(self.received())
    }

    /// Slots of copies of points that other ranks have.
    pub(crate) fn received(&self) -> impl Iterator<Item = usize> {
        let messages = { self.others.iter() }.flat_map(|o| o.receive.iter());
        messages.flat_map(|m| m.spans.iter().cloned().flatten())
    }

    /// Of a body of so many slots, in each that is a copy of another rank's point that rank.
    pub(crate) fn owners(&self, slots: usize) -> Vec<u32> {
        let mut owners = vec![0; slots];
        for message in self.others.iter().flat_map(|o| &o.receive) {
            for slot in message.spans.iter().cloned().flatten() {
                owners[slot] = message.rank as u32;
            }
        }
        owners
    }

    /// The slot that a slot is a copy of, or itself; of a point of another rank the first copy.
    #[inline]
    pub fn original(&self, slot: usize) -> usize {
        let runs = match &self.others {
            None => &self.runs,
            // most are no copies
            Some(others) if !others.is_named(slot) => return slot,
            Some(others) => &others.names,
        };
        let begun = runs.partition_point(|r| r.copy <= slot);
        let last = runs[..begun].last();
        let holds = last.filter(|r| slot < r.copy + r.len);
        holds.map_or(slot, |r| r.original + (slot - r.copy))
    }

    /// Fills the copies in a column, `[slots]`.
    pub fn fill<T: Pod>(&self, mut column: &mut [T]) {
        self.fill_during(&mut column, |column, fill| fill(column), |_| ());
    }

    fn fill_here<T: Copy>(&self, column: &mut [T]) {
        for r in &self.runs {
            column.copy_within(r.original..r.original + r.len, r.copy);
        }
    }

    /// In all columns of a field, or of what is seen of one, `[D][slots]`.
    pub fn fill_field<const D: usize>(&self, field: &mut [impl DerefMut<Target = [f64]>; D]) {
        self.fill_during(
            field,
            |field, fill| field.iter_mut().for_each(|column| fill(column)),
            |_| (),
        );
    }

    /// Fills the copies in columns of something. Where other ranks have parts of the body `work` is done with it while what they tell is on its way: copies of
    /// points that are here are filled by then, those of others are not. `each` hands out the columns, the same whenever it is asked.
    pub fn fill_during<S, T: Pod>(
        &self,
        of: &mut S,
        each: impl Fn(&mut S, &mut dyn FnMut(&mut [T])),
        work: impl FnOnce(&mut S),
    ) {
        each(of, &mut |column| self.fill_here(column));
        if let Some(others) = &self.others {
            others.fill_during(of, &each, work);
        }
    }

    /// Where each slot has so many numbers, number `n` of a slot `at(slot, n)`.
    pub fn fill_numbers<T: Pod>(
        &self,
        all: &mut [T],
        numbers: usize,
        at: impl Fn(usize, usize) -> usize,
    ) {
        for r in &self.runs {
            for n in 0..numbers {
                for k in 0..r.len {
                    all[at(r.copy + k, n)] = all[at(r.original + k, n)];
                }
            }
        }
        if let Some(others) = &self.others {
            others.fill_numbers(all, numbers, &at);
        }
    }

    /// Do other ranks have parts of the body?
    pub fn is_shared(&self) -> bool {
        self.others.is_some()
    }

    /// Is it so on any rank? All ask at once.
    pub fn any(&self, here: bool) -> bool {
        let Some(others) = &self.others else {
            return here;
        };
        let all = others.comm.all_as_long(&[u8::from(here)]);
        let all = all.unwrap_or_else(|failure| others.comm.end(failure));
        all.contains(&1)
    }

    /// Copies of points that other ranks have.
    pub fn received_slots(&self) -> usize {
        let others = self.others.as_ref();
        others.map_or(0, |o| o.receive.iter().map(|m| m.slots).sum())
    }

    pub fn bytes(&self) -> usize {
        size_of_val(&*self.runs) + self.others.as_ref().map_or(0, |o| o.bytes())
    }
}

/// Copies of a part of a body, as they are found, in the order of their slots.
pub(super) struct Copies {
    own: Vec<Run>,
    /// Of each rank: slots here, and there.
    of: Vec<Vec<(usize, usize)>>,
    names: Vec<Run>,
}

impl Copies {
    pub fn new(ranks: usize) -> Copies {
        Copies {
            own: vec![],
            of: vec![vec![]; ranks],
            names: vec![],
        }
    }

    /// A copy of a point that is here.
    pub fn own(&mut self, copy: usize, original: usize) {
        push(&mut self.own, copy, original);
        push(&mut self.names, copy, original);
    }

    /// A copy of a point that another rank has in a slot, which is called by the first copy of it.
    pub fn of_rank(&mut self, rank: usize, copy: usize, there: usize, name: usize) {
        self.of[rank].push((copy, there));
        if name != copy {
            push(&mut self.names, copy, name);
        }
    }
}

/// What one fill tells one rank, or hears of it.
#[derive(Debug)]
struct Message {
    rank: usize,
    spans: Vec<Range<usize>>,
    slots: usize,
}

impl Message {
    fn new(rank: usize, slots: impl Iterator<Item = usize>) -> Message {
        let (mut spans, mut count) = (Vec::<Range<usize>>::new(), 0);
        for slot in slots {
            count += 1;
            match spans.last_mut().filter(|span| span.end == slot) {
                Some(span) => span.end += 1,
                None => spans.push(slot..slot + 1),
            }
        }
        Message {
            rank,
            spans,
            slots: count,
        }
    }
}

/// Those of bodies side by side, one after the other.
struct Joined {
    comm: Arc<Comm>,
    send: BTreeMap<usize, Vec<usize>>,
    receive: BTreeMap<usize, Vec<usize>>,
    names: Vec<Run>,
}

impl Joined {
    fn none(like: &Others) -> Joined {
        Joined {
            comm: like.comm.clone(),
            send: BTreeMap::new(),
            receive: BTreeMap::new(),
            names: vec![],
        }
    }

    fn push(&mut self, first: usize, of: &Others) {
        for (all, of) in [(&mut self.send, &of.send), (&mut self.receive, &of.receive)] {
            for message in of {
                let slots = message.spans.iter().cloned().flatten();
                all.entry(message.rank)
                    .or_default()
                    .extend(slots.map(|s| first + s));
            }
        }
        self.names.extend(of.names.iter().map(|r| r.moved(first)));
    }

    fn end(self) -> Others {
        let messages = |all: BTreeMap<usize, Vec<usize>>| -> Vec<Message> {
            let each = all.into_iter();
            each.map(|(rank, slots)| Message::new(rank, slots.into_iter()))
                .collect()
        };
        Others {
            send: messages(self.send),
            receive: messages(self.receive),
            ..Others::named(&self.comm, self.names)
        }
    }
}

/// Points that other ranks have copies of, and copies of theirs.
#[derive(Debug)]
struct Others {
    comm: Arc<Comm>,
    send: Vec<Message>,
    receive: Vec<Message>,
    /// What every copy is called, in their order, and a bit for each slot: is it one that is called otherwise?
    names: Vec<Run>,
    named: Vec<u8>,
    /// What is sent, and what comes.
    workspace: Mutex<[Vec<u8>; 2]>,
}

impl Others {
    /// Asks the other ranks for what is wanted of each: slots here and there.
    fn new(comm: &Arc<Comm>, wanted: Vec<Vec<(usize, usize)>>, names: Vec<Run>) -> Others {
        let wishes = { wanted.iter() }.map(|of| {
            let slots = of.iter().map(|(_, there)| *there as u32);
            slots.flat_map(u32::to_le_bytes).collect()
        });
        let asked = { comm.to_each(wishes.collect()) }.unwrap_or_else(|failure| comm.end(failure));
        let slots = |bytes: &[u8]| -> Vec<usize> {
            let each = bytes.chunks_exact(4);
            each.map(|s| u32::from_le_bytes(s.try_into().expect("four bytes")) as usize)
                .collect()
        };
        let send = { asked.iter().enumerate() }
            .filter(|(_, of)| !of.is_empty())
            .map(|(rank, of)| Message::new(rank, slots(of).into_iter()));
        let receive = { wanted.iter().enumerate() }
            .filter(|(_, of)| !of.is_empty())
            .map(|(rank, of)| Message::new(rank, of.iter().map(|(here, _)| *here)));
        Others {
            send: send.collect(),
            receive: receive.collect(),
            ..Others::named(comm, names)
        }
    }

    /// Nothing is sent, but copies have these names.
    fn named(comm: &Arc<Comm>, names: Vec<Run>) -> Others {
        let end = names.last().map_or(0, |run| run.copy + run.len);
        let mut named = vec![0; end.div_ceil(8)];
        for slot in names.iter().flat_map(|run| run.copy..run.copy + run.len) {
            named[slot / 8] |= 1 << (slot % 8);
        }
        Others {
            named,
            send: vec![],
            receive: vec![],
            names,
            workspace: Mutex::default(),
            comm: comm.clone(),
        }
    }

    fn is_named(&self, slot: usize) -> bool {
        self.named
            .get(slot / 8)
            .is_some_and(|bits| bits >> (slot % 8) & 1 == 1)
    }

    /// Sends so many bytes of every slot that others want, as they are packed, and unpacks what they send. Slots lie in runs here and there that need not
    /// be alike: what is sent goes by their order alone. `work` is done meanwhile.
    fn trade<All: ?Sized>(
        &self,
        all: &mut All,
        bytes: usize,
        pack: impl Fn(&mut All, &[Range<usize>], &mut Vec<u8>),
        unpack: impl Fn(&mut All, &[Range<usize>], &[u8]),
        work: impl FnOnce(&mut All),
    ) {
        // taken, not held: another fill may wait for the same ranks
        let mut workspace = std::mem::take(&mut *self.workspace());
        let [out, into] = &mut workspace;
        out.clear();
        for message in &self.send {
            pack(all, &message.spans, out);
        }
        into.resize(self.receive.iter().map(|m| m.slots * bytes).sum(), 0);
        let mut send = Vec::with_capacity(self.send.len());
        let mut rest = &out[..];
        for message in &self.send {
            let (of, others) = rest.split_at(message.slots * bytes);
            send.push((message.rank, of));
            rest = others;
        }
        let mut receive = Vec::with_capacity(self.receive.len());
        let mut rest = &mut into[..];
        for message in &self.receive {
            let (of, others) = rest.split_at_mut(message.slots * bytes);
            receive.push((message.rank, of));
            rest = others;
        }
        let done = self.comm.exchange(&send, &mut receive, || work(all));
        done.unwrap_or_else(|failure| self.comm.end(failure));
        let mut rest = &into[..];
        for message in &self.receive {
            let (of, others) = rest.split_at(message.slots * bytes);
            unpack(all, &message.spans, of);
            rest = others;
        }
        *self.workspace() = workspace;
    }

    fn workspace(&self) -> MutexGuard<'_, [Vec<u8>; 2]> {
        self.workspace
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
    }

    /// One column after the other.
    fn fill_during<S, T: Pod>(
        &self,
        of: &mut S,
        each: &impl Fn(&mut S, &mut dyn FnMut(&mut [T])),
        work: impl FnOnce(&mut S),
    ) {
        let mut count = 0;
        each(of, &mut |_| count += 1);
        self.trade(
            of,
            count * size_of::<T>(),
            |of, spans, out| {
                each(of, &mut |column| {
                    let pieces = spans.iter().map(|span| cast_slice(&column[span.clone()]));
                    pieces.for_each(|bytes| out.extend_from_slice(bytes));
                });
            },
            |of, spans, mut from| {
                each(of, &mut |column| {
                    for span in spans {
                        let into = cast_slice_mut(&mut column[span.clone()]);
                        let (of, others) = from.split_at(into.len());
                        into.copy_from_slice(of);
                        from = others;
                    }
                });
            },
            work,
        );
    }

    /// Slot by slot.
    fn fill_numbers<T: Pod>(
        &self,
        all: &mut [T],
        numbers: usize,
        at: &dyn Fn(usize, usize) -> usize,
    ) {
        self.trade(
            all,
            numbers * size_of::<T>(),
            |all, spans, out| {
                for slot in spans.iter().cloned().flatten() {
                    for n in 0..numbers {
                        out.extend_from_slice(bytes_of(&all[at(slot, n)]));
                    }
                }
            },
            |all, spans, from| {
                let mut from = from.chunks_exact(size_of::<T>());
                for slot in spans.iter().cloned().flatten() {
                    for (n, of) in (0..numbers).zip(&mut from) {
                        bytes_of_mut(&mut all[at(slot, n)]).copy_from_slice(of);
                    }
                }
            },
            |_| (),
        );
    }

    fn bytes(&self) -> usize {
        let spans = self.send.iter().chain(&self.receive);
        let spans: usize = spans.map(|m| size_of_val(&*m.spans)).sum();
        spans + size_of_val(&*self.names) + self.named.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::{Body, view_mut, zeros};
    use crate::samples;
    use crate::space::lattice::{Lattice, LatticeKind};
    use std::collections::HashMap;

    /// All sites of a box of cells whose cell is kept, and a body of them, with halos of so many cells.
    fn body<const D: usize>(
        kind: LatticeKind,
        cells: [i32; 3],
        reach: usize,
        periodic: [bool; D],
        keep: fn([i32; 3]) -> bool,
    ) -> (Vec<[i32; 3]>, Body<D>) {
        let lattice = Lattice {
            kind,
            spacing: 0.5,
            origin: [0.0; 3],
        };
        let of_cell = |first: &[i32; 3]| {
            let first = *first;
            let site = move |q: &[i32; 3]| crate::array::from_fn(|a| first[a] + q[a]);
            kind.basis().iter().map(site)
        };
        let first = samples::sites(cells, keep);
        let sites: Vec<[i32; 3]> = first.iter().flat_map(of_cell).collect();
        let body = Body::on_lattice(lattice, &sites, reach, periodic, 1.0).unwrap();
        (sites, body)
    }

    /// Every slot is a copy of the point that is there modulo the periods, or of nobody; one fill is enough.
    fn check<const D: usize>(
        kind: LatticeKind,
        cells: [i32; 3],
        reach: usize,
        periodic: [bool; D],
        keep: fn([i32; 3]) -> bool,
    ) {
        let (sites, body) = body(kind, cells, reach, periodic, keep);
        let slots = body.slots.iter().map(|s| *s as usize);
        let point: HashMap<[i32; 3], usize> = sites.iter().copied().zip(slots).collect();
        let grid = body.grid();
        let inside = |slot: &usize| {
            let at = slot.checked_sub(grid.guard);
            let there = at.is_some_and(|i| i % grid.stride < grid.cells.iter().product());
            there && *slot < body.len - grid.guard
        };
        let from = |slot: usize| {
            let wrapped = |a: usize, q: i32| match a < D && periodic[a] {
                true => q.rem_euclid(4 * cells[a]),
                false => q,
            };
            let q = grid.quarter(slot);
            point
                .get(&crate::array::from_fn(|a| wrapped(a, q[a])))
                .copied()
        };
        let all = (0..body.len).map(|s| inside(&s).then(|| from(s)).flatten());
        let all: Vec<Option<usize>> = all.collect();
        let exchange = &body.exchange;
        let mut pairs = vec![];
        for (slot, from) in all.iter().enumerate() {
            assert_eq!(exchange.original(slot), from.unwrap_or(slot), "{kind:?}");
            pairs.extend(from.filter(|o| *o != slot).map(|o| (slot, o)));
        }
        assert_eq!(exchange.pairs().collect::<Vec<_>>(), pairs, "{kind:?}");
        assert_eq!(exchange.is_empty(), pairs.is_empty());

        // edges and corners know nothing before
        let mut ids = vec![u32::MAX; body.len];
        (0..)
            .zip(&body.slots)
            .for_each(|(n, s)| ids[*s as usize] = n);
        let own = ids.clone();
        exchange.fill(&mut ids);
        let wanted = all.iter().map(|o| o.map_or(u32::MAX, |o| own[o]));
        assert!(ids.into_iter().eq(wanted), "{kind:?}");
    }

    #[test]
    fn copies_are_images_of_points() {
        let all = |_: [i32; 3]| true;
        // with holes in corners, edges and within, the first and the last layers are still there
        let some = |c: [i32; 3]| (c[0] + 2 * c[1] + 3 * c[2]) % 5 != 2;
        for keep in [all, some] {
            check(LatticeKind::Chain, [7, 1, 1], 3, [true], keep);
            check(LatticeKind::Chain, [7, 1, 1], 3, [false], keep);
            for periodic in [[true, true], [true, false], [false, true]] {
                check(LatticeKind::Square, [6, 9, 1], 2, periodic, keep);
                check(LatticeKind::Triangular, [11, 6, 1], 3, periodic, keep);
            }
            for periodic in [[true; 3], [true, false, true], [false, false, true]] {
                check(LatticeKind::Cubic, [6, 7, 6], 2, periodic, keep);
                check(LatticeKind::Bcc, [6, 6, 8], 1, periodic, keep);
            }
        }
        // a period as long as the halo
        check(LatticeKind::Cubic, [2, 2, 3], 2, [true; 3], all);
    }

    #[test]
    fn a_chain_copies_its_ends() {
        let (_, body) = body(LatticeKind::Chain, [9, 1, 1], 3, [true], |_| true);
        let first = body.grid().guard;
        let ends = [(0, 9, 3), (12, 3, 3)].map(|(copy, original, len)| Run {
            copy: first + copy,
            original: first + original,
            len,
        });
        assert_eq!(body.exchange.runs, ends);
    }

    #[test]
    fn numbers_are_filled_wherever_they_lie() {
        let (_, body) = body(LatticeKind::Square, [5, 4, 1], 2, [true; 2], |c| {
            c != [2, 2, 0]
        });
        let (len, numbers) = (body.len, 7);
        let columns = |slot: usize, n: usize| n * (len + 5) + slot;
        let records = |slot: usize, n: usize| n / 4 * 4 * len + 4 * slot + n % 4;
        let tiles = |slot: usize, n: usize| (slot / 8 * numbers + n) * 8 + slot % 8;
        let places: [&dyn Fn(usize, usize) -> usize; 3] = [&columns, &records, &tiles];
        for at in places {
            let mut all = vec![-1.0; 9 * (len + 8)];
            for s in body.slots.iter().map(|s| *s as usize) {
                (0..numbers).for_each(|n| all[at(s, n)] = (100 * s + n) as f64);
            }
            let before = all.clone();
            body.exchange.fill_numbers(&mut all, numbers, at);
            let mut wanted = before.clone();
            for (copy, original) in body.exchange.pairs() {
                (0..numbers).for_each(|n| wanted[at(copy, n)] = (100 * original + n) as f64);
            }
            assert!(all == wanted && all != before);
        }
    }

    #[test]
    fn bodies_side_by_side_fill_their_own_parts() {
        let sheet = body(LatticeKind::Square, [5, 4, 1], 2, [true, true], |_| true).1;
        let other = body(LatticeKind::Triangular, [6, 4, 1], 1, [true, true], |c| {
            c[0] != 3
        })
        .1;
        let cloud = sheet.to_cloud().unwrap();
        assert!(cloud.exchange.is_empty());
        let all = Body::several(vec![sheet, cloud, other]);
        let copies: usize = { all.pieces().iter() }
            .map(|p| p.body.exchange.pairs().count())
            .sum();
        assert_eq!(all.exchange.pairs().count(), copies);
        for p in all.pieces() {
            for s in 0..p.body.len {
                let own = p.first + p.body.exchange.original(s);
                assert_eq!(all.exchange.original(p.first + s), own);
            }
        }
        let mut together = zeros::<2>(all.len);
        for (n, s) in all.slots.iter().enumerate() {
            together[0][*s as usize] = 1.0 + n as f64;
            together[1][*s as usize] = -1.0 - n as f64;
        }
        let mut apart = together.clone();
        all.exchange.fill_field(&mut together);
        for p in all.pieces() {
            let mut part = p.part_mut(view_mut(&mut apart));
            p.body.exchange.fill_field(&mut part);
        }
        assert!(together == apart);
        for (copy, original) in all.exchange.pairs() {
            assert!(together[0][original] > 0.0 && together[0][copy] == together[0][original]);
            assert_eq!(together[1][copy], -together[0][copy]);
        }
        // what is known of points is known of their copies
        let mut made = zeros::<2>(all.len);
        all.set_vectors(&mut made, |id, _| [1.0 + id as f64, -1.0 - id as f64]);
        assert!(made == together);
        let mut column = vec![0.0; all.len];
        all.set_points(&mut column, |slot| apart[0][slot]);
        assert!(column == *together[0]);
    }
}
