//! The part of several bodies that a rank has: its parts of each, side by side. Of some it may have nothing.

use crate::body::exchange::Copies;
use crate::body::several::Piece;
use crate::body::subdomain::{Subdomain, numbers};
use crate::body::{Body, Exchange, Identity, Layout, Values};
use crate::execute::lane::TILE;
use bytemuck::{Pod, cast_slice};
use peridyne_comm::Comm;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

impl<const D: usize> Body<D> {
    pub(super) fn part_of_several(
        &self,
        blocks: &[Range<usize>],
        comm: &Arc<Comm>,
        reach: f64,
        beside: &[u32],
    ) -> Body<D> {
        let (mut pieces, mut slots) = (vec![], vec![]);
        let (mut ids, mut of_slots) = (vec![], vec![]);
        let (mut passed, mut first, mut before) = (0, 0, 0);
        for whole in self.pieces() {
            let count = whole.body.points_of_blocks().len();
            let own = |x: usize| x.clamp(passed, passed + count) - passed;
            let own = blocks.iter().map(|of| own(of.start)..own(of.end));
            let body = whole.body.part(&own.collect::<Vec<_>>(), comm, reach);
            let of = body.subdomain().expect("made of a part of a body");
            ids.extend(of.ids().iter().map(|id| before + id));
            of_slots.extend(of.of_slots().iter().map(|id| before + id));
            slots.extend(body.slots.iter().map(|s| first as u32 + s));
            let next = first + body.len;
            pieces.push(Piece { first, body });
            (passed, first) = (passed + count, next);
            before += whole.body.points() as u32;
        }
        let copied = { pieces.iter() }.flat_map(|p| p.body.exchange.copies().map(|s| p.first + s));
        let copied = copied.map(|slot| of_slots[slot]).collect();
        let more = self.beside(comm, (&ids, &slots, copied), beside, &mut of_slots);
        let of_pieces = pieces.iter().map(|p| (p.first, &p.body.exchange));
        let exchange = Exchange::joined(of_pieces.chain(more.iter().map(|(_, of)| (0, of))));
        let len = of_slots.len();
        let part = Spread {
            whole: self,
            ids: &ids,
            slots: &slots,
            exchange: &exchange,
            len,
        };
        let (volume, density) = (
            part.values(&self.volume, 0.0),
            part.values(&self.density, 1.0),
        );
        let (material, horizon) = (
            part.column(&self.material, 0),
            part.column(&self.horizon, 0.0),
        );
        let mark = ids
            .iter()
            .filter_map(|id| self.mark.get(*id as usize).copied());
        Body {
            identity: Identity::new(),
            len,
            spacing: self.spacing,
            volume,
            density,
            period: self.period,
            material,
            horizon,
            mark: mark.collect(),
            subdomain: Some(Arc::new(Subdomain::new(comm, ids, of_slots, self.points()))),
            beside: more.map_or(vec![], |(beside, _)| beside),
            exchange,
            slots,
            layout: Layout::Several(pieces),
        }
    }
}

impl<const D: usize> Body<D> {
    /// Copies of those of these points (ids) that a part has neither of its own nor as copies of its bodies, behind all its slots: bodies of nothing but
    /// copies, one for each of the several, and who has the originals. Nothing where no rank asks for any.
    fn beside(
        &self,
        comm: &Arc<Comm>,
        (ids, slots, mut copied): (&[u32], &[u32], Vec<u32>),
        beside: &[u32],
        of_slots: &mut Vec<u32>,
    ) -> Option<(Vec<Piece<D>>, Exchange)> {
        if beside.is_empty() {
            return None;
        }
        // who has which, and where
        let own = { ids.iter().zip(slots) }.filter(|(id, _)| beside.binary_search(id).is_ok());
        let own: Vec<u32> = own.flat_map(|(id, slot)| [*id, *slot]).collect();
        let said = comm.all(cast_slice(&own));
        let said = said.unwrap_or_else(|failure| comm.end(failure));
        let mut there = BTreeMap::new();
        for (rank, bytes) in said.iter().enumerate() {
            let words: Vec<u32> = numbers(bytes);
            let each = words.as_chunks::<2>().0.iter();
            there.extend(each.map(|[id, slot]| (*id, (rank, *slot as usize))));
        }
        copied.sort_unstable();
        let is_here = |id: &u32| ids.binary_search(id).is_ok() || copied.binary_search(id).is_ok();
        let (mut copies, mut pieces) = (Copies::new(comm.ranks()), vec![]);
        let mut before = 0;
        for whole in self.pieces() {
            let next = before + whole.body.points() as u32;
            let of_piece = |id: &&u32| (before..next).contains(*id) && !is_here(id);
            let missing: Vec<u32> = beside.iter().filter(of_piece).copied().collect();
            before = next;
            let first = of_slots.len();
            for (n, id) in missing.iter().enumerate() {
                let (rank, slot) = there[id];
                copies.of_rank(rank, first + n, slot, first + n);
            }
            let mut x: [Vec<f64>; D] = crate::array::from_fn(|_| vec![]);
            for id in &missing {
                let place = self.position(self.slots[*id as usize] as usize);
                (0..D).for_each(|a| x[a].push(place[a]));
            }
            of_slots.extend(missing);
            pieces.push(Piece {
                first,
                body: whole.body.of_copies(x),
            });
        }
        of_slots.resize(of_slots.len().next_multiple_of(TILE), 0);
        Some((pieces, Exchange::among(comm, copies)))
    }

    /// Copies at these places, of points like those of this body.
    fn of_copies(&self, x: [Vec<f64>; D]) -> Body<D> {
        Body {
            identity: Identity::new(),
            len: x[0].len(),
            spacing: self.spacing,
            volume: Values::Uniform(0.0),
            density: Values::Uniform(1.0),
            period: self.period,
            material: vec![],
            horizon: vec![],
            mark: vec![],
            exchange: Exchange::default(),
            subdomain: None,
            beside: vec![],
            slots: vec![],
            layout: Layout::Cloud(x),
        }
    }
}

/// From slots of the whole to those of a part.
struct Spread<'a, const D: usize> {
    whole: &'a Body<D>,
    ids: &'a [u32],
    slots: &'a [u32],
    exchange: &'a Exchange,
    len: usize,
}

impl<const D: usize> Spread<'_, D> {
    /// Nothing where that is nothing.
    fn column<T: Pod>(&self, all: &[T], nobody: T) -> Vec<T> {
        if all.is_empty() {
            return vec![];
        }
        let mut part = vec![nobody; self.len];
        for (id, slot) in self.ids.iter().zip(self.slots) {
            part[*slot as usize] = all[self.whole.slots[*id as usize] as usize];
        }
        self.exchange.fill(&mut part);
        part
    }

    fn values(&self, of: &Values, nobody: f64) -> Values {
        match of {
            Values::Uniform(x) => Values::Uniform(*x),
            Values::PerSlot(x) => Values::PerSlot(self.column(x, nobody)),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::body::Body;
    use crate::samples;
    use crate::space::lattice::{Lattice, LatticeKind};
    use peridyne_comm::on_threads;
    use std::sync::Arc;

    /// Asked for, points are there on every rank: once, with their place, what they are, and what is filled.
    #[test]
    fn points_of_other_bodies_are_there_where_they_are_asked_for() {
        let lattice = |origin: [f64; 3]| Lattice {
            kind: LatticeKind::Square,
            spacing: 0.5,
            origin,
        };
        let made = |origin, periodic| {
            let sites = samples::sites([30, 20, 1], |_| true);
            Body::<2>::on_lattice(lattice(origin), &sites, 2, periodic, 0.25).unwrap()
        };
        for periodic in [[false; 2], [true, false]] {
            let one = made([0.0; 3], periodic);
            let other = made([0.0, 10.5, 0.0], periodic).to_cloud().unwrap();
            let mut whole = Body::several(vec![one, other]);
            let all = whole.points();
            whole.give_materials((0..all).map(|id| (id % 5) as u8));
            let densities: Vec<f64> = (0..all).map(|id| 1.0 + id as f64).collect();
            whole.set_densities(&densities);
            let beside: Vec<u32> = [3].into_iter().chain(570..640).chain([1199]).collect();
            for ranks in [1, 2, 3, 5, 9] {
                on_threads(ranks, |comm| {
                    let part = whole.subdomain_beside(&Arc::new(comm), 1.0, &beside);
                    let ids = part.ids_of_all().into_owned();
                    let mut column = vec![0.0; part.len];
                    part.set_points(&mut column, |slot| f64::from(ids[slot]));
                    let slots = part.slots_of_ids();
                    for id in beside.iter().map(|id| *id as usize) {
                        let slot = slots[id] as usize;
                        assert_eq!(column[slot], id as f64);
                        let there = whole.slots[id] as usize;
                        assert_eq!(part.home(slot), whole.position(there));
                        assert_eq!(part.piece_of(slot), whole.piece_of(there));
                        assert_eq!(part.material[slot], (id % 5) as u8);
                        assert_eq!(part.density.at(slot), 1.0 + id as f64);
                        assert_eq!(part.volume.at(slot), whole.volume.at(there));
                        // whoever was there is not there twice
                        let copies = part.exchange.copies();
                        let more = copies
                            .filter(|s| ids[*s] as usize == id && part.exchange.original(*s) == *s);
                        assert!(more.count() <= 1);
                    }
                });
            }
        }
    }
}
