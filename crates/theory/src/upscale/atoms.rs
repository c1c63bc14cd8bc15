//! Atoms of several kinds, and atoms with terms of more than two: their crystals.

use super::{UpscaleError, current, lattice};
use crate::crystal::arrangement::arrangement;
use crate::crystal::{Atom, Crystal, CrystalError, Reference, kinds};
use peridyne::law::fan;
use peridyne::law::potential::mixture::Given;
use peridyne::run::Shelf;
use peridyne::spec::Spec;

/// Has it several kinds of atoms, or terms of more than two? Such atoms live on current neighbours, and theory knows their potentials
/// by names.
pub fn has_basis_or_fans(spec: &Spec) -> bool {
    let several = spec.materials.len() > 1 || !spec.potentials.is_empty();
    spec.potential()
        .is_some_and(|p| several || fan::is_known(&p.name))
}

/// A cell of atoms and what they say to each other.
pub(super) struct Atoms<const D: usize> {
    given: Vec<(String, Given)>,
    cell: [[f64; D]; D],
    atoms: Vec<Atom<D>>,
}

impl<const D: usize> Atoms<D> {
    pub fn of(spec: &Spec) -> Result<Self, UpscaleError> {
        if !current(spec) {
            return Err(CrystalError::FixedNeighbours.into());
        }
        let (kind, spacing) = lattice(spec)?;
        let found = arrangement::<D>(spec)?;
        let volume = kind.site_volume() * spacing.powi(D as i32) * spec.section;
        let atom = |(place, kind): &([f64; D], usize)| Atom {
            place: *place,
            kind: *kind,
            mass: spec.materials[*kind].density * volume,
        };
        let given = Shelf::standard().given(spec);
        Ok(Atoms {
            given: given.map_err(|e| CrystalError::Potential(e.message))?,
            cell: found.cell,
            atoms: found.sites.iter().map(atom).collect(),
        })
    }

    /// All lengths of the cell times a factor.
    pub fn grown(&self, factor: f64) -> Self {
        let grown = |x: [f64; D]| x.map(|x| factor * x);
        let atom = |a: &Atom<D>| Atom {
            place: grown(a.place),
            ..*a
        };
        Atoms {
            given: self.given.clone(),
            cell: self.cell.map(grown),
            atoms: self.atoms.iter().map(atom).collect(),
        }
    }

    pub fn crystal(&self) -> Result<(Crystal<D>, Reference), CrystalError> {
        let (crystal, energy) = kinds::crystal(&self.given, self.cell, &self.atoms)?;
        let sites = self.atoms.len();
        let reference = Reference {
            energy: energy / sites as f64,
            pressure: crystal.pressure(),
            density: 0.0,
            neighbours: crystal.bonds.len() / sites,
        };
        Ok((crystal, reference))
    }
}
