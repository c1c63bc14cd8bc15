//! Cuts bodies into the parts that ranks have.
//!
//! Ranks own whole blocks, the same ones that sums are made of, in their order: of lattices blocks of tiles, of clouds blocks of points, of several bodies those of
//! one after the other. What is near by but somebody else's is a copy, as periodic images are ([`Exchange`](super::exchange::Exchange)).
//!
//! A part of a lattice has the cells of the whole grid from one to another, in the order of memory, so that a neighbour is as many cells away as in the whole:
//! slabs across the axis that is slowest in memory, whose borders may lie within a layer. What a region says of cells one by one needs no whole body: no rank
//! has it ([`Counted`]). The same holds of several such bodies, and of clouds whose points are sites of a lattice, moved or not.

mod blocks;
mod cloud;
mod counted;
mod lattice;
mod several;

use super::{Body, Layout};
pub(super) use blocks::CELLS;
use blocks::{by_ranks, shared_out};
pub use cloud::Moved;
pub use counted::Counted;
use peridyne_comm::Comm;
use std::ops::Range;
use std::sync::Arc;

impl<const D: usize> Body<D> {
    /// The part of this body that a rank has. A cloud has copies of all within `reach` (length), a lattice those that its stencil reaches. All ranks ask at
    /// once, with the same body. Where there are fewer blocks of 256 cells with points (of 256 points of a cloud) than ranks the last ranks have no points.
    pub fn subdomain_of(&self, comm: &Arc<Comm>, reach: f64) -> Body<D> {
        self.subdomain_beside(comm, reach, &[])
    }

    /// The same, with copies of these points of several bodies besides (ids in their order), whoever has them.
    pub fn subdomain_beside(&self, comm: &Arc<Comm>, reach: f64, beside: &[u32]) -> Body<D> {
        let blocks = shared_out(&self.points_of_blocks(), comm);
        match &self.layout {
            Layout::Several(_) => self.part_of_several(&blocks, comm, reach, beside),
            Layout::Grid(_) | Layout::Cloud(_) => self.part(&blocks, comm, reach),
        }
    }

    /// How so many ranks would share this body: the most points that one has; the most copies of others' points, of the first rank, the one in the middle and
    /// the last; and ranks that have points.
    pub fn shares(&self, ranks: usize, reach: f64) -> [usize; 3] {
        let points = self.points_of_blocks();
        let blocks = by_ranks(&points, ranks);
        let of = |blocks: &Range<usize>| points[blocks.clone()].iter().sum::<usize>();
        let working = blocks.iter().take_while(|blocks| of(blocks) > 0).count();
        let seen = [0, working / 2, working - 1].map(|rank| self.copies_of(&blocks[rank], reach));
        let most = blocks.iter().map(of).max();
        [
            most.unwrap_or(0),
            seen.into_iter().max().unwrap_or(0),
            working,
        ]
    }

    /// Copies of others' points that the rank of these blocks has.
    fn copies_of(&self, blocks: &Range<usize>, reach: f64) -> usize {
        match &self.layout {
            Layout::Grid(grid) => lattice::copies_of(grid, blocks),
            Layout::Cloud(x) => {
                let x = crate::array::from_fn(|a| &x[a][..self.points()]);
                cloud::near(x, self.period, &self.slots_of_blocks(blocks), reach).len()
            }
            Layout::Several(pieces) => {
                let counts = pieces.iter().map(|p| p.body.points_of_blocks().len());
                let own = several::of_each(counts, std::slice::from_ref(blocks));
                let each = pieces.iter().zip(own).map(|(p, own)| match &own[0] {
                    none if none.is_empty() => 0,
                    own => p.body.copies_of(own, reach),
                });
                each.sum()
            }
        }
    }

    /// The part with its rank's blocks, of those of all ranks.
    fn part(&self, blocks: &[Range<usize>], comm: &Arc<Comm>, reach: f64) -> Body<D> {
        match &self.layout {
            Layout::Grid(grid) => self.part_of_lattice(grid, blocks, comm),
            Layout::Cloud(x) => self.part_of_cloud(x, blocks, comm, reach),
            Layout::Several(_) => self.part_of_several(blocks, comm, reach, &[]),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::body::{Body, Values};
    use crate::samples;
    use crate::space::lattice::{Lattice, LatticeKind};
    use peridyne_comm::on_threads;
    use std::collections::BTreeMap;
    use std::sync::Arc;

    /// On so many ranks every point is somebody's, and after one fill whoever is near enough to be a partner is there with what is its own.
    fn check<const D: usize>(
        kind: LatticeKind,
        cells: [i32; 3],
        reach: usize,
        periodic: [bool; D],
        keep: fn([i32; 3]) -> bool,
    ) {
        let lattice = Lattice {
            kind,
            spacing: 0.5,
            origin: [0.1; 3],
        };
        let sites: Vec<[i32; 3]> = { samples::sites(cells, keep).into_iter() }
            .flat_map(|first| {
                let site = move |q: &[i32; 3]| crate::array::from_fn(|a| first[a] + q[a]);
                kind.basis().iter().map(site)
            })
            .collect();
        let mut whole = Body::on_lattice(lattice, &sites, reach, periodic, 1.0).unwrap();
        whole.set_marks((0..sites.len() as i32).collect());
        whole.give_materials((0..sites.len()).map(|id| (id % 7) as u8));
        let densities: Vec<f64> = (0..sites.len()).map(|id| 1.0 + id as f64).collect();
        whole.set_densities(&densities);
        let mut ids = vec![u32::MAX; whole.len];
        (0..)
            .zip(&whole.slots)
            .for_each(|(id, slot)| ids[*slot as usize] = id);
        whole.exchange.fill(&mut ids);
        let points = whole.points_of_blocks();
        let most = points.iter().filter(|n| **n > 0).count();
        let name = format!("{kind:?} {periodic:?}");
        assert!(most >= 3, "{name} {most}");
        for ranks in [1, 2, 3, most, most + 2] {
            let seen = on_threads(ranks, |comm| {
                let part = whole.subdomain_of(&Arc::new(comm), 0.0);
                let of = part.subdomain().unwrap();
                assert_eq!(of.points(), sites.len());
                let mut here = vec![u32::MAX; part.len];
                let mut field = crate::body::zeros::<D>(part.len);
                let mut records = vec![0u8; 3 * part.len];
                for (n, (id, slot)) in of.ids().iter().zip(&part.slots).enumerate() {
                    let slot = *slot as usize;
                    here[slot] = *id;
                    field[D - 1][slot] = f64::from(*id);
                    records[3 * slot + 2] = *id as u8;
                    assert_eq!(part.mark[n], *id as i32);
                    assert_eq!(part.density.at(slot), densities[*id as usize]);
                    assert_eq!(
                        part.position(slot),
                        whole.position(whole.slots[*id as usize] as usize)
                    );
                }
                part.exchange.fill(&mut here);
                part.exchange.fill_field(&mut field);
                part.exchange
                    .fill_numbers(&mut records, 3, |slot, n| 3 * slot + n);
                let grid = part.grid();
                let mut first = BTreeMap::new();
                for slot in grid.guard..grid.slots() - grid.guard {
                    let (b, cell) = grid.place(slot);
                    let id = ids[whole.grid().guard + b * whole.grid().stride + cell];
                    assert_eq!(
                        here[slot],
                        id,
                        "{name}, rank {} of {ranks}",
                        of.comm().rank()
                    );
                    assert_eq!(grid.is_present(slot), id != u32::MAX);
                    if id == u32::MAX {
                        continue;
                    }
                    assert_eq!(field[D - 1][slot], f64::from(id));
                    assert_eq!(records[3 * slot + 2], id as u8);
                    assert_eq!(part.material[slot], (id % 7) as u8);
                    // one point has one name, and it is its own slot where it has one
                    let own = of.ids().binary_search(&id).map(|n| part.slots[n] as usize);
                    let name = *first.entry(id).or_insert(own.unwrap_or(slot));
                    assert_eq!(part.exchange.original(slot), name);
                }
                let copies =
                    whole.copies_of(&super::by_ranks(&points, ranks)[of.comm().rank()], 0.0);
                let present =
                    (grid.guard..grid.slots() - grid.guard).filter(|s| grid.is_present(*s));
                assert_eq!(copies, present.count() - part.slots.len());
                assert!(whole.shares(ranks, 0.0)[0] >= part.slots.len());
                // all of whom anybody here may be bonded to
                for slot in &part.slots {
                    let (cell, b) = grid.cell(*slot as usize);
                    let (there, _) = whole.grid().cell(
                        whole.grid().guard + b * whole.grid().stride + grid.place(*slot as usize).1,
                    );
                    assert_eq!(cell, there);
                    for a in 0..D {
                        for d in [-(reach as i64), reach as i64] {
                            let mut to = cell;
                            to[a] += d;
                            for b in 0..grid.basis() {
                                assert_eq!(
                                    grid.slot(to, b).is_some_and(|s| grid.is_present(s)),
                                    whole
                                        .grid()
                                        .slot(to, b)
                                        .is_some_and(|s| whole.grid().is_present(s)),
                                );
                            }
                        }
                    }
                }
                of.ids().to_vec()
            });
            let mut seen = seen.concat();
            seen.sort_unstable();
            assert!(seen.into_iter().eq(0..sites.len() as u32), "{name}");
        }
        assert!(matches!(whole.density, Values::PerSlot(_)));
    }

    #[test]
    fn points_are_of_one_rank_and_near_ones_are_there() {
        let all = |_: [i32; 3]| true;
        let some = |c: [i32; 3]| (c[0] + 2 * c[1] + 3 * c[2]) % 5 != 2 && (c[1] - 9).abs() > 3;
        for periodic in [[true], [false]] {
            check(LatticeKind::Chain, [2600, 1, 1], 3, periodic, all);
        }
        for keep in [all, some] {
            for periodic in [[true, true], [true, false], [false, true]] {
                check(LatticeKind::Square, [41, 60, 1], 3, periodic, keep);
                check(LatticeKind::Triangular, [31, 57, 1], 2, periodic, keep);
            }
            for periodic in [[true; 3], [false, true, true], [true, true, false]] {
                check(LatticeKind::Cubic, [9, 13, 14], 2, periodic, keep);
                check(LatticeKind::Bcc, [9, 13, 9], 2, periodic, keep);
            }
        }
    }
}
