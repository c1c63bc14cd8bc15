//! How long to run.

use super::context::{Context, Result};
use crate::deck::document::{
    ControlName, Document, LoadCycles, MethodName, Run, Safety, SolverName, Statics,
};
use crate::deck::units::short;
use crate::deck::value::{At, Measured, Or, Written, span};
use crate::drive::refused_threads;
use peridyne::spec::{Control, Cycles, Method, Newmark, Schedule, Solver, Stepper, TimeStep};
use std::ops::Range;

/// A run of more steps is likely a slip of units.
pub(in crate::deck) const MANY_STEPS: u64 = 10_000_000;

pub(super) struct RunSpec {
    pub schedule: Schedule,
    pub threads: Option<usize>,
    /// Set when the steps follow from the estimated step only.
    pub duration: Option<f64>,
    /// Modes of vibration asked for.
    pub modes: usize,
    /// Statics before motion.
    pub preload: Option<Before>,
}

/// Statics before motion.
pub(super) struct Before {
    pub statics: peridyne::spec::Statics,
    pub increments: u64,
    pub duration: Option<f64>,
}

pub(super) fn schedule(context: &Context, document: &Document) -> Result<RunSpec> {
    match (&document.run, &document.statics) {
        (Some(run), None) => motion(context, run),
        (None, Some(written)) => statics(context, written, Method::Linear),
        (Some(run), Some(written)) => {
            let before = statics(context, written, Method::Newton)?;
            let Some(options) = before.schedule.statics() else {
                return Ok(before);
            };
            if before.schedule.steps == 0 {
                let zero = &written.value.increments;
                let span = zero.as_ref().map_or(&written.span, |n| &n.span);
                return Err(context.error_with(
                    span,
                    "motion begins in equilibrium, and no increment leads to one",
                    "write increments = 1 or more, or leave [statics] out",
                ));
            }
            let duration = context.optional(&written.value.duration)?;
            let then = motion(context, run)?;
            Ok(RunSpec {
                modes: before.modes,
                threads: then.threads.or(before.threads),
                preload: Some(Before {
                    statics: options,
                    increments: before.schedule.steps,
                    duration,
                }),
                ..then
            })
        }
        (None, None) => Err(context.error_with(
            &(0..0),
            "the deck does not say what to do",
            "add [run] with steps or a duration, or [statics] for equilibrium, or both: dynamics from a preloaded state",
        )),
    }
}

fn statics(context: &Context, written: &At<Statics>, usual: Method) -> Result<RunSpec> {
    let written = &written.value;
    let control = control(context, written)?;
    let method = match written.method {
        None if matches!(
            control,
            Control::IndirectDisplacement(_) | Control::ArcLength(_)
        ) =>
        {
            Method::Newton
        }
        None => usual,
        Some(MethodName(method)) => method,
    };
    let tolerance = context.value_or(&written.tolerance, method.tolerance())?;
    let increments = written.increments.as_ref().map_or(1, |n| n.value);
    let modes = written.modes.as_ref().map_or(0, |n| n.value);
    let end = context.value_or(&written.duration, 1.0)?;
    if increments == 0 && modes == 0 {
        let span = written.increments.as_ref().map_or(0..0, |n| n.span.clone());
        return Err(context.error_with(
            &span,
            "without increments and modes there is nothing to do",
            "write increments = 1, or modes = 6",
        ));
    }
    Ok(RunSpec {
        schedule: Schedule {
            steps: increments,
            time_step: TimeStep::Fixed(end / increments.max(1) as f64),
            force_unstable: false,
            stepper: Stepper::Statics(peridyne::spec::Statics {
                method,
                control,
                solver: solver(written.solver),
                tolerance,
                most_iterations: written.iterations.as_ref().map_or(100_000, |n| n.value),
                timed: written.duration.is_some(),
                cycles: { written.cycles.as_ref() }
                    .map(|c| cycles(context, &c.value))
                    .transpose()?,
            }),
        },
        threads: threads(context, &written.threads)?,
        duration: None,
        modes,
        preload: None,
    })
}

fn control(context: &Context, written: &Statics) -> Result<Control> {
    let name = { written.control.as_ref() }.map_or(ControlName::Load, |c| c.value);
    if name != ControlName::Load
        && let Some(duration) = &written.duration
    {
        return Err(context.error_with(
            &duration.span,
            "t is the load factor here, not a time",
            "leave duration out, or control",
        ));
    }
    let lengths = [
        (
            ("opening", span(&written.opening)),
            (
                ControlName::IndirectDisplacement,
                "add opening, a tenth of the critical stretch, say",
            ),
        ),
        (
            ("arc_length", span(&written.arc_length)),
            (
                ControlName::ArcLength,
                "add arc_length, how far points go in an increment",
            ),
        ),
    ];
    for ((key, length), (of, help)) in lengths {
        match (length, &written.control) {
            (Some(length), _) if name != of => {
                return Err(context.error_with(
                    &length,
                    format!("{key} is the length of increments of control = \"{key}\""),
                    format!("write control = \"{key}\", or leave {key} out"),
                ));
            }
            (None, Some(control)) if name == of => {
                return Err(context.error_with(
                    &control.span,
                    format!("control = \"{key}\" does not say how long an increment is"),
                    help,
                ));
            }
            (Some(_) | None, _) => {}
        }
    }
    Ok(match name {
        ControlName::Load => Control::Load,
        ControlName::SequentiallyLinear => Control::SequentiallyLinear,
        ControlName::IndirectDisplacement => {
            Control::IndirectDisplacement(context.value_or(&written.opening, 0.0)?)
        }
        ControlName::ArcLength => Control::ArcLength(context.value_or(&written.arc_length, 0.0)?),
    })
}

fn cycles(context: &Context, written: &LoadCycles) -> Result<Cycles> {
    if let Some(bonds) = written.bonds.as_ref().filter(|n| n.value == 0) {
        return Err(context.error(&bonds.span, "an increment breaks one bond at least"));
    }
    Ok(Cycles {
        load_ratio: context.value_or(&written.load_ratio, 0.0)?,
        bonds: written.bonds.as_ref().map_or(1, |n| n.value),
        most: context.value_or(&written.most, f64::INFINITY)?,
    })
}

fn solver(written: Option<SolverName>) -> Solver {
    match written {
        None | Some(SolverName::Auto) => Solver::Auto,
        Some(SolverName::Direct) => Solver::Direct,
        Some(SolverName::Cg) => Solver::ConjugateGradients,
    }
}

/// What moves the points; keys of the implicit methods belong to them alone.
fn stepper(context: &Context, run: &Run) -> Result<Stepper> {
    let integrator = match &run.integrator {
        None => Stepper::integrators()[0],
        Some(At { value, .. }) => value.0,
    };
    const HHT: &str = "hht";
    const PLAIN: &str = "newmark";
    let name = integrator.name;
    let own: [(&str, Option<Range<usize>>, &[&str]); 6] = [
        ("beta", span(&run.beta), &[PLAIN]),
        ("gamma", span(&run.gamma), &[PLAIN]),
        ("alpha", span(&run.alpha), &[HHT]),
        ("solver", span(&run.solver), &[PLAIN, HHT]),
        ("tolerance", span(&run.tolerance), &[PLAIN, HHT]),
        ("iterations", span(&run.iterations), &[PLAIN, HHT]),
    ];
    for (key, span, of) in own {
        if let Some(span) = span
            && !of.contains(&name)
        {
            let (whose, word) = match of {
                [HHT] => ("the method of Hilber, Hughes and Taylor", "hht"),
                [PLAIN] if name == HHT => ("Newmark's method; alpha says both here", "newmark"),
                _ => ("the implicit integrator", "newmark"),
            };
            return Err(context.error_with(
                &span,
                format!("{key} belongs to {whose}"),
                format!("write integrator = \"{word}\", or leave it out"),
            ));
        }
    }
    let Stepper::Newmark(mut standard) = integrator.stepper else {
        return Ok(integrator.stepper);
    };
    if let Some(alpha) = context.optional(&run.alpha)? {
        standard = Newmark::hht(alpha);
    }
    Ok(Stepper::Newmark(Newmark {
        beta: context.value_or(&run.beta, standard.beta)?,
        gamma: context.value_or(&run.gamma, standard.gamma)?,
        alpha: standard.alpha,
        solver: solver(run.solver.as_ref().map(|s| s.value)),
        tolerance: context.value_or(&run.tolerance, standard.tolerance)?,
        most_iterations: run
            .iterations
            .as_ref()
            .map_or(standard.most_iterations, |n| n.value),
    }))
}

fn threads(context: &Context, written: &Option<At<usize>>) -> Result<Option<usize>> {
    match written {
        Some(threads) if threads.value == 0 => Err(context.error_with(
            &threads.span,
            "a run needs a thread",
            "leave threads out to use all cores",
        )),
        Some(threads) => match refused_threads(threads.value) {
            Some(why) => Err(context.error(&threads.span, why)),
            None => Ok(Some(threads.value)),
        },
        None => Ok(None),
    }
}

fn motion(context: &Context, run: &At<Run>) -> Result<RunSpec> {
    let written = &run.value;
    let stepper = stepper(context, written)?;
    let time_step = match &written.time_step {
        None => TimeStep::Auto,
        Some(At {
            value:
                Or::Bare(Measured {
                    written: Written::Text(text),
                    ..
                }),
            ..
        }) if text == "auto" => TimeStep::Auto,
        Some(At {
            value: Or::Bare(number),
            span,
        }) => {
            let number = At {
                value: number.clone(),
                span: span.clone(),
            };
            TimeStep::Fixed(context.value(&number)?)
        }
        Some(At {
            value: Or::Table(Safety { safety }),
            ..
        }) => {
            let fraction = context.value(safety)?;
            if fraction > 1.0 && !written.force_unstable && stepper == Stepper::Verlet {
                let message = format!(
                    "a safety factor of {} is above the stability limit",
                    short(fraction)
                );
                return Err(context.error_with(
                    &safety.span,
                    message,
                    "use 0.8, or add force_unstable = true",
                ));
            }
            TimeStep::Fraction(fraction)
        }
    };
    let given = [
        ("steps", written.steps.is_some()),
        ("duration", written.duration.is_some()),
    ];
    context.one_of(&run.span, "run", &given)?;
    let duration = written
        .duration
        .as_ref()
        .map(|d| context.value(d).map(|v| (v, d)));
    let (steps, duration) = match (&written.steps, duration.transpose()?, time_step) {
        (Some(steps), _, _) => (steps.value, None),
        (None, Some((duration, at)), TimeStep::Fixed(step)) => {
            let steps = steps(duration, step);
            if steps > 1 << 53 {
                return Err(context.error(
                    &at.span,
                    "that takes more steps than can be counted: check the units",
                ));
            }
            (steps, None)
        }
        (None, Some((duration, _)), TimeStep::Fraction(_) | TimeStep::Auto) => (0, Some(duration)),
        (None, None, _) => return Err(context.error(&run.span, "run needs one of steps, duration")),
    };
    let schedule = Schedule {
        steps,
        time_step,
        force_unstable: written.force_unstable,
        stepper,
    };
    Ok(RunSpec {
        schedule,
        threads: threads(context, &written.threads)?,
        duration,
        modes: 0,
        preload: None,
    })
}

/// Whole steps that cover a duration; round-off does not add one.
pub(in crate::deck) fn steps(duration: f64, time_step: f64) -> u64 {
    (duration / time_step - 1e-6).ceil().max(1.0) as u64
}
