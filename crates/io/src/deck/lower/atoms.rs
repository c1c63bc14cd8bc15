//! Interatomic potentials and temperatures.

use super::Files;
use super::context::{Context, Result};
use crate::deck::document::{Body, Document, Given, Material, Thermal};
use crate::deck::units::{BOLTZMANN, Dim, UnitSystem};
use crate::deck::value::{At, Number, Written};
use peridyne::law::descriptor::{Key, Need, Value};
use peridyne::law::{fan, scaled};
use peridyne::run::Shelf;
use peridyne::spec::{
    BodySpec, BondedSpec, LawSpec, Parameter, PotentialSpec, TableSpec, ThermalSpec,
};
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
    let element = law.value.word("element");
    let mut read = super::law::read(context, law, |file, key| {
        if let Value::Entries(columns) = key.value {
            let (rows, element) = entries(context, file, element, columns, files)?;
            of_file.replace((Some(element), None));
            return Ok(Parameter::Rows(rows));
        }
        let (table, element, mass) = table(context, file, element, files)?;
        of_file.replace((Some(element), mass));
        Ok(Parameter::Table(Arc::new(table)))
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

/// Rows of the constants of one element in computed units, and its name.
fn entries(
    context: &Context,
    written: &At<String>,
    element: Option<&At<String>>,
    columns: &'static [Key],
    files: &Files,
) -> Result<(Vec<Vec<f64>>, String)> {
    let all = files.entries(context, written, columns)?;
    let names = crate::read::entries::names(&all);
    let known = names.join(", ");
    let name = match element {
        Some(name) if names.contains(&&*name.value) => name.value.clone(),
        Some(name) => {
            let message = format!(
                "no element `{}` in {}; it has {known}",
                name.value, written.value
            );
            return Err(context.error(&name.span, message));
        }
        None if names.len() == 1 => names[0].to_string(),
        None => {
            let message = format!("{} has several elements: {known}", written.value);
            let help = format!("add element = \"{}\"", names[0]);
            return Err(context.error_with(&written.span, message, help));
        }
    };
    let (angstrom, ev) = metal(context);
    let mut rows = crate::read::entries::rows(&all, &[&name]);
    scaled::rows(columns, &mut rows, angstrom, ev);
    Ok((rows, name))
}

/// Å and eV in computed units; 1 where these have no size.
fn metal(context: &Context) -> (f64, f64) {
    match context.units {
        UnitSystem::Si => (1e-10, EV),
        UnitSystem::Metal(_) | UnitSystem::Lj | UnitSystem::None => (1.0, 1.0),
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
    let (angstrom, ev) = metal(context);
    let mass = match context.units {
        UnitSystem::Si => Some(1e-3 / AVOGADRO),
        UnitSystem::Metal(_) => Some(context.units.plain_factor(Dim::MASS)),
        UnitSystem::Lj | UnitSystem::None => None,
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
            let needed = |k: &&Key| k.need == Need::Given || fan::is_known(&law.name);
            let key = descriptor.key(name).filter(needed);
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

/// What bonds the atoms of the deck's file.
pub(super) fn molecules(
    context: &Context,
    document: &Document,
    files: &Files,
) -> Result<Option<Arc<BondedSpec>>> {
    let body = &document.body.value;
    let bonded = context.atoms.as_ref().is_some_and(|a| a.bonded);
    let (written, file) = match (&document.molecules, &body.file) {
        (None, Some(file)) if bonded => {
            return Err(context.error_with(
                &file.span,
                "the file has bonds, angles or dihedrals, and the deck does not ask for them",
                "add molecules = { special = [0, 0, 0] }: what is left of the potential between atoms that are one, two and three bonds apart",
            ));
        }
        (None, _) => return Ok(None),
        (Some(written), Some(file)) if bonded => (written, file),
        (Some(written), _) => {
            return Err(context.error_with(
                &written.span,
                "there are no molecules: no bonds, angles or dihedrals in body.file",
                "give a LAMMPS data file of atom_style molecular, or remove this key",
            ));
        }
    };
    let special = match &written.value.special {
        None => [0.0; 3],
        Some(list) => match list.value[..] {
            [a, b, c] if [a, b, c].iter().all(|x| (0.0..=1.0).contains(x)) => [a, b, c],
            _ => {
                let message = "special has three numbers from 0 to 1";
                return Err(context.error(&list.span, message));
            }
        },
    };
    let made = files.molecules(context, file, special, metal(context))?;
    Ok(Some(Arc::new(made)))
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
