//! Conditions whose values come from outside, step by step, as a script evaluates them. They act in their order,
//! each on the force that the ones before it left.

use super::Program;
use super::force_field::ForceField;
use super::indenter::{Form, Indenter, Push};
use super::load::{Load, LoadKind};
use super::reaction::Reaction;
use crate::body::Body;
use crate::space::Point;
use crate::state::Archive;

/// The values of a driven condition at one instant. Lists are in order of the condition's points.
#[derive(Debug, Clone, PartialEq)]
pub enum Drive {
    /// Rigid surface: force density `stiffness g²` along its normal where the gap g is negative; a plane has the radius 0
    /// and goes through the centre.
    Indent {
        stiffness: f64,
        form: Form,
        push: Push,
        center: [f64; 3],
        radius: f64,
    },
    /// The force density on these components becomes this.
    Replace([Option<f64>; 3]),
    /// The same, with values for each point.
    ReplaceEach(Vec<[Option<f64>; 3]>),
    /// A force density (force / volume) is added.
    Add([f64; 3]),
    /// The same, with values for each point; nothing where there are none.
    AddEach(Vec<[Option<f64>; 3]>),
    /// The force density −γ v is added, v as it is when forces are evaluated (in a step: of its middle); γ of each point
    /// (mass / volume / time).
    Drag(Vec<f64>),
}

#[derive(Debug, Clone)]
#[allow(clippy::large_enum_variant)] // a handful, never moved
pub enum Driven<const D: usize> {
    Indenter(Indenter<D>),
    Load(Load<D>),
}

impl<const D: usize> Driven<D> {
    /// Passes what it remembers through an archive.
    pub fn archive(&mut self, body: &Body<D>, archive: &mut Archive<'_>) {
        match self {
            Driven::Indenter(i) => archive.within("indenter", |archive| {
                i.archive(body, archive);
                archive.one("energy", &mut i.reaction.energy);
                archive.one("reaction", &mut i.reaction.force);
            }),
            Driven::Load(l) => archive.within("load", |archive| {
                l.archive(body, archive);
                archive.one("before", &mut l.before);
            }),
        }
    }
}

/// The load of a drive; `None` for an indenter.
fn load<const D: usize>(drive: &Drive) -> Option<LoadKind<D>> {
    Some(match drive {
        Drive::Indent { .. } => return None,
        Drive::Replace(values) => LoadKind::Replace(Program::given(*values)),
        Drive::ReplaceEach(values) => LoadKind::Replace(Program::listed(values)),
        Drive::Add(values) => LoadKind::Body(Program::given(values.map(Some))),
        Drive::AddEach(values) => LoadKind::Body(Program::listed(values)),
        Drive::Drag(gamma) => LoadKind::Drag(gamma.clone()),
    })
}

impl<const D: usize> Driven<D> {
    /// `slots`: the points it acts on.
    pub fn new(drive: &Drive, slots: Vec<u32>, points: Vec<Point>) -> Self {
        if let Drive::Indent {
            stiffness,
            form,
            push,
            center,
            radius,
        } = *drive
        {
            let surface = Indenter::driven(stiffness, (form, push), center, radius, slots);
            return Driven::Indenter(surface);
        }
        let kind = load(drive).expect("all but indenters are loads");
        Driven::Load(Load::new(kind, slots, points))
    }

    /// New values; false if they are of another kind.
    pub fn set(&mut self, drive: &Drive) -> bool {
        match (self, drive) {
            (
                Driven::Indenter(i),
                Drive::Indent {
                    stiffness,
                    form,
                    push,
                    center,
                    radius,
                },
            ) if i.form() == Some((*form, *push)) => i.drive(*stiffness, *center, *radius),
            (Driven::Load(l), drive) => match (&mut l.kind, drive) {
                // the values of every step: nothing is allocated
                (LoadKind::Replace(p), Drive::Replace(values)) => p.give(*values),
                (LoadKind::Body(p), Drive::Add(values)) => p.give(values.map(Some)),
                (kind, drive) => match load(drive) {
                    Some(new) if std::mem::discriminant(kind) == std::mem::discriminant(&new) => {
                        *kind = new;
                    }
                    _ => return false,
                },
            },
            (Driven::Indenter(_), _) => return false,
        }
        true
    }

    pub fn field(&mut self) -> &mut dyn ForceField<D> {
        match self {
            Driven::Indenter(i) => i,
            Driven::Load(l) => l,
        }
    }

    /// What it is where it is no rigid body.
    pub fn load(&self) -> Option<&Load<D>> {
        match self {
            Driven::Load(l) => Some(l),
            Driven::Indenter(_) => None,
        }
    }

    pub fn reaction(&self) -> Reaction {
        match self {
            Driven::Indenter(i) => i.reaction,
            Driven::Load(l) => Reaction {
                energy: 0.0,
                force: l.before,
            },
        }
    }
}
