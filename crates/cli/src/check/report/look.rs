//! The three things to look at first.

use super::waves::increments;
use crate::check::advice::advice;
use crate::check::directions::percent;
use crate::check::{Findings, mean};
use crate::numbers::{digits, duration};
use peridyne::spec::Stepper;
use peridyne_io::deck::{Dim, counted, rounded};
use std::fmt::Write;

/// What matters most of this body and run, in words; at most three.
pub(super) fn look(found: &Findings) -> String {
    let mut all = vec![];
    match advice(found).len() {
        0 => {}
        1 => all.push("the warning above".to_string()),
        n => all.push(format!("the {n} warnings above")),
    }
    all.extend(stiffness(found));
    all.extend(time(found));
    all.extend(fracture(found));
    all.extend(cost(found));
    let mut out = String::from("Look at\n");
    for (n, what) in all.iter().take(3).enumerate() {
        // writing to a String cannot fail
        let _ = writeln!(out, "  {}. {what}", n + 1);
    }
    out
}

/// Does the body have the modulus that was asked for?
fn stiffness(found: &Findings) -> Option<String> {
    let patch = found.patch.as_ref()?;
    let (n, m) = { found.materials.iter().enumerate() }.find(|(_, m)| m.nominal.is_some())?;
    let nominal = m.nominal?.young;
    let real = mean(found, patch.best(n)?.1).young;
    real.is_finite().then(|| {
        format!(
            "stiffness: `{}` has a Young's modulus of {}, {} beside the target",
            m.name,
            found.units.show(real, Dim::PRESSURE),
            percent(real, nominal)
        )
    })
}

/// Is the run as long as what happens in it?
fn time(found: &Findings) -> Option<String> {
    let (info, spec) = (&found.info, found.spec);
    if let Some(statics) = spec.run.schedule.statics() {
        return Some(format!(
            "equilibrium: {} {}, each to a residual of {}",
            found.steps,
            increments(statics.control, found.steps),
            rounded(statics.tolerance, 4)
        ));
    }
    let lasts = found.steps as f64 * info.time_step;
    let shown = found.units.show(lasts, Dim::TIME);
    let long = (0..info.dimension).map(|a| found.long(a));
    let long = long.fold(0.0, f64::max);
    let still = found.spec.run.schedule.stepper == Stepper::Still;
    let speeds = found.materials.iter().map(|m| m.pressure_wave);
    let fastest = speeds.filter(|c| c.is_finite() && !still);
    let fastest = fastest.fold(0.0, f64::max);
    Some(match fastest > 0.0 {
        true => format!(
            "time: the run lasts {shown}, in which a wave goes {} times through the longest side",
            rounded(lasts * fastest / long, 2)
        ),
        false => format!(
            "time: the run lasts {shown}, {}",
            counted(found.steps, "step")
        ),
    })
}

/// Is a crack narrow beside what it runs through?
fn fracture(found: &Findings) -> Option<String> {
    let (stretch, _) = found.materials.iter().find_map(|m| m.fracture)?;
    Some(format!(
        "fracture: bonds break at a stretch of {} %, and a crack is two horizons wide, {}",
        rounded(100.0 * stretch, 3),
        found.units.show(2.0 * found.info.horizon, Dim::LENGTH)
    ))
}

fn cost(found: &Findings) -> Option<String> {
    let seconds = found.trial.seconds_per_step?;
    Some(format!(
        "cost: about {} of stepping, at {} steps/s",
        duration(found.load() + seconds * found.steps as f64),
        digits(1.0 / seconds)
    ))
}
