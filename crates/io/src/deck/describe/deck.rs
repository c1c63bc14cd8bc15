//! All that a deck says, and where its laws come from.

use super::material::{between_atoms, material};
use super::shape::body;
use super::{acting, family, probe, schedule};
use crate::deck::units::{Dim, UnitSystem};
use crate::excerpt::one_line;
use peridyne::run::Registry;
use peridyne::spec::{Breakage, LawSpec, Plane, Spec};

/// A short header: body, materials, horizon, what acts, schedule; numbers with units.
pub fn describe(spec: &Spec, units: UnitSystem) -> String {
    let mut lines = Vec::new();
    if !spec.title.is_empty() {
        lines.push(one_line(&spec.title).into_owned());
    }
    if let UnitSystem::Metal(constants) = units {
        lines.push(format!(
            "units      metal, physical constants: {}",
            constants.name()
        ));
    }
    lines.extend(of_what(spec, units));
    lines.extend(family::lines(spec, units));
    lines.extend(acting::lines(spec, units));
    lines.extend(probe::lines(spec, units));
    lines.extend(schedule::lines(spec, units));
    lines.join("\n")
}

/// The body and its materials.
fn of_what(spec: &Spec, units: UnitSystem) -> Vec<String> {
    let mut lines = vec![];
    let plane = match (spec.space.dimension, spec.space.plane) {
        (2, Plane::Stress) => " plane stress",
        (2, Plane::Strain) => " plane strain",
        _ => "",
    };
    let section = match spec.space.dimension {
        1 => format!(
            ", cross-section {}",
            units.write(spec.space.section, Dim::AREA)
        ),
        2 => format!(
            ", thickness {}",
            units.write(spec.space.section, Dim::LENGTH)
        ),
        _ => String::new(),
    };
    lines.push(format!(
        "body       {}-D{plane}{section}, {}",
        spec.space.dimension,
        body(&spec.body, units, spec.space.dimension)
    ));
    lines.extend(
        spec.materials
            .iter()
            .map(|m| format!("material   {}", material(m, units))),
    );
    if spec.materials.iter().any(|m| m.fracture.is_some()) {
        lines.push(match spec.damage.breakage {
            Breakage::BeforeForce => "breakage   bonds break before the force evaluation".into(),
            Breakage::AfterForce => "breakage   bonds break after the force evaluation".into(),
        });
    }
    if !spec.interactions.pairs.is_empty() {
        lines.push(
            "pairs      of materials have stiffness, horizon and critical stretch of their own"
                .into(),
        );
    }
    lines.extend(between_atoms(spec, units));
    lines
}

/// Names of the laws of a spec and where they come from, each once.
pub fn sources(spec: &Spec) -> Vec<String> {
    let registry = Registry::standard();
    let own = spec.materials.iter().map(|m| m.law.clone());
    let pairs =
        { spec.interactions.potentials.iter() }.map(|a| LawSpec::Atoms(a.potential.clone()));
    let mut all = vec![];
    for law in own.chain(pairs) {
        if let Some((descriptor, _)) = registry.written(&law) {
            let name = descriptor.name.replace('_', "-");
            let line = format!("{name}: {}", descriptor.source);
            if !descriptor.source.is_empty() && !all.contains(&line) {
                all.push(line);
            }
        }
    }
    all
}
