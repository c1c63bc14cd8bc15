//! What laws with kernels of their own are among those of `law/material`, which know what bonds remember, bodies that expand, points with
//! horizons of their own, and influence functions that know directions.

use crate::error::BuildError;
use crate::law::material::{Thermoelastic, ThermoelasticSolid};
use crate::law::solid::linear::{Linear, Lps, of_stiffness};
use crate::spec::{BodySpec, Influence, LawSpec, NamedLaw, PieceSpec, Spec};

/// The same law there; `None`: it has no kernel of its own, or is not among them.
pub(in crate::run) fn general(law: &LawSpec) -> Option<LawSpec> {
    let (name, parameters) = match law {
        LawSpec::Pmb(stiffness) => (Thermoelastic::NAME, of_stiffness(*stiffness)),
        LawSpec::Lps(_) => (ThermoelasticSolid::NAME, Lps::parameters(law)?),
        LawSpec::LpsAsTyped { .. }
        | LawSpec::EamLike { .. }
        | LawSpec::Springs(_)
        | LawSpec::Micromoduli(_)
        | LawSpec::Atoms(_)
        | LawSpec::Named(_) => return None,
    };
    Some(LawSpec::Named(NamedLaw {
        name: name.into(),
        parameters,
        isotropic: true,
        linear: None,
    }))
}

/// Where an influence function knows directions, `lps` is a law of `law/material`: its own kernel weighs a bond alike at both ends. Were laws
/// changed?
///
/// # Errors
/// Other laws with such a kernel.
pub(in crate::run) fn directed(spec: &mut Spec) -> Result<bool, BuildError> {
    let pieces: &[PieceSpec] = match &spec.body {
        BodySpec::Several(pieces) => pieces,
        BodySpec::Lattice { .. } | BodySpec::Sites { .. } | BodySpec::Cloud(_) => &[],
    };
    let mut own = pieces.iter().filter_map(|p| p.influence);
    if !spec.influence.is_directed() && !own.any(Influence::is_directed) {
        return Ok(false);
    }
    let mut changed = false;
    for (n, m) in spec.materials.iter_mut().enumerate() {
        match &m.law {
            LawSpec::Lps(_) => {
                if let Some(law) = general(&m.law) {
                    m.law = law;
                    changed = true;
                }
            }
            LawSpec::LpsAsTyped { .. } | LawSpec::EamLike { .. } => {
                return Err(BuildError::unsupported(
                    format!("materials[{n}].law"),
                    "this law weighs a bond alike at both ends: its influence function knows no directions",
                )
                .help("take lps, or an influence function of r and delta"));
            }
            LawSpec::Pmb(_)
            | LawSpec::Springs(_)
            | LawSpec::Micromoduli(_)
            | LawSpec::Atoms(_)
            | LawSpec::Named(_) => {}
        }
    }
    Ok(changed)
}
