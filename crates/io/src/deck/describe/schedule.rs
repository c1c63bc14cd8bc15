//! Increments and steps.

use crate::deck::units::{Dim, UnitSystem, counted, short};
use peridyne::spec::{Control, Spec, Statics, Stepper, TimeStep};

pub(super) fn lines(spec: &Spec, units: UnitSystem) -> Vec<String> {
    let mut lines = vec![];
    if let Some(statics) = &spec.run.schedule.statics() {
        lines.push(equilibrium(statics, spec.run.schedule.steps, units));
        return lines;
    }
    if let Some(preload) = &spec.run.preload {
        lines.push(format!(
            "{}, under {}",
            equilibrium(&preload.statics, preload.increments, units),
            counted(preload.conditions.len() as u64, "boundary condition")
        ));
        if !preload.cuts.is_empty() {
            lines.push(format!(
                "cut        {}, when motion begins",
                counted(preload.cuts.len() as u64, "crack")
            ));
        }
    }
    let step = match spec.run.schedule.time_step {
        TimeStep::Fixed(step) => units.write(step, Dim::TIME),
        TimeStep::Auto if spec.run.schedule.stepper == Stepper::Still => {
            "the longest explicit one of heat and species".into()
        }
        TimeStep::Auto if spec.potential().is_some() => {
            "a tenth of the stability limit, less for fast atoms".into()
        }
        TimeStep::Auto => "0.8 of the stability limit".into(),
        TimeStep::Fraction(fraction) => format!("{fraction} of the stability limit"),
    };
    let steps = match spec.run.schedule.steps {
        0 => "as many steps as the duration takes".to_string(),
        steps => format!("{steps} steps"),
    };
    let how = stepper(spec.run.schedule.stepper);
    lines.push(format!("run        {steps} of {step}{how}"));
    lines
}

/// How steps are done, where that is not the usual way.
fn stepper(stepper: Stepper) -> String {
    if stepper.rests() {
        return ", no point moves".into();
    }
    let Stepper::Newmark(n) = stepper else {
        // the usual one, and what is no integrator, need no word
        let name = stepper.name().filter(|name| *name != "verlet");
        return name.map_or(String::new(), |name| format!(", by {name}"));
    };
    let tolerance = short(n.tolerance);
    match n.alpha != 0.0 {
        true => format!(
            ", implicit by the method of Hilber, Hughes and Taylor with alpha = {}, tolerance {tolerance}",
            n.alpha
        ),
        false => format!(
            ", implicit by Newmark's method with beta = {}, gamma = {}, tolerance {tolerance}",
            n.beta, n.gamma
        ),
    }
}

/// Increments of load and how each finds its equilibrium.
fn equilibrium(statics: &Statics, increments: u64, units: UnitSystem) -> String {
    let method = statics.method.words();
    let many = match statics.control {
        Control::Load => counted(increments, "increment") + " of load",
        _ if increments == 1 => "1 equilibrium".into(),
        _ => format!("{increments} equilibria"),
    };
    let each = match statics.control {
        Control::Load => String::new(),
        Control::SequentiallyLinear => ", each where the next bond breaks".into(),
        Control::IndirectDisplacement(by) => format!(", bonds open by {} in each", short(by)),
        Control::ArcLength(by) => {
            let by = units.write(by, Dim::LENGTH);
            format!(", points go by {by} in each")
        }
    };
    format!(
        "statics    {many}{each}, {method}, tolerance {}",
        short(statics.tolerance)
    )
}
