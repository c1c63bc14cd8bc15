//! Cuts a cloud into the parts that ranks have: runs of its slots, which lie close to each other in space, and copies of who is within reach of them.
//!
//! Ranks own whole blocks of slots, the same ones that sums are made of. A part has copies of what comes before its slots in the whole, its slots, and copies of
//! what comes after: so the partners of a point stand in the order that they have in the whole, wherever the borders are.

use super::blocks::CELLS;
use crate::body::exchange::{Copies, Exchange};
use crate::body::subdomain::Subdomain;
use crate::body::{Body, Identity, Layout, Values};
use crate::execute::lane::TILE;
use crate::space::cells::Cells;
use peridyne_comm::Comm;
use std::ops::Range;
use std::sync::Arc;

/// In place of a slot of the whole where a part has nobody.
const NOBODY: u32 = u32::MAX;

/// The slots of a part, by the slots of the whole that they are.
struct Part {
    of: Vec<u32>,
    /// The first own one.
    first: usize,
}

impl Part {
    /// `near`: copies, in the order of the slots of the whole.
    fn new(own: &Range<usize>, near: &[u32]) -> Part {
        let before = near.partition_point(|slot| (*slot as usize) < own.start);
        let (before, after) = near.split_at(before);
        // what is missing for whole tiles lies at the outer ends and behind the last own point
        let first = before.len().next_multiple_of(TILE);
        let mut of = vec![NOBODY; first - before.len()];
        of.extend(before);
        of.extend(own.clone().map(|slot| slot as u32));
        of.resize(first + own.len().next_multiple_of(TILE), NOBODY);
        of.extend(after);
        // columns of no slots would be those of a law that has none
        of.resize(of.len().next_multiple_of(TILE).max(TILE), NOBODY);
        Part { of, first }
    }

    /// What slots have of what those of the whole have; nothing where that is nothing.
    fn gathered<T: Copy>(&self, all: &[T], nobody: T) -> Vec<T> {
        if all.is_empty() {
            return vec![];
        }
        let of = self.of.iter();
        of.map(|slot| all.get(*slot as usize).copied().unwrap_or(nobody))
            .collect()
    }
}

/// Which slots of the whole that are not in `own` are within `reach` (length) of those that are.
pub(super) fn near<const D: usize>(
    body: &Body<D>,
    x: &[Vec<f64>; D],
    own: &Range<usize>,
    reach: f64,
) -> Vec<u32> {
    let points = body.points();
    if !(reach > 0.0) {
        return vec![];
    }
    let mut is_near = vec![false; points];
    // around a period that is no longer, everybody is near: the list says that it is too short
    match body.period.iter().flatten().any(|p| *p <= 2.0 * reach) {
        true => is_near.fill(true),
        false => {
            let x = crate::array::from_fn(|a| x[a].as_slice());
            let all: Vec<u32> = (0..points as u32).collect();
            let cells = Cells::new(x, &all, body.period, reach);
            for slot in own.clone() {
                cells.candidates(slot, |other, square| {
                    is_near[other as usize] |= square <= reach * reach;
                });
            }
        }
    }
    is_near[own.clone()].fill(false);
    (0..points as u32)
        .filter(|slot| is_near[*slot as usize])
        .collect()
}

impl<const D: usize> Body<D> {
    /// Slots of the points of some blocks of a cloud.
    pub(super) fn slots_of_blocks(&self, blocks: &Range<usize>) -> Range<usize> {
        let [start, end] = [blocks.start, blocks.end].map(|n| (n * CELLS).min(self.points()));
        start..end
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
        let own = &all[comm.rank()];
        let near = match own.is_empty() {
            true => vec![],
            false => near(self, x, own, reach),
        };
        let part = Part::new(own, &near);
        let firsts = comm.all(&(part.first as u64).to_le_bytes());
        let firsts = firsts.unwrap_or_else(|failure| comm.end(failure));
        let first_of = |rank: usize| -> usize {
            let bytes = firsts[rank][..].try_into().expect("eight bytes");
            u64::from_le_bytes(bytes) as usize
        };
        let mut copies = Copies::new(all.len());
        for (slot, of) in part.of.iter().enumerate() {
            let of = *of as usize;
            let owner = all.partition_point(|share| share.end <= of);
            if owner < all.len() && owner != comm.rank() {
                copies.of_rank(owner, slot, first_of(owner) + of - all[owner].start, slot);
            }
        }
        let (mut ids, mut slots) = (vec![], vec![]);
        for (id, slot) in self.slots.iter().enumerate() {
            if let Some(place) =
                { own.contains(&(*slot as usize)) }.then(|| *slot as usize - own.start)
            {
                ids.push(id as u32);
                slots.push((part.first + place) as u32);
            }
        }
        let values = |of: &Values, nobody: f64| match of {
            Values::Uniform(x) => Values::Uniform(*x),
            Values::PerSlot(x) => Values::PerSlot(part.gathered(x, nobody)),
        };
        let mark = { ids.iter() }.filter_map(|id| self.mark.get(*id as usize).copied());
        let mark = mark.collect();
        let exchange = Exchange::among(comm, copies);
        let mut of_slots = vec![0; part.of.len()];
        { ids.iter().zip(&slots) }.for_each(|(id, slot)| of_slots[*slot as usize] = *id);
        exchange.fill(&mut of_slots);
        let own_slots = part.first..part.first + own.len().next_multiple_of(TILE);
        let subdomain =
            Subdomain::new(comm, ids, of_slots, self.points()).of_cloud(own_slots, own.start);
        let nobody = |a: usize| x[a].get(own.start).copied().unwrap_or(0.0);
        Body {
            identity: Identity::new(),
            len: part.of.len(),
            spacing: self.spacing,
            volume: values(&self.volume, 0.0),
            density: values(&self.density, 1.0),
            period: self.period,
            material: part.gathered(&self.material, 0),
            horizon: part.gathered(&self.horizon, 0.0),
            mark,
            exchange,
            subdomain: Some(Arc::new(subdomain)),
            beside: vec![],
            slots,
            // nobody is where the first own point is, as in the whole where the last one is
            layout: Layout::Cloud(crate::array::from_fn(|a| part.gathered(&x[a], nobody(a)))),
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
