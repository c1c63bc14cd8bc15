//! Laws and bonds of all bodies of a spec.

use super::interfaces::interfaces;
use super::parts::Part;
use super::surface;
use crate::body::Body;
use crate::constitutive::{ConstitutiveModel, ConstitutiveModels, Registry};
use crate::error::BuildError;
use crate::execute::simd::Simd;
use crate::interaction::Interaction;
use crate::interaction::MultiBodyInteraction;
use crate::message;
use crate::quantity::{Dimension, Warnings};
use crate::spec::{BodySpec, Spec};

type Bound<const D: usize> = (ConstitutiveModel, Option<Box<dyn Interaction<D>>>);

/// The law of one body, and its bonds, those near its surface scaled; `None`: loose points.
fn bonds<const D: usize>(
    part: &mut Part,
    body: &mut Body<D>,
    registry: &Registry,
    simd: Simd,
    warnings: &mut Warnings,
) -> Result<Bound<D>, BuildError> {
    let model = part.constitutive(body, registry, simd, warnings)?;
    let mut bonds = part.bonds(&model, body)?;
    if let (Some(factors), Some(bonds)) = (&part.spec.bonds.surface, &mut bonds) {
        surface::scale(factors, body, bonds.as_mut())?;
        warnings.extend(factors.warning.clone());
    }
    Ok((model, bonds))
}

/// Laws and bonds of all bodies.
#[allow(clippy::type_complexity)] // what a model is made of, twice
pub(super) fn bind<const D: usize>(
    spec: &Spec,
    parts: &mut [Part],
    body: &mut Body<D>,
    registry: &Registry,
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
        let (model, interaction) = bonds(&mut parts[0], body, registry, simd, warnings)?;
        let interaction = interaction.expect("a single body is bonded");
        let interaction = super::bonded::around(spec, body, registry, interaction, simd)?;
        return Ok((ConstitutiveModels::one(model), interaction));
    };
    let (mut constitutive, mut all) = (vec![], vec![]);
    for (n, part) in parts.iter_mut().enumerate() {
        let mut told = Warnings::default();
        let made = body.change_piece(n, |body| bonds(part, body, registry, simd, &mut told));
        let made = made.expect("made of several bodies");
        let (model, bonds) = made.map_err(|e| part.named(&named[n], e))?;
        warnings.extend(
            told.iter()
                .map(|w| message![format!("body `{}`: ", named[n].name), w]),
        );
        constitutive.push((body.pieces()[n].first, part.materials.clone(), model));
        all.push(bonds);
    }
    if named.iter().any(|p| p.surface.is_some()) {
        body.join_volumes();
    }
    let (mut joined, mut between) = (vec![], vec![]);
    for made in interfaces(spec, named, body, registry, simd)? {
        let (count, horizon) = (made.interface.near_horizon(), made.model.horizon);
        if count > 0 && !made.model.ratio {
            warnings.push(message![
                format!(
                    "{} bonds of an interface end within round-off of its horizon ",
                    count.div_ceil(2)
                ),
                Dimension::LENGTH.of(horizon),
                ": write it as a whole number of spacings (m_ratio), or well between two distances",
            ]);
        }
        joined.push(made.interface);
        between.extend(made.model.named);
    }
    let interaction = MultiBodyInteraction::new(body, all, joined);
    let constitutive = ConstitutiveModels::several(constitutive, between);
    Ok((constitutive, Box::new(interaction)))
}

/// Names and sizes of several bodies.
pub(super) fn names<const D: usize>(spec: &Spec, body: &Body<D>) -> Vec<(String, u64)> {
    match &spec.body {
        BodySpec::Several(pieces) => {
            let all = pieces.iter().zip(body.pieces());
            all.map(|(p, own)| (p.name.clone(), own.body.all_points() as u64))
                .collect()
        }
        BodySpec::Lattice { .. } | BodySpec::Sites { .. } | BodySpec::Cloud(_) => vec![],
    }
}
