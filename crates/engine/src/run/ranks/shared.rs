//! What ranks share of a spec so far.

use crate::error::BuildError;
use crate::spec::{
    BodySpec, ConditionKind, ConditionSpec, Criterion, FamilyChoice, FractureSpec, IndenterMotion,
    IndenterSpec, LawSpec, Measure, ProbeSpec, Spec, Stepper,
};

/// Observables that walk over bonds from one end, of which the other may be another rank's.
pub(super) const WALKS: [&str; 2] = ["displacement_gradient", "strain"];

/// The one that is found of all ranks together.
pub(super) const FRAGMENT: &str = "fragment";

/// Can ranks share the model of a spec?
///
/// # Errors
/// What they do not share yet.
pub fn shared(spec: &Spec) -> Result<(), BuildError> {
    let lattice = matches!(
        spec.body,
        BodySpec::Lattice { perturb: None, .. } | BodySpec::Sites { .. }
    );
    let bonds = |law: &LawSpec| match law {
        LawSpec::Pmb(_)
        | LawSpec::Lps(_)
        | LawSpec::LpsAsTyped { .. }
        | LawSpec::EamLike { .. }
        | LawSpec::Named(_) => true,
        LawSpec::Springs(_) | LawSpec::Micromoduli(_) | LawSpec::Atoms(_) => false,
    };
    let stretch = |f: &FractureSpec| {
        matches!(f.criterion, Criterion::Stretch(_)) && f.rate.is_none() && f.fatigue.is_none()
    };
    let named = |c: &ConditionSpec| matches!(c.kind, ConditionKind::Force(_));
    let rigid =
        |i: &IndenterSpec| matches!(i.motion, IndenterMotion::Kinematic(_)) && i.friction.is_none();
    let probe = |p: &ProbeSpec| match &p.measure {
        Measure::Reaction | Measure::Moment { .. } | Measure::Energy => true,
        Measure::Over { of, .. } | Measure::Value { of, .. } => {
            of != FRAGMENT && !WALKS.contains(&&**of)
        }
        Measure::Indenter { .. } | Measure::Contour(_) => false,
    };
    let fields = spec.run.fields.as_deref().unwrap_or_default();
    let (bonded, run) = (&spec.bonds, &spec.run);
    let limits = [
        ("body", "bodies other than one lattice", !lattice),
        (
            "bonds.family",
            "bonds in lists",
            !matches!(bonded.family, FamilyChoice::Auto | FamilyChoice::Stencil)
                || !spec.interactions.pairs.is_empty(),
        ),
        (
            "bonds",
            "horizons of points, factors of bonds and surfaces",
            bonded.own_horizon.is_some()
                || bonded.surface.is_some()
                || !bonded.factors.is_empty()
                || bonded.smooth.is_some(),
        ),
        (
            "materials",
            "bonds that break by more than their stretch",
            !{ spec.materials.iter() }.all(|m| m.fracture.as_ref().is_none_or(stretch)),
        ),
        (
            "materials",
            "potentials and linear springs",
            !spec.materials.iter().all(|m| bonds(&m.law)),
        ),
        (
            "interactions",
            "contact, interfaces and potentials beside bonds",
            spec.interactions.contact.is_some()
                || !spec.interactions.interfaces.is_empty()
                || !spec.interactions.potentials.is_empty()
                || spec.interactions.bonded.is_some(),
        ),
        (
            "interactions.transfers",
            "heat and other quantities",
            !spec.interactions.transfers.is_empty(),
        ),
        (
            "damage",
            "fields of toughness and healing",
            !spec.damage.toughness.is_empty() || spec.damage.healing.is_some(),
        ),
        (
            "conditions",
            "forces of the shelf",
            spec.loading.conditions.iter().any(named),
        ),
        (
            "indenter",
            "rigid bodies that rub, or go where forces push them",
            !spec.loading.indenters.iter().all(rigid),
        ),
        (
            "loading.thermal",
            "velocities by temperature",
            spec.loading.thermal.is_some(),
        ),
        (
            "output.fields",
            "strains and displacement gradients",
            fields.iter().any(|f| WALKS.contains(&&**f)),
        ),
        (
            "run.schedule.stepper",
            "steppers other than velocity Verlet",
            run.schedule.stepper != Stepper::default(),
        ),
        (
            "probes",
            "probes of strains, of rigid bodies and of contour integrals",
            !run.probes.iter().all(probe),
        ),
        ("run", "statics before motion", run.preload.is_some()),
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
