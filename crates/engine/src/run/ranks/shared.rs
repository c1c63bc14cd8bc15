//! What ranks share of a spec so far.

use crate::error::BuildError;
use crate::spec::{ConditionKind, ConditionSpec, FamilyChoice, LawSpec, Measure, ProbeSpec, Spec};

/// The one that is found of all ranks together.
pub(super) const FRAGMENT: &str = "fragment";

/// Can ranks share the model of a spec?
///
/// # Errors
/// What they do not share yet.
pub fn shared(spec: &Spec) -> Result<(), BuildError> {
    let bonds = |law: &LawSpec| match law {
        LawSpec::Pmb(_)
        | LawSpec::Lps(_)
        | LawSpec::LpsAsTyped { .. }
        | LawSpec::EamLike { .. }
        | LawSpec::Springs(_)
        | LawSpec::Named(_) => true,
        LawSpec::Micromoduli(_) | LawSpec::Atoms(_) => false,
    };
    let named = |c: &ConditionSpec| matches!(c.kind, ConditionKind::Force(_));
    let probe = |p: &ProbeSpec| match &p.measure {
        Measure::Reaction | Measure::Moment { .. } | Measure::Energy | Measure::Indenter { .. } => {
            true
        }
        Measure::Over { of, .. } | Measure::Value { of, .. } => of != FRAGMENT,
        // points that touch across ranks have no slot there
        Measure::Contour(_) => spec.interactions.contact.is_none(),
    };
    let in_reference = |family| match family {
        FamilyChoice::Auto | FamilyChoice::Stencil | FamilyChoice::List => true,
        FamilyChoice::Neighbours | FamilyChoice::Reference => false,
    };
    let (bonded, run, pieces) = (&spec.bonds, &spec.run, spec.body.pieces());
    let limits = [
        (
            "bonds.family",
            "families of now and of atoms",
            !{ std::iter::once(bonded.family) }
                .chain(pieces.iter().filter_map(|p| p.family))
                .all(in_reference),
        ),
        ("bonds", "fields on nodes", bonded.smooth.is_some()),
        (
            "materials",
            "potentials and micromoduli",
            !spec.materials.iter().all(|m| bonds(&m.law)),
        ),
        (
            "interactions",
            "friction of contact, heat through contact, interfaces, potentials beside bonds and constants of pairs",
            { spec.interactions.contact.as_ref() }
                .is_some_and(|c| c.friction.is_some() || c.conductance.is_some())
                || !spec.interactions.interfaces.is_empty()
                || !spec.interactions.potentials.is_empty()
                || !spec.interactions.pairs.is_empty()
                || spec.interactions.bonded.is_some(),
        ),
        (
            "conditions",
            "forces of the shelf",
            { spec.loading.conditions.iter() }
                .chain(run.preload.iter().flat_map(|p| &p.conditions))
                .any(named),
        ),
        (
            "loading.thermal",
            "velocities by temperature",
            spec.loading.thermal.is_some(),
        ),
        (
            "probes",
            "probes of fragments, and contour integrals beside contact",
            !run.probes.iter().all(probe),
        ),
    ];
    match limits.into_iter().find(|(_, _, wrong)| *wrong) {
        None => Ok(()),
        Some((path, what, _)) => Err(BuildError::unsupported(
            path,
            format!("ranks do not share {what} yet"),
        )
        .help("run it in one process, on as many threads as there are")),
    }
}
