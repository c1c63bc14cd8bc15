//! A frame of a file as particles: masses found, velocities in the units of the frame, the cell as it is.

use super::elements::weight;
use super::kinds::kinds_of;
use super::potential::Model;
use super::units::Units;
use crate::read::Atoms;
use peridyne_fields::{Cell, Frame};
use std::collections::BTreeMap;

/// Masses by the names of species, as a user gives them.
pub type Masses = BTreeMap<String, f64>;

/// The particles of a frame.
///
/// # Errors
/// In words: a species that the potential does not know or that has no mass, a periodic axis without a length, no atoms.
pub fn frame(atoms: &Atoms, units: Units, masses: &Masses, model: &Model) -> Result<Frame, String> {
    if atoms.is_empty() {
        return Err("the frame has no atoms".into());
    }
    let kind = kinds_of(&model.kinds, &model.name, atoms)?;
    let mut used = vec![false; atoms.species.len()];
    atoms.kind.iter().for_each(|k| used[*k as usize] = true);
    let mut mass = vec![];
    for (n, species) in atoms.species.iter().enumerate() {
        let name = &species.name;
        if !used[n] {
            mass.push(f64::NAN);
            continue;
        }
        let kind = &model.kinds[kind[n] as usize];
        let mut names = kind.names.iter().chain(&kind.element);
        let given = masses
            .get(name)
            .or_else(|| names.find_map(|own| masses.get(own)));
        let of_element = |name: &String| weight(name).and_then(|w| units.molar(w));
        let element = || of_element(name).or(kind.element.as_ref().and_then(of_element));
        let plain = units.molar(1.0).is_none().then_some(1.0);
        let found = given
            .copied()
            .or(species.mass)
            .or(kind.mass)
            .or_else(element)
            .or(plain);
        let Some(found) = found else {
            return Err(format!(
                "{name} has no mass: the file does not say it and it is no element that is known; give --mass {name}=MASS"
            ));
        };
        if !(found > 0.0 && found.is_finite()) {
            return Err(format!(
                "the mass of {name} is {found}: it must be positive"
            ));
        }
        mass.push(found * units.mass());
    }
    let speed = match atoms.from_momenta {
        true => units.ase_velocity(),
        false => 1.0,
    };
    let velocity = atoms.velocity.as_ref();
    Ok(Frame {
        cell: cell(atoms)?,
        position: atoms.position.clone(),
        velocity: velocity.map(|all| all.iter().map(|v| v.map(|c| c * speed)).collect()),
        mass: atoms.kind.iter().map(|k| mass[*k as usize]).collect(),
        kind: atoms.kind.iter().map(|k| kind[*k as usize]).collect(),
        time: atoms.time,
    })
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
