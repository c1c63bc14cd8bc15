//! Conditions whose values come from outside, step by step, as a script evaluates them. They act in their order,
//! each on the force that the ones before it left.

use super::Program;
use super::force_field::ForceField;
use super::load::{Load, LoadKind};
use super::reaction::Reaction;
use super::rigid_body::{Form, Push, RigidBody};
use crate::body::Body;
use crate::execute::exact::Exact;
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

impl Drive {
    /// Of those of its points that stand at these places.
    pub fn pick(&self, places: &[usize]) -> Drive {
        let of = |values: &[[Option<f64>; 3]]| places.iter().map(|n| values[*n]).collect();
        match self {
            Drive::ReplaceEach(values) => Drive::ReplaceEach(of(values)),
            Drive::AddEach(values) => Drive::AddEach(of(values)),
            Drive::Drag(gamma) => Drive::Drag(places.iter().map(|n| gamma[*n]).collect()),
            Drive::Indent { .. } | Drive::Replace(_) | Drive::Add(_) => self.clone(),
        }
    }

    /// As numbers, of which [`Drive::of`] makes it again.
    pub fn numbers(&self) -> Vec<f64> {
        let known = |x: &Option<f64>| [f64::from(x.is_some()), x.unwrap_or(0.0)];
        let each =
            |values: &[[Option<f64>; 3]]| values.as_flattened().iter().flat_map(known).collect();
        let (kind, numbers): (f64, Vec<f64>) = match self {
            Drive::Indent {
                stiffness,
                form,
                push,
                center,
                radius,
            } => {
                let [kind, axis] = match form {
                    Form::Sphere => [0, 0],
                    Form::Cylinder(a) => [1, *a],
                    Form::Plane(a) => [2, *a],
                };
                let out = f64::from(*push == Push::Out);
                let form = [kind as f64, axis as f64, out, *stiffness, *radius];
                (0.0, [&form[..], center].concat())
            }
            Drive::Replace(values) => (1.0, each(&[*values])),
            Drive::ReplaceEach(values) => (2.0, each(values)),
            Drive::Add(values) => (3.0, values.to_vec()),
            Drive::AddEach(values) => (4.0, each(values)),
            Drive::Drag(gamma) => (5.0, gamma.clone()),
        };
        let mut all = vec![kind, numbers.len() as f64];
        all.extend(numbers);
        all
    }

    /// Of the numbers that it was made of, which are taken away from the front; `None`: they are none of one.
    pub fn of(numbers: &mut &[f64]) -> Option<Drive> {
        let (&[kind, count], rest) = numbers.split_first_chunk()?;
        let (own, rest) = rest.split_at_checked(count as usize)?;
        *numbers = rest;
        let known = |[is, x]: &[f64; 2]| (*is == 1.0).then_some(*x);
        let rows = || -> Vec<[Option<f64>; 3]> {
            let pairs: Vec<Option<f64>> = own.as_chunks().0.iter().map(known).collect();
            pairs.as_chunks().0.to_vec()
        };
        Some(match kind as u8 {
            0 => {
                let [form, axis, out, stiffness, radius, x, y, z] = *own.first_chunk()?;
                Drive::Indent {
                    stiffness,
                    form: match form as u8 {
                        0 => Form::Sphere,
                        1 => Form::Cylinder(axis as usize),
                        _ => Form::Plane(axis as usize),
                    },
                    push: if out == 1.0 { Push::Out } else { Push::In },
                    center: [x, y, z],
                    radius,
                }
            }
            1 => Drive::Replace(*rows().first()?),
            2 => Drive::ReplaceEach(rows()),
            3 => Drive::Add(*own.first_chunk()?),
            4 => Drive::AddEach(rows()),
            5 => Drive::Drag(own.to_vec()),
            _ => return None,
        })
    }
}

#[derive(Debug, Clone)]
#[allow(clippy::large_enum_variant)] // a handful, never moved
pub enum Driven<const D: usize> {
    RigidBody(RigidBody<D>),
    Load(Load<D>),
}

impl<const D: usize> Driven<D> {
    /// Passes what it remembers through an archive.
    pub fn archive(&mut self, body: &Body<D>, archive: &mut Archive<'_>) {
        match self {
            Driven::RigidBody(i) => archive.within("indenter", |archive| {
                i.archive(body, archive);
                i.reaction.iter_mut().for_each(|r| r.archive(archive));
            }),
            Driven::Load(l) => archive.within("load", |archive| {
                l.archive(body, archive);
                l.before.iter_mut().for_each(|r| r.archive(archive));
            }),
        }
    }
}

/// The load of a drive; `None` for an rigid_body.
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
            let mut surface = RigidBody::driven(stiffness, (form, push), center, radius, slots);
            surface.reaction = Some(Box::default());
            return Driven::RigidBody(surface);
        }
        let kind = load(drive).expect("all but rigid bodies are loads");
        let mut load = Load::new(kind, slots, points);
        load.before = Some(Box::default());
        Driven::Load(load)
    }

    /// New values; false if they are of another kind.
    pub fn set(&mut self, drive: &Drive) -> bool {
        match (self, drive) {
            (
                Driven::RigidBody(i),
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
            (Driven::RigidBody(_), _) => return false,
        }
        true
    }

    pub fn field(&mut self) -> &mut dyn ForceField<D> {
        match self {
            Driven::RigidBody(i) => i,
            Driven::Load(l) => l,
        }
    }

    /// Work done on the points of this rank (energy).
    pub fn work(&self) -> &Exact {
        match self {
            Driven::RigidBody(i) => &i.work,
            Driven::Load(l) => &l.work,
        }
    }

    /// What it is where it is no rigid body.
    pub fn load(&self) -> Option<&Load<D>> {
        match self {
            Driven::Load(l) => Some(l),
            Driven::RigidBody(_) => None,
        }
    }

    /// Of all ranks; all ask at once.
    pub fn reaction(&self, body: &Body<D>) -> Reaction {
        let sums = match self {
            Driven::RigidBody(i) => &i.reaction,
            Driven::Load(l) => &l.before,
        };
        { sums.as_ref() }.map_or_else(Reaction::default, |sums| sums.value(body))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drives_come_back_from_their_numbers() {
        let each = vec![
            [Some(1.0), None, Some(f64::INFINITY)],
            [None, Some(-0.0), None],
        ];
        let all = [
            Drive::Indent {
                stiffness: 1e17,
                form: Form::Cylinder(2),
                push: Push::In,
                center: [1.0, -2.0, 0.1],
                radius: 3.0,
            },
            Drive::Replace([None, Some(0.0), Some(2.0)]),
            Drive::ReplaceEach(each.clone()),
            Drive::ReplaceEach(vec![]),
            Drive::Add([1.0, 2.0, 3.0]),
            Drive::AddEach(each),
            Drive::Drag(vec![0.5, 0.0, 7.0]),
        ];
        let numbers: Vec<f64> = all.iter().flat_map(Drive::numbers).collect();
        let mut left = &numbers[..];
        for drive in &all {
            assert_eq!(Drive::of(&mut left).as_ref(), Some(drive));
        }
        assert!(left.is_empty() && Drive::of(&mut left).is_none());
        assert!(Drive::of(&mut &[2.0, 9.0, 1.0][..]).is_none());
        let gamma = |drive: &Drive| drive.pick(&[2, 0]);
        assert_eq!(gamma(&all[6]), Drive::Drag(vec![7.0, 0.5]));
        assert_eq!(gamma(&all[4]), all[4]);
    }
}
