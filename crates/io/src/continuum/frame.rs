//! A frame of a file as particles: masses found, velocities in the units of the frame, the cell as it is.

use super::elements::weight;
use super::kinds::{Kind, kinds_of};
use super::potential::Model;
use super::units::Units;
use crate::deck::UnitSystem;
use crate::read::{Atoms, Species};
use peridyne_fields::{Cell, Frame};
use std::collections::BTreeMap;

/// Masses by the names of species, as a user gives them.
pub type Masses = BTreeMap<String, f64>;

/// The particles of a frame.
///
/// # Errors
/// In words: a species that the potential does not know or that has no mass, a mass of nobody, other units, a periodic axis without a
/// length, no atoms.
pub fn frame(atoms: &Atoms, units: Units, masses: &Masses, model: &Model) -> Result<Frame, String> {
    if atoms.is_empty() {
        return Err("the frame has no atoms".into());
    }
    if let Some(own) = { atoms.units.as_deref() }.filter(|own| *own != units.name())
        && units != Units::Deck(UnitSystem::None)
    {
        return Err(format!(
            "it says that it is in {own} units, and was taken to be in {}",
            units.name()
        ));
    }
    let kind = kinds_of(&model.kinds, &model.name, atoms)?;
    all_meant(atoms, masses, model)?;
    let mut used = vec![false; atoms.species.len()];
    atoms.kind.iter().for_each(|k| used[*k as usize] = true);
    let mut mass = vec![];
    for (n, species) in atoms.species.iter().enumerate() {
        let kind = &model.kinds[kind[n] as usize];
        mass.push(match used[n] {
            true => of_species(species, kind, units, masses, atoms.mass.is_some())?,
            false => None,
        });
    }
    // what is given for a species is that of all of its atoms; else each has its own
    let own = |(i, k): (usize, &u32)| match (mass[*k as usize], &atoms.mass) {
        (Some(mass), _) => mass,
        (None, Some(own)) => own[i],
        (None, None) => f64::NAN,
    };
    let speed = match atoms.from_momenta {
        true => units.ase_velocity(),
        false => 1.0,
    };
    let velocity = atoms.velocity.as_ref();
    Ok(Frame {
        cell: cell(atoms)?,
        position: atoms.position.clone(),
        velocity: velocity.map(|all| all.iter().map(|v| v.map(|c| c * speed)).collect()),
        mass: { atoms.kind.iter().enumerate() }
            .map(|at| own(at) * units.mass())
            .collect(),
        kind: atoms.kind.iter().map(|k| kind[*k as usize]).collect(),
        time: atoms.time,
    })
}

/// Names of what has a mass: species and kinds.
fn names<'a>(species: &'a str, kind: &'a Kind) -> impl Iterator<Item = &'a str> {
    let own = kind.names.iter().chain(&kind.element);
    std::iter::once(species).chain(own.map(String::as_str))
}

/// A mass for a name that nobody has is a mistake.
fn all_meant(atoms: &Atoms, masses: &Masses, model: &Model) -> Result<(), String> {
    let of_kinds = model.kinds.iter().flat_map(|kind| names("", kind));
    let species = || atoms.species.iter().map(|s| s.name.as_str());
    let known: Vec<&str> = species().chain(of_kinds).collect();
    match masses.keys().find(|name| !known.contains(&name.as_str())) {
        None => Ok(()),
        Some(name) => Err(format!(
            "--mass {name}: there is no {name}; the frame has {}",
            species().collect::<Vec<_>>().join(", ")
        )),
    }
}

/// The mass of a species, of whoever says it.
fn known(species: &Species, kind: &Kind, units: Units, masses: &Masses) -> Option<f64> {
    let name = &species.name;
    let given = names(name, kind).find_map(|own| masses.get(own).copied());
    let of_element = |name: &String| weight(name).and_then(|w| units.molar(w));
    let element = || of_element(name).or(kind.element.as_ref().and_then(of_element));
    given.or(species.mass).or(kind.mass).or_else(element)
}

/// The mass that reduced units are reduced by.
fn unit(units: Units) -> Option<f64> {
    (units == Units::Deck(UnitSystem::Lj)).then_some(1.0)
}

/// Species whose mass nobody says, and that is taken as 1 in reduced units.
pub fn of_unit_mass<'a>(
    atoms: &'a Atoms,
    units: Units,
    masses: &Masses,
    model: &Model,
) -> Vec<&'a str> {
    let Ok(kind) = kinds_of(&model.kinds, &model.name, atoms) else {
        return vec![];
    };
    if unit(units).is_none() || atoms.mass.is_some() {
        return vec![];
    }
    let used = |n: usize| atoms.kind.iter().any(|k| *k as usize == n);
    let all = atoms.species.iter().enumerate().filter(|(n, s)| {
        let kind = &model.kinds[kind[*n] as usize];
        known(s, kind, units, masses).is_none() && used(*n)
    });
    all.map(|(_, s)| s.name.as_str()).collect()
}

/// The mass of all atoms of a species in the user's units; `None`: each has its own.
fn of_species(
    species: &Species,
    kind: &Kind,
    units: Units,
    masses: &Masses,
    each: bool,
) -> Result<Option<f64>, String> {
    let name = &species.name;
    let given = names(name, kind).any(|own| masses.contains_key(own));
    if !given && species.mass.is_none() && each {
        return Ok(None);
    }
    match known(species, kind, units, masses).or(unit(units)) {
        Some(found) if found > 0.0 && found.is_finite() => Ok(Some(found)),
        Some(found) => Err(format!(
            "the mass of {name} is {found}: it must be positive"
        )),
        None => Err(format!(
            "{name} has no mass: the file does not say it{}; give --mass {name}=MASS",
            match units.molar(1.0) {
                Some(_) => " and it is no element that is known",
                None => ", and momentum, density and heat flux need it",
            }
        )),
    }
}

fn cell(atoms: &Atoms) -> Result<Cell, String> {
    let mut high = atoms.high;
    for a in 0..3 {
        let length = high[a] - atoms.low[a];
        if length > 0.0 || atoms.edges.is_some() {
            continue;
        }
        if atoms.periodic[a] {
            let axis = ["x", "y", "z"][a];
            return Err(format!(
                "{axis} is periodic, but the box has no length along it"
            ));
        }
        // atoms in a plane or on a line, and no box: any length will do
        high[a] = atoms.low[a] + 1.0;
    }
    let cell = match atoms.edges {
        Some(edges) => Cell::new(atoms.low, edges, atoms.periodic),
        None => Cell::orthogonal(atoms.low, high, atoms.periodic),
    };
    cell.map_err(|e| e.to_string())
}
