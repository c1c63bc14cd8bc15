//! Cuts a cloud into the parts that ranks have: runs of its slots, which lie close to each other in space, and copies of who is within reach of them.
//!
//! Ranks own whole blocks of slots, the same ones that sums are made of. A part has copies of what comes before its slots in the whole, its slots, and copies of
//! what comes after: so the partners of a point stand in the order that they have in the whole, wherever the borders are.

use super::blocks::CELLS;
use super::lattice;
use crate::body::build::cell_of;
use crate::body::exchange::{Copies, Exchange};
use crate::body::grid::Ends;
use crate::body::subdomain::Subdomain;
use crate::body::{Body, Identity, Layout, Values};
use crate::error::BuildError;
use crate::execute::lane::TILE;
use crate::space::Point;
use crate::space::cells::Cells;
use crate::space::fill::Search;
use peridyne_comm::Comm;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

/// In place of a point that is known where a part has nobody.
const NOBODY: u32 = u32::MAX;

/// The slots of a part, by the places of points in what is [known](Known).
struct Part {
    of: Vec<u32>,
    /// The first own one.
    first: usize,
}

impl Part {
    /// `near`: copies, in their order.
    fn new(own: &Range<usize>, near: &[u32]) -> Part {
        let before = near.partition_point(|place| (*place as usize) < own.start);
        let (before, after) = near.split_at(before);
        // what is missing for whole tiles lies at the outer ends and behind the last own point
        let first = before.len().next_multiple_of(TILE);
        let mut of = vec![NOBODY; first - before.len()];
        of.extend(before);
        of.extend(own.clone().map(|place| place as u32));
        of.resize(first + own.len().next_multiple_of(TILE), NOBODY);
        of.extend(after);
        // columns of no slots would be those of a law that has none
        of.resize(of.len().next_multiple_of(TILE).max(TILE), NOBODY);
        Part { of, first }
    }

    /// What slots have of what those have that are known; nothing where that is nothing.
    fn gathered<T: Copy>(&self, all: &[T], nobody: T) -> Vec<T> {
        if all.is_empty() {
            return vec![];
        }
        let of = self.of.iter();
        of.map(|place| all.get(*place as usize).copied().unwrap_or(nobody))
            .collect()
    }
}

/// Which of these points that are not in `own` are within `reach` (length) of those that are.
pub(super) fn near<const D: usize>(
    x: [&[f64]; D],
    period: [Option<f64>; D],
    own: &Range<usize>,
    reach: f64,
) -> Vec<u32> {
    let points = x[0].len();
    if own.is_empty() || !(reach > 0.0) {
        return vec![];
    }
    let mut is_near = vec![false; points];
    match all_are_near(&period, reach) {
        true => is_near.fill(true),
        false => {
            let all: Vec<u32> = (0..points as u32).collect();
            let cells = Cells::new(x, &all, period, reach);
            for place in own.clone() {
                cells.candidates(place, |other, square| {
                    is_near[other as usize] |= square <= reach * reach;
                });
            }
        }
    }
    is_near[own.clone()].fill(false);
    (0..points as u32)
        .filter(|place| is_near[*place as usize])
        .collect()
}

/// Around a period that is no longer than twice the reach, everybody is near: the list says that it is too short.
fn all_are_near<const D: usize>(period: &[Option<f64>; D], reach: f64) -> bool {
    period.iter().flatten().any(|p| *p <= 2.0 * reach)
}

/// Points of a cloud that a rank knows: its own, those near them, and others perhaps.
struct Known<'a, const D: usize> {
    /// In the order of their slots in the whole.
    x: [&'a [f64]; D],
    /// These slots; `None`: from 0 on.
    slots: Option<&'a [u32]>,
    /// Ids of own points.
    ids: &'a dyn Fn(usize) -> u32,
    period: [Option<f64>; D],
    spacing: f64,
    /// Points of all.
    points: usize,
}

impl<const D: usize> Known<'_, D> {
    /// The part of this rank, of those of all, that have these slots of the whole each, with copies of all within `reach` (length): points that are alike.
    fn part(&self, comm: &Arc<Comm>, all: &[Range<usize>], reach: f64) -> (Part, Body<D>) {
        let slot = |place: usize| self.slots.map_or(place, |of| of[place] as usize);
        let place = |slot: usize| match self.slots {
            Some(of) => of.partition_point(|s| (*s as usize) < slot),
            None => slot,
        };
        let share = &all[comm.rank()];
        let own = place(share.start)..place(share.end);
        let part = Part::new(&own, &near(self.x, self.period, &own, reach));
        let firsts = comm.all(&(part.first as u64).to_le_bytes());
        let firsts = firsts.unwrap_or_else(|failure| comm.end(failure));
        let first_of = |rank: usize| -> usize {
            let bytes = firsts[rank][..].try_into().expect("eight bytes");
            u64::from_le_bytes(bytes) as usize
        };
        let mut copies = Copies::new(all.len());
        for (here, place) in part.of.iter().enumerate().filter(|(_, of)| **of != NOBODY) {
            let of = slot(*place as usize);
            let owner = all.partition_point(|share| share.end <= of);
            if owner != comm.rank() {
                copies.of_rank(owner, here, first_of(owner) + of - all[owner].start, here);
            }
        }
        let (first, start) = (part.first, own.start);
        let here = own.clone();
        let mut here: Vec<(u32, u32)> = here
            .map(|place| ((self.ids)(place), (first + place - start) as u32))
            .collect();
        here.sort_unstable();
        let (ids, slots): (Vec<u32>, Vec<u32>) = here.into_iter().unzip();
        let exchange = Exchange::among(comm, copies);
        let mut of_slots = vec![0; part.of.len()];
        { ids.iter().zip(&slots) }.for_each(|(id, slot)| of_slots[*slot as usize] = *id);
        exchange.fill(&mut of_slots);
        let own_slots = first..first + own.len().next_multiple_of(TILE);
        let subdomain =
            Subdomain::new(comm, ids, of_slots, self.points).of_cloud(own_slots, share.start);
        // nobody is where the first own point is, as in the whole where the last one is
        let nobody = |a: usize| self.x[a].get(start).copied().unwrap_or(0.0);
        let x = |a: usize| match self.x[a].is_empty() {
            true => vec![0.0; part.of.len()],
            false => part.gathered(self.x[a], nobody(a)),
        };
        let body = Body {
            identity: Identity::new(),
            len: part.of.len(),
            spacing: self.spacing,
            volume: Values::Uniform(1.0),
            density: Values::Uniform(1.0),
            period: self.period,
            material: vec![],
            horizon: vec![],
            mark: vec![],
            exchange,
            subdomain: Some(Arc::new(subdomain)),
            beside: vec![],
            slots,
            layout: Layout::Cloud(crate::array::from_fn(x)),
        };
        (part, body)
    }
}

/// Slots of the points of some blocks of a cloud of so many.
fn slots_of(blocks: &Range<usize>, points: usize) -> Range<usize> {
    let [start, end] = [blocks.start, blocks.end].map(|n| (n * CELLS).min(points));
    start..end
}

impl<const D: usize> Body<D> {
    /// Slots of the points of some blocks of a cloud.
    pub(super) fn slots_of_blocks(&self, blocks: &Range<usize>) -> Range<usize> {
        slots_of(blocks, self.points())
    }

    /// The part of a cloud that a rank has, with copies of all within `reach` (length).
    pub(super) fn part_of_cloud(
        &self,
        x: &[Vec<f64>; D],
        blocks: &[Range<usize>],
        comm: &Arc<Comm>,
        reach: f64,
    ) -> Body<D> {
        let all: Vec<Range<usize>> = blocks.iter().map(|of| self.slots_of_blocks(of)).collect();
        let mut of_slots = vec![0; self.points()];
        (0..)
            .zip(&self.slots)
            .for_each(|(id, slot)| of_slots[*slot as usize] = id);
        let known = Known {
            x: crate::array::from_fn(|a| &x[a][..self.points()]),
            slots: None,
            ids: &|slot| of_slots[slot],
            period: self.period,
            spacing: self.spacing,
            points: self.points(),
        };
        let (part, body) = known.part(comm, &all, reach);
        let values = |of: &Values, nobody: f64| match of {
            Values::Uniform(x) => Values::Uniform(*x),
            Values::PerSlot(x) => Values::PerSlot(part.gathered(x, nobody)),
        };
        let ids = body.subdomain.iter().flat_map(|of| of.ids());
        let mark = ids.filter_map(|id| self.mark.get(*id as usize).copied());
        Body {
            volume: values(&self.volume, 0.0),
            density: values(&self.density, 1.0),
            material: part.gathered(&self.material, 0),
            horizon: part.gathered(&self.horizon, 0.0),
            mark: mark.collect(),
            ..body
        }
    }
}

/// Where a point, called by its id, lies that belongs to a site there.
pub type Moved = Box<dyn Fn(usize, Point) -> Point>;

/// A layer of cells of a lattice whose sites become a cloud.
struct Layer {
    /// The first id.
    first: u64,
    /// Slabs of the [cells](cell_of) that its points lie in, from one to another.
    slabs: [i64; 2],
}

/// A cloud of the sites of a lattice, perhaps moved, of which all ranks know how many points each slab has: a layer of the cells that say in which order points
/// are stored, the slowest of these axes.
pub(super) struct CountedCloud<const D: usize> {
    search: Search,
    moved: Moved,
    layers: Vec<Layer>,
    /// The first slab, and the first slot of each, and the number of points.
    slab: i64,
    slots: Vec<usize>,
    pub period: [Option<f64>; D],
    volume: f64,
}

impl<const D: usize> CountedCloud<D> {
    /// Errors as of [`Counted::lattice`](super::Counted::lattice).
    pub fn new(
        comm: &Comm,
        search: Search,
        (reach, periodic): (usize, [bool; D]),
        volume: f64,
        moved: Moved,
    ) -> Result<Self, BuildError> {
        let own = lattice::share_of(search.layers(), comm);
        let (mut ends, mut counts) = (Ends::none(), vec![0u64; own.len()]);
        let layer = |q: [i32; 3]| q[D - 1].div_euclid(4);
        search.each(own.clone(), |q| {
            ends.reach(q);
            counts[(layer(q) - own.start) as usize] += 1;
        });
        let grid = lattice::grid_of(comm, &search, ends, (reach, periodic))?;
        let counts = lattice::every(comm, &counts).concat();
        let mut layers = vec![];
        let mut count = 0;
        for n in counts {
            layers.push(Layer {
                first: count,
                slabs: [i64::MAX, i64::MIN],
            });
            count += n;
        }
        lattice::numbered(count as usize)?;
        let mut cloud = CountedCloud {
            period: grid.period(periodic),
            search,
            moved,
            layers,
            slab: 0,
            slots: vec![],
            volume,
        };
        let mut points: BTreeMap<i64, u64> = BTreeMap::new();
        let mut slabs = vec![[i64::MAX, i64::MIN]; own.len()];
        cloud.each(own.clone(), |layer, _, _, cell| {
            *points.entry(cell[3 - D]).or_default() += 1;
            let of: &mut [i64; 2] = &mut slabs[(layer - own.start) as usize];
            *of = [of[0].min(cell[3 - D]), of[1].max(cell[3 - D])];
        });
        let slabs = lattice::every(comm, &slabs).concat();
        { cloud.layers.iter_mut().zip(slabs) }.for_each(|(layer, slabs)| layer.slabs = slabs);
        let points: Vec<[i64; 2]> = points.into_iter().map(|(at, n)| [at, n as i64]).collect();
        let points = lattice::every(comm, &points).concat();
        let ends = points
            .iter()
            .fold([i64::MAX, i64::MIN], |[low, high], [at, _]| {
                [low.min(*at), high.max(*at)]
            });
        cloud.slab = ends[0];
        // as many slabs as there are layers at the most, about
        cloud.slots = vec![0; (ends[1] - ends[0] + 2) as usize];
        for [at, n] in points {
            cloud.slots[(at - ends[0] + 1) as usize] += n as usize;
        }
        (1..cloud.slots.len()).for_each(|n| cloud.slots[n] += cloud.slots[n - 1]);
        Ok(cloud)
    }

    pub fn spacing(&self) -> f64 {
        self.search.lattice().distance()
    }

    pub fn points(&self) -> usize {
        self.slots.last().copied().unwrap_or(0)
    }

    /// Points of these layers: their layer, id, place and cell.
    fn each(&self, layers: Range<i32>, mut visit: impl FnMut(i32, u32, Point, [i64; 3])) {
        let lattice = *self.search.lattice();
        let (spacing, first) = (self.spacing(), self.search.layers().start);
        let mut id = match self.layers.get((layers.start - first) as usize) {
            Some(layer) => layer.first as usize,
            None => return,
        };
        self.search.each(layers, |q| {
            let x = (self.moved)(id, lattice.position(q));
            let cell = cell_of::<D>(&x, spacing);
            visit(q[D - 1].div_euclid(4), id as u32, x, cell);
            id += 1;
        });
    }

    /// Which slabs a rank has points in or within `reach` (length) of, that has these slots.
    fn slabs(&self, own: &Range<usize>, reach: f64) -> Vec<bool> {
        let count = self.slots.len() - 1;
        let mut needed = vec![false; count];
        if own.is_empty() {
            return needed;
        }
        if reach > 0.0 && all_are_near(&self.period, reach) {
            return vec![true; count];
        }
        let thick = 4.0 * self.spacing();
        let of = |slot: usize| self.slots.partition_point(|first| *first <= slot) - 1;
        let (first, last) = (of(own.start), of(own.end - 1));
        needed[first..=last].fill(true);
        if reach > 0.0 {
            // a slab more at both ends: no round-off loses anybody
            let [low, high] = [
                (first as i64 + self.slab) as f64 * thick - reach,
                (last as i64 + self.slab + 1) as f64 * thick + reach,
            ];
            let period = self.period[D - 1].map_or(vec![0.0], |p| vec![-p, 0.0, p]);
            for moved in period {
                let slab = |x: f64| ((x + moved) / thick).floor() as i64 - self.slab;
                for n in (slab(low) - 1).max(0)..=(slab(high) + 1).min(count as i64 - 1) {
                    needed[n as usize] = true;
                }
            }
        }
        needed
    }

    /// The part of a rank, of all of these blocks, with copies of all within `reach` (length).
    pub fn part(&self, blocks: &[Range<usize>], comm: &Arc<Comm>, reach: f64) -> Body<D> {
        let all: Vec<_> = { blocks.iter() }
            .map(|of| slots_of(of, self.points()))
            .collect();
        let needed = self.slabs(&all[comm.rank()], reach);
        let is_needed = |slab: i64| needed[(slab - self.slab) as usize];
        let mut found: Vec<([i64; 3], u32, Point)> = vec![];
        for (n, layer) in (self.search.layers().start..).zip(&self.layers) {
            let [low, high] = layer.slabs;
            if !(low..=high).any(is_needed) {
                continue;
            }
            self.each(n..n + 1, |_, id, x, cell| {
                if is_needed(cell[3 - D]) {
                    found.push((cell, id, x));
                }
            });
        }
        found.sort_unstable_by_key(|(cell, id, _)| (*cell, *id));
        let (mut slots, mut next) = (Vec::with_capacity(found.len()), 0);
        let mut slab = None;
        for (cell, ..) in &found {
            if slab != Some(cell[3 - D]) {
                slab = Some(cell[3 - D]);
                next = self.slots[(cell[3 - D] - self.slab) as usize] as u32;
            }
            slots.push(next);
            next += 1;
        }
        let x: [Vec<f64>; D] =
            crate::array::from_fn(|a| found.iter().map(|(.., x)| x[a]).collect());
        let ids: Vec<u32> = found.into_iter().map(|(_, id, _)| id).collect();
        let known = Known {
            x: crate::array::from_fn(|a| x[a].as_slice()),
            slots: Some(&slots),
            ids: &|place| ids[place],
            period: self.period,
            spacing: self.spacing(),
            points: self.points(),
        };
        let (_, body) = known.part(comm, &all, reach);
        Body {
            volume: Values::Uniform(self.volume),
            ..body
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::body::Body;
    use crate::family::horizon::HorizonList;
    use crate::samples::Random;
    use peridyne_comm::on_threads;
    use std::sync::Arc;

    /// Ids of the partners of each point, in their order.
    fn families<const D: usize>(body: &Body<D>, horizon: f64) -> Vec<(u32, Vec<u32>)> {
        let list = HorizonList::new(body, horizon).unwrap();
        let ids = body.ids_of_all();
        let of = |slot: &u32| {
            let row = list.row(*slot as usize);
            assert_eq!(list.rows()[row], *slot);
            let partners = list.partners(row).map(|(_, j)| ids[j]);
            (ids[*slot as usize], partners.collect())
        };
        body.slots.iter().map(of).collect()
    }

    fn check<const D: usize>(points: usize, period: [Option<f64>; D]) {
        let mut random = Random(5);
        let place = |_| {
            std::array::from_fn(|a| {
                if a < D {
                    4.0 + 4.0 * random.next()
                } else {
                    0.0
                }
            })
        };
        let position: Vec<[f64; 3]> = (0..points).map(place).collect();
        let volume: Vec<f64> = (0..points).map(|n| 1.0 + n as f64).collect();
        let mark: Vec<i32> = (0..points as i32).collect();
        let whole = Body::<D>::from_cloud(&position, &volume, &mark, 0.3, period).unwrap();
        let horizon = [0.05, 0.4, 0.9][D - 1];
        let one = families(&whole, horizon);
        let most = points.div_ceil(super::CELLS);
        for ranks in [1, 2, most, most + 2] {
            let seen = on_threads(ranks, |comm| {
                let part = whole.subdomain_of(&Arc::new(comm), horizon);
                let ids = part.ids_of_all();
                let copies: Vec<usize> = part.exchange.copies().collect();
                let own = part.slots.iter().map(|s| *s as usize);
                for slot in own.chain(copies.iter().copied()) {
                    let id = ids[slot] as usize;
                    assert_eq!(part.position(slot), position[id]);
                    assert_eq!(part.volume.at(slot), volume[id]);
                }
                for (id, slot) in part.slots.iter().enumerate() {
                    assert_eq!(part.mark[id], ids[*slot as usize] as i32);
                    let there = whole.slots[part.id_of_all(id)];
                    assert_eq!(part.order(*slot as usize), u64::from(there));
                }
                let mut column = vec![0.0; part.len];
                part.set_points(&mut column, |slot| f64::from(ids[slot]));
                assert!(copies.iter().all(|s| column[*s] == f64::from(ids[*s])));
                families(&part, horizon)
            });
            let mut seen = seen.concat();
            seen.sort_unstable();
            assert!(seen == one, "{D}-D, {ranks} ranks");
        }
    }

    #[test]
    fn points_have_the_partners_of_the_whole_in_their_order() {
        check::<1>(1300, [None]);
        check::<1>(1300, [Some(8.0)]);
        check::<2>(1500, [None, Some(8.0)]);
        check::<3>(1500, [Some(8.0), None, None]);
        check::<3>(1111, [Some(8.0); 3]);
    }
}
