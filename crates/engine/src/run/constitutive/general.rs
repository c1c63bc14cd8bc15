//! What laws with kernels of their own are among those of `law/material`, which know what bonds remember, bodies that expand, points with
//! horizons of their own, and influence functions that know directions.

use crate::law::material::{Thermoelastic, ThermoelasticSolid};
use crate::law::solid::linear::{EamLike, Linear, Lps, LpsAsTyped, of_stiffness};
use crate::spec::{LawSpec, NamedLaw, Parameter, Parameters, Spec};

/// The same law there; `None`: it has no kernel of its own, or is not among them.
pub(in crate::run) fn general(law: &LawSpec) -> Option<LawSpec> {
    let typed = |name: &str, bulk, shear| {
        let mut parameters = Parameters::numbers(&[("bulk", bulk), ("shear", shear)]);
        let word = Parameter::Word(name.into());
        (parameters.0).push((ThermoelasticSolid::FORMULAS.into(), word));
        (ThermoelasticSolid::NAME, parameters)
    };
    let (name, parameters) = match law {
        LawSpec::Pmb(stiffness) => (Thermoelastic::NAME, of_stiffness(*stiffness)),
        LawSpec::Lps(_) => (ThermoelasticSolid::NAME, Lps::parameters(law)?),
        LawSpec::LpsAsTyped { bulk, shear } => typed(LpsAsTyped::NAME, *bulk, *shear),
        LawSpec::EamLike { pair, volume } => {
            typed(EamLike::NAME, volume / 3.0 + pair / 18.0, pair / 30.0)
        }
        LawSpec::Springs(_) | LawSpec::Micromoduli(_) | LawSpec::Atoms(_) | LawSpec::Named(_) => {
            return None;
        }
    };
    Some(LawSpec::Named(NamedLaw {
        name: name.into(),
        parameters,
        isotropic: true,
        linear: None,
    }))
}

/// Where an influence function knows directions, solids are laws of `law/material`: their own kernel weighs a bond alike at both ends. Were laws
/// changed?
pub(in crate::run) fn directed(spec: &mut Spec) -> bool {
    spec.bonds.influence.is_directed() && generalised(spec, is_solid)
}

/// Is it state-based, with a kernel of its own?
pub(in crate::run) fn is_solid(law: &LawSpec) -> bool {
    !matches!(law, LawSpec::Pmb(_))
}

/// Laws for which `which` holds become those of `law/material`. Were laws changed?
pub(in crate::run) fn generalised(spec: &mut Spec, which: impl Fn(&LawSpec) -> bool) -> bool {
    let mut changed = false;
    for m in &mut spec.materials {
        if let Some(law) = general(&m.law).filter(|_| which(&m.law)) {
            m.law = law;
            changed = true;
        }
    }
    changed
}
