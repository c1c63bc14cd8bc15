//! What atoms need beyond peridynamic points: their crystal looked at before it runs, and a temperature.

use super::agreed::agreed;
use super::reference::{SplitMix, current_neighbours};
use super::system::System;
use crate::constitutive::{AnyPotentials, breaks};
use crate::error::BuildError;
use crate::expression::Expression;
use crate::family::stencil::Stencil;
use crate::message;
use crate::quantity::{Dimension, Message, rounded};
use crate::space::AXES;
use crate::space::lattice::LatticeKind;
use crate::spec::{BodySpec, FamilyChoice, Horizon, Spec, ThermalSpec};

/// What a spec's family means for its law. Potentials of pairs and densities have their reference family on a lattice as a stencil.
pub(super) fn resolve_family(spec: &mut Spec, potentials: &AnyPotentials) {
    let whole = !breaks(spec);
    let lattice = matches!(
        spec.body,
        BodySpec::Lattice { perturb: None, .. } | BodySpec::Sites { .. }
    );
    let molecules = spec.interactions.bonded.is_some();
    let family = &mut spec.bonds.family;
    match family {
        // bonds of lists can be taken out one by one
        FamilyChoice::Stencil if !whole => *family = FamilyChoice::Reference,
        FamilyChoice::Reference if lattice && potentials.has_stencil() && !molecules && whole => {
            *family = FamilyChoice::Stencil;
        }
        FamilyChoice::Auto
        | FamilyChoice::Stencil
        | FamilyChoice::Neighbours
        | FamilyChoice::List
        | FamilyChoice::Reference => {}
    }
}

/// Are the lengths of nodes some?
pub(super) fn check_smooth(spec: &Spec) -> Result<(), BuildError> {
    let Some(smooth) = &spec.bonds.smooth else {
        return Ok(());
    };
    for (path, length) in [
        ("smooth.width", Some(smooth.width)),
        ("smooth.spacing", smooth.spacing),
    ] {
        if length.is_some_and(|l| !(l > 0.0 && l.is_finite())) {
            return Err(BuildError::invalid(path, "expected a positive length"));
        }
    }
    Ok(())
}

/// A potential on current neighbours needs a cut-off, and periods of at least two of them.
pub(super) fn check_box(
    potentials: &AnyPotentials,
    period: &[Option<f64>],
) -> Result<(), BuildError> {
    let cutoff = potentials.reach;
    if !(cutoff > 0.0 && cutoff.is_finite()) {
        return Err(BuildError::missing(
            "potential.cutoff",
            format!("the potential has no cut-off ({cutoff})"),
        )
        .help("give a cutoff, or the neighbours of the reference: family = \"reference\" with a horizon"));
    }
    check_periods("potential.cutoff", "cut-off", cutoff, period)
}

/// Nobody may be within reach twice: a length of this name and path is at most half of every period.
pub(super) fn check_periods(
    path: &str,
    name: &str,
    length: f64,
    period: &[Option<f64>],
) -> Result<(), BuildError> {
    for (axis, p) in AXES.iter().zip(period) {
        if let Some(p) = p
            && length > 0.5 * p * (1.0 + 1e-12)
        {
            return Err(BuildError::conflict(
                path,
                message![
                    format!("the {name} "),
                    Dimension::LENGTH.of(length),
                    " is beyond half the period ",
                    Dimension::LENGTH.of(*p),
                    format!(" along {axis}: an atom would see another twice"),
                ],
            )
            .help(format!(
                "make the box longer along this axis, or the {name} shorter"
            )));
        }
    }
    Ok(())
}

/// Warnings about the perfect crystal: pressure, and densities that the embedding energy does not know.
pub(super) fn crystal(
    spec: &Spec,
    potentials: &AnyPotentials,
    kind: LatticeKind,
    spacing: f64,
) -> Result<Option<Message>, BuildError> {
    let horizon = match (current_neighbours(spec), spec.bonds.horizon) {
        (true, _) => Horizon::Length(potentials.reach),
        (false, h) => h,
    };
    let length = horizon.length(spacing);
    // someone else says what is wrong with these
    if !(length.is_finite() && spacing > 0.0 && length < 100.0 * spacing) {
        return Ok(None);
    }
    let volume = kind.site_volume() * spacing.powi(kind.dimension() as i32) * spec.space.section;
    let stencil = Stencil::new(kind, spacing, horizon);
    let bulk = |spacing: f64| potentials.bulk(&stencil, spacing, volume);
    // how the kinds of a mixture lie on the lattice is not known here
    let (Some(found), Some(stiff)) = (bulk(spacing)?, bulk(spacing * 0.999)?) else {
        return Ok(None);
    };
    if found.density <= found.least_density {
        return Err(BuildError::ill_posed(
            "potential",
            message![
                format!("the electron density of the perfect {} lattice of spacing ", kind.name()),
                Dimension::LENGTH.of(spacing),
                format!(
                    " is {}: the embedding energy has no meaning there, its logarithm needs a positive density",
                    rounded(found.density, 4)
                ),
            ],
        )
        .help("the length scale of the density does not fit this lattice: give density_length of its own"));
    }
    // pressure against that of a strain of a thousandth; a spacing of five digits is within a twentieth of it
    let scale = (stiff.pressure - found.pressure).abs();
    Ok((found.pressure.abs() > 0.05 * scale).then(|| {
        message![
            format!("the {} lattice of spacing ", kind.name()),
            Dimension::LENGTH.of(spacing),
            " is not in equilibrium: its pressure is ",
            Dimension::PRESSURE.of(found.pressure),
            ", its energy per atom ",
            Dimension::ENERGY.of(found.energy),
            "; free ends and surfaces will move, and constants of this state include the pressure",
        ]
    }))
}

/// Part of the stability limit `2/ω` that atoms run at if nobody says otherwise: π/0.1, 31 steps in the shortest period.
pub(super) const FRACTION: f64 = 0.1;
/// Part of the length on which the potential changes that the fastest atom may go in a step.
const STRIDE: f64 = 0.02;
/// Speed of the fastest atoms of a Maxwellian, in standard deviations of a component.
const FASTEST: f64 = 4.0;

/// The step that the atoms' speeds allow (time): none goes further than a small part of the shortest bond, nor of the
/// distance to which two of the fastest come when they meet head on.
pub(super) fn step_of_speeds<const D: usize>(
    system: &System<D>,
    potentials: &AnyPotentials,
) -> Result<f64, BuildError> {
    let body = &system.body;
    let mass = |s: usize| body.volume().at(s) * body.density().at(s);
    let masses = body.whole(1, body.by_id(mass));
    let velocities = body.whole(D, body.values(&system.v).into_flattened());
    // by the first rank as by one that has all
    let speed = body.told(
        masses
            .zip(velocities)
            .map(|(m, v)| speed(&m, v.as_chunks::<D>().0)),
    );
    if speed == 0.0 {
        return Ok(f64::INFINITY);
    }
    let mut shortest = f64::INFINITY;
    system
        .interaction
        .each_bond(&system.body, &mut |_, _, xi, _| {
            shortest = xi.iter().map(|c| c * c).sum::<f64>().min(shortest);
        });
    let shortest = body.least(shortest).sqrt();
    let heaviest = body.by_id(mass).into_iter().fold(0.0, f64::max);
    let heaviest = body.most(heaviest);
    let from = shortest.min(potentials.reach);
    let closest = potentials.closest(from, heaviest * speed * speed)?;
    Ok(STRIDE * closest.unwrap_or(f64::INFINITY).min(shortest) / speed)
}

/// That of the fastest of these atoms against their mean, or of a Maxwellian of their energy.
fn speed<const D: usize>(mass: &[f64], v: &[[f64; D]]) -> f64 {
    let total: f64 = mass.iter().sum();
    let mean: [f64; D] = crate::array::from_fn(|a| {
        let momentum: f64 = mass.iter().zip(v).map(|(m, v)| m * v[a]).sum();
        momentum / total
    });
    let square = |v: &[f64; D]| (0..D).map(|a| (v[a] - mean[a]).powi(2)).sum::<f64>();
    let twice: f64 = mass.iter().zip(v).map(|(m, v)| m * square(v)).sum();
    let fastest = v.iter().map(square).fold(0.0, f64::max).sqrt();
    fastest.max(FASTEST * (twice / (D as f64 * total)).sqrt())
}

/// Maxwellian velocities: component by component normal with variance k_B T / m, without total momentum, scaled to
/// the mean temperature `(D N − D) k_B T / 2 = kinetic energy`. The same for a seed on every machine and number of threads.
///
/// # Errors
/// A temperature that is negative or no number somewhere.
pub(super) fn heat<const D: usize>(
    system: &mut System<D>,
    thermal: &ThermalSpec,
) -> Result<(), BuildError> {
    let body = &system.body;
    let slots: Vec<usize> = body.slots().iter().map(|s| *s as usize).collect();
    let mass = body.by_id(|s| body.volume().at(s) * body.density().at(s));
    let energy = agreed(body, thermal_energies(system, &thermal.energy, &slots))?;
    // by the first rank as by one that has all
    let whole = body.whole(1, mass).zip(body.whole(1, energy));
    let whole = whole.map(|(mass, energy)| maxwellian::<D>(thermal, &mass, &energy));
    let own = body.part_of(D, whole.map(Vec::into_flattened));
    for (s, v) in slots.into_iter().zip(own.as_chunks::<D>().0) {
        (0..D).for_each(|a| system.v[a][s] = v[a]);
    }
    Ok(())
}

/// Of atoms of these masses and k_B T.
fn maxwellian<const D: usize>(
    thermal: &ThermalSpec,
    mass: &[f64],
    energy: &[f64],
) -> Vec<[f64; D]> {
    let mut random = SplitMix(thermal.seed);
    let mut v = vec![[0.0; D]; mass.len()];
    let mut momentum = [0.0; D];
    for ((v, m), energy) in v.iter_mut().zip(mass).zip(energy) {
        for a in 0..D {
            // Box & Muller 1958
            let (x, y) = (1.0 - random.unit(), random.unit());
            let normal = (-2.0 * libm::log(x)).sqrt() * libm::cos(std::f64::consts::TAU * y);
            v[a] = (energy / m).sqrt() * normal;
            momentum[a] += m * v[a];
        }
    }
    let total: f64 = mass.iter().sum();
    let mut twice = 0.0;
    for (v, m) in v.iter_mut().zip(mass) {
        for a in 0..D {
            v[a] -= momentum[a] / total;
            twice += m * v[a] * v[a];
        }
    }
    let free = (D * mass.len().saturating_sub(1)) as f64;
    let mean = match thermal.energy.as_constant() {
        Some(energy) => energy,
        None => energy.iter().sum::<f64>() / mass.len() as f64,
    };
    if twice > 0.0 {
        let scale = (free * mean / twice).sqrt();
        v.iter_mut().flatten().for_each(|v| *v *= scale);
    }
    v
}

/// k_B T of each point.
fn thermal_energies<const D: usize>(
    system: &System<D>,
    of: &Expression,
    slots: &[usize],
) -> Result<Vec<f64>, BuildError> {
    let one = |s: &usize| {
        let x = system.body.position(*s);
        let energy = of.eval(&x, 0.0);
        match energy >= 0.0 && energy.is_finite() {
            true => Ok(energy),
            false => Err(BuildError::invalid(
                "initial_velocities.temperature",
                format!("`{}` is not a temperature at {x:?}", of.source()),
            )),
        }
    };
    slots.iter().map(one).collect()
}
