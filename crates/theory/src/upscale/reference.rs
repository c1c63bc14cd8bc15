//! The lattice of a model, how far its bonds reach, and its crystal.

use super::error::UpscaleError;
use crate::crystal::Reach;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::{BodySpec, FamilyChoice, PotentialSpec, Spec};

/// How many cut-offs of reference neighbours an upscaled potential keeps: those that a compression of a tenth brings in.
pub const REACH: f64 = 1.1;

/// Lattice and spacing of a body.
pub fn lattice(spec: &Spec) -> Result<(LatticeKind, f64), UpscaleError> {
    match &spec.body {
        BodySpec::Lattice {
            kind,
            spacing,
            perturb: None,
            ..
        }
        | BodySpec::Sites { kind, spacing, .. } => Ok((*kind, *spacing)),
        BodySpec::Lattice { .. } | BodySpec::Cloud(_) | BodySpec::Several(_) => {
            Err(UpscaleError::NoLattice)
        }
    }
}

pub(super) fn current(spec: &Spec) -> bool {
    let own = spec.materials.iter().filter_map(|m| m.law.potential());
    let all = own.chain(spec.interactions.potentials.iter().map(|p| &p.potential));
    let longest = all.map(PotentialSpec::cut_off).fold(0.0, f64::max);
    match spec.bonds.family {
        _ if spec.potential().is_none() => false,
        FamilyChoice::Auto | FamilyChoice::Neighbours => true,
        // about the reference nobody can tell, if families hold all that feel each other
        FamilyChoice::Reference => {
            lattice(spec).is_ok_and(|(_, a)| spec.bonds.horizon.length(a) >= longest)
        }
        FamilyChoice::Stencil | FamilyChoice::List => false,
    }
}

/// Which neighbours of a perfect crystal count.
pub(crate) fn reach(spec: &Spec) -> Reach {
    match current(spec) {
        true => Reach::Cutoff,
        false => Reach::Horizon(spec.bonds.horizon),
    }
}
