//! When bonds break: the critical stretch of a material.

use super::Shelf;
use crate::error::BuildError;
use crate::interaction::Toughness;
use crate::law::fracture_energy;
use crate::law::micromodulus::{Moments, micromodulus};
use crate::spec::{Criterion, LawSpec, MaterialSpec, PmbStiffness, Spec};

/// Of a material; `path` is where the spec has it.
pub(super) fn toughness<const D: usize>(
    spec: &Spec,
    m: &MaterialSpec,
    horizon: f64,
    moments: Moments,
    shelf: &Shelf,
    path: &str,
) -> Result<Toughness, BuildError> {
    let Some(fracture) = m.fracture else {
        return Ok(Toughness {
            s00: f64::INFINITY,
            alpha: 0.0,
        });
    };
    let s00 = match fracture.criterion {
        Criterion::Stretch(s) => s,
        Criterion::BondEnergy(_) | Criterion::VonMises(_) | Criterion::PlasticStrain(_) => {
            return Ok(Toughness {
                s00: f64::INFINITY,
                alpha: 0.0,
            });
        }
        Criterion::Energy(energy) => {
            if let LawSpec::Named(law) = &m.law
                && !law.isotropic
            {
                return Err(BuildError::unsupported(
                    path,
                    format!("a bond of the law {} has another energy in every direction: a fracture energy gives no critical stretch", law.name),
                )
                .help("give critical_stretch instead"));
            }
            if let LawSpec::Named(law) = &m.law
                && shelf.turns(&law.name)
            {
                return Err(BuildError::unsupported(
                    path,
                    format!("bonds of the law {} store energy by turning, too: a fracture energy gives no critical stretch", law.name),
                )
                .help("write criterion = \"bond_energy\" beside energy, or give critical_stretch"));
            }
            let energy = shelf.brittle_energy(&m.law, energy);
            let bonds = |stiffness| {
                let c = micromodulus(D, spec.space.plane, stiffness, moments);
                fracture_energy::bond_based(D, c, moments)
            };
            let of_unit_stretch = match m.law.linear() {
                LawSpec::Pmb(s) => bonds(*s),
                LawSpec::Lps(m) if D == 1 => bonds(PmbStiffness::Young(m.young)),
                LawSpec::Lps(m) => fracture_energy::state_based(
                    D,
                    spec.space.plane,
                    m,
                    horizon,
                    spec.bonds.influence,
                ),
                LawSpec::Atoms(_) => {
                    return Err(BuildError::unsupported(
                        path,
                        "the energy of a stretched bond of a potential is no square of its stretch: a fracture energy gives no critical stretch",
                    )
                    .help("write criterion = \"bond_energy\" beside energy, or give critical_stretch"));
                }
                LawSpec::LpsAsTyped { .. }
                | LawSpec::EamLike { .. }
                | LawSpec::Springs(_)
                | LawSpec::Micromoduli(_)
                | LawSpec::Named(_) => {
                    return Err(BuildError::unsupported(
                        path,
                        "a fracture energy is known for pmb and lps materials only",
                    )
                    .help("give critical_stretch instead"));
                }
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
