//! Contact between points without a bond, its friction and cohesion.

use super::bodies;
use super::context::{Context, Result};
use crate::deck::document::{Cohesion, Document, Friction};
use crate::deck::quantity::Positive;
use crate::deck::value::{At, Measured, Or};
use peridyne::spec::{
    AtRest, CohesionSpec, ContactSpec, ContactStiffness, FrictionSpec, MaterialSpec,
};
use std::ops::Range;

pub fn contact(
    context: &Context,
    document: &Document,
    materials: &[MaterialSpec],
) -> Result<Option<ContactSpec>> {
    let standard = ContactSpec {
        bonded: 0.9,
        free: 1.35,
        stiffness: ContactStiffness::Laws,
        friction: None,
        cohesion: None,
        conductance: None,
    };
    match &document.contact {
        Some(Or::Bare(false)) => Ok(None),
        Some(Or::Bare(true)) => Ok(Some(standard)),
        None => {
            let touches = bodies::several(document);
            let breaks = materials.iter().any(|m| m.fracture.is_some());
            // how atoms repel each other their potential says
            let atoms = materials.iter().all(|m| m.law.potential().is_some());
            Ok((touches || breaks && !atoms).then_some(standard))
        }
        Some(Or::Table(c)) => Ok(Some(ContactSpec {
            bonded: context.value_or(&c.reference_fraction, standard.bonded)?,
            free: context.value_or(&c.spacing_multiple, standard.free)?,
            stiffness: match context.optional(&c.stiffness)? {
                Some(same) => ContactStiffness::Same(same),
                None => ContactStiffness::Laws,
            },
            friction: c
                .friction
                .as_ref()
                .map(|f| friction(context, f))
                .transpose()?,
            cohesion: { c.cohesion.as_ref() }
                .map(|c| cohesion(context, &c.value))
                .transpose()?,
            conductance: context.optional(&c.conductance)?,
        })),
    }
}

pub(super) fn cohesion(context: &Context, c: &Cohesion) -> Result<CohesionSpec> {
    Ok(CohesionSpec {
        energy: context.value(&c.energy)?,
        strength: context.value(&c.strength)?,
    })
}

pub(super) fn friction(
    context: &Context,
    written: &At<Or<Measured<Positive>, Friction>>,
) -> Result<FrictionSpec> {
    match &written.value {
        Or::Bare(value) => Ok(FrictionSpec {
            kinetic: context.expression(&At {
                value: value.clone(),
                span: written.span.clone(),
            })?,
            at_rest: None,
        }),
        Or::Table(f) => {
            let alone = |span: &Range<usize>| {
                let message = "static and speed go together: at the speed the difference from kinetic is 1/e of that at rest";
                context.error(span, message)
            };
            let at_rest = match (&f.at_rest, &f.speed) {
                (Some(n), Some(v)) => Some(AtRest {
                    coefficient: context.expression(n)?,
                    speed: context.value(v)?,
                }),
                (None, None) => None,
                (Some(n), None) => return Err(alone(&n.span)),
                (None, Some(v)) => return Err(alone(&v.span)),
            };
            Ok(FrictionSpec {
                kinetic: context.expression(&f.kinetic)?,
                at_rest,
            })
        }
    }
}
