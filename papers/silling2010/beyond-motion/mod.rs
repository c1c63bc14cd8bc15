//! Levels in motion (section 7): what moves with a retained point, how long a wave must be, and the time scale of a level.

use peridyne::run::{Options as Build, Simulation, build};
use peridyne::spec::{ConditionKind, LinearBody, Spec, TimeStep};
use peridyne_io::deck::Deck;
use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;
use peridyne_theory::coarsen::waves::{Frequencies, Wave, frequencies, stable_step};
use peridyne_theory::coarsen::{Mass, Options, Radius, Scheme, Selection, coarsen};

use crate::silling2010::compare::failed;
use crate::{Context, Failure, Findings};

experiment!(
    BeyondMotion,
    "beyond-motion",
    "Levels in motion: waves, pulses, a plate",
    ["../compare.rs", "deck.toml", "plate.toml"]
);

const DECK: &str = include_str!("deck.toml");
const PLATE: &str = include_str!("plate.toml");
const END: f64 = 0.3;
const MASSES: [(&str, Mass); 3] = [
    ("lumped", Mass::Lumped),
    ("consistent", Mass::Consistent),
    ("blend", Mass::Blend),
];

fn deck(text: &str, set: &[(&str, String)]) -> Result<Deck, Failure> {
    let set: Vec<_> = (set.iter())
        .map(|(key, value)| (key.to_string(), value.clone()))
        .collect();
    Deck::parse(text, "deck.toml", &set).map_err(failed)
}

/// The linear body of a deck about its reference.
fn linear<const D: usize>(deck: &Deck) -> Result<LinearBody<D>, Failure> {
    let mut spec = deck.spec.clone();
    spec.loading.initial.clear();
    spec.loading.conditions.clear();
    spec.run.schedule.time_step = TimeStep::Fixed(1.0);
    let options = Build {
        trust_time_step: true,
        ..Build::default()
    };
    let body = build(&spec, options).map_err(failed)?.linear_body();
    body.of()
        .ok_or_else(|| Failure::new(format!("the deck is not {D}-dimensional")))
}

fn coarse<const D: usize>(
    body: &LinearBody<D>,
    retained: &[u32],
    options: Options,
) -> Result<LinearBody<D>, Failure> {
    Ok(coarsen(body, retained, &options).map_err(failed)?.0)
}

fn exact(mass: Mass) -> Options {
    Options {
        scheme: Scheme::Schur,
        mass,
        ..Options::default()
    }
}

fn balls(mass: Mass) -> Options {
    Options {
        radius: Radius::Tolerance(0.01),
        mass,
        ..Options::default()
    }
}

fn waves<const D: usize>(
    fine: &LinearBody<D>,
    coarse: &LinearBody<D>,
) -> Result<Vec<Wave>, Failure> {
    match frequencies(fine, coarse) {
        Frequencies::Waves(waves) => Ok(waves),
        other => Err(Failure::new(format!("a chain has waves, not {other:?}"))),
    }
}

/// The error of the frequency of a wave of so many coarse spacings (%).
fn at(waves: &[Wave], spacings: f64) -> f64 {
    let wave = waves.iter().find(|w| w.spacings == spacings);
    wave.map_or(f64::NAN, |w| 100.0 * w.error())
}

/// A body in motion from given displacements along x, in equal steps.
fn started<const D: usize>(
    body: &LinearBody<D>,
    u: impl Fn(f64) -> f64,
    dt: f64,
) -> Result<Box<dyn Simulation>, Failure> {
    let mut spec = Spec::of_linear(body);
    spec.run.schedule.time_step = TimeStep::Fixed(dt);
    let mut sim = build(&spec, Build::default()).map_err(failed)?;
    let u: Vec<_> = { body.position.iter() }
        .map(|x| [u(x[0]), 0.0, 0.0])
        .collect();
    sim.set_displacements(&u);
    sim.start(true);
    Ok(sim)
}

/// How far a coarse chain is from the fine one at the end, at the points that both have.
fn pulse([fine, coarse]: [&LinearBody<1>; 2], retained: &[u32], w: f64) -> Result<f64, Failure> {
    let steps = 60;
    let shape = |x: f64| 1e-3 * (-((x - 0.5) / w).powi(2)).exp();
    let end = |body: &LinearBody<1>| -> Result<Vec<f64>, Failure> {
        let mut sim = started(body, shape, END / f64::from(steps))?;
        for _ in 0..steps {
            sim.step().map_err(failed)?;
        }
        Ok(sim.displacements().iter().map(|u| u[0]).collect())
    };
    let (whole, part) = (end(fine)?, end(coarse)?);
    let (mut off, mut size) = (0.0, 0.0);
    for (k, u) in retained.iter().zip(part) {
        let v = whole[*k as usize];
        off += (u - v).powi(2);
        size += v * v;
    }
    Ok(100.0 * f64::sqrt(off / size))
}

/// `Σ M v` and the energy over a run with a velocity of the whole body: how far each strays, relative.
fn kept(body: &LinearBody<1>, dt: f64) -> Result<[f64; 2], Failure> {
    let mut sim = started(body, |x| 1e-3 * (-((x - 0.5) / 0.1).powi(2)).exp(), dt)?;
    sim.set_velocities(&vec![[1e-3, 0.0, 0.0]; body.points()]);
    sim.start(true);
    let mass = body
        .mass
        .as_ref()
        .ok_or_else(|| Failure::new("masses couple points"))?;
    let momentum = |sim: &mut dyn Simulation| -> f64 {
        let v = sim.vectors("velocity");
        let row = |i: usize| {
            let (partners, blocks) = mass.row(i);
            let each = partners.iter().zip(blocks);
            each.map(|(j, m)| m[0][0] * v[*j as usize][0]).sum::<f64>()
        };
        (0..body.points()).map(row).sum()
    };
    let begin = momentum(sim.as_mut());
    let energy = |sim: &mut dyn Simulation| -> Result<f64, Failure> {
        let ledger = sim.ledger().map_err(failed)?;
        Ok(ledger.kinetic + ledger.strain)
    };
    let before = energy(sim.as_mut())?;
    let mut strays = [0.0f64; 2];
    for _ in 0..(END / dt).round() as usize {
        sim.step().map_err(failed)?;
        let now = [
            momentum(sim.as_mut()) / begin - 1.0,
            energy(sim.as_mut())? / before - 1.0,
        ];
        for (s, x) in strays.iter_mut().zip(now) {
            *s = s.max(if x.is_nan() { f64::INFINITY } else { x.abs() });
        }
    }
    Ok(strays)
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let fine = linear::<1>(&deck(DECK, &[])?)?;
    let every = |body: &LinearBody<1>, k: u32| Selection::every(k).choose(body).map_err(failed);
    let retained = every(&fine, 4)?;
    let mut plot = Plot::new("Waves of a chain, every fourth point retained")
        .x("coarse spacings per wave", "")
        .y("error of the frequency", "%");
    let mut table = Table::new();
    let mut steps = vec![];
    let mut pulses = vec![];
    let mut errors = vec![];
    for (name, mass) in MASSES {
        let body = coarse(&fine, &retained, exact(mass))?;
        let all = waves(&fine, &body)?;
        errors.push([at(&all, 25.0), at(&all, 10.0)]);
        let x: Vec<f64> = all.iter().map(|w| w.spacings).collect();
        let y: Vec<f64> = all.iter().map(|w| 100.0 * w.error()).collect();
        if steps.is_empty() {
            table = table.column("coarse spacings per wave", "", x.iter().copied());
        }
        table = table.column(name, "%", y.iter().copied());
        plot = plot.line(name, &x, &y);
        let step = |b: &LinearBody<1>| stable_step(b).unwrap_or(f64::NAN);
        steps.push(step(&body) / step(&fine));
        let mut each = [0.0; 3];
        for (error, w) in each.iter_mut().zip([0.05, 0.1, 0.2]) {
            *error = pulse([&fine, &body], &retained, w)?;
        }
        pulses.push(each);
    }
    found.picture(plot.save(&context.out, "waves")?);
    let path = context.out.join("waves.csv");
    table.save(&path)?;
    found.file(path);
    let [lumped, consistent, blend] = pulses[..] else {
        return Err(Failure::new("three masses"));
    };
    // 1/ω² goes with the mass
    let square = |error: f64| (1.0 + 0.01 * error).powi(-2);
    for (k, spacings) in ["25", "10"].into_iter().enumerate() {
        let [l, c] = [errors[0][k], errors[1][k]];
        found.number(&format!("lumped-{spacings}"), l);
        found.number(&format!("consistent-{spacings}"), c);
        let half = (0.5 * (square(l) + square(c))).powf(-0.5) - 1.0;
        found.number(&format!("half-{spacings}"), 100.0 * half);
    }
    let told = |x: [f64; 3]| format!("{:.2}, {:.2}, {:.2} %", x[0], x[1], x[2]);
    let near = [75.7, 22.7, 3.1].iter().zip(lumped);
    found.holds(
        "lumped-pulse",
        told(lumped),
        near.into_iter().all(|(a, b)| (a - b).abs() < 0.5),
    );
    found.measured(
        "pulses with the masses of the shapes, exact elimination",
        told(consistent),
        "",
    );
    found.measured(
        "pulses with blended masses, exact elimination",
        told(blend),
        "",
    );
    found.holds(
        "stable-step",
        format!(
            "{:.2} lumped, {:.2} of shapes, {:.2} blended",
            steps[0], steps[1], steps[2]
        ),
        steps[0] > steps[2] && steps[2] > steps[1],
    );

    let body = coarse(&fine, &retained, balls(Mass::Blend))?;
    let mut by_balls = [0.0; 3];
    for (error, w) in by_balls.iter_mut().zip([0.05, 0.1, 0.2]) {
        *error = pulse([&fine, &body], &retained, w)?;
    }
    found.holds("pulse-wide", told(by_balls), by_balls[2] < 0.3);
    found.holds("pulse", told(by_balls), by_balls[1] < 5.0);
    found.holds(
        "pulse-narrow",
        told(by_balls),
        [lumped, consistent, blend, by_balls]
            .iter()
            .all(|p| p[0] > 5.0),
    );
    let all = waves(&fine, &body)?;
    let both = [errors[2], [at(&all, 25.0), at(&all, 10.0)]];
    found.holds(
        "balls",
        both.map(|e| format!("{:.3} and {:.2} %", e[0], e[1]))
            .join(", "),
        both.iter().all(|e| e[0].abs() < 0.3 && e[1].abs() < 5.5),
    );
    let [momentum, coarse_step] = kept(&body, 0.02)?;
    let [_, half_step] = kept(&body, 0.01)?;
    found.holds("momentum", format!("{momentum:.1e}"), momentum < 1e-12);
    let ratio = coarse_step / half_step;
    found.holds(
        "energy",
        format!("{ratio:.3} times"),
        (ratio - 4.0).abs() < 0.2,
    );

    let two = coarse(&fine, &every(&fine, 2)?, balls(Mass::Blend))?;
    let four = coarse(&two, &every(&two, 2)?, balls(Mass::Blend))?;
    let all = waves(&fine, &four)?;
    found.holds(
        "second-level",
        format!("{:.3} %", at(&all, 25.0)),
        at(&all, 25.0).abs() < 0.5,
    );

    if !context.small {
        plate(context, &mut found)?;
    }
    Ok(found)
}

/// The plate of fibres with lumped masses and half of each.
fn plate(context: &Context, found: &mut Findings) -> Result<(), Failure> {
    let deck = deck(PLATE, &[])?;
    let fine = linear::<2>(&deck)?;
    let mut chosen = Selection::every(3).choose(&fine).map_err(failed)?;
    let model = build(&deck.spec, Build::default()).map_err(failed)?;
    for condition in &deck.spec.loading.conditions {
        let held = matches!(condition.kind, ConditionKind::Displacement(_));
        chosen.extend(
            model
                .members(&condition.set)
                .filter(|_| held)
                .unwrap_or_default(),
        );
    }
    chosen.sort_unstable();
    chosen.dedup();
    let end = deck.duration.unwrap_or(f64::NAN);
    // displacements at the end of a run in equal steps of the fine body's
    let steps = (end / model.info().time_step).ceil();
    let ended = |body: &LinearBody<2>| -> Result<Vec<[f64; 3]>, Failure> {
        let mut spec = Spec::of_linear(body);
        spec.sets = deck.spec.sets.clone();
        spec.loading.conditions = deck.spec.loading.conditions.clone();
        spec.run.schedule.time_step = TimeStep::Fixed(end / steps);
        let mut sim = build(&spec, Build::default()).map_err(failed)?;
        sim.start(true);
        for _ in 0..steps as usize {
            sim.step().map_err(failed)?;
        }
        Ok(sim.displacements())
    };
    context.say("plate, level 0");
    let whole = ended(&fine)?;
    let mut errors = vec![];
    for mass in [Mass::Lumped, Mass::Blend] {
        context.say(&format!("plate, {mass:?}"));
        let part = ended(&coarse(&fine, &chosen, balls(mass))?)?;
        let (mut off, mut size) = (0.0, 0.0);
        for (k, u) in chosen.iter().zip(part) {
            let v = whole[*k as usize];
            for a in 0..2 {
                off += (u[a] - v[a]).powi(2);
                size += v[a] * v[a];
            }
        }
        errors.push(100.0 * f64::sqrt(off / size));
    }
    found.holds(
        "plate",
        format!("{:.1} % (lumped {:.1} %)", errors[1], errors[0]),
        errors[1] < errors[0],
    );
    Ok(())
}
