//! Molecules: bonded terms beside the potential of a body of atoms.

use crate::body::Body;
use crate::constitutive::Registry;
use crate::error::BuildError;
use crate::execute::simd::Simd;
use crate::interaction::BondedAtoms;
use crate::interaction::Interaction;
use crate::spec::{BodySpec, BondedSpec, Spec};

/// The interaction with what is bonded in the spec, if anything is.
pub(super) fn around<const D: usize>(
    spec: &Spec,
    body: &Body<D>,
    registry: &Registry,
    interaction: Box<dyn Interaction<D>>,
    simd: Simd,
) -> Result<Box<dyn Interaction<D>>, BuildError> {
    let Some(bonded) = &spec.interactions.bonded else {
        return Ok(interaction);
    };
    let refused =
        |message: &str, help: &str| Err(BuildError::unsupported("bonded", message).help(help));
    let Some(potentials) = registry.potentials(spec)? else {
        return Ok(interaction);
    };
    if !matches!(spec.body, BodySpec::Cloud(_)) {
        return refused(
            "bonded terms name atoms by their place in a file",
            "give body.file",
        );
    }
    fits(bonded, body.all_points())?;
    let pair = potentials.pair()?;
    Ok(Box::new(BondedAtoms::new(
        interaction,
        body,
        bonded.clone(),
        pair,
        simd,
    )))
}

/// Do all terms name forms and points that exist, each point once?
fn fits(bonded: &BondedSpec, points: usize) -> Result<(), BuildError> {
    for (n, term) in bonded.terms.iter().enumerate() {
        let wrong =
            |message: String| Err(BuildError::invalid(format!("bonded.terms[{n}]"), message));
        let Some(form) = bonded.forms.get(term.form as usize) else {
            return wrong(format!(
                "there is no form {}; there are {}",
                term.form,
                bonded.forms.len()
            ));
        };
        let named = &term.points[..form.particles()];
        if let Some(p) = named.iter().find(|p| **p as usize >= points) {
            return wrong(format!("there is no point {p}; there are {points}"));
        }
        let twice = (1..named.len()).find(|m| named[..*m].contains(&named[*m]));
        if let Some(m) = twice {
            return wrong(format!("the point {} is in it twice", named[m]));
        }
    }
    Ok(())
}
