//! When bonds break: the critical stretch of a material.

use super::Registry;
use crate::error::BuildError;
use crate::interaction::Toughness;
use crate::law::fracture_energy;
use crate::law::micromodulus::{Moments, micromodulus};
use crate::law::solid::eam_like::Solid;
use crate::spec::{Criterion, LawSpec, MaterialSpec, PmbStiffness, Spec};

/// No stretch breaks its bonds.
const UNBREAKABLE: Toughness = Toughness {
    s00: f64::INFINITY,
    alpha: 0.0,
};

/// Of a material; `path` is where the spec has it.
pub fn toughness<const D: usize>(
    spec: &Spec,
    m: &MaterialSpec,
    horizon: f64,
    moments: Moments,
    registry: &Registry,
    path: &str,
) -> Result<Toughness, BuildError> {
    let Some(fracture) = m.fracture else {
        return Ok(UNBREAKABLE);
    };
    let s00 = match fracture.criterion {
        Criterion::Stretch(s) => s,
        Criterion::BondEnergy(_) | Criterion::VonMises(_) | Criterion::PlasticStrain(_) => {
            return Ok(UNBREAKABLE);
        }
        Criterion::Energy(energy) => {
            let energy = registry.brittle_energy(&m.law, energy);
            let bonds = |stiffness| {
                let c = micromodulus(D, spec.space.plane, stiffness, moments);
                fracture_energy::bond_based(D, c, moments)
            };
            let linear = m.law.linear();
            let of_unit_stretch = match linear {
                LawSpec::Pmb(s) => bonds(*s),
                LawSpec::Lps(m) if D == 1 => bonds(PmbStiffness::Young(m.young)),
                LawSpec::Lps(m) => fracture_energy::state_based(
                    D,
                    spec.space.plane,
                    m,
                    horizon,
                    spec.bonds.influence,
                ),
                LawSpec::Lps3d { .. }
                | LawSpec::EamLike { .. }
                | LawSpec::Springs(_)
                | LawSpec::Micromoduli(_)
                | LawSpec::Atoms(_)
                | LawSpec::Named(_) => match Solid::of_law(D, spec.space.plane, linear) {
                    Some(s) if D == 1 => bonds(PmbStiffness::Young(s.along_a_line())),
                    Some(s) => fracture_energy::of_solid(D, s, horizon, spec.bonds.influence),
                    // nobody breaks such bonds by a stretch of an energy
                    None => return Ok(UNBREAKABLE),
                },
            };
            let s00 = (energy / of_unit_stretch).sqrt();
            if !(s00 > 0.0) {
                return Err(BuildError::invalid(
                    path,
                    format!("a fracture energy of {energy} gives no critical stretch"),
                ));
            }
            s00
        }
    };
    if !(s00 > 0.0) || !(fracture.alpha >= 0.0) {
        return Err(BuildError::invalid(
            path,
            format!(
                "critical stretch {s00} and alpha {} must be positive",
                fracture.alpha
            ),
        ));
    }
    Ok(Toughness {
        s00,
        alpha: fracture.alpha,
    })
}
