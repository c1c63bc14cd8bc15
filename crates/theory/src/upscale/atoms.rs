//! Atoms of several kinds, and atoms with terms of more than two: their crystals.

use super::reference::{current, lattice};

use super::error::UpscaleError;
use crate::crystal::arrangement::arrangement;
use crate::crystal::atoms::{Cell, Near, neighbours};
use crate::crystal::cells::determinant;
use crate::crystal::{Atom, Crystal, CrystalError, Reference, kinds};
use peridyne::law::many_body;
use peridyne::law::potential::mixture::Given;
use peridyne::run::Registry;
use peridyne::spec::{FamilyChoice, Horizon, LawSpec, Spec};

/// What is at a horizon is within it.
const INCLUSIVE: f64 = 1.0 + 1e-9;

/// Has it several kinds of atoms, or terms of more than two? Theory knows such potentials by names.
pub fn has_basis_or_many_body(spec: &Spec) -> bool {
    let several = spec.materials.len() > 1 || !spec.interactions.potentials.is_empty();
    spec.potential()
        .is_some_and(|p| several || many_body::is_known(&p.name))
}

/// A cell of atoms and what they say to each other.
pub(super) struct Atoms<const D: usize> {
    given: Vec<(String, Given)>,
    cell: [[f64; D]; D],
    atoms: Vec<Atom<D>>,
    /// Neighbours that stay neighbours; `None`: those that are near now.
    fixed: Option<Vec<Near<D>>>,
}

impl<const D: usize> Atoms<D> {
    pub fn of(spec: &Spec) -> Result<Self, UpscaleError> {
        let (kind, spacing) = lattice(spec)?;
        let found = arrangement::<D>(spec)?;
        let volume = kind.site_volume() * spacing.powi(D as i32) * spec.space.section;
        let atom = |(place, kind): &([f64; D], usize)| Atom {
            place: *place,
            kind: *kind,
            mass: spec.materials[*kind].density * volume,
        };
        let given = Registry::standard().given(spec);
        let given = given.map_err(|e| CrystalError::Potential(e.message.into()))?;
        let atoms: Vec<Atom<D>> = found.sites.iter().map(atom).collect();
        let fixed = match current(spec) {
            true => None,
            false if given.len() > 1 => return Err(CrystalError::FixedNeighbours.into()),
            false => {
                let horizon = INCLUSIVE * spec.bonds.horizon.length(spacing);
                Some(neighbours(&found.cell, &atoms, horizon, |_, _| horizon)?)
            }
        };
        Ok(Atoms {
            given,
            cell: found.cell,
            atoms,
            fixed,
        })
    }

    fn cell(&self) -> Cell<'_, D> {
        Cell {
            rows: self.cell,
            atoms: &self.atoms,
            fixed: self.fixed.as_deref(),
        }
    }

    /// Everything carried along.
    fn moved(&self, by: impl Fn([f64; D]) -> [f64; D] + Copy) -> Self {
        let atom = |a: &Atom<D>| Atom {
            place: by(a.place),
            ..*a
        };
        let near = |all: &Vec<Near<D>>| all.iter().map(|n| n.moved(by)).collect();
        Atoms {
            given: self.given.clone(),
            cell: self.cell.map(by),
            atoms: self.atoms.iter().map(atom).collect(),
            fixed: self.fixed.as_ref().map(near),
        }
    }

    /// All lengths of the cell times a factor.
    pub fn grown(&self, factor: f64) -> Self {
        self.moved(|x| x.map(|x| factor * x))
    }

    /// Energy per volume of the reference where it is strained by ε (x → x + ε x) with all atoms carried along.
    pub fn energy_density(&self, strain: [[f64; 3]; 3]) -> Option<f64> {
        let moved = |x: [f64; D]| -> [f64; D] {
            std::array::from_fn(|a| x[a] + (0..D).map(|b| strain[a][b] * x[b]).sum::<f64>())
        };
        let strained = self.moved(moved);
        let found = kinds::state(&self.given, strained.cell()).ok();
        found.map(|[energy, _]| energy / determinant(&self.cell).abs())
    }

    /// Energy per atom and pressure.
    pub fn state(&self) -> Result<[f64; 2], CrystalError> {
        let [energy, pressure] = kinds::state(&self.given, self.cell())?;
        Ok([energy / self.atoms.len() as f64, pressure])
    }

    pub fn crystal(&self) -> Result<(Crystal<D>, Reference), CrystalError> {
        let (crystal, energy) = kinds::crystal(&self.given, self.cell())?;
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

/// All potentials of atoms at n times the spacing, which `coarse` has already: lengths times n, energies times n^D.
///
/// # Errors
/// The kinds do not lie there as they lie here.
pub(super) fn grow(fine: &Spec, coarse: &mut Spec, n: f64) -> Result<(), UpscaleError> {
    let energy = n.powi(fine.space.dimension as i32);
    for material in &mut coarse.materials {
        if let LawSpec::Atoms(potential) = &mut material.law {
            *potential = potential
                .scaled(n, energy)
                .map_err(CrystalError::Potential)?;
        }
    }
    for acting in &mut coarse.interactions.potentials {
        let scaled = acting.potential.scaled(n, energy);
        acting.potential = scaled.map_err(CrystalError::Potential)?;
    }
    if current(fine) {
        coarse.bonds.family = FamilyChoice::Neighbours;
    } else if let Horizon::Length(d) = &mut coarse.bonds.horizon {
        *d *= n;
    }
    let alike = match fine.space.dimension {
        1 => alike::<1>(fine, coarse, n),
        2 => alike::<2>(fine, coarse, n),
        _ => alike::<3>(fine, coarse, n),
    };
    match alike? {
        true => Ok(()),
        false => Err(UpscaleError::OtherArrangement),
    }
}

/// Is one the other, `n` times as large?
fn alike<const D: usize>(fine: &Spec, coarse: &Spec, n: f64) -> Result<bool, UpscaleError> {
    let a = arrangement::<D>(fine)?;
    let b = match arrangement::<D>(coarse) {
        Err(CrystalError::NotPeriodic) => return Ok(false),
        found => found?,
    };
    let kinds = |sites: &[([f64; D], usize)]| {
        let mut all: Vec<usize> = sites.iter().map(|(_, kind)| *kind).collect();
        all.sort_unstable();
        all
    };
    let volumes = determinant(&b.cell).abs() / determinant(&a.cell).abs();
    Ok(kinds(&a.sites) == kinds(&b.sites) && (volumes / n.powi(D as i32) - 1.0).abs() < 1e-9)
}
