//! Constants of all materials of a body, from the spec.

use super::registry::{AnyPotentials, Registry};
use crate::error::BuildError;
use crate::law::micromodulus::{Moments, micromodulus};
use crate::law::solid::eam_like::Solid;
use crate::spec::{AnyLinearBody, Influence, LawSpec, MaterialSpec, PmbStiffness, Spec};
use std::sync::Arc;

/// Constants of all materials.
#[derive(Debug, Clone)]
pub enum Laws {
    Bond(Vec<f64>),
    Solid(Vec<Solid>),
    /// Micromodulus of linear springs.
    Springs(f64),
    Atoms(AnyPotentials),
    /// Of the points in order of their ids.
    Micromoduli(Arc<AnyLinearBody>),
}

pub(super) struct Constants {
    pub laws: Laws,
    /// Stiffness of contact between points of a material, from its law (force / volume² / length).
    pub contact: Vec<f64>,
}

/// What stiffnesses are calibrated to.
struct Calibration {
    /// Length.
    horizon: f64,
    /// Sums over a full family.
    moments: Moments,
    /// Those of the full ball of radius `horizon` whose bonds weigh alike.
    alike: Moments,
}

/// `moments` are those that stiffnesses are calibrated to, `alike` those of the full ball of radius `horizon` whose bonds weigh alike.
pub(super) fn constants<const D: usize>(
    spec: &Spec,
    horizon: f64,
    moments: Moments,
    alike: Moments,
    registry: &Registry,
) -> Result<Constants, BuildError> {
    let to = Calibration {
        horizon,
        moments,
        alike,
    };
    let mut kinds = Kinds::default();
    let mut contact = vec![];
    for (n, m) in spec.materials.iter().enumerate() {
        kinds
            .solid
            .extend(Solid::of_law(D, spec.space.plane, m.law.linear()));
        possible(n, m)?;
        let (value, hard) = kinds.take::<D>(spec, n, &m.law, &to)?;
        sound(spec, n, &m.law, value, moments)?;
        contact.push(15.0 * hard / horizon);
    }
    kinds.are_one()?;
    let laws = kinds.laws(spec, registry)?;
    Ok(Constants { laws, contact })
}

/// Key of a material.
fn at(n: usize, key: &str) -> String {
    format!("materials[{n}].{key}")
}

/// Has material `n` a mass?
fn possible(n: usize, m: &MaterialSpec) -> Result<(), BuildError> {
    if !(m.density > 0.0 && m.density.is_finite()) {
        return Err(BuildError::invalid(
            at(n, "density"),
            format!("density is {}, expected a positive number", m.density),
        ));
    }
    Ok(())
}

/// Is the stiffness `value` that followed from the law of material `n` one?
fn sound(
    spec: &Spec,
    n: usize,
    law: &LawSpec,
    value: f64,
    moments: Moments,
) -> Result<(), BuildError> {
    if let Influence::Formula(formula) = spec.bonds.influence
        && !(moments.first > 0.0 && moments.first.is_finite())
        && matches!(law.linear(), LawSpec::Pmb(s) | LawSpec::Springs(s) if !matches!(s, PmbStiffness::Micromodulus(_)))
    {
        return Err(BuildError::invalid(
            "influence",
            format!(
                "Σ ω |ξ| over the bonds of a point is {} with ω = {}: no micromodulus follows from a modulus",
                moments.first,
                formula.source()
            ),
        )
        .help("a function whose integral over the ball is finite, or calibration = \"discrete\""));
    }
    if !(value > 0.0 && value.is_finite()) {
        return Err(
            BuildError::invalid(at(n, "law"), "stiffness must be positive and finite")
                .help("check the moduli: K > 0, G > 0, −1 < ν < ½"),
        );
    }
    Ok(())
}

/// Constants of the materials by the kind of their law.
#[derive(Default)]
struct Kinds<'a> {
    bond: Vec<f64>,
    solid: Vec<Solid>,
    springs: Vec<f64>,
    atoms: usize,
    given: Vec<&'a Arc<AnyLinearBody>>,
}

impl<'a> Kinds<'a> {
    /// One more material: what must be positive of its law, and its stiffness of contact as a micromodulus.
    fn take<const D: usize>(
        &mut self,
        spec: &Spec,
        n: usize,
        law: &'a LawSpec,
        to: &Calibration,
    ) -> Result<(f64, f64), BuildError> {
        let moments = to.moments;
        let c = |stiffness| micromodulus(D, spec.space.plane, stiffness, moments);
        // contact knows no influence function
        let hard = |stiffness| micromodulus(D, spec.space.plane, stiffness, to.alike);
        Ok(match law.linear() {
            LawSpec::Pmb(stiffness) => {
                let stiffness = *stiffness;
                self.bond.push(c(stiffness));
                (c(stiffness), c(stiffness) * (moments.first / moments.bare))
            }
            LawSpec::Lps(moduli) => {
                let k = if D == 1 { moduli.young } else { moduli.bulk() };
                (moduli.shear().min(k), hard(PmbStiffness::Bulk(k)))
            }
            LawSpec::Lps3d { bulk, shear } => (
                shear.min(*bulk),
                18.0 * bulk / (std::f64::consts::PI * to.horizon.powi(4)),
            ),
            LawSpec::EamLike { pair, volume } => (
                *pair,
                hard(PmbStiffness::Bulk((3.0 * volume + 0.5 * pair) / 9.0)),
            ),
            LawSpec::Springs(stiffness) => {
                let stiffness = *stiffness;
                self.springs.push(c(stiffness));
                (c(stiffness), 0.0)
            }
            LawSpec::Atoms(_) => {
                self.atoms += 1;
                (1.0, 0.0)
            }
            LawSpec::Micromoduli(body) => {
                self.given.push(body);
                (1.0, 0.0)
            }
            LawSpec::Named(law) => {
                return Err(BuildError::unknown(
                    at(n, "law"),
                    law.name.clone(),
                    format!("the law {} is not in the registry", law.name),
                ));
            }
        })
    }

    /// Are all materials of one kind, and is what they share the same?
    fn are_one(&self) -> Result<(), BuildError> {
        let kinds = [
            self.bond.len(),
            self.solid.len(),
            self.springs.len(),
            self.atoms,
            self.given.len(),
        ];
        match kinds.iter().filter(|many| **many > 0).count() {
            0 => return Err(BuildError::missing("materials", "the body has no material")),
            1 => {}
            _ => {
                return Err(BuildError::unsupported(
                    "materials",
                    "different kinds of law in one body, such as bond-based and state-based",
                )
                .help("give all materials the same kind of law: bonds across need one"));
            }
        }
        if self.springs.iter().any(|c| *c != self.springs[0]) {
            return Err(BuildError::unsupported(
                "materials",
                "springs of unlike stiffness in one body",
            )
            .help("give all materials the same springs"));
        }
        if self.given.iter().any(|b| !Arc::ptr_eq(b, self.given[0])) {
            return Err(BuildError::unsupported(
                "materials",
                "micromoduli of more than one linear body in one body",
            )
            .help("give all materials the micromoduli of the same body"));
        }
        Ok(())
    }

    fn laws(mut self, spec: &Spec, registry: &Registry) -> Result<Laws, BuildError> {
        Ok(if let Some(potentials) = registry.potentials(spec)? {
            Laws::Atoms(potentials)
        } else if let Some(body) = self.given.pop() {
            Laws::Micromoduli(body.clone())
        } else if let Some(c) = self.springs.pop() {
            Laws::Springs(c)
        } else if self.solid.is_empty() {
            Laws::Bond(self.bond)
        } else {
            Laws::Solid(self.solid)
        })
    }
}
