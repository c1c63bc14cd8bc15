//! What materials break by beside their critical stretch.

use crate::error::BuildError;
use crate::interaction::criterion::{Criteria, Measure};
use crate::law::fracture_energy;
use crate::law::micromodulus::Moments;
use crate::quantity::Message;
use crate::spec::{Criterion, FractureSpec, MaterialSpec, Spec};

fn unsupported(n: usize, key: &str, message: impl Into<Message>) -> BuildError {
    BuildError::unsupported(format!("materials[{n}].{key}"), message)
}

/// Of all materials of a body.
pub(super) fn criteria<const D: usize>(
    spec: &Spec,
    moments: Moments,
) -> Result<Criteria, BuildError> {
    let all = || spec.materials.iter().enumerate();
    let breaking = || all().filter_map(|(n, m)| Some((n, m.fracture?)));
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
        Criterion::VonMises(_) => Measure::VonMises(limits(1.0)),
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

/// Are there cycles where bonds have fatigue, and bonds with fatigue where there are cycles?
pub fn consistent(spec: &Spec) -> Result<(), BuildError> {
    let fatigue = |f: Option<FractureSpec>| f.is_some_and(|f| f.fatigue.is_some());
    let mut materials = spec.materials.iter();
    let material = materials.position(|m| fatigue(m.fracture));
    let mut interfaces = spec.interactions.interfaces.iter();
    let interface = interfaces.position(|i| fatigue(i.fracture));
    let path = |of: &str, n: usize| format!("{of}[{n}].fracture.fatigue");
    let fatigues = material.map(|n| path("materials", n));
    let fatigues = fatigues.or(interface.map(|n| path("interface", n)));
    let cycles = spec.run.schedule.statics().and_then(|s| s.cycles);
    match (fatigues, cycles) {
        (None, None) | (Some(_), Some(_)) => Ok(()),
        (Some(path), None) => Err(BuildError::unsupported(
            path,
            "fatigue needs cycles of load, and this run has none",
        )
        .help("write [statics] with method = \"newton\", increments and cycles = { load_ratio = 0.1 }")),
        (None, Some(_)) => Err(BuildError::unsupported(
            "statics.cycles",
            "no material has fatigue",
        )
        .help("give a material fracture.fatigue")),
    }
}
