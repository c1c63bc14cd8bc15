//! What materials break by beside their critical stretch.

use super::Shelf;
use super::general::general;
use crate::error::BuildError;
use crate::interaction::criterion::{Criteria, Measure};
use crate::law::descriptor::Memory;
use crate::law::fracture_energy;
use crate::law::micromodulus::Moments;
use crate::quantity::Message;
use crate::spec::{Criterion, FractureSpec, LawSpec, MaterialSpec, Plane, Spec};

fn unsupported(n: usize, key: &str, message: impl Into<Message>) -> BuildError {
    BuildError::unsupported(format!("materials[{n}].{key}"), message)
}

/// Where bonds break by more than the stretch of now, `pmb` is `thermoelastic` and `lps` `thermoelastic_solid`: their own kernels know no more. Were
/// laws changed?
///
/// # Errors
/// Laws whose bonds cannot remember.
pub(in crate::run) fn remembering(spec: &mut Spec) -> Result<bool, BuildError> {
    let remembers = |m: &MaterialSpec| m.fracture.is_some_and(|f| f.remembers());
    if !spec.materials.iter().any(remembers) {
        return Ok(false);
    }
    for (n, m) in spec.materials.iter_mut().enumerate() {
        match &m.law {
            LawSpec::Pmb(_) | LawSpec::Lps(_) => {
                if let Some(law) = general(&m.law) {
                    m.law = law;
                }
            }
            LawSpec::Named(_) => {}
            LawSpec::LpsAsTyped { .. } | LawSpec::EamLike { .. } => {
                return Err(unsupported(
                    n,
                    "law",
                    "bonds of this law remember nothing: they break by their critical stretch alone",
                )
                .help("take lps with the same moduli, or give critical_stretch without rate and fatigue"));
            }
            LawSpec::Atoms(_) => {
                let works = |f: FractureSpec| {
                    matches!(f.criterion, Criterion::BondEnergy(_))
                        && f.rate.is_none()
                        && f.fatigue.is_none()
                };
                if !m.fracture.is_none_or(works) {
                    return Err(unsupported(
                        n,
                        "fracture",
                        "the bonds of a potential know how far they are stretched and the work that was done on them, and no stress, rate or age",
                    )
                    .help("give critical_stretch, or energy with criterion = \"bond_energy\""));
                }
            }
            LawSpec::Springs(_) | LawSpec::Micromoduli(_) => {
                return Err(unsupported(n, "law", "bonds of this law never break")
                    .help("remove fracture, or take pmb or lps"));
            }
        }
    }
    Ok(true)
}

/// Of all materials of a body.
pub(super) fn criteria<const D: usize>(
    spec: &Spec,
    moments: Moments,
    shelf: &Shelf,
) -> Result<Criteria, BuildError> {
    let all = || spec.materials.iter().enumerate();
    let breaking = || all().filter_map(|(n, m)| Some((n, m.fracture?)));
    for (n, fracture) in breaking().filter(|(_, f)| f.remembers()) {
        if fracture.alpha != 0.0 {
            return Err(unsupported(
                n,
                "fracture",
                "strengthening under compression (alpha) is of critical stretches alone",
            )
            .help("leave alpha out"));
        }
        if let LawSpec::Named(law) = &spec.materials[n].law
            && (shelf.ends(&law.name) || shelf.kinds(&law.name))
        {
            let message = format!(
                "the law {} has a critical stretch among its constants: its bonds break by nothing else",
                law.name
            );
            return Err(unsupported(n, "fracture", message));
        }
    }
    let kind = |f: &FractureSpec| match f.criterion {
        Criterion::Energy(_) => std::mem::discriminant(&Criterion::Stretch(0.0)),
        other => std::mem::discriminant(&other),
    };
    let Some((_, first)) = breaking().next() else {
        return Ok(Criteria::default());
    };
    if let Some((n, _)) = breaking().find(|(_, f)| kind(f) != kind(&first)) {
        return Err(unsupported(
            n,
            "fracture",
            "materials of one body break by different measures, and bonds across by neither",
        )
        .help("give all materials of a body a critical stretch (or energy), or all the same other criterion"));
    }
    // all of one kind; what has none never breaks
    let limits = |per: f64| -> Vec<f64> {
        let limit = |m: &MaterialSpec| m.fracture.map(|f| f.criterion.limit() / per);
        let each = spec.materials.iter();
        each.map(|m| limit(m).unwrap_or(f64::INFINITY)).collect()
    };
    let measure = match first.criterion {
        Criterion::Stretch(_) | Criterion::Energy(_) => Measure::Stretch,
        Criterion::BondEnergy(_) => {
            Measure::Work(limits(fracture_energy::of_unit_work(D, moments)))
        }
        Criterion::PlasticStrain(_) => Measure::PlasticStrain(limits(1.0)),
        Criterion::VonMises(_) => {
            for (n, m) in all() {
                across_known::<D>(spec, n, m, shelf)?;
            }
            Measure::VonMises(limits(1.0))
        }
    };
    let rates = || all().map(|(_, m)| m.fracture.and_then(|f| f.rate));
    let fatigues = || all().map(|(_, m)| m.fracture.and_then(|f| f.fatigue));
    Ok(Criteria {
        measure,
        rate: match rates().any(|r| r.is_some()) {
            true => rates().collect(),
            false => vec![],
        },
        fatigue: match fatigues().any(|f| f.is_some()) {
            true => fatigues().collect(),
            false => vec![],
        },
    })
}

/// Is the stress across a body in plane strain known?
fn across_known<const D: usize>(
    spec: &Spec,
    n: usize,
    m: &MaterialSpec,
    shelf: &Shelf,
) -> Result<(), BuildError> {
    if D != 2 || spec.plane == Plane::Stress {
        return Ok(());
    }
    let known = match &m.law {
        LawSpec::Named(law) => {
            let of = shelf.descriptor(&law.name);
            let elastic = law.isotropic && of.is_some_and(|d| d.memory == Memory::Nothing);
            elastic || shelf.across(&law.name)
        }
        LawSpec::Pmb(_)
        | LawSpec::Springs(_)
        | LawSpec::Lps(_)
        | LawSpec::LpsAsTyped { .. }
        | LawSpec::EamLike { .. }
        | LawSpec::Micromoduli(_)
        | LawSpec::Atoms(_) => true,
    };
    match known {
        true => Ok(()),
        false => Err(unsupported(
            n,
            "fracture",
            "the stress across plane strain does not follow from that in the plane: this law is anisotropic, or its bonds soften",
        )
        .help("give another criterion, or take three dimensions")),
    }
}

/// What criteria and the way in which a body moves have to do with each other.
///
/// # Errors
/// Rates without time, cycles without bonds that wear, and the other way round.
pub(in crate::run) fn consistent(spec: &Spec) -> Result<(), BuildError> {
    let find = |has: &dyn Fn(&FractureSpec) -> bool| {
        let mut all = spec.materials.iter();
        all.position(|m| m.fracture.as_ref().is_some_and(has))
    };
    let statics = spec.schedule.statics();
    if spec
        .preload
        .as_ref()
        .is_some_and(|p| p.statics.cycles.is_some())
    {
        return Err(BuildError::unsupported(
            "preload.statics.cycles",
            "cycles of load are statics alone, no motion follows",
        )
        .help("leave [run] or cycles out"));
    }
    let cycles = statics.and_then(|s| s.cycles);
    match (find(&|f| f.fatigue.is_some()), cycles) {
        (None, None) => return Ok(()),
        (Some(n), None) => {
            return Err(unsupported(
                n,
                "fracture.fatigue",
                "bonds wear in cycles of load, and this run has none",
            )
            .help("write [statics] with method = \"newton\", increments and cycles = { load_ratio = 0.1 }"));
        }
        (None, Some(_)) => {
            return Err(BuildError::unsupported(
                "statics.cycles",
                "no material wears in cycles of load",
            )
            .help("give a material fracture.fatigue"));
        }
        (Some(_), Some(_)) => {}
    }
    Ok(())
}
