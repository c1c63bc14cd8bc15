//! What laws with kernels of their own are among those of `law/material`, which know what bonds remember, bodies that expand, points with
//! horizons of their own, and influence functions that know directions.

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

/// Does the influence function of any body?
pub(in crate::run) fn knows_directions(spec: &Spec) -> bool {
    let pieces: &[PieceSpec] = match &spec.body {
        BodySpec::Several(pieces) => pieces,
        BodySpec::Lattice { .. } | BodySpec::Sites { .. } | BodySpec::Cloud(_) => &[],
    };
    let mut own = pieces.iter().filter_map(|p| p.influence);
    spec.bonds.influence.is_directed() || own.any(Influence::is_directed)
}

/// Where an influence function knows directions, `lps` is a law of `law/material`: its own kernel weighs a bond alike at both ends. Were laws
/// changed?
pub(in crate::run) fn directed(spec: &mut Spec) -> bool {
    if !knows_directions(spec) {
        return false;
    }
    let mut changed = false;
    for m in &mut spec.materials {
        if let (LawSpec::Lps(_), Some(law)) = (&m.law, general(&m.law)) {
            m.law = law;
            changed = true;
        }
    }
    changed
}
