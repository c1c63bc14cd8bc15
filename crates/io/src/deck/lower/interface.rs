//! `bond_mixing`: what bonds between unlike materials have. `[[interface]]`: bonds between two of several bodies.

use super::context::{Context, Result};
use super::family::{horizon, influence};
use super::material::{fracture, law};
use super::pieces::named;
use crate::deck::document::{BondMixingName, Document};
use peridyne::law::material::Thermoelastic;
use peridyne::spec::{BodySpec, BondMixing, InterfaceSpec, LawSpec, MaterialSpec};

/// What bonds between unlike ends have.
pub(super) fn rule(
    context: &Context,
    document: &Document,
    materials: &[MaterialSpec],
) -> Result<BondMixing> {
    let Some(written) = &document.bond_mixing else {
        return Ok(BondMixing::Harmonic);
    };
    let rule = match written.value {
        BondMixingName::Arithmetic => BondMixing::Arithmetic,
        BondMixingName::Minimum => BondMixing::Minimum,
        BondMixingName::Harmonic => BondMixing::Harmonic,
    };
    let bonds = |m: &MaterialSpec| match &m.law {
        LawSpec::Pmb(_) | LawSpec::Springs(_) => true,
        // pmb in general sweeps
        LawSpec::Named(law) => law.name == Thermoelastic::NAME,
        LawSpec::Lps(_)
        | LawSpec::Lps3d { .. }
        | LawSpec::EamLike { .. }
        | LawSpec::Micromoduli(_)
        | LawSpec::Atoms(_) => false,
    };
    let applies = rule == BondMixing::Arithmetic
        || !document.bond_stiffness.is_empty()
        || materials.iter().all(bonds);
    match applies {
        true => Ok(rule),
        false => Err(context.error_with(
            &written.span,
            "`bond_mixing` is for bond-based materials (pmb): with other laws each end of a bond has its own constants",
            "leave it out, or write bond_mixing = \"arithmetic\"",
        )),
    }
}

/// All of a deck.
pub(super) fn interfaces(
    context: &Context,
    document: &Document,
    all: &BodySpec,
) -> Result<Vec<InterfaceSpec>> {
    let mut made = Vec::new();
    for at in &document.interface {
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
            law: law(context, &written.law)?,
            horizon: match (&written.horizon, one.horizon) {
                (Some(written), _) => horizon(context, written, &one.body)?,
                (None, Some(own)) => own,
                (None, None) => {
                    return Err(context.error(&at.span, "the interface has no horizon"));
                }
            },
            influence: influence(context, written.influence.as_ref(), &[])?,
            fracture: written
                .fracture
                .as_ref()
                .map(|f| fracture(context, f))
                .transpose()?,
        });
    }
    Ok(made)
}
