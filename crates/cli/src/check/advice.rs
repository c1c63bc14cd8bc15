//! What looks wrong, and what to write instead.

use super::{Findings, atoms, directions, mean};
use peridyne::spec::{Calibration, Horizon, LawSpec};
use peridyne_io::deck::lints;
use peridyne_theory::patch_test::Place;

/// A warning with its fix.
pub struct Advice {
    pub what: String,
    pub fix: Option<String>,
}

pub fn advice(found: &Findings) -> Vec<Advice> {
    let mut all: Vec<Advice> = vec![];
    let mut say = |what: String, fix: &str| {
        all.push(Advice {
            what,
            fix: (!found.script && !fix.is_empty()).then(|| fix.to_string()),
        });
    };
    let (spec, info) = (found.spec, &found.info);
    for warning in &info.warnings {
        say(found.units.tell(warning), "");
    }
    // those of a deck are said with their lines
    if found.script {
        let lints = lints(spec, info, found.units).into_iter();
        lints.for_each(|lint| say(found.units.tell(&lint.text), ""));
    }
    if spec.potential().is_some() {
        atoms::advice(found, &mut say);
        trial(found, &mut say);
        return all;
    }
    geometry(found, &mut say);
    for (n, ties) in found.ties.iter().enumerate().filter(|(_, ties)| **ties > 0) {
        let name = match &*spec.loading.rigid_bodies[n].name {
            "" => format!("rigid body {}", n + 1),
            name => format!("`{name}`"),
        };
        say(
            format!(
                "two sides of {name} push {ties} points alike: round-off decides which of them does, and a symmetric body may be pushed aside"
            ),
            "move the points or the rigid body by a part of the spacing",
        );
    }
    let fraction = info.time_step / info.stable_step;
    // equilibrium has no step and no limit
    if info.stable_step.is_finite() && fraction < 0.05 {
        say(
            format!(
                "the time step is {:.1} % of the stability limit",
                100.0 * fraction
            ),
            "leave run.time_step out (80 % of the limit), or write time_step = { safety = 0.5 }",
        );
    }
    for m in &found.materials {
        if let Some((s00, _)) = m.fracture.filter(|f| f.0 > 0.05) {
            say(
                format!(
                    "bonds of `{}` break at a stretch of {:.1} %: beyond 5 % strains are not small",
                    m.name,
                    100.0 * s00
                ),
                "a larger horizon or a smaller fracture energy gives a smaller critical stretch",
            );
        }
    }
    stiffness(found, &mut say);
    for (m, spec) in found.materials.iter().zip(&spec.materials) {
        if matches!(spec.law, LawSpec::EamLike { .. } | LawSpec::Lps3d { .. })
            && m.nominal.is_none()
        {
            say(
                format!(
                    "the law of `{}` has the constants of a 3-D solid, in a {}-D body",
                    m.name, info.dimension
                ),
                "law = { lps = … } has the right constants in every dimension",
            );
        }
    }
    trial(found, &mut say);
    all
}

fn trial(found: &Findings, say: &mut dyn FnMut(String, &str)) {
    if let Some(why) = &found.untried {
        say(
            why.clone(),
            "`peridyne run` takes as long as it takes, and says how far it is",
        );
    }
    if let Some(why) = &found.trial.failed {
        say(
            format!("trial steps failed: {why}"),
            "a smaller time step; slower initial velocities; softer contact or rigid body",
        );
    }
}

fn geometry(found: &Findings, say: &mut dyn FnMut(String, &str)) {
    let (spec, info) = (found.spec, &found.info);
    let d = info.dimension;
    let small = match spec.bonds.horizon {
        Horizon::Ratio(m) => m < 3,
        Horizon::Length(_) => info.horizon < 2.5 * info.spacing,
    };
    if small {
        say(
            format!(
                "the horizon is {:.2} spacings: below 3, cracks follow the lattice and waves disperse strongly",
                info.horizon / info.spacing
            ),
            "write horizon = { m_ratio = 3 }",
        );
    }
    let lonely = found
        .families
        .size
        .iter()
        .filter(|n| **n < d as u32)
        .count();
    if lonely > 0 {
        say(
            format!("{lonely} points have fewer than {d} bonds and are mechanisms"),
            "a larger horizon, or a region without such corners",
        );
    }
    for a in 0..d {
        let thickness = found.long(a);
        if spec.space.periodic[a].is_none() && thickness < info.horizon * (1.0 - 1e-9) {
            say(
                format!(
                    "along {} the body is thinner ({:.2} spacings) than the horizon ({:.2} spacings)",
                    ["x", "y", "z"][a],
                    thickness / info.spacing,
                    info.horizon / info.spacing
                ),
                "a smaller spacing with the same m_ratio, or a 2-D body with a thickness",
            );
        }
    }
}

fn stiffness(found: &Findings, say: &mut dyn FnMut(String, &str)) {
    let spec = found.spec;
    let Some(patch) = &found.patch else { return };
    for (n, m) in found.materials.iter().enumerate() {
        let Some((class, stiffness)) = patch.best(n) else {
            if patch.classes.iter().any(|c| c.material == n) {
                say(
                    format!(
                        "no point of `{}` has a full family: it has no elastic constants by long waves",
                        m.name
                    ),
                    "a larger body, or one that is periodic along all axes",
                );
            }
            continue;
        };
        if class.place != Place::Bulk {
            let young = patch.whole(n).and_then(|w| w.young_along());
            let told = match (young, directions::nominal_along(found, m)) {
                (Some(young), Some(nominal)) => format!(
                    ", and its Young's modulus is off the target along {}",
                    directions::against(&young, nominal)
                ),
                (None, _) => ", and it is not stable".into(),
                (Some(_), None) => String::new(),
            };
            say(
                format!(
                    "no point of `{}` has a full family: it is thinner than two horizons, no point is in the bulk{told}",
                    m.name
                ),
                "a smaller spacing with the same m_ratio",
            );
            continue;
        }
        let real = mean(found, stiffness);
        if let Some(nominal) = m.nominal {
            let off = match real.young.is_finite() {
                true => real.young / nominal.young - 1.0,
                // unlike along its axes: the worst of them
                false => (stiffness.young_along().into_iter().flatten())
                    .zip(directions::nominal_along(found, m).into_iter().cycle())
                    .map(|(e, nominal)| e / nominal - 1.0)
                    .fold(0.0, |worst: f64, off| match off.abs() > worst.abs() {
                        true => off,
                        false => worst,
                    }),
            };
            if off.abs() > 0.05 {
                let fix = match (spec.bonds.calibration, &spec.materials[n].law) {
                    (_, LawSpec::Pmb(peridyne::spec::PmbStiffness::Micromodulus(_))) => {
                        "give bulk or young instead of micromodulus: the constant is then calibrated to this body"
                    }
                    (Calibration::Continuum, _) => {
                        "write calibration = \"discrete\": the constants then come from this body's own sums"
                    }
                    (Calibration::Discrete, _) => "a larger m_ratio comes nearer to the continuum",
                };
                say(
                    format!(
                        "Young's modulus of `{}` in the bulk is {:+.1} % off the target",
                        m.name,
                        100.0 * off
                    ),
                    fix,
                );
            }
        }
        // plies and crystals are meant to be
        let meant = match &spec.materials[n].law {
            LawSpec::Named(law) => !law.isotropic,
            law => law.micromoduli().is_some(),
        };
        if let Some(a) = stiffness.anisotropy()
            && (a.zener - 1.0).abs() > 0.2
            && !meant
        {
            say(
                format!(
                    "`{}` is anisotropic in the bulk: Zener ratio {:.2}",
                    m.name, a.zener
                ),
                "a larger m_ratio makes the body more isotropic; influence functions that fade make it less",
            );
        }
    }
}
