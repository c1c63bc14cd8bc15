//! Who copies from whom. A sweep finds every partner at its own place, so some slots repeat a point that lies elsewhere: today the
//! periodic images of lattice bodies, later, of a body in parts on many ranks, also the points of other parts near by. Nobody else knows;
//! whoever has written what partners read asks the [`Exchange`] of its body to fill the copies before the next pass.
//!
//! # What is filled before what
//!
//! | what the points have | filled before |
//! |---|---|
//! | materials, factors, constants of places and families (once they are known) | the first sweep |
//! | displacements | every sweep |
//! | velocities, strains of expansion | sweeps that end a step; every sweep |
//! | what points made of their sums (pressures, slopes of embedding, [`Material::settle`](crate::law::material::Material::settle)) | after each pass, before the next and the forces |
//! | what bonds remember, which the far end answers with | the forces after what they remembered changed |
//! | critical stretches, damage, integrity | the next search for bonds that break; the forces |
//!
//! A law declares what that takes by its types: the numbers of its points, of its bonds' memory, and how many passes there are.
//!
//! # What ranks must keep
//!
//! - *One fill is enough.* What a copy repeats is a point of the body, never a copy: in corners, too. Copies come in the order of their slots.
//! - *One fill is one message* to each neighbour: fields, numbers of points and memories are filled as a whole.
//! - *All ranks fill, or none.* Whether there is a fill must follow from the model and from what all ranks know. What is left out where no bond
//!   breaks (`BondState::find_breaking`, `StencilInteraction::settled`) has to follow from the broken bonds of all of them.
//! - *Nothing is added back.* Every point gathers all its bonds, so a bond across a border is computed at both ends, from the same numbers and in the
//!   same order of operations, and the forces of a point are summed in the order of its bonds, wherever the partners are. What copies would have is not written.
//! - *Sums over the body* (energies, tallies, products of vectors) are those of fixed blocks, in the order of the blocks of the whole body: a rank owns whole
//!   blocks, and their results are added by their numbers, not rank by rank.
//! - *Ids and slots of originals* name the ends of bonds for whoever walks over them ([`Exchange::original`]).
//!
//! Lists of clouds have no copies yet: they move a partner by whole periods to where it is nearest. Lists of near atoms make theirs anew with every list
//! ([`near`](crate::family::neighbours::near)), which says what ranks need for that.

use std::ops::DerefMut;

/// Copies that lie side by side, whose originals do, too: the first slots, and how many there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Run {
    copy: usize,
    original: usize,
    len: usize,
}

/// Slots that are copies of others, in their order.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Exchange {
    runs: Vec<Run>,
}

impl Exchange {
    /// One more copy, in a later slot than all others; the original is none.
    pub(super) fn push(&mut self, copy: usize, original: usize) {
        let next = |r: &&mut Run| r.copy + r.len == copy && r.original + r.len == original;
        match self.runs.last_mut().filter(next) {
            Some(run) => run.len += 1,
            None => self.runs.push(Run {
                copy,
                original,
                len: 1,
            }),
        }
    }

    /// Of bodies side by side, by their first slots.
    pub(super) fn joined<'a>(bodies: impl Iterator<Item = (usize, &'a Exchange)>) -> Exchange {
        let shifted = |(first, of): (usize, &'a Exchange)| {
            of.runs.iter().map(move |r| Run {
                copy: first + r.copy,
                original: first + r.original,
                len: r.len,
            })
        };
        Exchange {
            runs: bodies.flat_map(shifted).collect(),
        }
    }

    /// No slot is a copy.
    pub fn is_empty(&self) -> bool {
        self.runs.is_empty()
    }

    /// Slots of copies with those of their originals.
    pub fn pairs(&self) -> impl Iterator<Item = (usize, usize)> {
        let each = |r: &Run| {
            let (copy, original) = (r.copy, r.original);
            (0..r.len).map(move |k| (copy + k, original + k))
        };
        self.runs.iter().flat_map(each)
    }

    /// The slot that a slot is a copy of, or itself.
    #[inline]
    pub fn original(&self, slot: usize) -> usize {
        let begun = self.runs.partition_point(|r| r.copy <= slot);
        let last = self.runs[..begun].last();
        let holds = last.filter(|r| slot < r.copy + r.len);
        holds.map_or(slot, |r| r.original + (slot - r.copy))
    }

    /// Fills the copies in a column, `[slots]`.
    pub fn fill<T: Copy>(&self, column: &mut [T]) {
        for r in &self.runs {
            column.copy_within(r.original..r.original + r.len, r.copy);
        }
    }

    /// In all columns of a field, or of what is seen of one, `[D][slots]`.
    pub fn fill_field<const D: usize>(&self, field: &mut [impl DerefMut<Target = [f64]>; D]) {
        field.iter_mut().for_each(|column| self.fill(column));
    }

    /// Where each slot has so many numbers, number `n` of a slot `at(slot, n)`.
    pub fn fill_numbers<T: Copy>(
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
    }

    pub fn bytes(&self) -> usize {
        size_of_val(&*self.runs)
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
