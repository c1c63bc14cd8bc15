//! Laws and bonds of all bodies of a spec.

use super::constitutive::{ConstitutiveModels, Shelf};
use super::contact::own_stiffness;
use super::interfaces::interfaces;
use super::parts::Part;
use crate::body::{Body, Layout};
use crate::error::BuildError;
use crate::execute::simd::Simd;
use crate::interaction::Interaction;
use crate::interaction::several::SeveralInteraction;
use crate::message;
use crate::quantity::{Dimension, Warnings};
use crate::spec::{BodySpec, Spec};

/// Laws and bonds of all bodies.
#[allow(clippy::type_complexity)] // what a model is made of, twice
pub(super) fn bind<const D: usize>(
    spec: &Spec,
    parts: &mut [Part],
    body: &mut Body<D>,
    shelf: &Shelf,
    simd: Simd,
    warnings: &mut Warnings,
) -> Result<(ConstitutiveModels, Box<dyn Interaction<D>>), BuildError> {
    let BodySpec::Several(named) = &spec.body else {
        if let Some(interface) = spec.interactions.interfaces.first() {
            let message = format!(
                "interface `{}` joins two of several bodies, and there is one",
                interface.name
            );
            return Err(BuildError::conflict("interface[0].bodies", message)
                .help("write [[body]] for each of the two"));
        }
        let mut model = parts[0].constitutive(body, shelf, simd, warnings)?;
        if let Some(repulsion) = &mut model.repulsion {
            repulsion.own = own_stiffness(spec, body, &model.contact, model.horizon);
        }
        let interaction = model.interaction(body, None)?;
        let interaction = super::bonded::around(spec, body, shelf, interaction, simd)?;
        return Ok((ConstitutiveModels::one(model), interaction));
    };
    let (mut constitutive, mut bonds) = (vec![], vec![]);
    for (n, part) in parts.iter_mut().enumerate() {
        let mut own = body.pieces()[n].body.clone();
        part.choose(body, n, &mut own);
        let mut told = Warnings::default();
        let made = part
            .constitutive(&own, shelf, simd, &mut told)
            .and_then(|model| {
                let bonds = part.bonds(&model, &own)?;
                Ok((model, bonds))
            });
        let (model, bond) = made.map_err(|e| BuildError {
            message: message![format!("body `{}`: ", named[n].name), e.message],
            ..e
        })?;
        warnings.extend(
            told.iter()
                .map(|w| message![format!("body `{}`: ", named[n].name), w]),
        );
        constitutive.push((body.pieces()[n].first, part.materials.clone(), model));
        bonds.push(bond);
        if let Layout::Several(pieces) = &mut body.layout {
            pieces[n].body = own;
        }
    }
    let mut joined = vec![];
    for made in interfaces(spec, named, body, shelf, simd)? {
        let (count, horizon) = (made.interface.near_horizon(), made.model.horizon);
        if count > 0 && !made.model.ratio {
            warnings.push(message![
                format!(
                    "{count} directed bonds of an interface end within round-off of its horizon "
                ),
                Dimension::LENGTH.of(horizon),
                ": write it as a whole number of spacings (m_ratio), or well between two distances",
            ]);
        }
        joined.push(made.interface);
    }
    let interaction = SeveralInteraction::new(body, bonds, joined);
    let constitutive = ConstitutiveModels::several(constitutive);
    Ok((constitutive, Box::new(interaction)))
}

/// Names and sizes of several bodies.
pub(super) fn names<const D: usize>(spec: &Spec, body: &Body<D>) -> Vec<(String, u64)> {
    match &spec.body {
        BodySpec::Several(pieces) => {
            let all = pieces.iter().zip(body.pieces());
            all.map(|(p, own)| (p.name.clone(), own.body.points() as u64))
                .collect()
        }
        BodySpec::Lattice { .. } | BodySpec::Sites { .. } | BodySpec::Cloud(_) => vec![],
    }
}
