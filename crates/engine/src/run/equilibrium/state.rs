//! What statics keeps between increments.

use super::system::Equations;
use crate::body::{Field, zeros};
use crate::spec::{Control, LinearBody, Statics};
use crate::state::{Archive, words};
use crate::statics::{Direct, Solved, Support};

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
    /// The largest masses of points that relaxation had, of laws that remember; else empty.
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
    /// What later increments read, of a body with so many slots; factors of the reference are found anew.
    pub fn archive(&mut self, slots: usize, archive: &mut Archive<'_>) {
        let sequence = || Sequence {
            next: vec![],
            f: zeros(slots),
            factor: 0.0,
        };
        archive.option("sequence", &mut self.sequence, sequence, |s, archive| {
            archive.list("next", &mut s.next);
            archive.columns("force_density", &mut s.f);
            archive.one("factor", &mut s.factor);
        });
        let followed = || Followed {
            way: vec![],
            factor: 0.0,
            part: 0.0,
            most: 0.0,
        };
        archive.option("followed", &mut self.followed, followed, |f, archive| {
            archive.list("way", &mut f.way);
            archive.one("factor", &mut f.factor);
            archive.one("part", &mut f.part);
            archive.one("most", &mut f.most);
        });
        archive.list("masses", &mut self.masses);
        archive.one("solved", &mut self.solved);
    }

    /// Equations of a step in time that may serve the next, factored anew with what was held.
    pub fn archive_kept(
        &mut self,
        period: [Option<f64>; D],
        held: &Support<D>,
        archive: &mut Archive<'_>,
    ) {
        let none = || Equations::none(period);
        archive.option("kept", &mut self.step, none, |kept, archive| {
            kept.archive(held, archive);
        });
        archive.one("solved", &mut self.solved);
    }
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
