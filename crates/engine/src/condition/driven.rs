//! Conditions whose values come from outside, step by step, as a script evaluates them. They act in their order,
//! each on the force that the ones before it left.

use super::Program;
use super::indenter::Indenter;
use super::load::{Load, LoadKind};
use crate::body::{Body, Field};
use crate::space::Point;

/// The values of a driven condition at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Drive {
    /// Rigid sphere: force density `stiffness (r − radius)²` away from `center` for r < `radius`.
    Indent {
        stiffness: f64,
        center: [f64; 3],
        radius: f64,
    },
    /// The force density on these components becomes this.
    Replace([Option<f64>; 3]),
    /// A force density (force / volume) is added.
    Add([f64; 3]),
}

/// What an indenter had at the last force evaluation, in sums over points of *densities* (as LAMMPS prints them).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Reaction {
    /// `Σ K (R − r)³ / 3`.
    pub energy: f64,
    /// Minus the sum of the force densities on the points.
    pub force: [f64; 3],
}

#[derive(Debug, Clone)]
#[allow(clippy::large_enum_variant)] // a handful, never moved
pub(crate) enum Driven<const D: usize> {
    Indenter(Indenter<D>),
    Load(Load<D>),
}

impl<const D: usize> Driven<D> {
    /// `slots`: the points it acts on.
    pub fn new(drive: &Drive, slots: Vec<u32>, points: Vec<Point>) -> Self {
        match *drive {
            Drive::Indent {
                stiffness,
                center,
                radius,
            } => Driven::Indenter(Indenter::driven(stiffness, center, radius, slots)),
            Drive::Replace(values) => Driven::Load(Load::new(
                LoadKind::Replace(Program::given(values)),
                slots,
                points,
            )),
            Drive::Add(values) => Driven::Load(Load::new(
                LoadKind::Body(Program::given(values.map(Some))),
                slots,
                points,
            )),
        }
    }

    /// New values; false if they are of another kind.
    pub fn set(&mut self, drive: &Drive) -> bool {
        match (self, *drive) {
            (
                Driven::Indenter(i),
                Drive::Indent {
                    stiffness,
                    center,
                    radius,
                },
            ) => i.drive(stiffness, center, radius),
            (Driven::Load(l), Drive::Replace(values)) => match &mut l.kind {
                LoadKind::Replace(p) => p.give(values),
                _ => return false,
            },
            (Driven::Load(l), Drive::Add(values)) => match &mut l.kind {
                LoadKind::Body(p) => p.give(values.map(Some)),
                _ => return false,
            },
            _ => return false,
        }
        true
    }

    /// Half of the old force's work; `moved` bounds the path of any point.
    pub fn begin(&mut self, body: &Body<D>, v: &Field<D>, t: f64, dt: f64, moved: f64) {
        match self {
            Driven::Indenter(i) => i.begin(body, v, t, dt, moved),
            Driven::Load(l) => l.begin(body, v, dt),
        }
    }

    /// Add the force density; `dt` is 0 at the start of a run.
    pub fn add(
        &mut self,
        body: &Body<D>,
        u: &Field<D>,
        v: &Field<D>,
        f: &mut Field<D>,
        t: f64,
        dt: f64,
    ) {
        match self {
            Driven::Indenter(i) => i.add(body, u, v, f, dt),
            Driven::Load(l) => l.add(body, v, f, t, dt),
        }
    }

    pub fn reaction(&self) -> Reaction {
        match self {
            Driven::Indenter(i) => i.reaction,
            Driven::Load(_) => Reaction::default(),
        }
    }
}
