//! Several bodies as one: each keeps its own layout, its slots and its points come one after another.

use super::{Body, Exchange, FieldView, FieldViewMut, Identity, Layout, Subdomain, Values};
use std::sync::Arc;

/// A body among several.
#[derive(Debug, Clone)]
pub struct Piece<const D: usize> {
    /// Its first slot.
    pub first: usize,
    pub body: Body<D>,
}

impl<const D: usize> Piece<D> {
    /// Its slots.
    pub fn range(&self) -> std::ops::Range<usize> {
        self.first..self.first + self.body.len
    }

    /// Its part of a field of all.
    pub fn part<'a>(&self, all: FieldView<'a, D>) -> FieldView<'a, D> {
        all.map(|column| &column[self.range()])
    }

    /// [`part`](Piece::part), to write.
    pub fn part_mut<'a>(&self, all: FieldViewMut<'a, D>) -> FieldViewMut<'a, D> {
        all.map(|column| &mut column[self.range()])
    }
}

impl<const D: usize> Body<D> {
    /// Changes a body among several, which keeps its slots. `None`: there is none of this number.
    ///
    /// # Panics
    /// If it has other slots then.
    pub fn change_piece<T>(
        &mut self,
        n: usize,
        change: impl FnOnce(&mut Body<D>) -> T,
    ) -> Option<T> {
        let Layout::Several(pieces) = &mut self.layout else {
            return None;
        };
        let body = &mut pieces.get_mut(n)?.body;
        let slots = body.len;
        let changed = change(body);
        assert_eq!(body.len, slots, "a body among several keeps its slots");
        Some(changed)
    }

    /// One body of several, all with the same periods. Its spacing is the smallest. Of parts of bodies that ranks share all ranks join theirs at once.
    ///
    /// # Panics
    /// If some are parts of bodies, and others are whole: somebody else's copies would know nothing of these.
    pub fn several(bodies: Vec<Body<D>>) -> Body<D> {
        let parts = bodies.iter().filter(|b| b.subdomain.is_some()).count();
        assert!(
            parts == 0 || parts == bodies.len(),
            "ranks share all of several bodies, or none"
        );
        let mut pieces = Vec::with_capacity(bodies.len());
        let mut first = 0;
        for body in bodies {
            let next = first + body.len;
            pieces.push(Piece { first, body });
            first = next;
        }
        let len = first;
        let mut slots = vec![];
        for p in &pieces {
            slots.extend(p.body.slots.iter().map(|s| p.first as u32 + s));
        }
        let exchange = Exchange::joined(pieces.iter().map(|p| (p.first, &p.body.exchange)));
        let volume = join(&pieces, &slots, (len, 0.0), &exchange, |b| &b.volume);
        let density = join(&pieces, &slots, (len, 1.0), &exchange, |b| &b.density);
        let marked = pieces.iter().any(|p| !p.body.mark.is_empty());
        let mark = |p: &Piece<D>| match p.body.mark.is_empty() {
            true => vec![0; p.body.points()],
            false => p.body.mark.clone(),
        };
        Body {
            identity: Identity::new(),
            slots,
            len,
            spacing: pieces
                .iter()
                .map(|p| p.body.spacing)
                .fold(f64::INFINITY, f64::min),
            volume,
            density,
            period: pieces.first().map_or([None; D], |p| p.body.period),
            material: vec![],
            horizon: vec![],
            mark: match marked {
                true => pieces.iter().flat_map(mark).collect(),
                false => vec![],
            },
            exchange,
            subdomain: joined(&pieces).map(Arc::new),
            layout: Layout::Several(pieces),
            beside: vec![],
        }
    }

    /// The bodies that this one is made of, if it is made of several.
    pub fn pieces(&self) -> &[Piece<D>] {
        match &self.layout {
            Layout::Several(pieces) => pieces,
            Layout::Grid(_) | Layout::Cloud(_) => &[],
        }
    }

    /// Which of the bodies a slot belongs to; 0 where there is one.
    pub fn piece_of(&self, slot: usize) -> usize {
        piece_of(self.row_of(slot), slot)
    }

    /// The piece that a slot lies in, or the copies of points of one.
    pub(super) fn piece_at(&self, slot: usize) -> &Piece<D> {
        &self.row_of(slot)[self.piece_of(slot)]
    }

    fn row_of(&self, slot: usize) -> &[Piece<D>] {
        match self.beside.first() {
            Some(first) if slot >= first.first => &self.beside,
            _ => self.pieces(),
        }
    }

    /// Typical distance of nearest points around a slot (length): that of its body.
    pub fn spacing_at(&self, slot: usize) -> f64 {
        match self.pieces() {
            [] => self.spacing,
            pieces => pieces[self.piece_of(slot)].body.spacing,
        }
    }

    /// One face of the point in a slot: its volume over the spacing (area).
    pub fn face_at(&self, slot: usize) -> f64 {
        self.volume.at(slot) / self.spacing_at(slot)
    }

    /// Volumes of points become those that the pieces have now, of other ranks' points, too.
    pub fn join_volumes(&mut self) {
        let mut volume = vec![0.0; self.len];
        for p in self.pieces() {
            for s in p.body.slots.iter().map(|s| *s as usize) {
                volume[p.first + s] = p.body.volume.at(s);
            }
        }
        self.exchange.fill(&mut volume);
        self.volume = Values::PerSlot(volume);
    }

    /// Points have the horizons of their pieces (length, a number per slot), those of a piece without its own, of `of_pieces`; none have any if no piece has.
    pub fn join_horizons(&mut self, of_pieces: &[f64]) {
        let pieces = self.pieces();
        if pieces.iter().all(|p| p.body.horizon.is_empty()) {
            self.horizon = vec![];
            return;
        }
        let mut all = vec![0.0; self.len];
        for (p, horizon) in pieces.iter().zip(of_pieces) {
            match p.body.horizon.is_empty() {
                true => all[p.range()].fill(*horizon),
                false => all[p.range()].copy_from_slice(&p.body.horizon),
            }
        }
        // of copies that are of no piece
        self.exchange.fill(&mut all);
        self.horizon = all;
    }

    /// Ids of the points of each of the bodies, of those of all ranks.
    pub fn ids(&self) -> Vec<std::ops::Range<usize>> {
        let mut first = 0;
        let each = self.pieces().iter().map(|p| {
            let from = first;
            first += p.body.all_points();
            from..first
        });
        each.collect()
    }
}

/// The piece that has this slot.
fn piece_of<const D: usize>(pieces: &[Piece<D>], slot: usize) -> usize {
    pieces
        .partition_point(|p| p.first <= slot)
        .saturating_sub(1)
}

/// What parts of bodies, side by side, know of the whole of these; `None`: they are whole.
fn joined<const D: usize>(pieces: &[Piece<D>]) -> Option<Subdomain> {
    let comm = pieces.first()?.body.subdomain()?.comm();
    let (mut ids, mut of_slots, mut before) = (vec![], vec![], 0);
    for of in pieces.iter().filter_map(|p| p.body.subdomain()) {
        ids.extend(of.ids().iter().map(|id| before + id));
        of_slots.extend(of.of_slots().iter().map(|id| before + id));
        before += of.points() as u32;
    }
    Some(Subdomain::new(comm, ids, of_slots, before as usize))
}

/// A number per slot from those of the pieces, uniform if they are all the same.
fn join<const D: usize>(
    pieces: &[Piece<D>],
    slots: &[u32],
    (len, absent): (usize, f64),
    exchange: &Exchange,
    of: impl Fn(&Body<D>) -> &Values,
) -> Values {
    // what is uniform all ranks know to be so
    let first = pieces.first().and_then(|p| of(&p.body).uniform());
    if let Some(first) = first
        && pieces.iter().all(|p| of(&p.body).uniform() == Some(first))
    {
        return Values::Uniform(first);
    }
    let each = pieces.iter().flat_map(|p| {
        let values = of(&p.body);
        p.body.slots.iter().map(|s| values.at(*s as usize))
    });
    if !exchange.is_shared() {
        return Values::from_points(&each.collect::<Vec<_>>(), slots, len, absent);
    }
    let mut all = vec![absent; len];
    each.zip(slots).for_each(|(x, s)| all[*s as usize] = x);
    exchange.fill(&mut all);
    Values::PerSlot(all)
}
