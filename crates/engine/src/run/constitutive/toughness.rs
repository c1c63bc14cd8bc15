//! When bonds break: the critical stretch of a material.

use super::Shelf;
use crate::error::BuildError;
use crate::interaction::Toughness;
use crate::law::micromodulus::{self, Moments, micromodulus};
use crate::spec::{Criterion, LawSpec, MaterialSpec, PmbStiffness, Spec};

/// Of a material; `path` is where the spec has it.
pub(super) fn toughness<const D: usize>(
    spec: &Spec,
    m: &MaterialSpec,
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
        Criterion::Energy(energy) => {
            let energy = shelf.brittle_energy(&m.law, energy);
            // the bond-based constant of the same bulk; for state-based solids of the same K
            let stiffness = match m.law.linear() {
                LawSpec::Pmb(s) => *s,
                LawSpec::Lps(m) if D == 1 => PmbStiffness::Young(m.young),
                LawSpec::Lps(m) => {
                    return lps_toughness::<D>(spec, *m, energy, fracture.alpha, path);
                }
                LawSpec::LpsAsTyped { .. }
                | LawSpec::EamLike { .. }
                | LawSpec::Springs(_)
                | LawSpec::Atoms(_)
                | LawSpec::Micromoduli(_)
                | LawSpec::Named(_) => {
                    return Err(BuildError::new(
                        path,
                        "a fracture energy is known for pmb and lps materials only",
                    )
                    .help("give critical_stretch instead"));
                }
            };
            let c = micromodulus(D, spec.plane, stiffness, moments);
            micromodulus::critical_stretch(D, energy, c, moments)
        }
    };
    if !(s00 > 0.0) || !(fracture.alpha >= 0.0) {
        return Err(BuildError::new(
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

/// Critical stretch of LPS from a fracture energy: Madenci & Oterkus 2014 (6.19) in 3-D,
/// `s0² = G0 / ((3G + (3/4)⁴ (K − 5G/3)) δ)`, and (6.20) in 2-D, `s0² = G0 / ((6G/π + 16 (K₂ − 2G)/(9π²)) δ)`.
fn lps_toughness<const D: usize>(
    spec: &Spec,
    m: crate::spec::Moduli,
    energy: f64,
    alpha: f64,
    path: &str,
) -> Result<Toughness, BuildError> {
    let horizon = match spec.horizon {
        crate::spec::Horizon::Length(d) => d,
        crate::spec::Horizon::Ratio(r) => r as f64 * spec.body.spacing().unwrap_or(1.0),
    };
    let (k, g) = (m.bulk(), m.shear());
    let stiffness = if D == 3 {
        3.0 * g + 0.75f64.powi(4) * (k - 5.0 * g / 3.0)
    } else {
        let l = m.lame();
        let plane = match spec.plane {
            crate::spec::Plane::Strain => l + g,
            crate::spec::Plane::Stress => 2.0 * l * g / (l + 2.0 * g) + g,
        };
        6.0 * g / std::f64::consts::PI
            + 16.0 * (plane - 2.0 * g) / (9.0 * std::f64::consts::PI.powi(2))
    };
    let s00 = (energy / (stiffness * horizon)).sqrt();
    if !(s00 > 0.0) {
        return Err(BuildError::new(
            path,
            format!("a fracture energy of {energy} gives no critical stretch"),
        ));
    }
    Ok(Toughness { s00, alpha })
}
