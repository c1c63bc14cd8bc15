//! What statics keeps between increments.

use super::system::Equations;
use crate::body::{Body, Field, zeros};
use crate::spec::{Control, LinearBody, Statics};
use crate::state::{Archive, words};
use crate::statics::{Direct, Solved, Support};
use std::cmp::Ordering;
use std::collections::HashMap;

pub(in crate::run) struct StaticState<const D: usize> {
    pub options: Statics,
    /// The linear body about the reference and its factors, as long as no bond broke.
    pub(super) factors: Option<(LinearBody<D>, Direct<D>)>,
    /// Factored equations of a step in time, which may serve the next.
    pub(super) step: Option<Equations<D>>,
    /// Where bonds break in turn: which are next.
    pub(super) sequence: Option<Sequence<D>>,
    /// Where a path is followed: the last increment.
    pub(super) followed: Option<Followed<D>>,
    /// Of the operator about the reference, once looked at.
    pub(super) asymmetry: Option<f64>,
    /// `[N]` the largest masses of points that relaxation had, of laws that remember; else empty.
    pub(super) masses: Vec<f64>,
    /// Of the last increment.
    pub solved: Solved,
}

impl<const D: usize> StaticState<D> {
    pub fn new(options: Statics) -> Self {
        StaticState {
            options,
            factors: None,
            step: None,
            sequence: None,
            followed: None,
            asymmetry: None,
            masses: vec![],
            solved: Solved::default(),
        }
    }

    /// Is t a factor that may fall?
    pub fn load_may_fall(&self) -> bool {
        self.options.control != Control::Load
    }

    /// Factors belong to other equations.
    pub fn forget(&mut self) {
        self.factors = None;
        self.step = None;
        self.asymmetry = None;
    }
}

impl<const D: usize> StaticState<D> {
    /// What later increments read; factors of the reference are found anew.
    pub fn archive(&mut self, body: &Body<D>, archive: &mut Archive<'_>) {
        let points = body.points();
        let sequence = || Sequence {
            next: vec![],
            f: zeros(body.len()),
            factor: 0.0,
        };
        archive.option("sequence", &mut self.sequence, sequence, |s, archive| {
            archive_bonds(body, archive, &mut s.next);
            body.archive_field(archive, "force_density", &mut s.f);
            archive.one("factor", &mut s.factor);
        });
        let followed = || Followed {
            way: vec![[0.0; D]; points],
            factor: 0.0,
            part: 0.0,
            most: 0.0,
        };
        archive.option("followed", &mut self.followed, followed, |f, archive| {
            archive.points("way", body.whose(), 1, (&mut f.way, 0..points));
            archive.one("factor", &mut f.factor);
            archive.one("part", &mut f.part);
            archive.one("most", &mut f.most);
        });
        body.archive_if_any(archive, "masses", &mut self.masses, 0.0);
        archive.one("solved", &mut self.solved);
    }

    /// Equations of a step in time that may serve the next, factored anew with what was held.
    pub fn archive_kept(&mut self, body: &Body<D>, held: &Support<D>, archive: &mut Archive<'_>) {
        let unread = || Equations::unread(body);
        archive.option("kept", &mut self.step, unread, |kept, archive| {
            kept.archive(body, held, archive);
        });
        archive.one("solved", &mut self.solved);
    }
}

/// Passes bonds through an archive, of which the one of two ranks has each that has its lower id.
fn archive_bonds<const D: usize>(
    body: &Body<D>,
    archive: &mut Archive<'_>,
    bonds: &mut Vec<Critical<D>>,
) {
    let ids = body.ids_of_all();
    let by_id = |bond: &Critical<D>| {
        let [i, j] = [bond.i, bond.j].map(|slot| ids[slot] as usize);
        let xi = if i < j { bond.xi } else { bond.xi.map(|x| -x) };
        let (i, j) = (i.min(j), i.max(j));
        (i as u32, Critical { i, j, xi, ..*bond })
    };
    let mut entries: Vec<(u32, Critical<D>)> = bonds.iter().map(by_id).collect();
    entries.sort_by(|(_, a), (_, b)| (a.i, a.j).cmp(&(b.i, b.j)).then(order(&a.xi, &b.xi)));
    archive.entries("next", body.whose(), &mut entries);
    if !archive.loads() {
        return;
    }
    let copies = body.exchange().copies();
    let others = copies.filter(|slot| body.exchange().original(*slot) == *slot);
    let own = body.slots().iter().map(|slot| *slot as usize);
    let slots: HashMap<usize, usize> = own.chain(others).map(|s| (ids[s] as usize, s)).collect();
    let lie = |(_, bond): (u32, Critical<D>)| {
        let (i, j) = (*slots.get(&bond.i)?, *slots.get(&bond.j)?);
        Some(Critical { i, j, ..bond })
    };
    match entries.into_iter().map(lie).collect() {
        Some(found) => *bonds = found,
        None => archive.refuse("next"),
    }
}

/// By the first numbers that differ.
fn order(x: &[f64], y: &[f64]) -> Ordering {
    let each = x.iter().zip(y).map(|(x, y)| x.total_cmp(y));
    each.fold(Ordering::Equal, Ordering::then)
}

/// A bond at its critical stretch.
#[derive(Debug, Clone, Copy)]
pub(in crate::run) struct Critical<const D: usize> {
    pub i: usize,
    pub j: usize,
    pub xi: [f64; D],
    pub stretch: f64,
}

words!([const D: usize] Critical<D> { i: usize, j: usize, xi: [f64; D], stretch: f64 });

/// What the last equilibrium left to be done.
pub(in crate::run) struct Sequence<const D: usize> {
    /// Bonds that break next.
    pub next: Vec<Critical<D>>,
    /// Forces of bonds at that equilibrium (force density).
    pub f: Field<D>,
    /// Its factor.
    pub factor: f64,
}

/// The last increment along a path.
pub(in crate::run) struct Followed<const D: usize> {
    /// `[N]` displacements that it added.
    pub way: Vec<[f64; D]>,
    /// What it added to the factor of the load.
    pub factor: f64,
    /// Its length over what is asked for.
    pub part: f64,
    /// The largest loads and reactions up to here (force).
    pub most: f64,
}
