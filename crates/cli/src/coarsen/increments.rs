//! `--increments`: a nonlinear body of a deck of statics goes on in increments, its linear body taken and coarsened anew in each.

mod results;

use super::arguments::CoarsenArguments;
use super::levels::{Thinning, options, selection, step};
use super::way::Way;
use super::{kept, marked, no_faces, prescribes};
use crate::deck;
use crate::failure::{Failure, say};
use crate::signals;
use peridyne::observe::Snapshot;
use peridyne::run::{Options, Simulation, build};
use peridyne::spec::{Control, Method, Statics, TimeStep};
use peridyne_io::deck::{Deck, Dim};
use peridyne_io::write::WriteError;
use peridyne_io::write::linear::{room, write_linear};
use peridyne_theory::coarsen::Scheme;
use peridyne_theory::coarsen::increments::{
    Increment, IncrementError, Increments, Linear, Model, Plan, Removed, alone,
};
use results::{Errors, Written};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// All increments of a deck.
pub(super) fn followed(
    arguments: &CoarsenArguments,
    deck: &Deck,
    increments: usize,
) -> Result<(), Failure> {
    let asked = Asked::of(arguments, deck, increments)?;
    // what the engine has to say of the deck: is it held, can it be in equilibrium?
    let options = Options {
        trust_time_step: true,
        simd: deck::simd(&arguments.input)?,
    };
    let wrong = |e| Failure::Input(deck.explain(&e).into());
    let fine = build(&deck.spec, options).map_err(wrong)?;
    let fine = arguments.run.then_some(fine);
    let sim = build(&alone(&deck.spec), options).map_err(wrong)?;
    room(sim.info()).map_err(|e| {
        Failure::input(format!(
            "{}: {e}; take fewer points or a shorter horizon",
            deck.file()
        ))
    })?;
    match deck.spec.space.dimension {
        1 => go::<1>(arguments, deck, &asked, sim, fine),
        2 => go::<2>(arguments, deck, &asked, sim, fine),
        _ => go::<3>(arguments, deck, &asked, sim, fine),
    }
}

/// What was asked for, and what of the deck it needs.
struct Asked {
    way: Way,
    statics: Statics,
    increments: usize,
    corrections: usize,
    removed: Removed,
    /// t at the end.
    end: f64,
    out: PathBuf,
}

impl Asked {
    /// # Errors
    /// What stands in the way of increments.
    fn of(arguments: &CoarsenArguments, deck: &Deck, increments: usize) -> Result<Asked, Failure> {
        let wrong = |what: &str| {
            Err(Failure::input(format!(
                "{}: --increments: {what}",
                deck.file()
            )))
        };
        let way = Way::of(arguments)?;
        let removed = match arguments.removed.as_str() {
            "carried" => Removed::KinematicPoints,
            "relaxed" => Removed::Relaxed,
            other => {
                return Err(Failure::input(format!(
                    "--removed {other}: expected carried or relaxed"
                )));
            }
        };
        if increments == 0 {
            return Err(Failure::input(
                "--increments 0: expected a number of increments, such as 10",
            ));
        }
        no_faces(deck, way)?;
        let spec = &deck.spec;
        let Some(statics) = spec.run.schedule.statics() else {
            return wrong(
                "increments go from one equilibrium to the next, and this deck moves in time; write [statics] in place of [run], or leave --increments out",
            );
        };
        if way.scheme == Scheme::Rows {
            return wrong(
                "rows as published are not forces of an energy, and what is missing in a state that goes on is weighed by the work of the shapes: take --scheme energy or schur",
            );
        }
        match statics.control {
            Control::Load => {}
            Control::SequentiallyLinear
            | Control::IndirectDisplacement(_)
            | Control::ArcLength(_) => {
                return wrong(
                    "this deck follows a path whose load factor may decrease (statics.control); increments go to loads that are functions of t: leave control out",
                );
            }
        }
        if statics.cycles.is_some() {
            return wrong(
                "increments of this deck are cycles of fatigue; the equilibrium of one load is what is coarsened: leave cycles out",
            );
        }
        if statics.timed {
            return wrong(
                "t of this deck is a time (statics.duration), for rate-dependent laws; coarse increments take none: leave duration out",
            );
        }
        if spec.interactions.contact.is_some() || !spec.loading.rigid_bodies.is_empty() {
            return wrong(
                "contact has no tangent from which a coarse body could be made: write contact = false, and leave rigid bodies out",
            );
        }
        if !spec.interactions.diffusions.is_empty() || spec.damage.healing.is_some() {
            return wrong(
                "diffusion and healing change the body while the load stands still; increments depend on the load alone: leave heat, species and healing out",
            );
        }
        let TimeStep::Fixed(each) = spec.run.schedule.time_step else {
            return wrong("this deck does not say how far its load goes");
        };
        let out = arguments.out.clone().unwrap_or_else(|| {
            let name = arguments.input.file.file_stem();
            let name = name.map_or("deck".into(), |n| n.to_string_lossy());
            Path::new("out").join(format!("{name}-increments"))
        });
        Ok(Asked {
            way,
            statics,
            increments,
            corrections: arguments.corrections,
            removed,
            end: deck.steps(each) as f64 * each,
            out,
        })
    }
}

fn go<const D: usize>(
    arguments: &CoarsenArguments,
    deck: &Deck,
    asked: &Asked,
    sim: Box<dyn Simulation>,
    fine: Option<Box<dyn Simulation>>,
) -> Result<(), Failure> {
    let held = marked(deck, sim.as_ref(), prescribes)?;
    let selection = selection(arguments, kept(arguments, deck, sim.as_ref())?)?;
    let linear = asked.statics.method == Method::Linear;
    let mut body = Model::<D>::new(&deck.spec, sim, linear).ok_or_else(|| {
        Failure::input(format!(
            "{}: a boundary condition names no set",
            deck.file()
        ))
    })?;
    let supports = held.iter().map(|h| asked.way.supports && *h).collect();
    let sites = body.sites().to_vec();
    let mut thinning = Thinning::new(selection, sites, body.period(), supports);
    let mut levels = vec![];
    for level in 1..=arguments.levels {
        let retained = thinning.next(step(arguments, level)).map_err(|error| {
            let error = IncrementError::Coarsen { level, error };
            Failure::input(told(&error, deck))
        })?;
        levels.push((retained, options(arguments, asked.way, level)));
    }
    let plan = Plan {
        levels,
        corrections: asked.corrections,
        tolerance: asked.statics.tolerance,
        removed: asked.removed,
    };
    let kept = plan.retained(held.len());
    if !asked.way.condensed {
        body.load_only(&kept);
    }
    let begin = body.begin();
    // what is compared begins where this does
    let plain = match fine.is_some() {
        true => Some(plain(deck, asked, &mut body, &plan, &begin)?),
        false => None,
    };
    say(&format!(
        "{} points of {}, {} increments{}",
        kept.len(),
        held.len(),
        asked.increments,
        match asked.corrections {
            0 => String::new(),
            most => format!(" of at most {} solutions", most + 1),
        }
    ));
    let began = Instant::now();
    let mut path = Increments::new(&mut body, plan, begin);
    let last = follow(deck, asked, &mut body, &mut path)?;
    let seconds = began.elapsed().as_secs_f64();
    write_levels(deck, asked, &mut body, &mut path)?;
    say(&format!(
        "increments.csv, points.pvd and levels in {}, {seconds:.2} s",
        asked.out.display()
    ));
    let (Some(fine), Some(plain)) = (fine, plain) else {
        return Ok(());
    };
    let mut truth = results::run::<D>(deck, fine)?;
    let whole = body.reactions_of(truth.sim.as_mut(), asked.end);
    let each = [(path.displacements(), &last), (&plain.0[..], &plain.1)];
    let [errors, linear] = each.map(|(u, done)| {
        let reactions = body.reactions(&kept, &done.reaction);
        Errors::of([u, &truth.u], &kept, [&reactions, &whole])
    });
    say(&format!(
        "all points run as the deck says: {:.3} s",
        truth.seconds
    ));
    say(&format!("in increments: {}", errors.told()));
    say(&format!("linear about the reference: {}", linear.told()));
    results::compared(&asked.out, [&errors, &linear], [seconds, truth.seconds]).map_err(failed)
}

fn failed(e: WriteError) -> Failure {
    Failure::Run(e.to_string())
}

/// Displacements of all points, and the last increment.
type Answer<const D: usize> = (Vec<[f64; D]>, Increment<D>);

/// All of the load at once, on the level of the linear body about where increments begin.
fn plain<const D: usize>(
    deck: &Deck,
    asked: &Asked,
    body: &mut Model<D>,
    plan: &Plan,
    begin: &[[f64; D]],
) -> Result<Answer<D>, Failure> {
    let load = body.load(asked.end);
    let mut linear = Linear::of(body, begin);
    let plan = Plan {
        corrections: 0,
        removed: Removed::KinematicPoints,
        ..plan.clone()
    };
    let mut path = Increments::new(&mut linear, plan, begin.to_vec());
    let done = path.step(&mut linear, &load);
    let done = done.map_err(|e| Failure::input(told(&e, deck)))?;
    Ok((path.displacements().to_vec(), done))
}

/// One increment after the other, each told and written.
fn follow<const D: usize>(
    deck: &Deck,
    asked: &Asked,
    body: &mut Model<D>,
    path: &mut Increments<D>,
) -> Result<Increment<D>, Failure> {
    let first = frame(deck, body, 0, 0.0);
    let mut written = Written::new(deck, body, &asked.out, first);
    let mut last = None;
    for n in 1..=asked.increments {
        let t = asked.end * n as f64 / asked.increments as f64;
        let load = body.load(t);
        let done = path.step(body, &load).map_err(|e| {
            let told = format!("increment {n} of {}: {}", asked.increments, told(&e, deck));
            match (&e, n) {
                // no level about the reference: what was asked for is wrong
                (IncrementError::Coarsen { .. }, 1) => Failure::input(told),
                (_, 1) => Failure::Run(told),
                _ => Failure::Run(format!(
                    "{told}\nthe increments before are in {}",
                    asked.out.display()
                )),
            }
        })?;
        written.row(body, (n, t), path, &done);
        let frame = frame(deck, body, n as u64, t);
        written.save(&frame).map_err(failed)?;
        say(&written.told());
        last = Some(done);
        if let Some(signal) = signals::received() {
            return Err(Failure::Ended(signal));
        }
    }
    last.ok_or_else(|| Failure::Run("there was no increment".into()))
}

/// Levels about the last state, from which something else may begin.
fn write_levels<const D: usize>(
    deck: &Deck,
    asked: &Asked,
    body: &mut Model<D>,
    path: &mut Increments<D>,
) -> Result<(), Failure> {
    let reduced = match path.reduced(body, asked.way.mass) {
        Ok(reduced) => reduced,
        Err(e) => {
            let why = told(&e, deck);
            say(&format!("note: no levels about the last state: {why}"));
            return Ok(());
        }
    };
    for (n, (level, report)) in (1..).zip(&reduced.levels) {
        say(&format!(
            "level {n} about the last state: {} points, {:.1} bonds each{}",
            level.points(),
            level.partner.len() as f64 / level.points().max(1) as f64,
            match report.radius.is_finite() {
                true => format!(
                    ", balls of radius {}",
                    deck.units.show(report.radius, Dim::LENGTH)
                ),
                false => String::new(),
            }
        ));
        write_linear(&asked.out.join(format!("level{n}.npz")), level).map_err(failed)?;
    }
    Ok(())
}

/// What is seen of the body where it is: of a linear one displacements, as other columns are those of its law.
fn frame<const D: usize>(deck: &Deck, body: &mut Model<D>, number: u64, t: f64) -> Snapshot {
    let fields = match body.is_linear() {
        true => vec!["displacement".to_string()],
        false => deck::fields(deck),
    };
    let fields: Vec<&str> = fields.iter().map(String::as_str).collect();
    let sim = body.simulation();
    sim.set_time(number, t);
    sim.snapshot(&fields, false)
}

/// What stands in the way, with units.
fn told(error: &IncrementError, deck: &Deck) -> String {
    match error {
        IncrementError::Coarsen { level, error } => format!(
            "{}, level {level}: {}",
            deck.file(),
            deck.units.tell(&error.message())
        ),
        error => format!("{}: {error}", deck.file()),
    }
}
