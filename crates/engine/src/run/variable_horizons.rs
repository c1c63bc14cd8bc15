//! Horizons of points: what each has, and what can have such.

use super::agreed::agreed;
use crate::body::Body;
use crate::constitutive::{Registry, toughness};
use crate::error::BuildError;
use crate::expression::Expression;
use crate::law::micromodulus::Moments;
use crate::message;
use crate::quantity::{Dimension, place};
use crate::spec::{
    ContactStiffness, Criterion, FractureSpec, Influence, LawSpec, MaterialSpec, Spec,
};
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// What is longer by this part is so by round-off.
const ROUND_OFF: f64 = 1.0 + 1e-9;

/// Is the critical stretch that of a fracture energy?
fn of_energy(fracture: FractureSpec) -> bool {
    matches!(fracture.criterion, Criterion::Energy(_))
}

/// By what the critical stretch of each slot differs from that of its material, where that follows from a fracture energy: `G ∝ E s² δ` of a body
/// without another length. Empty: it does not.
pub(super) fn strengths<const D: usize>(
    spec: &Spec,
    body: &Body<D>,
    horizon: f64,
    registry: &Registry,
) -> Result<Vec<f64>, BuildError> {
    let energies = |m: &MaterialSpec| m.fracture.is_some_and(of_energy);
    if body.horizons().is_empty() || !spec.materials.iter().any(energies) {
        return Ok(vec![]);
    }
    let bears = |n: usize, horizon: f64| {
        let path = format!("materials[{n}].fracture");
        let moments = Moments::continuum(D, horizon, spec.space.section, spec.bonds.influence);
        let m = &spec.materials[n];
        toughness::<D>(spec, m, horizon, moments, registry, &path).map(|t| t.s00)
    };
    // an expression may have lengths of its own
    let written = matches!(spec.bonds.influence, Influence::Formula(_));
    let mut known: HashMap<(usize, u64), f64> = HashMap::new();
    let mut all = vec![1.0; body.len()];
    for s in body.slots().iter().map(|s| *s as usize) {
        let (n, own) = (body.material_of(s), body.horizons()[s]);
        if !energies(&spec.materials[n]) {
            continue;
        }
        if !written {
            all[s] = (horizon / own).sqrt();
            continue;
        }
        all[s] = match known.entry((n, own.to_bits())) {
            Entry::Occupied(by) => *by.get(),
            Entry::Vacant(by) => *by.insert(bears(n, own)? / bears(n, horizon)?),
        };
    }
    Ok(all)
}

/// Gives the points of a cloud the horizons that the spec asks for, none longer than `longest`.
pub(super) fn give<const D: usize>(
    spec: &Spec,
    body: &mut Body<D>,
    longest: f64,
) -> Result<(), BuildError> {
    let Some(expression) = &spec.bonds.variable_horizon else {
        return Ok(());
    };
    if expression.depends_on_time() {
        return Err(BuildError::invalid(
            "variable_horizon",
            "horizons are those of the reference, and this one depends on t",
        )
        .help("write it with x, y, z alone"));
    }
    let mut own = agreed(body, of_points(expression, body, longest))?;
    body.exchange().fill(&mut own);
    body.set_horizons(own);
    Ok(())
}

/// The horizon of each point that is here, by its slot.
fn of_points<const D: usize>(
    expression: &Expression,
    body: &Body<D>,
    longest: f64,
) -> Result<Vec<f64>, BuildError> {
    let mut own = vec![0.0; body.len()];
    for &s in body.slots() {
        let x = body.position(s as usize);
        let horizon = expression.eval(&x, 0.0);
        if !(horizon > 0.0 && horizon <= longest * ROUND_OFF) {
            return Err(BuildError::invalid(
                "variable_horizon",
                message![
                    "the horizon of the point at ",
                    place(&x[..D]),
                    " is ",
                    Dimension::LENGTH.of(horizon),
                    ", expected a positive length up to the horizon of the body, ",
                    Dimension::LENGTH.of(longest),
                ],
            )
            .help("horizon is the longest of all"));
        }
        own[s as usize] = horizon;
    }
    Ok(own)
}

/// `15 c/δ` of the bonds of each slot, `c` of bonds that weigh alike, from that of the materials at the horizon of the body: `c ∝ δ^−(D+1)` at equal moduli,
/// and of `lps_3d` `c = 18K/πδ⁴` in all dimensions. Empty: points have no horizons of their own, or the stiffness was given.
pub(super) fn own_stiffness<const D: usize>(
    spec: &Spec,
    body: &Body<D>,
    of_materials: &[f64],
    horizon: f64,
) -> Vec<f64> {
    match spec.interactions.contact.as_ref().map(|c| &c.stiffness) {
        Some(ContactStiffness::Laws) => {}
        Some(ContactStiffness::Same(_) | ContactStiffness::Pairs(_)) | None => return vec![],
    }
    let power = |material: usize| match spec.materials[material].law.linear() {
        LawSpec::Lps3d { .. } => 5,
        LawSpec::Pmb(_)
        | LawSpec::Lps(_)
        | LawSpec::EamLike { .. }
        | LawSpec::Springs(_)
        | LawSpec::Atoms(_)
        | LawSpec::Micromoduli(_)
        | LawSpec::Named(_) => D as i32 + 2,
    };
    let of = |(slot, own): (usize, &f64)| {
        let material = body.material_of(slot);
        match *own > 0.0 {
            true => of_materials[material] * (horizon / own).powi(power(material)),
            false => 0.0,
        }
    };
    body.horizons().iter().enumerate().map(of).collect()
}
