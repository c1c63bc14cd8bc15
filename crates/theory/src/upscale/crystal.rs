//! The crystal of a model.

use super::atoms::Atoms;
use super::atoms::has_basis_or_many_body;
use super::error::UpscaleError;
use super::reference::{lattice, reach};
use crate::crystal::{Crystal, CrystalError, LatticeSolid, Reach, Reference};
use peridyne::law::potential::{Potential, Visitor};
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::Spec;

pub(super) struct OfPotential<const D: usize> {
    kind: LatticeKind,
    spacing: f64,
    mass: f64,
    reach: Reach,
}

impl<const D: usize> Visitor for OfPotential<D> {
    type Out = Result<(Crystal<D>, Reference), CrystalError>;
    fn visit<P: Potential>(self, potential: P) -> Self::Out {
        Crystal::of_potential(&potential, self.kind, self.spacing, self.mass, self.reach)
    }
}

/// The perfect crystal of a lattice spec about its reference; of atoms also what that reference is.
pub fn crystal<const D: usize>(
    spec: &Spec,
) -> Result<(Crystal<D>, Option<Reference>), UpscaleError> {
    let (kind, spacing) = lattice(spec)?;
    let density = spec.materials[0].density;
    match spec.potential() {
        Some(_) if has_basis_or_many_body(spec) => {
            let (crystal, reference) = Atoms::<D>::of(spec)?.crystal()?;
            Ok((crystal, Some(reference)))
        }
        None if spec.materials.len() > 1 => Err(UpscaleError::SeveralMaterials),
        Some(potential) => {
            let volume = kind.site_volume() * spacing.powi(D as i32) * spec.space.section;
            let of = OfPotential::<D> {
                kind,
                spacing,
                mass: density * volume,
                reach: reach(spec),
            };
            let (crystal, reference) = potential.apply(of).map_err(CrystalError::Potential)??;
            Ok((crystal, Some(reference)))
        }
        None => {
            let mut solid = LatticeSolid::new(kind, spacing, spec.bonds.horizon);
            solid.section = spec.space.section;
            solid.density = density;
            solid.influence = spec.bonds.influence;
            solid.partial_volume_correction = spec.bonds.partial_volume_correction;
            let crystal = solid.of_law(
                &spec.materials[0].law,
                spec.space.plane,
                spec.bonds.calibration,
            )?;
            Ok((crystal, None))
        }
    }
}
