//! From the deck as written to a law with its state.

use super::document::*;
use super::variables::{of_one_variable, only_names, places};
use super::{LawDeck, explain};
use crate::deck::error::DeckError;
use crate::deck::lower;
use crate::deck::lower::context::{Context, Result};
use crate::deck::quantity::{Length, Positive};
use crate::deck::source::Source;
use crate::deck::units::Dim;
use crate::deck::value::{At, Measured, Number, Or, Quantity, Written};
use peridyne::error::BuildError;
use peridyne::execute::memory::afford;
use peridyne::expression::Expression;
use peridyne::quantity::rounded;
use peridyne_transport::exact::{Reference, Solution};
use peridyne_transport::grid::Values;
use peridyne_transport::{
    Boundary, Bump, Direction, Evaluation, Evolution, Flux, Formula, Grid, Kernel, Law, Method,
    Operator, Parity, Profile, StepSize, measure, memory,
};
use std::ops::Range;
use std::sync::Arc;

/// Safety of steps that nobody gives.
const SAFETY: f64 = 0.8;

/// What steps may add to u, over its largest |u|, where nobody says.
const TOLERANCE: f64 = 1e-6;

/// The least of it: sums of a run are no better.
const LEAST_TOLERANCE: f64 = 1e-12;

/// Bytes for each point of a frame that is shown: pictures and the report.
const SHOWN: f64 = 120.0;

pub(super) fn lower(source: &Source, document: &LawDocument) -> Result<LawDeck> {
    // the only one there is
    let KindName::ConservationLaw = document.kind;
    let units = lower::units_of(document.units.as_ref());
    let mut context = Context::new(source, units, Dim::TIME, &document.constants)?;
    context.dimension = 1 + usize::from(document.domain.value.y.is_some());
    let explained = |e| explain(source, &e);
    let grid = grid(&context, document)?;
    let dimension = match document.advection.as_ref().map(|a| &a.value.flux.value) {
        Some(Or::Bare(FluxName::Burgers | FluxName::EnergyConserving)) => Dim::VELOCITY,
        Some(Or::Table(_)) | None => Dim::NUMBER,
    };
    let horizons = horizons(&context, document)?;
    let run = &document.run.value;
    let asked = run.evaluation.as_ref().map(|e| e.value);
    let output = &document.output;
    let frames = count(&context, &output.frames, "frames")?;
    let periodic = matches!(document.boundary.value, Or::Bare(BoundaryName::Periodic));
    let fourier = periodic && asked != Some(EvaluationName::Direct);
    fits(
        &grid,
        memory::bytes(&grid, horizons, fourier),
        output,
        frames,
    )
    .map_err(explained)?;
    let place = places(&grid);
    only_names(&context, &document.initial, place, "u at t = 0")?;
    let initial = context.expression_of(&document.initial, dimension)?;
    let initial: Values = Arc::new(move |x, t| initial.eval(x, t));
    let u = sampled(&context, document, &grid, &initial)?;
    let ends = measure::extremes(&u);
    let advection = document.advection.as_ref().map(|a| {
        advection(
            &context,
            &a.value,
            place,
            ends,
            horizons[0].unwrap_or_default(),
        )
    });
    let advection = advection.transpose()?;
    let diffusion = document.diffusion.as_ref().map(|d| {
        let horizon = horizons[1].unwrap_or_default();
        let kernel = kernel(
            &context,
            &d.value.kernel,
            Parity::Even,
            horizon,
            "diffusion.kernel",
        )?;
        Ok((context.value(&d.value.viscosity)?, kernel))
    });
    let diffusion = diffusion.transpose()?;
    let law = Law::new(
        grid,
        boundary(&context, document, &grid, dimension, horizons)?,
        advection
            .as_ref()
            .map(|(f, d, k)| (f.clone(), d.clone(), k)),
        diffusion.as_ref().map(|(e, k)| (*e, k)),
    )
    .map_err(explained)?;
    let evaluation = match asked {
        Some(EvaluationName::Direct) => Evaluation::Direct,
        Some(EvaluationName::Fourier) => Evaluation::Fourier,
        Some(EvaluationName::Auto) | None => Evaluation::choose(&law),
    };
    let operator = Operator::new(law, evaluation).map_err(|e| match &*e.path {
        "evaluation" => explain(source, &e.at("run.evaluation")),
        _ => explained(e),
    })?;
    let method = match run.method {
        Some(MethodName::Ssprk3) => Method::Ssprk3,
        Some(MethodName::Rk4) | None => Method::Rk4,
        Some(MethodName::Imex) => Method::Imex,
    };
    let duration = context.value(&run.duration)?;
    let size = step_size(&context, run, duration)?;
    let evolution = Evolution::new(operator, u, method, size);
    if let (Err(e), Some(at)) = (evolution.next_step(duration), &run.time_step) {
        return Err(context.error_with(&at.span, e.to_string(), "or add force_unstable = true"));
    }
    let reference = reference(&context, output, &evolution, &initial, duration)?;
    if let (Some(at), true) = (&output.flux, grid.dimension > 1) {
        return Err(context.error_with(
            &at.span,
            "what flows through faces is written on a line: in a plane many fields have one divergence",
            "leave flux out, or write a domain without y",
        ));
    }
    Ok(LawDeck {
        title: String::new(),
        units,
        dimension,
        evolution,
        horizons,
        duration,
        frames,
        rows: count(&context, &output.history, "history")?,
        reference,
        flux: flux_asked(output),
        pictures: true,
        report: true,
        dir: None,
        warnings: lower::unitless(&context),
        source: source.clone(),
    })
}

/// Horizons of advection and diffusion, where there are any: their own, or that of the deck.
fn horizons(context: &Context, document: &LawDocument) -> Result<[Option<f64>; 2]> {
    let both = &document.horizon;
    let parts = [
        document
            .advection
            .as_ref()
            .map(|a| (&a.value.horizon, &a.span)),
        document
            .diffusion
            .as_ref()
            .map(|d| (&d.value.horizon, &d.span)),
    ];
    let mut each = [None, None];
    for (found, part) in each.iter_mut().zip(parts) {
        if let Some((own, span)) = part {
            *found = Some(horizon(context, own.as_ref().or(both.as_ref()), span)?);
        }
    }
    Ok(each)
}

/// Does memory hold a law of so many bytes, and its frames?
fn fits(
    grid: &Grid,
    law_bytes: f64,
    output: &LawOutput,
    frames: u64,
) -> std::result::Result<(), BuildError> {
    let points = grid.points();
    afford(
        "points",
        &format!("this law on {points} points"),
        law_bytes,
        "write fewer points, or a shorter horizon",
    )?;
    let shown = output.pictures.unwrap_or(true) || output.report.unwrap_or(true);
    let columns = 1 + usize::from(output.compare.is_some()) + usize::from(flux_asked(output));
    let frame_bytes = bytes_of_frames(points as f64, frames as f64, columns as f64, shown);
    afford(
        "output.frames",
        &format!("this law on {points} points with {frames} frames, kept until the end,"),
        law_bytes + frame_bytes,
        "write fewer frames",
    )
}

/// u at the start.
fn sampled(
    context: &Context,
    document: &LawDocument,
    grid: &Grid,
    initial: &Values,
) -> Result<Vec<f64>> {
    let u = grid.sample(|x| initial(x, 0.0));
    if let Some(n) = u.iter().position(|u| !u.is_finite()) {
        let place = &grid.place(n)[..grid.dimension];
        return Err(context.error(
            &document.initial.span,
            format!("u is {} at {place:?}", u[n]),
        ));
    }
    Ok(u)
}

/// What carries u, which goes from `low` to `high` at the start.
fn advection(
    context: &Context,
    written: &Transport,
    place: &[&str],
    [low, high]: [f64; 2],
    horizon: f64,
) -> Result<(Flux, Direction, Kernel)> {
    let flux = flux(context, &written.flux, [low, high])?;
    flux.evaluable(low, high, "advection.flux")
        .map_err(|e| explain(context.source, &e))?;
    let kernel = kernel(
        context,
        &written.kernel,
        Parity::Odd,
        horizon,
        "advection.kernel",
    )?;
    Ok((flux, direction(context, written, place)?, kernel))
}

/// Frames are kept until the end and packed for their file; pictures and the report look at them once more.
fn bytes_of_frames(points: f64, frames: f64, columns: f64, shown: bool) -> f64 {
    let copies = if shown { 3.0 } else { 2.0 };
    8.0 * points * (frames + 2.0) * columns * copies + if shown { SHOWN * points } else { 0.0 }
}

fn flux_asked(output: &LawOutput) -> bool {
    output.flux.as_ref().is_some_and(|f| f.value)
}

/// What the run compares itself with.
fn reference(
    context: &Context,
    output: &LawOutput,
    evolution: &Evolution,
    initial: &Values,
    duration: f64,
) -> Result<Option<Reference>> {
    let Some(at) = &output.compare else {
        return Ok(None);
    };
    let solution = match at.value {
        CompareName::Characteristics => Solution::Characteristics,
        CompareName::Riemann => Solution::Riemann,
        CompareName::ColeHopf => Solution::ColeHopf,
    };
    let law = evolution.operator.law();
    let made = Reference::new(solution, law, initial, duration, "output.compare");
    made.map(Some).map_err(|e| {
        let said = context.units.tell(&e.message);
        match &e.help {
            Some(help) => context.error_with(&at.span, said, context.units.tell(help)),
            None => context.error(&at.span, said),
        }
    })
}

fn count(context: &Context, written: &Option<At<u64>>, what: &str) -> Result<u64> {
    match written {
        None => Ok(100),
        Some(n) if (1..=1_000_000).contains(&n.value) => Ok(n.value),
        Some(n) => Err(context.error(&n.span, format!("{what} is a number from 1 to 1000000"))),
    }
}

fn grid(context: &Context, document: &LawDocument) -> Result<Grid> {
    let ends = |at: &At<[Quantity<Length>; 2]>| -> Result<[f64; 2]> {
        let [a, b] = &at.value;
        Ok([context.value(a)?, context.value(b)?])
    };
    let domain = &document.domain.value;
    let x = ends(&domain.x)?;
    let n = document.points.value;
    let made = match &domain.y {
        None => Grid::line(x[0], x[1], n),
        Some(y) => {
            let y = ends(y)?;
            Grid::plane([x[0], y[0]], [x[1], y[1]], n)
        }
    };
    made.map_err(|e| explain(context.source, &e))
}

fn horizon(
    context: &Context,
    written: Option<&Quantity<Positive<Length>>>,
    span: &Range<usize>,
) -> Result<f64> {
    match written {
        Some(number) => context.value(number),
        None => Err(context.error_with(
            span,
            "the key `horizon` is missing",
            "write horizon = a length, for the deck or here",
        )),
    }
}

/// Collars that are as wide as the horizon; each must say what u is in it.
fn boundary(
    context: &Context,
    document: &LawDocument,
    grid: &Grid,
    dimension: Dim,
    horizons: [Option<f64>; 2],
) -> Result<Boundary> {
    let at = &document.boundary;
    let Or::Table(collars) = &at.value else {
        return Ok(Boundary::Periodic);
    };
    let width = horizons.into_iter().flatten().fold(0.0, f64::max);
    let width = context.units.write(width, Dim::LENGTH);
    let empty = |what: &str, write: &str| {
        context.error_with(
            &at.span,
            format!(
                "the {what} is empty: bonds reach {width} beyond the end, and u is not given there"
            ),
            format!("write {write}, or boundary = \"periodic\""),
        )
    };
    let given = |number: &Number, names: &[&str]| -> Result<Expression> {
        only_names(context, number, names, "u in this collar")?;
        let expression = context.expression_of(number, dimension)?;
        match expression.eval(&grid.place(0), 0.0).is_finite() {
            true => Ok(expression),
            false => Err(context.error(&number.span, "u in the collar is no finite number")),
        }
    };
    let foreign = |number: &Option<Number>, what: &str| match number {
        Some(n) => Err(context.error(&n.span, what)),
        None => Ok(()),
    };
    let values: Values = if grid.dimension == 1 {
        foreign(&collars.around, "a line has two collars, left and right")?;
        let left = collars
            .left
            .as_ref()
            .ok_or_else(|| empty("left collar", "left = \"0\""))?;
        let right = collars
            .right
            .as_ref()
            .ok_or_else(|| empty("right collar", "right = \"0\""))?;
        let (left, right) = (given(left, &["x", "t"])?, given(right, &["x", "t"])?);
        let low = grid.low[0];
        Arc::new(move |x, t| {
            if x[0] < low {
                left.eval(x, t)
            } else {
                right.eval(x, t)
            }
        })
    } else {
        foreign(&collars.left, "a plane has one collar, around")?;
        foreign(&collars.right, "a plane has one collar, around")?;
        let around = collars
            .around
            .as_ref()
            .ok_or_else(|| empty("collar", "around = \"0\""))?;
        let around = given(around, &["x", "y", "t"])?;
        Arc::new(move |x, t| around.eval(x, t))
    };
    Ok(Boundary::Collars(values))
}

fn direction(context: &Context, transport: &Transport, place: &[&str]) -> Result<Direction> {
    let Some(written) = &transport.direction else {
        return Ok(Direction::Constant([1.0, 0.0]));
    };
    let [x, y, _] = context.expressions(written)?;
    for number in &written.value.0 {
        let number = At {
            value: number.value.written.clone(),
            span: written.span.clone(),
        };
        only_names(context, &number, place, "the direction")?;
    }
    if let (Some(x), Some(y)) = (x.as_constant(), y.as_constant()) {
        return Ok(Direction::Constant([x, y]));
    }
    Ok(Direction::Field([x, y].map(|e| {
        Arc::new(move |p: &[f64; 3], t: f64| e.eval(p, t)) as Values
    })))
}

/// u goes from `low` to `high` at the start.
fn flux(context: &Context, at: &At<Or<FluxName, FluxForm>>, [low, high]: [f64; 2]) -> Result<Flux> {
    let form = match &at.value {
        Or::Bare(FluxName::Burgers) => return Ok(Flux::burgers()),
        Or::Bare(FluxName::EnergyConserving) => return Ok(Flux::energy_conserving()),
        Or::Table(form) => form,
    };
    let given = [
        ("linear", form.linear.is_some()),
        ("polynomial", form.polynomial.is_some()),
        ("expression", form.expression.is_some()),
    ];
    context.one_of(&at.span, "flux", &given)?;
    if let Some(speed) = &form.linear {
        return Ok(Flux::linear(context.value(speed)?));
    }
    if let Some(written) = &form.polynomial {
        let each = written.value.iter().map(|c| context.value(c));
        let coefficients: Vec<f64> = each.collect::<Result<_>>()?;
        if coefficients.len() > peridyne_transport::flux::HIGHEST + 1 {
            return Err(context.error_with(
                &written.span,
                "a polynomial flux goes up to u⁸",
                "write it as an expression",
            ));
        }
        return Ok(Flux::of_mean(&coefficients));
    }
    let Some(written) = &form.expression else {
        return Err(context.error(&at.span, "flux needs one of linear, polynomial, expression"));
    };
    let (_, text) = of_one_variable(context, written, "u", 'x', &[])?;
    let formula = Formula::new(&text, &context.plain_constants())
        .map_err(|e| context.error(&written.span, e.message))?;
    Ok(Flux::of_formula(formula, low, high))
}

fn bump(context: &Context, name: BumpName, power: &Option<At<u32>>) -> Result<Bump> {
    match (name, power) {
        (BumpName::Polynomial, Some(p)) if !(1..=20).contains(&p.value) => {
            Err(context.error(&p.span, "the power of a bump is a number from 1 to 20"))
        }
        (BumpName::Polynomial, p) => Ok(Bump::Polynomial(p.as_ref().map_or(2, |p| p.value))),
        (BumpName::Hat | BumpName::Cosine | BumpName::Smooth, Some(p)) => {
            Err(context.error(&p.span, "power belongs to bump = \"polynomial\""))
        }
        (BumpName::Hat, None) => Ok(Bump::Hat),
        (BumpName::Cosine, None) => Ok(Bump::Cosine),
        (BumpName::Smooth, None) => Ok(Bump::Smooth),
    }
}

fn kernel(
    context: &Context,
    at: &At<KernelForm>,
    parity: Parity,
    horizon: f64,
    path: &str,
) -> Result<Kernel> {
    let form = &at.value;
    let given = [
        ("bump", form.bump.is_some()),
        ("expression", form.expression.is_some()),
        ("table", form.table.is_some()),
    ];
    context.one_of(&at.span, "kernel", &given)?;
    if let (Some(f), true) = (&form.form, parity == Parity::Odd || form.bump.is_none()) {
        return Err(context.error(
            &f.span,
            "form belongs to a bump of diffusion; of transport it is −2b′",
        ));
    }
    if let (Some(p), None) = (&form.power, &form.bump) {
        return Err(context.error(&p.span, "power belongs to bump = \"polynomial\""));
    }
    let profile = if let Some(name) = form.bump {
        let b = bump(context, name, &form.power)?;
        match (parity, form.form.as_ref().map(|f| f.value)) {
            (Parity::Odd, _) => Profile::Slope(b),
            (Parity::Even, None | Some(FormName::Value)) => Profile::Value(b),
            (Parity::Even, Some(FormName::SlopeOverDistance)) => Profile::SlopeOverDistance(b),
            (Parity::Even, Some(FormName::SecondDerivative)) => Profile::Curvature(b),
        }
    } else if let Some(written) = &form.expression {
        let (e, _) = of_one_variable(context, written, "z", 'z', &[("delta", horizon)])?;
        Profile::Function(Arc::new(move |z| e.eval(&[0.0, 0.0, z], 0.0)))
    } else {
        let points = form.table.iter().flat_map(|t| &t.value);
        let number = |n: &Number, dim| context.finite(n, dim);
        // of transport 1/length², of diffusion 1/length³, and a length more in a plane
        let power = match parity {
            Parity::Odd => 1 + context.dimension as i8,
            Parity::Even => 2 + context.dimension as i8,
        };
        let value = Dim([-power, 0, 0, 0]);
        let each = points.map(|[z, f]| Ok([number(z, Dim::LENGTH)?, number(f, value)?]));
        Profile::Table(each.collect::<Result<_>>()?)
    };
    let made = Kernel::new(
        parity,
        profile,
        horizon,
        context.dimension,
        form.normalise,
        path,
    );
    made.map_err(|e| explain(context.source, &e))
}

fn step_size(
    context: &Context,
    run: &LawRun,
    duration: f64,
) -> std::result::Result<StepSize, DeckError> {
    let within = |part: f64| {
        let tolerance = match &run.tolerance {
            None => TOLERANCE,
            Some(written) => {
                let tolerance = context.limit(written)?;
                if !(tolerance >= LEAST_TOLERANCE) {
                    return Err(context.error_with(
                        &written.span,
                        format!("the tolerance is {}: sums are no better than {LEAST_TOLERANCE:e} of u", rounded(tolerance, 3)),
                        "write what steps may add to u over its largest |u|, such as 1e-6, or inf for steps that are as long as they are stable",
                    ));
                }
                tolerance
            }
        };
        Ok(match tolerance.is_finite() {
            true => StepSize::Within {
                part,
                tolerance,
                duration,
            },
            false => StepSize::Part(part),
        })
    };
    let Some(at) = &run.time_step else {
        return within(SAFETY);
    };
    match &at.value {
        Or::Bare(Measured {
            written: Written::Text(text),
            ..
        }) if text == "auto" => within(SAFETY),
        Or::Bare(number) => {
            if let Some(written) = &run.tolerance {
                return Err(context.error_with(
                    &written.span,
                    "a step that is given is not chosen by a tolerance",
                    "leave one of time_step and tolerance out: what steps of a given length add to u is estimated too",
                ));
            }
            let number = At {
                value: number.clone(),
                span: at.span.clone(),
            };
            Ok(StepSize::Fixed {
                step: context.value(&number)?,
                force_unstable: run.force_unstable,
            })
        }
        Or::Table(LawSafety { safety }) => {
            let part = context.value(safety)?;
            match part <= 1.0 || run.force_unstable {
                true => within(part),
                false => Err(context.error_with(
                    &safety.span,
                    format!("the step would be unstable: a safety factor of {part} is above the stability limit"),
                    "use 0.8, or add force_unstable = true",
                )),
            }
        }
    }
}
