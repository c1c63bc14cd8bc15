//! Contact between points without a bond, its friction and cohesion.

use super::bodies;
use super::context::{Context, Result};
use crate::deck::document::{Cohesion, Document, Friction};
use crate::deck::units::Dim;
use crate::deck::value::{At, Number, Or, Written};
use peridyne::spec::{
    AtRest, CohesionSpec, ContactSpec, ContactStiffness, FrictionSpec, MaterialSpec,
};

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
        Some(Or::Table(c)) => {
            let get = |n: &Option<_>, or: f64, what: &str| {
                n.as_ref()
                    .map_or(Ok(or), |n| context.positive(n, Dim::NUMBER, what))
            };
            Ok(Some(ContactSpec {
                bonded: get(
                    &c.bonded,
                    standard.bonded,
                    "the fraction of the reference distance",
                )?,
                free: get(&c.free, standard.free, "the range")?,
                stiffness: match &c.stiffness {
                    Some(n) => ContactStiffness::Same(context.positive(
                        n,
                        Dim::CONTACT_STIFFNESS,
                        "the stiffness",
                    )?),
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
                conductance: { c.conductance.as_ref() }
                    .map(|n| context.positive(n, Dim::HEAT_TRANSFER, "the contact conductance"))
                    .transpose()?,
            }))
        }
    }
}

pub(super) fn cohesion(context: &Context, c: &Cohesion) -> Result<CohesionSpec> {
    Ok(CohesionSpec {
        energy: context.positive(&c.energy, Dim::FRACTURE_ENERGY, "the work of adhesion")?,
        strength: context.positive(&c.strength, Dim::PRESSURE, "the strength")?,
    })
}

pub(super) fn friction(
    context: &Context,
    written: &At<Or<Written, Friction>>,
) -> Result<FrictionSpec> {
    let coefficient = |n: &Number| {
        let expression = context.expression(n, Dim::NUMBER)?;
        match expression.as_constant() {
            Some(_) => context.positive(n, Dim::NUMBER, "the friction coefficient")?,
            None => 0.0,
        };
        Ok(expression)
    };
    match &written.value {
        Or::Bare(value) => Ok(FrictionSpec {
            kinetic: coefficient(&At {
                value: value.clone(),
                span: written.span.clone(),
            })?,
            at_rest: None,
        }),
        Or::Table(f) => {
            let at_rest = match (&f.at_rest, &f.speed) {
                (Some(n), Some(v)) => Some(AtRest {
                    coefficient: coefficient(n)?,
                    speed: context.positive(
                        v,
                        Dim::VELOCITY,
                        "the speed over which friction falls",
                    )?,
                }),
                (None, None) => None,
                (Some(n), None) | (None, Some(n)) => {
                    let message = "static and speed go together: at the speed the difference from kinetic is 1/e of that at rest";
                    return Err(context.error(&n.span, message));
                }
            };
            Ok(FrictionSpec {
                kinetic: coefficient(&f.kinetic)?,
                at_rest,
            })
        }
    }
}
