//! The part of a lattice that a rank has, of a whole body, or of a region of which no rank has all sites.

use super::blocks::CELLS;
use crate::body::exchange::{Copies, Exchange};
use crate::body::grid::Ends;
use crate::body::subdomain::{Subdomain, numbers};
use crate::body::{Body, Grid, Values};
use crate::error::BuildError;
use crate::execute::lane::TILE;
use crate::space::fill::Search;
use bytemuck::cast_slice;
use peridyne_comm::Comm;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

/// Cells of the whole grid, of each sublattice: those whose points a rank owns, and those that it has.
struct Share {
    own: Range<usize>,
    near: Range<usize>,
}

impl Share {
    /// Of all ranks, that have these blocks.
    fn of_blocks<const D: usize>(grid: &Grid<D>, blocks: &[Range<usize>]) -> Vec<Share> {
        let reach = grid.guard - TILE;
        let share = |of: &Range<usize>| {
            let own = of.start * CELLS..(of.end * CELLS).min(grid.stride);
            let near = match own.is_empty() {
                true => 0..0,
                false => own.start.saturating_sub(reach)..(own.end + reach).min(grid.stride),
            };
            Share { own, near }
        };
        blocks.iter().map(share).collect()
    }

    /// The grid of the rank that has it, of a whole one where `holds` says which sites of which cells (by their places in order) have points.
    fn grid<const D: usize>(
        &self,
        whole: &Grid<D>,
        holds: &dyn Fn(usize, usize) -> bool,
    ) -> Grid<D> {
        let cells: usize = whole.cells().iter().product();
        let tiles = whole.basis() * self.near.len() / TILE;
        let mut grid = Grid {
            first: self.near.start,
            stride: self.near.len(),
            present: vec![0; tiles],
            owned: vec![0; tiles],
            ..*whole
        };
        for b in 0..whole.basis() {
            for cell in self.near.start..self.near.end.min(cells) {
                let home = whole.original(cell);
                if !holds(b, home) {
                    continue;
                }
                let i = b * self.near.len() + cell - self.near.start;
                grid.present[i / TILE] |= 1 << (i % TILE);
                if home == cell && self.own.contains(&cell) {
                    grid.owned[i / TILE] |= 1 << (i % TILE);
                }
            }
        }
        grid
    }

    /// The slot of a site of a cell that the rank has.
    fn slot<const D: usize>(&self, whole: &Grid<D>, (b, cell): (usize, usize)) -> usize {
        whole.guard + b * self.near.len() + cell - self.near.start
    }

    /// What slots of the part have of what those of the whole have; nothing where that is nothing.
    fn gathered<const D: usize, T: Copy>(&self, whole: &Grid<D>, all: &[T]) -> Vec<T> {
        // guards have what the first one has
        let Some(guard) = all.first() else {
            return vec![];
        };
        let basis = whole.basis();
        let mut part = vec![*guard; 2 * whole.guard + basis * self.near.len()];
        for b in 0..basis {
            let from = whole.guard + b * whole.stride;
            let from = &all[from + self.near.start..from + self.near.end];
            let to = whole.guard + b * self.near.len();
            part[to..to + from.len()].copy_from_slice(from);
        }
        part
    }
}

/// Copies of others' points that the rank of these blocks of a whole grid has.
pub(super) fn copies_of<const D: usize>(whole: &Grid<D>, blocks: &Range<usize>) -> usize {
    let share = &Share::of_blocks(whole, std::slice::from_ref(blocks))[0];
    let part = share.grid(whole, &|b, cell| whole.is_owned(whole.slot_of(b, cell)));
    let bits = |of: &[u8]| of.iter().map(|b| b.count_ones() as usize).sum::<usize>();
    bits(&part.present) - bits(&part.owned)
}

/// Who is there, but is not this rank's.
fn copies<const D: usize>(whole: &Grid<D>, grid: &Grid<D>, all: &[Share], rank: usize) -> Copies {
    let mut copies = Copies::new(all.len());
    let mut named = HashMap::new();
    for slot in grid.guard..grid.slots() - grid.guard {
        if grid.is_owned(slot) || !grid.is_present(slot) {
            continue;
        }
        let (b, cell) = grid.place(slot);
        let place = (b, whole.original(cell));
        let owner = all.partition_point(|share| share.own.end <= place.1);
        let there = all[owner].slot(whole, place);
        match owner == rank {
            true => copies.own(slot, there),
            false => copies.of_rank(owner, slot, there, *named.entry(place).or_insert(slot)),
        }
    }
    copies
}

/// The part of a rank: a body of points that are alike.
struct Part<'a, const D: usize> {
    whole: &'a Grid<D>,
    shares: &'a [Share],
    comm: &'a Arc<Comm>,
    period: [Option<f64>; D],
    volume: f64,
}

impl<const D: usize> Part<'_, D> {
    /// With its own of so many points, their ids and slots in order of ids; `holds` as of [`Share::grid`].
    fn body(
        &self,
        points: usize,
        (ids, slots): (Vec<u32>, Vec<u32>),
        holds: &dyn Fn(usize, usize) -> bool,
    ) -> Body<D> {
        let share = &self.shares[self.comm.rank()];
        let grid = share.grid(self.whole, holds);
        let copies = copies(self.whole, &grid, self.shares, self.comm.rank());
        let exchange = Exchange::among(self.comm, copies);
        let mut of_slots = vec![0; grid.slots()];
        { ids.iter().zip(&slots) }.for_each(|(id, slot)| of_slots[*slot as usize] = *id);
        exchange.fill(&mut of_slots);
        let subdomain = Subdomain::new(self.comm, ids, of_slots, points);
        Body {
            subdomain: Some(Arc::new(subdomain)),
            ..Body::of_grid(grid, slots, exchange, self.period, self.volume)
        }
    }
}

impl<const D: usize> Body<D> {
    pub(super) fn part_of_lattice(
        &self,
        whole: &Grid<D>,
        blocks: &[Range<usize>],
        comm: &Arc<Comm>,
    ) -> Body<D> {
        let shares = &Share::of_blocks(whole, blocks);
        let share = &shares[comm.rank()];
        let all = { (0..).zip(&self.slots) }.map(|(id, s)| (id, whole.place(*s as usize)));
        let own = all.filter(|(_, place)| share.own.contains(&place.1));
        let own = own.map(|(id, place)| (id, share.slot(whole, place) as u32));
        let part = Part {
            whole,
            shares,
            comm,
            period: self.period,
            volume: 1.0,
        };
        let holds = |b: usize, cell: usize| whole.is_owned(whole.slot_of(b, cell));
        let part = part.body(self.points(), own.unzip(), &holds);
        let values = |of: &Values| match of {
            Values::Uniform(x) => Values::Uniform(*x),
            Values::PerSlot(x) => Values::PerSlot(share.gathered(whole, x)),
        };
        let ids = part.subdomain.iter().flat_map(|of| of.ids());
        let mark = ids.filter_map(|id| self.mark.get(*id as usize).copied());
        Body {
            volume: values(&self.volume),
            density: values(&self.density),
            material: share.gathered(whole, &self.material),
            horizon: share.gathered(whole, &self.horizon),
            mark: mark.collect(),
            spacing: self.spacing,
            ..part
        }
    }
}

/// A body on the sites of a lattice of which all ranks know how many points each block has.
pub(super) struct CountedLattice<const D: usize> {
    search: Search,
    whole: Grid<D>,
    pub points: Vec<usize>,
    pub period: [Option<f64>; D],
    volume: f64,
}

impl<const D: usize> CountedLattice<D> {
    /// Errors as of [`Counted::lattice`](super::Counted::lattice).
    pub fn new(
        comm: &Comm,
        search: Search,
        (reach, periodic): (usize, [bool; D]),
        volume: f64,
    ) -> Result<Self, BuildError> {
        let layers = share_of(search.layers(), comm);
        let mut ends = Ends::none();
        search.each(layers.clone(), |q| ends.reach(q));
        let whole = grid_of(comm, &search, ends, (reach, periodic))?;
        let points = points_of_blocks(&whole, &search, layers, comm);
        numbered(points.iter().sum())?;
        Ok(CountedLattice {
            period: whole.period(periodic),
            search,
            whole,
            points,
            volume,
        })
    }

    pub fn spacing(&self) -> f64 {
        self.whole.lattice().distance()
    }

    /// The part of a rank, of all of these blocks.
    pub fn part(&self, blocks: &[Range<usize>], comm: &Arc<Comm>) -> Body<D> {
        let (whole, search, points) = (&self.whole, &self.search, &self.points);
        let own = &blocks[comm.rank()];
        let first: usize = points[..own.start].iter().sum();
        let shares = &Share::of_blocks(whole, blocks);
        let share = &shares[comm.rank()];
        let mut slots = vec![];
        search.each(layers_of(whole, &share.own), |q| {
            let place = whole.find(q).filter(|place| share.own.contains(&place.1));
            slots.extend(place.map(|place| share.slot(whole, place) as u32));
        });
        // ids follow cells
        let ids = { (first as u32..).take(slots.len()) }.collect();
        let part = Part {
            whole,
            shares,
            comm,
            period: self.period,
            volume: self.volume,
        };
        let holds = |b: usize, cell: usize| search.contains(whole.site(b, cell));
        part.body(points.iter().sum(), (ids, slots), &holds)
    }
}

/// The grid of a search, of which this rank has seen so much; without sites.
pub(super) fn grid_of<const D: usize>(
    comm: &Comm,
    search: &Search,
    mut ends: Ends<D>,
    (reach, periodic): (usize, [bool; D]),
) -> Result<Grid<D>, BuildError> {
    for of in every(comm, &[ends.low, ends.high].concat()) {
        let (low, high) = of.split_at(D);
        for a in 0..D {
            ends.low[a] = ends.low[a].min(low[a]);
            ends.high[a] = ends.high[a].max(high[a]);
        }
    }
    if ends.low[0] > ends.high[0] {
        return Err(search.empty());
    }
    Grid::around(*search.lattice(), &ends, reach, periodic)
}

/// So many points, if they can be numbered.
pub(super) fn numbered(count: usize) -> Result<usize, BuildError> {
    if count > u32::MAX as usize {
        let message = format!("{count} points are more than 2³² − 1");
        return Err(BuildError::too_many("body", message));
    }
    Ok(count)
}

/// How many points each block of a grid has, of which this rank looks at those in these layers.
fn points_of_blocks<const D: usize>(
    whole: &Grid<D>,
    search: &Search,
    layers: Range<i32>,
    comm: &Comm,
) -> Vec<usize> {
    // the first block, then the points of it and of those after it
    let mut own: Vec<u64> = vec![];
    search.each(layers, |q| {
        let Some((_, cell)) = whole.find(q) else {
            return;
        };
        let block = (cell / CELLS) as u64;
        if own.is_empty() {
            own.push(block);
        }
        let n = 1 + (block - own[0]) as usize;
        own.resize(own.len().max(n + 1), 0);
        own[n] += 1;
    });
    let mut points = vec![0; whole.stride.div_ceil(CELLS)];
    for of in every(comm, &own) {
        let Some((first, counts)) = of.split_first() else {
            continue;
        };
        let of_blocks = &mut points[*first as usize..];
        { of_blocks.iter_mut().zip(counts) }.for_each(|(n, count)| *n += *count as usize);
    }
    points
}

/// The layers of the lattice that these cells of a grid lie in.
fn layers_of<const D: usize>(whole: &Grid<D>, cells: &Range<usize>) -> Range<i32> {
    if cells.is_empty() {
        return 0..0;
    }
    let of_layer: usize = whole.cells()[..D - 1].iter().product();
    let layer = |cell: usize| whole.low[D - 1] + (cell / of_layer) as i32;
    layer(cells.start)..layer(cells.end - 1) + 1
}

/// What this rank looks at of them.
pub(super) fn share_of(layers: Range<i32>, comm: &Comm) -> Range<i32> {
    let (start, all) = (i64::from(layers.start), layers.len() as i64);
    let end = |rank: usize| (start + all * rank as i64 / comm.ranks() as i64) as i32;
    end(comm.rank())..end(comm.rank() + 1)
}

/// Numbers of each rank, in their order.
pub(super) fn every<T: bytemuck::Pod>(comm: &Comm, own: &[T]) -> Vec<Vec<T>> {
    let all = comm.all(cast_slice(own));
    let all = all.unwrap_or_else(|failure| comm.end(failure));
    all.iter().map(|bytes| numbers(bytes)).collect()
}

#[cfg(test)]
mod tests {
    use crate::body::cut::Counted;
    use crate::body::{Body, Layout};
    use crate::error::BuildError;
    use crate::space::fill::{Search, fill};
    use crate::space::lattice::{Lattice, LatticeKind};
    use crate::space::region::Region;
    use peridyne_comm::Comm;
    use peridyne_comm::on_threads;

    /// This rank's part of a lattice of which no rank has all.
    fn shared<const D: usize>(
        comm: &Arc<Comm>,
        search: Search,
        reach: (usize, [bool; D]),
        volume: f64,
    ) -> Result<Body<D>, BuildError> {
        let counted = Counted::lattice(comm, search, reach, volume)?;
        Ok(Counted::parts(&[counted], comm, 0.0).remove(0))
    }
    use std::sync::Arc;

    /// The parts that ranks make of a region are those of the whole body on its sites.
    fn check<const D: usize>(kind: LatticeKind, size: [f64; 3], reach: usize, periodic: [bool; D]) {
        let lattice = Lattice {
            kind,
            spacing: 0.5,
            origin: [0.1; 3],
        };
        let hole = Region::Sphere {
            center: size.map(|x| 0.3 * x),
            radius: 2.0,
        };
        let block = Region::Block {
            low: [0.0; 3],
            high: size,
        };
        let region = Region::Difference(Box::new(block), vec![hole]);
        let sites = fill(&lattice, &region).unwrap();
        let whole = Body::on_lattice(lattice, &sites.quarters, reach, periodic, 0.25).unwrap();
        for ranks in [1, 2, 3, 5, 40] {
            on_threads(ranks, |comm| {
                let comm = Arc::new(comm);
                let cut = whole.subdomain_of(&comm, 0.0);
                let search = Search::new(&lattice, &region).unwrap();
                let made = shared(&comm, search, (reach, periodic), 0.25).unwrap();
                let name = format!("{kind:?} {periodic:?} rank {} of {ranks}", comm.rank());
                let [(a, of_a), (b, of_b)] =
                    [&cut, &made].map(|body| (body, body.subdomain().unwrap()));
                assert_eq!(of_a.ids(), of_b.ids(), "{name}");
                assert_eq!(of_a.of_slots(), of_b.of_slots(), "{name}");
                assert_eq!(of_a.points(), of_b.points(), "{name}");
                assert_eq!(a.slots, b.slots, "{name}");
                assert_eq!(a.len, b.len, "{name}");
                assert_eq!((a.spacing, a.period), (b.spacing, b.period), "{name}");
                assert_eq!((&a.volume, &a.density), (&b.volume, &b.density), "{name}");
                let (Layout::Grid(a), Layout::Grid(b)) = (&a.layout, &b.layout) else {
                    unreachable!("lattices");
                };
                assert_eq!((a.cells, a.low, a.halo), (b.cells, b.low, b.halo), "{name}");
                assert_eq!(
                    (a.first, a.stride, a.guard),
                    (b.first, b.stride, b.guard),
                    "{name}"
                );
                assert_eq!((&a.present, &a.owned), (&b.present, &b.owned), "{name}");
                for slot in 0..cut.len {
                    let [a, b] = [&cut, &made].map(|body| body.exchange.original(slot));
                    assert_eq!(a, b, "{name} {slot}");
                }
            });
        }
    }

    #[test]
    fn no_rank_needs_the_whole_body() {
        check(LatticeKind::Chain, [900.0, 0.0, 0.0], 3, [false]);
        check(LatticeKind::Chain, [900.0, 0.0, 0.0], 3, [true]);
        check(LatticeKind::Square, [30.0, 25.0, 0.0], 3, [false, true]);
        check(LatticeKind::Triangular, [20.0, 30.0, 0.0], 2, [true; 2]);
        check(LatticeKind::Cubic, [7.0, 6.0, 9.0], 3, [false; 3]);
        check(LatticeKind::Bcc, [6.0, 5.0, 8.0], 2, [true, false, true]);
        check(LatticeKind::Fcc, [5.0, 5.0, 5.0], 2, [false, true, false]);
        check(LatticeKind::Diamond, [6.0, 6.0, 4.0], 2, [true; 3]);
    }

    #[test]
    fn a_region_without_sites_is_told_by_all() {
        let lattice = Lattice {
            kind: LatticeKind::Square,
            spacing: 1.0,
            origin: [0.0; 3],
        };
        let region = Region::Block {
            low: [0.2; 3],
            high: [0.4; 3],
        };
        let said = fill(&lattice, &region).unwrap_err();
        for ranks in [1, 3] {
            on_threads(ranks, |comm| {
                let search = Search::new(&lattice, &region).unwrap();
                let made = shared::<2>(&Arc::new(comm), search, (3, [false; 2]), 1.0);
                assert_eq!(made.unwrap_err().message, said.message);
            });
        }
    }
}
