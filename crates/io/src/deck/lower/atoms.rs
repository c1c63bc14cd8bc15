//! Interatomic potentials and temperatures.

use super::Files;
use super::context::{Context, Result};
use crate::deck::document::{Body, Document, EamForm, EndName, Law, Material, Thermal};
use crate::deck::units::{BOLTZMANN, Dim, UnitSystem, short};
use crate::deck::value::{At, Number, Written};
use peridyne::family::stencil::Stencil;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::{
    BodySpec, Buckingham, End, Form, Horizon, LennardJones, MeiSpec, Morse, PotentialSpec,
    TableSpec, ThermalSpec,
};
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
    for material in written.values() {
        let law = &material.value.law;
        let (form, end) = match &law.value.0 {
            Law::LennardJones(p) => (
                Form::LennardJones(LennardJones {
                    epsilon: context.positive(&p.epsilon, Dim::ENERGY, "ε")?,
                    sigma: context.positive(&p.sigma, Dim::LENGTH, "σ")?,
                }),
                (&p.cutoff, p.end, &p.smooth_from),
            ),
            Law::Morse(p) => (
                Form::Morse(Morse {
                    depth: context.positive(&p.depth, Dim::ENERGY, "the depth")?,
                    alpha: context.positive(&p.alpha, Dim::INVERSE_LENGTH, "α")?,
                    distance: context.positive(&p.distance, Dim::LENGTH, "the distance")?,
                }),
                (&p.cutoff, p.end, &p.smooth_from),
            ),
            Law::Buckingham(p) => (
                Form::Buckingham(Buckingham {
                    strength: context.positive(&p.strength, Dim::ENERGY, "the strength")?,
                    range: context.positive(&p.range, Dim::LENGTH, "the range")?,
                    dispersion: context.finite(&p.dispersion, Dim([8, 1, -2, 0]))?,
                }),
                (&p.cutoff, p.end, &p.smooth_from),
            ),
            Law::Eam(e) => {
                let file = files.eam(context, &e.file)?;
                let scale = |n: &Option<Number>, what: &str| match n {
                    Some(n) => context.positive(n, Dim::NUMBER, what),
                    None => Ok(1.0),
                };
                let (length, energy) = (
                    scale(&e.length_scale, "the length scale")?,
                    scale(&e.energy_scale, "the energy scale")?,
                );
                let element = match &e.element {
                    Some(name) => file
                        .element(&name.value)
                        .map_err(|error| context.error(&name.span, error.to_string()))?,
                    None if file.elements.len() == 1 => 0,
                    None => {
                        let names: Vec<_> = file.elements.iter().map(|e| &*e.name).collect();
                        return Err(context.error_with(
                            &e.file.span,
                            format!(
                                "{} has several elements: {}",
                                e.file.value,
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
                return Ok(Some(AtomsPotential {
                    spec: PotentialSpec {
                        form: Form::Tabulated(Arc::new(
                            table.scaled(length * angstrom, energy * ev),
                        )),
                        cutoff: f64::INFINITY,
                        end: End::Truncated,
                    },
                    element: Some(file.elements[element].name.clone()),
                    mass: mass.map(|m| m * file.elements[element].mass),
                }));
            }
            Law::EamForm(form) => {
                let mei = closed_form(context, form, body, &law.span)?;
                return Ok(Some(AtomsPotential {
                    spec: PotentialSpec {
                        form: Form::Mei(Box::new(mei)),
                        cutoff: f64::INFINITY,
                        end: End::Truncated,
                    },
                    element: None,
                    mass: None,
                }));
            }
            Law::Pmb(_)
            | Law::Lps(_)
            | Law::LpsAsTyped(_)
            | Law::EamLike(_)
            | Law::Springs(_)
            | Law::Micromoduli
            | Law::Named(_) => continue,
        };
        let (cutoff, end) = ended(context, end)?;
        if written.len() > 1 {
            return Err(context.error_with(
                &law.span,
                "a body of atoms has one material",
                "one kind of atom at a time: give a single [material]",
            ));
        }
        return Ok(Some(AtomsPotential {
            spec: PotentialSpec { form, cutoff, end },
            element: None,
            mass: None,
        }));
    }
    Ok(None)
}

/// Plain numbers of atoms are hardly ever in metres and joules: the deck must say in which units they are.
pub(super) fn units_are_said(context: &Context, document: &Document) -> Result<()> {
    if document.units.is_some() {
        return Ok(());
    }
    let laws = document.material.values().map(|m| &m.value.law.value.0);
    let constants = laws.flat_map(|law| match law {
        Law::LennardJones(p) => vec![&p.epsilon, &p.sigma],
        Law::Morse(p) => vec![&p.depth, &p.distance],
        Law::Buckingham(p) => vec![&p.strength, &p.range],
        Law::EamForm(p) => vec![&p.cohesive],
        Law::Eam(_)
        | Law::Pmb(_)
        | Law::Lps(_)
        | Law::LpsAsTyped(_)
        | Law::EamLike(_)
        | Law::Springs(_)
        | Law::Micromoduli
        | Law::Named(_) => vec![],
    });
    let plain = |n: &&Number| match &n.value {
        Written::Plain(_) => true,
        Written::Text(text) => text.trim().parse::<f64>().is_ok(),
    };
    match constants.chain(&document.body.value.spacing).find(plain) {
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

fn ended(
    context: &Context,
    (cutoff, end, from): (&Option<Number>, Option<EndName>, &Option<Number>),
) -> Result<(f64, End)> {
    let Some(written) = cutoff else {
        if let Some(from) = from {
            return Err(context.error(&from.span, "smooth_from needs a cutoff"));
        }
        return Ok((f64::INFINITY, End::Truncated));
    };
    let cutoff = context.positive(written, Dim::LENGTH, "the cut-off")?;
    let end = match end {
        None | Some(EndName::Truncated) => End::Truncated,
        Some(EndName::Shifted) => End::Shifted,
        Some(EndName::ShiftedForce) => End::ShiftedForce,
        Some(EndName::Smooth) => {
            let near = match from {
                Some(n) => context.positive(n, Dim::LENGTH, "the beginning of the smooth end")?,
                None => 0.9 * cutoff,
            };
            if near >= cutoff {
                return Err(
                    context.error(&written.span, "the smooth end begins beyond the cut-off")
                );
            }
            End::Smooth(near)
        }
    };
    if let (Some(from), false) = (from, matches!(end, End::Smooth(_))) {
        return Err(context.error_with(
            &from.span,
            "smooth_from belongs to a smooth end",
            "write end = \"smooth\"",
        ));
    }
    Ok((cutoff, end))
}

fn closed_form(
    context: &Context,
    form: &EamForm,
    body: &BodySpec,
    span: &std::ops::Range<usize>,
) -> Result<MeiSpec> {
    let number = |n: &Number| context.finite(n, Dim::NUMBER);
    let positive = |n: &Number, what: &str| context.positive(n, Dim::NUMBER, what);
    let (kind, spacing) = match body {
        BodySpec::Lattice { kind, spacing, .. } | BodySpec::Sites { kind, spacing, .. } => {
            (*kind, *spacing)
        }
        BodySpec::Cloud(_) | BodySpec::Several(_) => {
            return Err(context.error_with(
                span,
                "the embedding energy in closed form is made for a lattice, this is a cloud of points",
                "take a lattice body, or a table (law = { eam = { file = … } })",
            ));
        }
    };
    let nearest = match &form.nearest {
        Some(n) => context.positive(n, Dim::LENGTH, "the nearest distance")?,
        None => spacing * kind.nearest(),
    };
    let density = &form.density.value;
    if density.len() != 6 {
        return Err(context.error(
            &form.density.span,
            format!("density has c_0 to c_5: 6 numbers, not {}", density.len()),
        ));
    }
    let mut c = [0.0; 6];
    for (c, n) in c.iter_mut().zip(density) {
        *c = number(n)?;
    }
    let scale = |n: &Option<Number>, what: &str| match n {
        Some(n) => positive(n, what),
        None => Ok(1.0),
    };
    let (near, cutoff) = (
        positive(&form.near, "the beginning of the end")?,
        positive(&form.cutoff, "the cut-off")?,
    );
    if near >= cutoff || cutoff > 50.0 {
        return Err(context.error(
            &form.cutoff.span,
            format!(
                "the cut-off {} must lie beyond near = {} and below 50 nearest distances",
                short(cutoff),
                short(near)
            ),
        ));
    }
    let pair_length = scale(&form.pair_length, "the length of the pair term")?;
    Ok(MeiSpec {
        cohesive: context.positive(&form.cohesive, Dim::ENERGY, "the cohesive energy")?,
        pair: context.finite(&form.pair, Dim::ENERGY)?,
        alpha: number(&form.alpha)?,
        beta: positive(&form.beta, "β")?,
        gamma: number(&form.gamma)?,
        lambda: number(&form.lambda)?,
        density: c,
        density_scale: positive(&form.density_scale, "f_e/ρ_e")?,
        pair_length: nearest * pair_length,
        density_length: nearest * scale(&form.density_length, "the length of the density")?,
        near: nearest * near,
        cutoff: nearest * cutoff,
        shells: shells(kind, 2.0 * cutoff),
        nearest,
        shell_scale: match &form.shell_scale {
            Some(n) => positive(n, "the scale of the shells")?,
            None => 1.0 / pair_length,
        },
    })
}

/// Shells of a lattice around a site: number of atoms and distance in nearest distances, up to `limit` of those.
pub fn shells(kind: LatticeKind, limit: f64) -> Vec<(f64, f64)> {
    let nearest = kind.nearest();
    let stencil = Stencil::new(kind, 1.0, Horizon::Length(limit * nearest));
    let mut counts: BTreeMap<i64, f64> = BTreeMap::new();
    for offset in &stencil.offsets[0] {
        *counts.entry(offset.squared).or_default() += 1.0;
    }
    let shell = |(squared, count): (i64, f64)| (count, (squared as f64).sqrt() / 4.0 / nearest);
    counts.into_iter().map(shell).collect()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shells_of_lattices() {
        assert_eq!(
            shells(LatticeKind::Chain, 3.5),
            [(2.0, 1.0), (2.0, 2.0), (2.0, 3.0)]
        );
        let fcc = shells(LatticeKind::Fcc, 2.05);
        let counts: Vec<f64> = fcc.iter().map(|s| s.0).collect();
        assert_eq!(counts, [12.0, 6.0, 24.0, 12.0]);
        for (m, s) in fcc.iter().enumerate() {
            assert!((s.1 - ((m + 1) as f64).sqrt()).abs() < 1e-14);
        }
    }
}
