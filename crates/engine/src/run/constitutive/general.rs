//! What laws with kernels of their own are among those of `law/material`, which know what bonds remember, bodies that expand, and points with
//! horizons of their own.

use crate::law::material::{Thermoelastic, ThermoelasticSolid};
use crate::law::solid::linear::{Linear, Lps, of_stiffness};
use crate::spec::{LawSpec, NamedLaw};

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
