//! `[[interface]]`: bonds between two of several bodies.

use super::context::{Context, Result};
use super::material::{fracture, law};
use super::pieces::named;
use super::{horizon, influence};
use crate::deck::document::Document;
use peridyne::spec::{BodySpec, InterfaceSpec};

/// All of a deck.
pub(super) fn interfaces(
    context: &Context,
    document: &Document,
    all: &BodySpec,
) -> Result<Vec<InterfaceSpec>> {
    let mut made = Vec::new();
    for at in &document.interfaces {
        let written = &at.value;
        let [first, second] = written.bodies.value.as_slice() else {
            return Err(context.error_with(
                &written.bodies.span,
                format!(
                    "an interface joins two bodies, here are {}",
                    written.bodies.value.len()
                ),
                "write bodies = [\"upper\", \"lower\"], names of two [[body]]",
            ));
        };
        let one = named(context, first, all)?;
        let other = named(context, second, all)?;
        made.push(InterfaceSpec {
            name: match &written.name {
                Some(name) => name.value.clone(),
                None => format!("{} to {}", one.name, other.name),
            },
            bodies: [one.name.clone(), other.name.clone()],
            law: law(context, &written.law, None)?,
            horizon: match (&written.horizon, one.horizon) {
                (Some(written), _) => horizon(context, written, &one.body)?,
                (None, Some(own)) => own,
                (None, None) => {
                    return Err(context.error(&at.span, "the interface has no horizon"));
                }
            },
            influence: influence(written.influence, &[]),
            fracture: written
                .fracture
                .as_ref()
                .map(|f| fracture(context, f))
                .transpose()?,
        });
    }
    Ok(made)
}
