//! The part of several bodies that a rank has: its parts of each, side by side. Of some it may have nothing.

use super::lattice;
use crate::body::exchange::Copies;
use crate::body::several::Piece;
use crate::body::subdomain::Subdomain;
use crate::body::{Body, Exchange, Identity, Layout, Values};
use crate::execute::lane::TILE;
use crate::space::Point;
use bytemuck::Pod;
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
        let counts = self
            .pieces()
            .iter()
            .map(|p| p.body.points_of_blocks().len());
        let parts = { self.pieces().iter().zip(of_each(counts, blocks)) }
            .map(|(whole, own)| whole.body.part(&own, comm, reach));
        let part = Body::several(parts.collect()).beside(beside);
        let of = part.subdomain().expect("made of parts of bodies");
        let spread = Spread {
            whole: self,
            ids: of.ids(),
            part: &part,
        };
        let (volume, density) = (
            spread.values(&self.volume, 0.0),
            spread.values(&self.density, 1.0),
        );
        let (material, horizon) = (
            spread.column(&self.material, 0),
            spread.column(&self.horizon, 0.0),
        );
        let mark = { of.ids().iter() }.filter_map(|id| self.mark.get(*id as usize).copied());
        let mark = mark.collect();
        Body {
            volume,
            density,
            material,
            horizon,
            mark,
            ..part
        }
    }
}

/// Blocks of all ranks among those of each of several bodies that have so many, one after the other.
pub(super) fn of_each(
    counts: impl Iterator<Item = usize>,
    blocks: &[Range<usize>],
) -> impl Iterator<Item = Vec<Range<usize>>> {
    let mut passed = 0;
    counts.map(move |count| {
        let own = |x: usize| x.clamp(passed, passed + count) - passed;
        let own = blocks.iter().map(|of| own(of.start)..own(of.end)).collect();
        passed += count;
        own
    })
}

impl<const D: usize> Body<D> {
    /// A part of several bodies with copies of those of these points (ids of all in their order, the same on all ranks) that it has neither of its own nor as
    /// copies of its bodies, behind all its slots: bodies of nothing but copies, one for each of the several. All ranks ask at once, before points have
    /// materials and horizons.
    ///
    /// # Panics
    /// It is no part, and there are such points.
    pub fn beside(mut self, beside: &[u32]) -> Body<D> {
        if beside.is_empty() {
            return self;
        }
        let of = self.subdomain.clone().expect("a part of several bodies");
        let (comm, ids) = (of.comm(), of.ids());
        // who has which, and where
        let own =
            { ids.iter().zip(&self.slots) }.filter(|(id, _)| beside.binary_search(id).is_ok());
        let own: Vec<[u32; 2]> = own.map(|(id, slot)| [*id, *slot]).collect();
        let places = own.iter().map(|[_, slot]| self.position(*slot as usize));
        let at = lattice::every(comm, &places.collect::<Vec<Point>>());
        let said = lattice::every(comm, &own);
        let mut there = BTreeMap::new();
        for (rank, (said, at)) in said.iter().zip(at).enumerate() {
            let each = said.iter().zip(at);
            there.extend(each.map(|([id, slot], x)| (*id, (rank, *slot as usize, x))));
        }
        let mut of_slots = of.of_slots().to_vec();
        let copied = self.exchange.copies().map(|slot| of_slots[slot]);
        let mut copied: Vec<u32> = copied.collect();
        copied.sort_unstable();
        let is_here = |id: &u32| ids.binary_search(id).is_ok() || copied.binary_search(id).is_ok();
        let (mut copies, mut pieces) = (Copies::new(comm.ranks()), vec![]);
        for (whole, all) in self.pieces().iter().zip(self.ids()) {
            let of_piece = |id: &&u32| all.contains(&(**id as usize)) && !is_here(id);
            let missing: Vec<u32> = beside.iter().filter(of_piece).copied().collect();
            let first = of_slots.len();
            let mut x: [Vec<f64>; D] = crate::array::from_fn(|_| vec![]);
            for (n, id) in missing.iter().enumerate() {
                let (rank, slot, place) = there[id];
                copies.of_rank(rank, first + n, slot, first + n);
                (0..D).for_each(|a| x[a].push(place[a]));
            }
            of_slots.extend(missing);
            pieces.push(Piece {
                first,
                body: whole.body.of_copies(x),
            });
        }
        of_slots.resize(of_slots.len().next_multiple_of(TILE), 0);
        let more = Exchange::among(comm, copies);
        self.exchange = Exchange::joined([(0, &self.exchange), (0, &more)].into_iter());
        self.len = of_slots.len();
        for (of, nobody) in [(&mut self.volume, 0.0), (&mut self.density, 1.0)] {
            if let Values::PerSlot(x) = of {
                x.resize(self.len, nobody);
                self.exchange.fill(x);
            }
        }
        let subdomain = Subdomain::new(comm, ids.to_vec(), of_slots, of.points());
        self.subdomain = Some(Arc::new(subdomain));
        self.beside = pieces;
        self
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
    part: &'a Body<D>,
}

impl<const D: usize> Spread<'_, D> {
    /// Nothing where that is nothing.
    fn column<T: Pod>(&self, all: &[T], nobody: T) -> Vec<T> {
        if all.is_empty() {
            return vec![];
        }
        let mut part = vec![nobody; self.part.len];
        for (id, slot) in self.ids.iter().zip(&self.part.slots) {
            part[*slot as usize] = all[self.whole.slots[*id as usize] as usize];
        }
        self.part.exchange.fill(&mut part);
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
