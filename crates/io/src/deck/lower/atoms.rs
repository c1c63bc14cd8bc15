//! Interatomic potentials and temperatures.

use super::Files;
use super::context::{Context, Result};
use crate::deck::document::{Body, Document, Given, Material, Thermal};
use crate::deck::units::{BOLTZMANN, Dim, UnitSystem};
use crate::deck::value::{At, Number, Written};
use peridyne::law::descriptor::{Key, Need};
use peridyne::run::Shelf;
use peridyne::spec::{BodySpec, LawSpec, PotentialSpec, TableSpec, ThermalSpec};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::sync::Arc;

const EV: f64 = 1.602176634e-19;
const AVOGADRO: f64 = 6.02214076e23;

/// A potential, and the mass of its atoms where its file says it.
pub(super) struct AtomsPotential {
    pub spec: PotentialSpec,
    /// Name of the atoms where its file says it.
    pub element: Option<String>,
    pub mass: Option<f64>,
}

/// The potential of the deck's material, if it is one of atoms.
pub(super) fn potential(
    context: &Context,
    written: &BTreeMap<String, At<Material>>,
    body: &BodySpec,
    files: &Files,
) -> Result<Option<AtomsPotential>> {
    let shelf = Shelf::standard();
    let mut laws = written.values().map(|m| &m.value.law);
    let Some(law) = laws.find(|law| shelf.is_potential(&law.value.name)) else {
        return Ok(None);
    };
    if written.len() > 1 {
        return Err(context.error_with(
            &law.span,
            "a body of atoms has one material",
            "one kind of atom at a time: give a single [material]",
        ));
    }
    let of_file = RefCell::new((None, None));
    let mut read = super::law::read(context, law, |file| {
        let (table, element, mass) = table(context, file, law.value.word("element"), files)?;
        of_file.replace((Some(element), mass));
        Ok(Arc::new(table))
    })?;
    if let BodySpec::Lattice { kind, spacing, .. } | BodySpec::Sites { kind, spacing, .. } = body {
        shelf.on_lattice(&mut read.law, *kind, *spacing);
    }
    let (element, mass) = of_file.into_inner();
    match read.look_up(context)? {
        LawSpec::Atoms(spec) => Ok(Some(AtomsPotential {
            spec,
            element,
            mass,
        })),
        _ => Err(context.error(&law.span, "this law is no potential")),
    }
}

/// The tables of a file in computed units, and name and mass of their element.
fn table(
    context: &Context,
    written: &At<String>,
    element: Option<&At<String>>,
    files: &Files,
) -> Result<(TableSpec, String, Option<f64>)> {
    let file = files.eam(context, written)?;
    let element = match element {
        Some(name) => file
            .element(&name.value)
            .map_err(|error| context.error(&name.span, error.to_string()))?,
        None if file.elements.len() == 1 => 0,
        None => {
            let names: Vec<_> = file.elements.iter().map(|e| &*e.name).collect();
            return Err(context.error_with(
                &written.span,
                format!(
                    "{} has several elements: {}",
                    written.value,
                    names.join(", ")
                ),
                format!("add element = \"{}\"", names[0]),
            ));
        }
    };
    let (angstrom, ev, mass) = match context.units {
        UnitSystem::Si => (1e-10, EV, Some(1e-3 / AVOGADRO)),
        UnitSystem::Metal(_) => (1.0, 1.0, Some(context.units.plain_factor(Dim::MASS))),
        UnitSystem::Lj | UnitSystem::None => (1.0, 1.0, None),
    };
    let pair = &file.pair[crate::read::eam::EamFile::pair_index(element, element)];
    let table = TableSpec {
        density_step: file.drho,
        embedding: file.embedding[element].clone(),
        step: file.dr,
        density: file.density[element].clone(),
        pair: pair.clone(),
        cutoff: file.cutoff,
    };
    let atom = &file.elements[element];
    Ok((
        table.scaled(angstrom, ev),
        atom.name.clone(),
        mass.map(|m| m * atom.mass),
    ))
}

/// Plain numbers of atoms are hardly ever in metres and joules: the deck must say in which units they are.
pub(super) fn units_are_said(context: &Context, document: &Document) -> Result<()> {
    if document.units.is_some() {
        return Ok(());
    }
    let shelf = Shelf::standard();
    let mut numbers = vec![];
    for material in document.material.values() {
        let law = &material.value.law.value;
        let Some(descriptor) = shelf.descriptor(&law.name) else {
            continue;
        };
        for (name, given) in &law.given {
            let key = descriptor.key(name).filter(|k| k.need == Need::Given);
            let dimension = key.and_then(Key::dimension);
            if let (Given::Number(number), Some(Dim::ENERGY | Dim::LENGTH)) = (given, dimension) {
                numbers.push(number);
            }
        }
    }
    let plain = |n: &&Number| match &n.value {
        Written::Plain(_) => true,
        Written::Text(text) => text.trim().parse::<f64>().is_ok(),
    };
    numbers.extend(&document.body.value.spacing);
    match numbers.into_iter().find(plain) {
        Some(number) => Err(context.error_with(
            &number.span,
            "atoms need units: without `units` this number is in SI (metres, joules)",
            "write units = \"metal\" (Å, ps, eV) or units = \"lj\", or give the numbers units",
        )),
        None => Ok(()),
    }
}

/// What a file of atoms means for the potential: it must be one kind of atom, whose mass the file may know.
pub(super) fn of_file(
    context: &Context,
    body: &At<Body>,
    potential: Option<&mut AtomsPotential>,
) -> Result<()> {
    let (Some(file), Some(written)) = (&context.atoms, &body.value.file) else {
        return Ok(());
    };
    let Some(potential) = potential else {
        return Err(context.error_with(
            &written.span,
            "the file is one of atoms, without volumes",
            "give the material an interatomic potential, or take points with volumes (LAMMPS: atom_style peri)",
        ));
    };
    if file.species.len() > 1 {
        return Err(context.error(
            &written.span,
            format!(
                "the file has {} kinds of atoms ({}); a potential knows one",
                file.species.len(),
                file.species.join(", ")
            ),
        ));
    }
    potential.mass = file.mass.or(potential.mass);
    Ok(())
}

/// Boltzmann's constant in computed units.
pub fn boltzmann(units: UnitSystem) -> f64 {
    match units {
        UnitSystem::Si => BOLTZMANN,
        UnitSystem::Metal(constants) => constants.boltzmann(),
        UnitSystem::Lj | UnitSystem::None => 1.0,
    }
}

pub(super) fn thermal(context: &Context, thermal: &Thermal) -> Result<ThermalSpec> {
    let temperature =
        context.positive(&thermal.temperature, Dim::TEMPERATURE, "the temperature")?;
    Ok(ThermalSpec {
        energy: boltzmann(context.units) * temperature,
        seed: thermal.seed,
    })
}
