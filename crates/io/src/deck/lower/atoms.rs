//! Interatomic potentials and temperatures.

use super::Files;
use super::context::{Context, Result};
use crate::deck::document::{Document, Given, Law, Material, MixingName, Thermal};
use crate::deck::error::nearest;
use crate::deck::units::{BOLTZMANN, Constants, Dim, UnitSystem};
use crate::deck::value::{At, Number, Quantity, Written};
use crate::read::eam::EamFile;
use crate::read::tag;
use peridyne::law::descriptor::{Key, Need, Value};
use peridyne::law::{many_body, scaled};
use peridyne::run::Registry;
use peridyne::spec::{
    Acting, ActingSpec, BodySpec, BondedSpec, LawSpec, Mixing, Parameter, PartnerTable,
    PotentialSpec, TableSpec, ThermalSpec,
};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The potential of a material, and what files say of its atoms.
pub(super) struct AtomsPotential {
    pub spec: PotentialSpec,
    /// Name of the atoms.
    pub element: Option<String>,
    pub mass: Option<f64>,
}

/// Potentials of materials by their names.
pub(super) type AtomsPotentials = BTreeMap<String, AtomsPotential>;

/// The potentials of the deck's materials, if they are atoms.
pub(super) fn potentials(
    context: &Context,
    written: &BTreeMap<String, At<Material>>,
    body: &BodySpec,
    files: &Files,
) -> Result<AtomsPotentials> {
    let registry = Registry::standard();
    let is_potential = |m: &At<Material>| registry.is_potential(&m.value.law.value.name);
    if !written.values().any(is_potential) {
        return Ok(AtomsPotentials::new());
    }
    if let Some(other) = written.values().find(|m| !is_potential(m)) {
        return Err(context.error_with(
            &other.value.law.span,
            "some materials are atoms and this one is not",
            "all materials of a body use the same kind of law: give this one an interatomic potential",
        ));
    }
    let tables = Tables::of(context, written, files)?;
    let mut all = AtomsPotentials::new();
    for (name, material) in written {
        let found = potential(context, &material.value.law, body, &tables)?;
        all.insert(name.clone(), found);
    }
    Ok(all)
}

/// A written potential.
fn potential(
    context: &Context,
    law: &At<Law>,
    body: &BodySpec,
    tables: &Tables,
) -> Result<AtomsPotential> {
    let registry = Registry::standard();
    let of_file = RefCell::new((None, None));
    let element = law.value.word("element");
    let mut read = super::law::read(context, law, |file, key| {
        if let Value::Entries(columns) = key.value {
            let (rows, element) = tables.entries(context, file, element, columns)?;
            of_file.replace((Some(element), None));
            return Ok(Parameter::Rows(rows));
        }
        let (table, element, mass) = tables.of_element(context, file, element)?;
        of_file.replace((Some(element), mass));
        Ok(Parameter::Table(Arc::new(table)))
    })?;
    if let BodySpec::Lattice { kind, spacing, .. } | BodySpec::Sites { kind, spacing, .. } = body {
        registry.on_lattice(&mut read.law, *kind, *spacing);
    }
    if matches!(read.law.parameters.get("file"), Some(Parameter::Rows(_))) {
        // the rows know the elements of all materials, which are alike so
        read.law.parameters.0.retain(|(key, _)| key != "element");
    }
    let (element, mass) = of_file.into_inner();
    match read.look_up(context)? {
        LawSpec::Atoms(spec) => Ok(AtomsPotential {
            spec,
            element,
            mass,
        }),
        _ => Err(context.error(&law.span, "this law is no potential")),
    }
}

/// Length, energy and mass of a file's numbers in computed units.
struct Scale {
    length: f64,
    energy: f64,
    /// `None` in units that know no atoms.
    mass: Option<f64>,
}

/// Of a file of eV, Å and g/mol, or with a [tag] that says otherwise; numbers as they are where units have no size.
fn scale(context: &Context, file: &At<String>, tagged: Option<&str>) -> Result<Scale> {
    let own = context.units.name();
    let plain = Scale {
        length: 1.0,
        energy: 1.0,
        mass: None,
    };
    let name = tagged.unwrap_or(tag::METAL);
    let Some(sizes) = tag::sizes(name) else {
        return Err(context.error_with(
            &file.span,
            format!(
                "{} says `UNITS: {name}`, which is no system of units",
                file.value
            ),
            format!("expected {}", tag::names()),
        ));
    };
    let of = |dim| context.units.to_si(1.0, dim);
    match (context.units, sizes) {
        (UnitSystem::None, _) => Ok(plain),
        (UnitSystem::Lj, _) if tagged.is_none_or(|name| name == own) => Ok(plain),
        (UnitSystem::Lj, _) | (UnitSystem::Si | UnitSystem::Metal(_), None) => {
            Err(context.error_with(
                &file.span,
                format!(
                    "{} says `UNITS: {name}`, and the units here are {own}: one of them has no size",
                    file.value
                ),
                format!("write units = {name:?}, or constants in {own} units"),
            ))
        }
        (UnitSystem::Metal(constants), Some(size)) => Ok(Scale {
            length: size.length / 1e-10,
            energy: match (name, constants) {
                (tag::METAL, _) => 1.0,
                // the number that LAMMPS converts with
                ("real", Constants::Lammps) => 1.0 / 23.060549,
                _ => size.energy / of(Dim::ENERGY),
            },
            mass: Some(match name {
                tag::METAL | "real" => context.units.plain_factor(Dim::MASS),
                _ => size.mass / of(Dim::MASS),
            }),
        }),
        (UnitSystem::Si, Some(size)) => Ok(Scale {
            length: size.length,
            energy: size.energy,
            mass: Some(size.mass),
        }),
    }
}

/// Files of potentials. All funcfl files of a deck, an element each, are one potential.
struct Tables<'a> {
    files: &'a Files<'a>,
    mixed: Option<EamFile>,
    /// The elements of materials that have the same law of the same file, in order of the materials.
    elements: Vec<&'a At<String>>,
}

impl<'a> Tables<'a> {
    fn of(
        context: &Context,
        written: &'a BTreeMap<String, At<Material>>,
        files: &'a Files<'a>,
    ) -> Result<Self> {
        let laws = written.values().map(|m| &m.value.law.value);
        let file = |law: &'a Law| law.word("file").map(|f| &f.value);
        let first = laws.clone().next();
        let alike =
            |law: &'a Law| first.is_some_and(|f| f.name == law.name && file(f) == file(law));
        let elements = match laws.clone().all(alike) {
            true => laws.clone().map(|law| law.word("element")).collect(),
            false => None,
        };
        let named = laws.filter_map(|law| law.word("file"));
        let mut funcfl: Vec<&At<String>> = vec![];
        for file in named.filter(|f| Files::is_funcfl(&f.value)) {
            if funcfl.iter().all(|f| f.value != file.value) {
                funcfl.push(file);
            }
        }
        let mixed = match funcfl.len() > 1 {
            true => Some(files.funcfl(context, &funcfl)?),
            false => None,
        };
        Ok(Tables {
            files,
            mixed,
            elements: elements.unwrap_or_default(),
        })
    }

    /// Rows of the constants of an element in computed units, and its name; of several materials of one file those of all.
    fn entries(
        &self,
        context: &Context,
        written: &At<String>,
        element: Option<&At<String>>,
        columns: &'static [Key],
    ) -> Result<(Vec<Vec<f64>>, String)> {
        let all = self.files.entries(context, written, columns)?;
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
        let tagged = self.files.units_of_entries(context, written)?;
        let scale = scale(context, written, tagged.as_deref())?;
        let kinds: Vec<&str> = match self.elements.iter().any(|e| e.value != name) {
            // isotopes are of one kind
            false => vec![&name],
            true => self.elements.iter().map(|e| &*e.value).collect(),
        };
        let mut rows = crate::read::entries::rows(&all, &kinds);
        scaled::rows(columns, &mut rows, scale.length, scale.energy);
        Ok((rows, name))
    }

    /// The tables of a file in computed units, and name and mass of their element.
    fn of_element(
        &self,
        context: &Context,
        written: &At<String>,
        element: Option<&At<String>>,
    ) -> Result<(TableSpec, String, Option<f64>)> {
        let own = self.files.eam(context, written)?;
        let element = match element {
            Some(name) => own
                .element(&name.value)
                .map_err(|error| context.error(&name.span, error.to_string()))?,
            None if own.elements.len() == 1 => 0,
            None => {
                let names: Vec<_> = own.elements.iter().map(|e| &*e.name).collect();
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
        let tagged = |file: &EamFile| {
            let lines = file.comments.iter().map(String::as_str);
            tag::of_comments(lines).map(str::to_string)
        };
        let own_tag = tagged(&own);
        let scale = scale(context, written, own_tag.as_deref())?;
        let atom = own.elements[element].clone();
        let place = |file: &EamFile| file.elements.iter().position(|e| e.name == atom.name);
        let mixed = self
            .mixed
            .as_ref()
            .filter(|_| Files::is_funcfl(&written.value));
        if let Some(other) = mixed.and_then(|file| {
            { file.comments.iter() }.find(|c| tag::of_comments([c.as_str()]) != own_tag.as_deref())
        }) {
            return Err(context.error_with(
                &written.span,
                format!("the files of one model say different UNITS: one begins `{other}`"),
                "give all of them the same tag",
            ));
        }
        let table = match mixed.and_then(|file| Some((file, place(file)?))) {
            Some((file, element)) => table(file, element),
            None => table(&own, element),
        };
        Ok((
            table.scaled(scale.length, scale.energy),
            atom.name,
            scale.mass.map(|m| m * atom.mass),
        ))
    }
}

/// What a file has of an element.
fn table(file: &EamFile, element: usize) -> TableSpec {
    let others = (0..file.elements.len()).filter(|e| *e != element);
    let pair = |other| file.pair[EamFile::pair_index(element, other)].clone();
    TableSpec {
        density_step: file.drho,
        embedding: file.embedding[element].clone(),
        step: file.dr,
        density: file.density_of(element, element).to_vec(),
        pair: pair(element),
        cutoff: file.cutoff,
        element: file.elements[element].name.clone(),
        partners: others
            .map(|other| PartnerTable {
                element: file.elements[other].name.clone(),
                density: file.density_of(other, element).to_vec(),
                pair: pair(other),
            })
            .collect(),
    }
}

/// Potentials between materials, `[[pair]]`.
pub(super) fn pairs(
    context: &Context,
    document: &Document,
    body: &BodySpec,
    potentials: &AtomsPotentials,
    files: &Files,
) -> Result<Vec<ActingSpec>> {
    let mut all = vec![];
    for at in &document.pair {
        let pair = &at.value;
        if potentials.is_empty() {
            return Err(context.error_with(
                &at.span,
                "[[pair]] is for atoms, and the material is none",
                "give the materials interatomic potentials as laws",
            ));
        }
        let [a, b] = &pair.between.value[..] else {
            let found = pair.between.value.len();
            return Err(context.error_with(
                &pair.between.span,
                format!("a pair is between two materials, here are {found}"),
                "write between = [\"A\", \"B\"], names of [material.NAME]",
            ));
        };
        let place = |name: &At<String>| {
            let found = potentials.keys().position(|known| *known == name.value);
            found.ok_or_else(|| {
                let known: Vec<&str> = potentials.keys().map(|k| k.as_str()).collect();
                let help = match nearest(&name.value, known.iter().copied()) {
                    Some(near) => format!("did you mean \"{near}\"?"),
                    None => format!("materials: {}", known.join(", ")),
                };
                let message = format!("there is no material \"{}\"", name.value);
                context.error_with(&name.span, message, help)
            })
        };
        if !Registry::standard().is_potential(&pair.law.value.name) {
            return Err(context.error_with(
                &pair.law.span,
                format!("{} is no potential between atoms", pair.law.value.name),
                "`peridyne laws` lists them: those that begin with \"Atoms\"",
            ));
        }
        let tables = Tables {
            files,
            mixed: None,
            elements: vec![],
        };
        all.push(ActingSpec {
            potential: potential(context, &pair.law, body, &tables)?.spec,
            on: Acting::Between([place(a)?, place(b)?]),
        });
    }
    Ok(all)
}

/// The rule of mixing.
pub(super) fn mixing(
    context: &Context,
    document: &Document,
    potentials: &AtomsPotentials,
) -> Result<Option<Mixing>> {
    let Some(written) = &document.mixing else {
        return Ok(None);
    };
    if potentials.len() < 2 {
        return Err(context.error_with(
            &written.span,
            "mixing is for several kinds of atoms",
            "leave it out, or write [material.NAME] with an interatomic potential for each kind",
        ));
    }
    Ok(Some(match written.value {
        MixingName::Arithmetic => Mixing::Arithmetic,
        MixingName::Geometric => Mixing::Geometric,
        MixingName::Sixthpower => Mixing::SixthPower,
    }))
}

/// Plain numbers of atoms are hardly ever in metres and joules: the deck must say in which units they are.
pub(super) fn units_are_said(context: &Context, document: &Document) -> Result<()> {
    if document.units.is_some() {
        return Ok(());
    }
    let registry = Registry::standard();
    let mut numbers = vec![];
    let of_materials = document.material.values().map(|m| &m.value.law.value);
    for law in of_materials.chain(document.pair.iter().map(|p| &p.value.law.value)) {
        let Some(descriptor) = registry.descriptor(&law.name) else {
            continue;
        };
        for (name, given) in &law.given {
            let needed = |k: &&Key| k.need == Need::Given || many_body::is_known(&law.name);
            let key = descriptor.key(name).filter(needed);
            let dimension = key.and_then(Key::dimension);
            if let (Given::Number(number), Some(Dim::ENERGY | Dim::LENGTH)) = (given, dimension) {
                numbers.push(number.clone());
            }
        }
    }
    let plain = |n: &Number| match &n.value {
        Written::Plain(_) => true,
        Written::Text(text) => text.trim().parse::<f64>().is_ok(),
    };
    numbers.extend(document.body.value.spacing.as_ref().map(Quantity::number));
    match numbers.into_iter().find(plain) {
        Some(number) => Err(context.error_with(
            &number.span,
            "atoms need units: without `units` this number is in SI (metres, joules)",
            "write units = \"metal\" (Å, ps, eV) or units = \"lj\", or give the numbers units",
        )),
        None => Ok(()),
    }
}

/// What a file of atoms means for the potentials: it may know masses and names.
pub(super) fn of_file(
    context: &Context,
    document: &Document,
    potentials: &mut AtomsPotentials,
) -> Result<()> {
    let (Some(file), Some(written)) = (&context.atoms, &document.body.value.file) else {
        return Ok(());
    };
    if potentials.is_empty() {
        return Err(context.error_with(
            &written.span,
            "the file is one of atoms, without volumes",
            "give the material an interatomic potential, or take points with volumes (LAMMPS: atom_style peri)",
        ));
    }
    let species = |name: &str| file.species.iter().find(|s| s.name == *name);
    let kinds = || {
        let names: Vec<&str> = file.species.iter().map(|s| s.name.as_str()).collect();
        names.join(", ")
    };
    for (name, potential) in potentials.iter_mut() {
        let material = &document.material[name].value;
        let found = match (&material.set, &file.species[..]) {
            (_, [only]) => Some(only),
            (Some(set), _) => species(&set.value),
            (None, _) => species(name),
        };
        if let Some(found) = found {
            potential.mass = found.mass.or(potential.mass);
            if found.name.parse::<u32>().is_err() && potential.element.is_none() {
                potential.element = Some(found.name.clone());
            }
        }
    }
    if potentials.len() == 1 && file.species.len() > 1 {
        return Err(context.error_with(
            &written.span,
            format!(
                "the file has {} kinds of atoms ({}), and there is one material",
                file.species.len(),
                kinds()
            ),
            "write [material.NAME] for each kind: a kind is a set of its name, or of the number of its type",
        ));
    }
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
                "the file has bonds, angles, dihedrals or impropers, and the deck does not ask for them",
                "add molecules = { special = [0, 0, 0] }: what is left of the potential between atoms that are one, two and three bonds apart",
            ));
        }
        (None, _) => return Ok(None),
        (Some(written), Some(file)) if bonded => (written, file),
        (Some(written), _) => {
            return Err(context.error_with(
                &written.span,
                "there are no molecules: no bonds, angles, dihedrals or impropers in body.file",
                "give a LAMMPS data file of atom_style molecular or full, or remove this key",
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
    let scale = scale(context, file, None)?;
    let made = files.molecules(context, file, special, (scale.length, scale.energy))?;
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
    let temperature = context.expression(&thermal.temperature)?;
    if temperature.depends_on_time() {
        let message = "a temperature at the start does not depend on t";
        return Err(context.error(&thermal.temperature.span, message));
    }
    Ok(ThermalSpec {
        energy: temperature.times(boltzmann(context.units)),
        seed: thermal.seed,
    })
}
