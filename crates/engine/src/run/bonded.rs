//! Molecules: bonded terms beside the potential of a body of atoms.

use super::constitutive::{Shelf, breaking};
use crate::body::Body;
use crate::error::BuildError;
use crate::execute::simd::Simd;
use crate::interaction::Interaction;
use crate::interaction::atoms::bonded::BondedAtoms;
use crate::spec::{BodySpec, BondedSpec, FamilyChoice, Spec};

/// The interaction with what is bonded in the spec, if anything is.
pub(super) fn around<const D: usize>(
    spec: &Spec,
    body: &Body<D>,
    shelf: &Shelf,
    interaction: Box<dyn Interaction<D>>,
    simd: Simd,
) -> Result<Box<dyn Interaction<D>>, BuildError> {
    let Some(bonded) = &spec.interactions.bonded else {
        return Ok(interaction);
    };
    let refused =
        |message: &str, help: &str| Err(BuildError::unsupported("bonded", message).help(help));
    let Some(potentials) = shelf.potentials(spec)? else {
        return refused(
            "bonds, angles and dihedrals stand beside a potential of atoms",
            "give the material a pair potential",
        );
    };
    if spec.bonds.family == FamilyChoice::Stencil {
        return refused(
            "molecules have no stencil",
            "remove family = \"stencil\": atoms feel those that are near now, or with family = \"reference\" those of the reference",
        );
    }
    if !matches!(spec.body, BodySpec::Cloud(_)) {
        return refused(
            "bonded terms name atoms by their place in a file",
            "give body.file",
        );
    }
    if spec.materials.len() > 1 {
        return refused(
            "molecules leave out pairs of one potential, and several materials have several",
            "give the atoms one material",
        );
    }
    if let Some(path) = breaking(spec) {
        let message =
            "the bonds of a molecule are terms of its force field, which hold at any length";
        return Err(BuildError::unsupported(path, message).help("remove fracture and pre-cracks"));
    }
    fits(bonded, body.points())?;
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
