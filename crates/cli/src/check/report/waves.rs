//! Waves, steps and fracture.

use super::row::row;
use crate::check::Findings;
use crate::numbers::whole;
use peridyne::spec::{Control, Criterion, Statics, Stepper};
use peridyne_io::deck::{Dim, rounded};

/// How long a run is.
fn lasts(found: &Findings) -> String {
    let time = found.steps as f64 * found.info.time_step;
    format!(
        "{} steps = {}",
        whole(found.steps),
        found.units.show(time, Dim::TIME)
    )
}

/// What a step of statics is.
pub(super) fn increments(control: Control, n: u64) -> &'static str {
    match (control, n) {
        (Control::Load, 1) => "increment of load",
        (Control::Load, _) => "increments of load",
        (_, 1) => "equilibrium",
        (_, _) => "equilibria",
    }
}

fn equilibrium(out: &mut String, name: &str, statics: &Statics, increments: u64) {
    row(
        out,
        name,
        format!(
            "{} {}, {}",
            whole(increments),
            self::increments(statics.control, increments),
            statics.method.words()
        ),
    );
}

pub(super) fn waves(found: &Findings) -> String {
    let (info, units) = (&found.info, found.units);
    let mut out = String::from("Waves and step\n");
    if found.spec.run.schedule.stepper == Stepper::Still {
        out = String::from("Step\n");
        row(&mut out, "integrator", "none, no point moves");
        let step = units.show(info.time_step, Dim::TIME);
        row(&mut out, "time step", step);
        row(&mut out, "run", lasts(found));
        return out;
    }
    let long = (0..info.dimension)
        .map(|a| found.high[a] - found.low[a] + info.spacing)
        .fold(0.0, f64::max);
    for m in &found.materials {
        if !m.pressure_wave.is_finite() {
            continue;
        }
        let prefix = if found.materials.len() > 1 {
            format!("{}: ", m.name)
        } else {
            String::new()
        };
        let shear = m.shear_wave.map_or(String::new(), |c| {
            format!(", shear {}", units.show(c, Dim::VELOCITY))
        });
        let kind = if m.shear_wave.is_some() {
            "pressure "
        } else {
            ""
        };
        let speeds = units.show(m.pressure_wave, Dim::VELOCITY);
        row(
            &mut out,
            "wave speeds",
            format!("{prefix}{kind}{speeds}{shear}"),
        );
        let crossing = long / m.pressure_wave;
        let steps = match found.spec.run.schedule.statics() {
            Some(_) => String::new(),
            None => format!(
                " = {} steps",
                whole((crossing / info.time_step).ceil() as u64)
            ),
        };
        row(
            &mut out,
            "crossing",
            format!(
                "{prefix}{}{steps} through the longest side",
                units.show(crossing, Dim::TIME)
            ),
        );
    }
    if let Some(statics) = found.spec.run.schedule.statics() {
        equilibrium(&mut out, "equilibrium", &statics, found.steps);
        return out;
    }
    if let Some(preload) = &found.spec.run.preload {
        equilibrium(
            &mut out,
            "before motion",
            &preload.statics,
            found.increments,
        );
    }
    if let Stepper::Newmark(n) = found.spec.run.schedule.stepper {
        row(
            &mut out,
            "integrator",
            match n.alpha != 0.0 {
                true => format!(
                    "implicit, the method of Hilber, Hughes and Taylor with alpha = {}: what is fast keeps {} of itself in a step",
                    n.alpha,
                    rounded((1.0 + n.alpha) / (1.0 - n.alpha), 3)
                ),
                false => format!(
                    "implicit, Newmark's method with beta = {}, gamma = {}",
                    n.beta, n.gamma
                ),
            },
        );
        let ratio = info.time_step / info.stable_step;
        row(
            &mut out,
            "time step",
            format!(
                "{}, {ratio:.3} times the limit {} of explicit steps",
                units.show(info.time_step, Dim::TIME),
                units.show(info.stable_step, Dim::TIME)
            ),
        );
        row(&mut out, "run", lasts(found));
        return out;
    }
    row(&mut out, "integrator", "velocity Verlet");
    row(
        &mut out,
        "time step",
        format!(
            "{}, {:.1} % of the stability limit {}{}",
            units.show(info.time_step, Dim::TIME),
            100.0 * info.time_step / info.stable_step,
            units.show(info.stable_step, Dim::TIME),
            if info.contact_step <= info.stable_step && info.contact_step.is_finite() {
                ", which contact sets"
            } else {
                ""
            }
        ),
    );
    row(&mut out, "run", lasts(found));
    out
}

pub(super) fn fracture(found: &Findings) -> String {
    let units = found.units;
    let mut out = String::new();
    for (m, spec) in found.materials.iter().zip(&found.spec.materials) {
        let Some((s00, energy)) = m.fracture else {
            continue;
        };
        let prefix = if found.materials.len() > 1 {
            format!("{}: ", m.name)
        } else {
            String::new()
        };
        let energy = energy.map_or("no formula for this law".to_string(), |e| {
            units.show(e, Dim::FRACTURE_ENERGY)
        });
        let given = matches!(
            spec.fracture.map(|f| f.criterion),
            Some(Criterion::Energy(_))
        );
        let (a, b) = if given {
            ("from the energy", "asked")
        } else {
            ("asked", "from the stretch")
        };
        row(
            &mut out,
            "critical stretch",
            format!("{prefix}{:.4} % ({a})", 100.0 * s00),
        );
        row(
            &mut out,
            "fracture energy",
            format!("{prefix}{energy} ({b})"),
        );
    }
    if out.is_empty() {
        out
    } else {
        format!("Fracture\n{out}")
    }
}

pub(super) fn contact(found: &Findings) -> String {
    let Some(contact) = &found.spec.interactions.contact else {
        return String::new();
    };
    let units = found.units;
    let mut out = String::new();
    let stiffness = &found.info.contact_stiffness;
    let alike = stiffness.windows(2).all(|two| two[0] == two[1]);
    for (m, k) in found.materials.iter().zip(stiffness) {
        let of = if alike {
            String::new()
        } else {
            format!("{}: ", m.name)
        };
        let k = units.show(*k, Dim::CONTACT_STIFFNESS);
        row(&mut out, "stiffness", format!("{of}{k}"));
        if alike {
            break;
        }
    }
    row(
        &mut out,
        "touch",
        format!(
            "nearer than {} of their distance in the reference and than {} spacings",
            contact.bonded, contact.free
        ),
    );
    format!("Contact\n{out}")
}
