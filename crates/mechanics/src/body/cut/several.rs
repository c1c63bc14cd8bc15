//! The part of several bodies that a rank has: its parts of each, side by side. Of some it may have nothing.

use crate::body::several::Piece;
use crate::body::subdomain::Subdomain;
use crate::body::{Body, Exchange, Identity, Layout, Values};
use bytemuck::Pod;
use peridyne_comm::Comm;
use std::ops::Range;
use std::sync::Arc;

impl<const D: usize> Body<D> {
    pub(super) fn part_of_several(
        &self,
        blocks: &[Range<usize>],
        comm: &Arc<Comm>,
        reach: f64,
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
        let exchange = Exchange::joined(pieces.iter().map(|p| (p.first, &p.body.exchange)));
        let len = first;
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
            exchange,
            slots,
            layout: Layout::Several(pieces),
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
