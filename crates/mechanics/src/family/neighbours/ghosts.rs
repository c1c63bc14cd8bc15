//! Points of other ranks that are near now (ghosts), whatever they were in the reference.
//!
//! Whenever a list is made, each rank says in which cells of a grid that all ranks share, and in those around them, it has points; who has points there sends
//! them. Space is wound up as for the list ([rings](super::rings)), so debris is found wherever it flies. Of all that came those stay that are listed;
//! these tell where they are at every step. Ghosts follow the slots of the body: the nth is at `len + n`.

use super::rings::{FULL, cell_at, each_around, each_point, number, wind};
use crate::body::{Body, Field, FieldView};
use crate::space::Point;
use bytemuck::{Pod, Zeroable, cast_slice, pod_read_unaligned};
use peridyne_comm::Comm;
use std::borrow::Cow;
use std::sync::Arc;

/// Cells that all ranks know of, at most: they tell each other which ones they have.
const CELLS: usize = 1 << 18;

/// In place of a slot where there is none.
const NOBODY: u32 = u32::MAX;

/// A point of another rank.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub(crate) struct Ghost {
    /// Its place among all points, in the order of slots of the whole.
    pub order: u64,
    /// In the reference (lengths), padded to three components.
    pub position: [f64; 3],
    /// Its displacement when the list was made, padded.
    displacement: [f64; 3],
    /// Among all points.
    pub id: u64,
}

// SAFETY, both: numbers without gaps between them, and all bits are some
unsafe impl Zeroable for Ghost {}
unsafe impl Pod for Ghost {}

/// The cells that all ranks know of.
#[derive(Debug, Clone)]
struct Rings<const D: usize> {
    count: [usize; D],
    length: [f64; D],
}

impl<const D: usize> Rings<D> {
    /// All ranks come here at once.
    fn new(body: &Body<D>, reach: f64) -> Rings<D> {
        let mut bounds = [[f64::INFINITY, f64::NEG_INFINITY]; D];
        each_point(body, |_, x| {
            for a in 0..D {
                bounds[a] = [bounds[a][0].min(x[a]), bounds[a][1].max(x[a])];
            }
        });
        // a little wider than the reach, for the round-off of points far out
        let edge = reach * (1.0 + 1e-6);
        let cells = |x: f64| (x / edge).min(1e9) as usize;
        let (mut count, mut length) = ([0; D], [0.0; D]);
        for a in 0..D {
            let [low, high] = [body.least(bounds[a][0]), body.most(bounds[a][1])];
            (count[a], length[a]) = match body.period[a] {
                Some(period) => (cells(period).max(1), period),
                None => {
                    let count = cells(high - low) + 3;
                    (count, count as f64 * edge)
                }
            };
        }
        while count.iter().fold(1usize, |n, c| n.saturating_mul(*c)) > CELLS {
            let Some(widest) = (0..D).max_by_key(|a| count[*a]) else {
                break;
            };
            count[widest] = count[widest].div_ceil(2);
        }
        Rings { count, length }
    }

    fn cell(&self, x: [f64; D]) -> [usize; D] {
        let place = crate::array::from_fn(|a| wind(x[a] * (FULL / self.length[a])));
        cell_at(self.count, &place)
    }

    fn number(&self, cell: [usize; D]) -> usize {
        number(self.count, cell)
    }
}

/// Some of the cells of rings, a bit each.
struct Marked(Vec<u32>);

impl Marked {
    fn none<const D: usize>(rings: &Rings<D>) -> Marked {
        let cells: usize = rings.count.iter().product();
        Marked(vec![0; cells.div_ceil(32)])
    }

    fn mark(&mut self, cell: usize) {
        self.0[cell / 32] |= 1 << (cell % 32);
    }

    fn has(&self, cell: usize) -> bool {
        self.0[cell / 32] >> (cell % 32) & 1 == 1
    }

    /// Words in which any cell is marked, with their places.
    fn sparse(&self) -> Vec<[u32; 2]> {
        let filled = self.0.iter().enumerate().filter(|(_, word)| **word != 0);
        filled.map(|(n, word)| [n as u32, *word]).collect()
    }
}

/// Points of other ranks that are near now.
#[derive(Debug, Clone)]
pub(crate) struct Ghosts<const D: usize> {
    /// `None`: there are no other ranks, or no list was made.
    ranks: Option<Arc<Comm>>,
    rings: Option<Rings<D>>,
    all: Vec<Ghost>,
    /// `[D][ghosts]`: where they are now, less where they were in the reference.
    u: [Vec<f64>; D],
    /// Where a copy of theirs lies here, of those near in the reference.
    copy: Vec<u32>,
    /// Of each rank that sends or is sent anything: slots of what goes there, and the number of ghosts that are its points.
    traffic: Vec<Traffic>,
}

#[derive(Debug, Clone)]
struct Traffic {
    rank: usize,
    send: Vec<u32>,
    receive: usize,
}

impl<const D: usize> Default for Ghosts<D> {
    fn default() -> Self {
        Ghosts {
            ranks: None,
            rings: None,
            all: vec![],
            u: crate::array::from_fn(|_| vec![]),
            copy: vec![],
            traffic: vec![],
        }
    }
}

impl<const D: usize> Ghosts<D> {
    /// Do other ranks have points, as far as [`find`](Self::find) saw?
    pub fn is_shared(&self) -> bool {
        self.ranks.is_some()
    }

    /// Is it so on any rank? All come here at once.
    pub fn any(&self, here: bool) -> bool {
        let Some(comm) = &self.ranks else {
            return here;
        };
        let all = comm.all_as_long(&[u8::from(here)]);
        all.unwrap_or_else(|failure| comm.end(failure)).contains(&1)
    }

    /// Takes all of other ranks that may be within `reach` (length) of points that are here, at these displacements. All ranks come here at once.
    pub fn find(&mut self, body: &Body<D>, u: FieldView<D>, reach: f64) {
        let Some(of) = body.subdomain().filter(|of| of.comm().ranks() > 1) else {
            return;
        };
        let comm = of.comm();
        self.ranks = Some(comm.clone());
        let rings = self.rings.get_or_insert_with(|| Rings::new(body, reach));
        let mut own = Marked::none(rings);
        each_point(body, |slot, x| {
            let now = crate::array::from_fn(|a| x[a] + u[a][slot]);
            own.mark(rings.number(rings.cell(now)));
        });
        let mut wanted = Marked::none(rings);
        for cell in (0..rings.count.iter().product()).filter(|c| own.has(*c)) {
            let mut rest = cell;
            let at = rings.count.map(|n| {
                let c = rest % n;
                rest /= n;
                c
            });
            each_around(rings.count, at, |near| wanted.mark(near));
        }
        let wishes = body.all_of(&wanted.sparse());
        // of each of the own cells that anybody wants: who
        let mut wanting: Vec<Vec<u32>> = vec![vec![]; own.0.len()];
        for (rank, words) in wishes.into_iter().enumerate() {
            for [n, word] in words {
                if rank != comm.rank() && own.0[n as usize] & word != 0 {
                    wanting[n as usize].extend([rank as u32, word]);
                }
            }
        }
        let mut slots: Vec<Vec<u32>> = vec![vec![]; comm.ranks()];
        each_point(body, |slot, x| {
            let now = crate::array::from_fn(|a| x[a] + u[a][slot]);
            let cell = rings.number(rings.cell(now));
            for of in wanting[cell / 32].chunks_exact(2) {
                if of[1] >> (cell % 32) & 1 == 1 {
                    slots[of[0] as usize].push(slot as u32);
                }
            }
        });
        let ids = of.of_slots();
        let ghost = |slot: &u32| {
            let slot = *slot as usize;
            Ghost {
                order: body.order(slot),
                position: body.position(slot),
                displacement: std::array::from_fn(|a| if a < D { u[a][slot] } else { 0.0 }),
                id: u64::from(ids[slot]),
            }
        };
        let own = slots.iter().map(|slots| {
            let all: Vec<Ghost> = slots.iter().map(ghost).collect();
            cast_slice(&all).to_vec()
        });
        let came = { comm.to_each(own.collect()) }.unwrap_or_else(|failure| comm.end(failure));
        self.all.clear();
        self.traffic.clear();
        for (rank, (bytes, send)) in came.into_iter().zip(slots).enumerate() {
            let each = bytes.chunks_exact(size_of::<Ghost>());
            let receive = each.len();
            self.all.extend(each.map(pod_read_unaligned::<Ghost>));
            if receive + send.len() > 0 {
                self.traffic.push(Traffic {
                    rank,
                    send,
                    receive,
                });
            }
        }
        let all = &self.all;
        self.u = crate::array::from_fn(|a| all.iter().map(|g| g.displacement[a]).collect());
        let mut copies: Vec<(u32, u32)> = { body.exchange.copies() }
            .map(|slot| (ids[slot], slot as u32))
            .collect();
        copies.sort_unstable();
        let copy = |ghost: &Ghost| {
            let id = ghost.id as u32;
            let first = copies.partition_point(|(of, _)| *of < id);
            let found = copies.get(first).filter(|(of, _)| *of == id);
            found.map_or(NOBODY, |(_, slot)| *slot)
        };
        self.copy = all.iter().map(copy).collect();
    }

    /// Of all ghosts those for which `listed` is true; the others are forgotten by those who sent them. What ghosts are called now, by what they were called;
    /// all ranks come here at once.
    pub fn keep(&mut self, listed: &[bool]) -> Vec<u32> {
        let Some(comm) = self.ranks.clone() else {
            return vec![];
        };
        let mut left = 0..;
        let kept = listed.iter().map(|l| if *l { left.next() } else { None });
        let now = kept.map(|n: Option<u32>| n.unwrap_or(NOBODY)).collect();
        let mut wishes = vec![vec![]; comm.ranks()];
        let mut rest = listed;
        for of in &self.traffic {
            let (own, others) = rest.split_at(of.receive);
            wishes[of.rank] = own.iter().map(|l| u8::from(*l)).collect();
            rest = others;
        }
        let wanted = comm
            .to_each(wishes)
            .unwrap_or_else(|failure| comm.end(failure));
        let mut rest = listed;
        for of in &mut self.traffic {
            let mut wanted = wanted[of.rank].iter();
            of.send.retain(|_| wanted.next() == Some(&1));
            let (own, others) = rest.split_at(of.receive);
            of.receive = own.iter().filter(|l| **l).count();
            rest = others;
        }
        self.traffic.retain(|of| of.receive + of.send.len() > 0);
        fn stay<T>(all: &mut Vec<T>, listed: &[bool]) {
            let mut listed = listed.iter();
            all.retain(|_| listed.next() == Some(&true));
            all.shrink_to_fit();
        }
        stay(&mut self.all, listed);
        stay(&mut self.copy, listed);
        self.u.iter_mut().for_each(|u| stay(u, listed));
        now
    }

    /// Where they are now, at these displacements of the points that are here. All ranks come here at once.
    pub fn follow(&mut self, u: FieldView<D>) {
        let now = self.ask(|slot| std::array::from_fn(|a| if a < D { u[a][slot] } else { 0.0 }));
        for (n, x) in now.into_iter().enumerate() {
            let x: [f64; 3] = x;
            (0..D).for_each(|a| self.u[a][n] = x[a]);
        }
    }

    /// What those who have them say of them, by their slots there. All ranks come here at once.
    pub fn ask<T: Pod>(&self, of: impl Fn(usize) -> T) -> Vec<T> {
        let Some(comm) = self.ranks.as_ref().filter(|_| !self.traffic.is_empty()) else {
            return vec![];
        };
        let said = |slots: &Vec<u32>| slots.iter().map(|slot| of(*slot as usize)).collect();
        let out: Vec<Vec<T>> = self.traffic.iter().map(|of| said(&of.send)).collect();
        let mut all = vec![T::zeroed(); self.all.len()];
        let mut rest = &mut all[..];
        let (mut send, mut receive) = (vec![], vec![]);
        for (of, out) in self.traffic.iter().zip(&out) {
            let (into, others) = rest.split_at_mut(of.receive);
            rest = others;
            if !out.is_empty() {
                send.push((of.rank, cast_slice(out)));
            }
            if !into.is_empty() {
                receive.push((of.rank, bytemuck::cast_slice_mut(into)));
            }
        }
        let done = comm.exchange(&send, &mut receive, || ());
        done.unwrap_or_else(|failure| comm.end(failure));
        all
    }

    /// Displacements of points by slot, and of ghosts after them.
    pub fn after<'a>(&self, u: FieldView<'a, D>) -> [Cow<'a, [f64]>; D] {
        crate::array::from_fn(|a| match self.all.is_empty() {
            true => Cow::Borrowed(u[a]),
            false => Cow::Owned([u[a], &self.u[a]].concat()),
        })
    }

    pub fn all(&self) -> &[Ghost] {
        &self.all
    }

    /// The ghost that a number in a list is, if it is none of a slot.
    #[inline]
    pub fn of(&self, body: &Body<D>, n: usize) -> Option<&Ghost> {
        n.checked_sub(body.len).map(|n| &self.all[n])
    }

    /// What who has a number in a list [is called](Body::id_of).
    #[inline]
    pub fn name(&self, body: &Body<D>, n: usize) -> usize {
        self.of(body, n)
            .map_or(n, |ghost| body.len + ghost.id as usize)
    }

    /// Reference position of who has a number in a list, padded to three components.
    pub fn position(&self, body: &Body<D>, n: usize) -> Point {
        match self.of(body, n) {
            None => body.position(n),
            Some(ghost) => ghost.position,
        }
    }

    /// Displacement of who has a number in a list.
    #[inline(always)]
    pub fn displacement(&self, u: &Field<D>, n: usize) -> [f64; D] {
        match n.checked_sub(u[0].len()) {
            None => crate::array::from_fn(|a| u[a][n]),
            Some(n) => crate::array::from_fn(|a| self.u[a][n]),
        }
    }

    /// Where it lies among the slots as a copy, if it is near in the reference.
    pub fn copy(&self, n: usize) -> Option<usize> {
        let copy = self.copy[n];
        (copy != NOBODY).then_some(copy as usize)
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let sent = self.traffic.iter().map(|of| 4 * of.send.capacity());
        size_of::<Ghost>() * self.all.capacity()
            + 4 * self.copy.capacity()
            + 8 * self.u.iter().map(Vec::capacity).sum::<usize>()
            + sent.sum::<usize>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::view;
    use crate::family::neighbours::{Neighbours, periods};
    use crate::samples::{Random, lattice, sites};
    use crate::space::lattice::LatticeKind;
    use peridyne_comm::on_threads;

    /// Ids of the partners of each point that is here, in the order in which it meets them.
    fn met<const D: usize>(body: &Body<D>, moved: &[[f64; D]], reach: f64) -> Vec<(u32, Vec<u32>)> {
        let ids = body.ids_of_all();
        let of = |slot: usize| ids[slot];
        let mut u = body.at_rest();
        body.set_vectors(&mut u, |_, slot| moved[of(slot) as usize]);
        let mut list = Neighbours::new(body, 0.8 * reach, 0.2 * reach);
        let mut ghosts = Ghosts::default();
        // family is left out
        let keep = |i: usize, j: usize| {
            let (p, q) = (body.position(i), body.position(j));
            let xi: [f64; D] = crate::array::from_fn(|a| q[a] - p[a]);
            let back = periods(body, &xi);
            (0..D).map(|a| (xi[a] - back[a]).powi(2)).sum::<f64>() > 1.01
        };
        assert!(list.update(body, &mut ghosts, view(&u), &keep));
        ghosts.follow(view(&u));
        let id = |n: usize| match ghosts.of(body, n) {
            None => of(n),
            Some(ghost) => ghost.id as u32,
        };
        let mut partners = vec![vec![]; body.len];
        let mut listed = vec![false; ghosts.all().len()];
        for (i, row) in list.rows() {
            for j in row.iter().map(|j| *j as usize) {
                for (at, other) in [(i, j), (j, i)] {
                    match at.checked_sub(body.len) {
                        None => partners[at].push(id(other)),
                        Some(ghost) => listed[ghost] = true,
                    }
                }
            }
        }
        assert!(listed.iter().all(|l| *l), "who is not listed is not kept");
        for n in body.len..body.len + listed.len() {
            assert_eq!(ghosts.displacement(&u, n), moved[id(n) as usize]);
        }
        let numbers = ghosts.ask(of);
        assert!({ numbers.iter().zip(ghosts.all()) }.all(|(id, g)| u64::from(*id) == g.id));
        let own = body.slots.iter().map(|s| *s as usize);
        own.map(|s| (of(s), partners[s].clone())).collect()
    }

    fn check<const D: usize>(kind: LatticeKind, cells: [i32; 3], periodic: [bool; D], far: f64) {
        let sites = sites(cells, |_| true);
        let (body, _) = lattice::<D>(kind, &sites, 0.5, 2, periodic);
        let mut random = Random(11);
        let place = |_| crate::array::from_fn(|_| far * random.next());
        let moved: Vec<[f64; D]> = (0..body.points()).map(place).collect();
        let one = met(&body, &moved, 0.7);
        assert!(one.iter().map(|(_, p)| p.len()).sum::<usize>() > body.points() / 8);
        for ranks in [2, 3, 40] {
            let parts = on_threads(ranks, |comm| {
                let part = body.subdomain_of(&Arc::new(comm), 0.0);
                met(&part, &moved, 0.7)
            });
            let mut all = parts.concat();
            all.sort_unstable();
            assert!(all == one, "{kind:?}, {ranks} ranks");
        }
    }

    #[test]
    fn points_meet_the_same_ones_in_the_same_order_whoever_has_them() {
        check::<1>(LatticeKind::Chain, [900, 1, 1], [false], 40.0);
        check::<2>(LatticeKind::Square, [30, 40, 1], [false, true], 6.0);
        check::<3>(LatticeKind::Cubic, [9, 10, 11], [false; 3], 2.0);
        check::<3>(LatticeKind::Cubic, [9, 10, 11], [true, false, true], 1.0);
    }
}
