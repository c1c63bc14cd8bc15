//! `peridyne converge`: one deck, several finer bodies, the order with which the error falls.

mod around;
mod files;
mod level;

use crate::deck;
use crate::failure::{Failure, note, say};
use crate::run::with_threads;
use crate::signals;
use crate::study::{Study, StudyArguments};
use level::{Keep, Level, Reference, measure};
use peridyne::expression::Expression;
use peridyne_io::deck::{Deck, Dim, UnitSystem, rounded};
use peridyne_theory::convergence::{Kind, Order, Verdict, order};
use peridyne_theory::refine::refine;
use serde_json::json;

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Lengths {
    /// Horizon and spacing shrink together, m = δ/Δx stays.
    Delta,
    /// The spacing shrinks, the horizon δ stays.
    M,
    /// The horizon shrinks, the spacing faster: m grows by √2 per level.
    DeltaM,
}

#[derive(clap::Args)]
pub struct ConvergeArguments {
    #[command(flatten)]
    pub study: StudyArguments,
    /// Which lengths shrink.
    #[arg(long = "study", value_enum)]
    lengths: Lengths,
    /// Levels, each with half the spacing of the one before; the deck is the coarsest.
    #[arg(long, default_value_t = 4)]
    pub levels: u32,
    /// Exact displacement along x, y, z at the end, an expression of x, y, z, t and `pi`; once per component, `0` for none.
    /// Without it, levels are compared with the finest.
    #[arg(long, value_name = "EXPRESSION")]
    pub exact: Vec<String>,
    /// All levels take the deck's step on the finest level (its fraction of the stability limit there) over this number.
    #[arg(long, default_value_t = 4)]
    pub substeps: u32,
}

/// A finished study.
struct Finished {
    kind: Kind,
    levels: Vec<Level>,
    exact: Vec<String>,
    /// The end of all runs, and the step of all levels.
    time: f64,
    time_step: f64,
    points: usize,
    /// What a step twice as long changes at the finest level, over 3: the time error (relative).
    time_error: f64,
    /// Of the errors against the reference.
    errors: Option<Order>,
    /// Of the differences between neighbouring levels.
    differences: Option<Order>,
    notes: Vec<String>,
}

impl Finished {
    /// The order to quote. Against the finest level errors fall too fast near it; differences between neighbours do not.
    fn order(&self) -> Option<&Order> {
        match self.exact.is_empty() {
            true => self.differences.as_ref().or(self.errors.as_ref()),
            false => self.errors.as_ref(),
        }
    }
}

fn words(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Converges => "consistent order of convergence",
        Verdict::Preasymptotic => {
            "errors fall, the order is not yet consistent: take more levels, or a finer first one"
        }
        Verdict::Stalls => {
            "errors stop falling: another error remains (the model's distance from the exact solution, the time step, round-off)"
        }
        Verdict::Diverges => "no convergence: errors do not fall",
        Verdict::Undecided => "one pair of levels has an order and no verdict: take more levels",
    }
}

pub fn converge(arguments: &ConvergeArguments) -> Result<(), Failure> {
    if !deck::is_deck(&arguments.study.input) {
        return Err(Failure::input(
            "converge takes a deck (.toml) with a lattice body",
        ));
    }
    let least = if arguments.exact.is_empty() { 3 } else { 2 };
    if !(least..=12).contains(&arguments.levels) {
        return Err(Failure::input(format!(
            "--levels {}: an order takes {least} to 12 levels{}",
            arguments.levels,
            if least == 3 {
                " when the finest is the reference"
            } else {
                ""
            }
        )));
    }
    if arguments.substeps == 0 {
        return Err(Failure::input("--substeps 0: take 1 or more"));
    }
    let kind = match arguments.lengths {
        Lengths::Delta => Kind::Delta,
        Lengths::M => Kind::M,
        Lengths::DeltaM => Kind::DeltaM,
    };
    let name = ["delta", "m", "delta-m"][kind as usize];
    let mut study = Study::of(&arguments.study, name)?;
    study.made_by("converge", &format!("--study {name}"));
    let deck = study.deck(&vec![])?;
    deck::is_plain(&deck, "converge")?;
    let exact = expressions(&arguments.exact, deck.spec.space.dimension)?;
    all(arguments, (&study, kind), &deck, &exact)
}

fn expressions(texts: &[String], dimension: usize) -> Result<Vec<Expression>, Failure> {
    if texts.len() > dimension {
        return Err(Failure::input(format!(
            "--exact is given {} times, the body has {dimension} dimensions: one expression per component",
            texts.len()
        )));
    }
    texts
        .iter()
        .map(|text| {
            Expression::parse(text, &[]).map_err(|e| {
                let caret =
                    " ".repeat(e.source[..e.span.start.min(e.source.len())].chars().count());
                Failure::input(format!(
                    "--exact: {}{}\n  {}\n  {caret}^",
                    e.message,
                    e.help.as_ref().map_or(String::new(), |h| format!("; {h}")),
                    e.source
                ))
            })
        })
        .collect()
}

fn all(
    arguments: &ConvergeArguments,
    (study, kind): (&Study, Kind),
    deck: &Deck,
    exact: &[Expression],
) -> Result<(), Failure> {
    // every deck is refined before any is run
    let mut decks = vec![];
    for k in 0..arguments.levels {
        let mut finer = deck.clone();
        finer.spec = refine(&deck.spec, kind, k).map_err(|e| {
            let told = deck.units.tell(&e.message());
            Failure::input(format!("{}: {told}", deck.file()))
        })?;
        decks.push(finer);
    }
    let mut step = None;
    with_threads(study.arguments.threads, |_| {
        let input = &arguments.study.input;
        step = Some(level::common_step(&decks, input, arguments.substeps)?);
        Ok(())
    })?;
    let step = step.ok_or_else(|| Failure::input("no levels"))?;
    say(&format!(
        "{}: {} levels to the time {}, all with the step {}",
        kind.name(),
        arguments.levels,
        deck.units.show(step.time, Dim::TIME),
        deck.units.show(step.time_step, Dim::TIME)
    ));
    let finest = decks.last().ok_or_else(|| Failure::input("no levels"))?;
    let mut runs: Vec<Deck> = decks.iter().map(|deck| step.of(deck, 1)).collect();
    runs.push(step.of(finest, 2));
    let levels =
        json!({ "study": kind.name(), "levels": arguments.levels, "substeps": arguments.substeps });
    study.claim("converge.json", ("levels", levels))?;
    let work = |n: usize| level_of(study, (&runs, n), deck.units);
    let made = study.side_by_side(runs.len(), &work)?;
    let made = made
        .into_iter()
        .collect::<Result<Vec<Option<Level>>, _>>()?;
    let mut levels: Vec<Level> = made.into_iter().flatten().collect();
    if let Some(signal) = signals::received() {
        note("ended: the same command goes on");
        return Err(Failure::Ended(signal));
    }
    let coarser_step = levels.pop().ok_or_else(|| Failure::input("no levels"))?;
    let finished = finish(kind, levels, &coarser_step, exact, &step)
        .map_err(|m| Failure::input(format!("{}: {m}", deck.file())))?;
    files::write(&study.dir, &finished, deck.units).map_err(|e| Failure::Run(e.to_string()))?;
    say(&report(&finished, deck.units));
    say(&format!("written: {}", study.dir.display()));
    Ok(())
}

/// The level of a run, the last of which has the coarser step; `None`: a signal has ended it.
fn level_of(
    study: &Study,
    (runs, n): (&[Deck], usize),
    units: UnitSystem,
) -> Result<Option<Level>, Failure> {
    let again = n + 1 == runs.len();
    let dir = study.dir.join(match again {
        true => "coarser-step".to_string(),
        false => format!("level{}", n + 1),
    });
    let mut keep = Keep::of(&runs[n], &dir);
    let row = study.watched(&runs[n], &vec![], dir, &mut keep);
    if let Some(error) = keep.failed {
        return Err(Failure::Run(error.to_string()));
    }
    let why = || row.why.clone().unwrap_or_default();
    match &*row.status {
        "done" => {}
        "ended" if signals::received().is_some() => return Ok(None),
        "refused" => return Err(Failure::input(why())),
        _ => return Err(Failure::Run(format!("{}: {}", row.dir.display(), why()))),
    }
    let level = Level::of(&row)?;
    if !again {
        say(&format!(
            "  spacing {}, horizon {}: {} points, volume {}, {} steps in {:.2} s",
            units.show(level.spacing, Dim::LENGTH),
            units.show(level.horizon, Dim::LENGTH),
            level.points,
            units.show(level.volume, Dim::VOLUME),
            level.steps,
            level.seconds
        ));
    }
    Ok(Some(level))
}

/// Errors, differences and orders.
fn finish(
    kind: Kind,
    mut levels: Vec<Level>,
    coarser_step: &Level,
    exact: &[Expression],
    step: &level::Step,
) -> Result<Finished, String> {
    let last = levels.len() - 1;
    let places = levels[0].reference.clone();
    let values = levels
        .iter()
        .map(|l| l.at(&places))
        .collect::<Result<Vec<_>, _>>()?;
    let reference = match exact.is_empty() {
        true => Reference::Values(&values[last]),
        false => Reference::Exact(exact, step.time),
    };
    for (k, level) in levels.iter_mut().enumerate() {
        if !(exact.is_empty() && k == last) {
            level.error = Some(measure(&places, &values[k], &reference)?);
        }
        if k < last {
            let next = Reference::Values(&values[k + 1]);
            level.difference = Some(measure(&places, &values[k], &next)?[0]);
        }
    }
    let again = coarser_step.at(&places)?;
    let [change, _] = measure(&places, &again, &Reference::Values(&values[last]))?;
    // errors go with Δt²: twice the step has four times of it
    let time_error = change / 3.0;
    let of = |get: &dyn Fn(&Level) -> Option<f64>| {
        let series: Vec<(f64, f64)> = levels
            .iter()
            .filter_map(|l| get(l).map(|e| (l.length(kind), e)))
            .collect();
        order(&series)
    };
    let errors = of(&|l| l.error.map(|e| e[0]));
    let differences = of(&|l| l.difference);
    let mut notes = vec![];
    let smallest = levels
        .iter()
        .filter_map(|l| l.error.map(|e| e[0]))
        .fold(f64::INFINITY, f64::min);
    // between levels the time error of the common step drops out
    if !exact.is_empty() && time_error > 0.1 * smallest {
        notes.push(format!(
            "The time error of the finest level, {}, is more than a tenth of the smallest error, {}: take more --substeps.",
            rounded(time_error, 3),
            rounded(smallest, 3)
        ));
    }
    if let (false, Some(e), Some(d)) = (exact.is_empty(), &errors, &differences)
        && d.fitted > e.fitted + 0.5
    {
        notes.push(format!(
            "The levels draw together with order {:.2}, towards another solution than the exact one: at fixed δ the nonlocal one, at fixed m that of the lattice's own stiffness (`peridyne waves` computes it).",
            d.fitted
        ));
    }
    let volumes = levels.iter().map(|l| l.volume);
    let (least, most) = volumes.fold((f64::INFINITY, 0.0f64), |(l, m), v| (l.min(v), m.max(v)));
    if most > least * (1.0 + 1e-9) {
        notes.push(format!(
            "The bodies of the levels differ in volume by {} %: cells fill the region each in its own way, and that is part of the differences.",
            rounded(100.0 * (most / least - 1.0), 2)
        ));
    }
    let pairs: Vec<[f64; 2]> = levels.iter().map(|l| [l.horizon, l.spacing]).collect();
    if Kind::of(&pairs) != Some(kind) {
        notes.push(format!(
            "Rounding of m left these levels no {}: take a larger m_ratio.",
            kind.name()
        ));
    }
    Ok(Finished {
        kind,
        points: places.len(),
        exact: exact.iter().map(|e| e.source().to_string()).collect(),
        time: step.time,
        time_step: step.time_step,
        time_error,
        errors,
        differences,
        notes,
        levels,
    })
}

fn report(f: &Finished, units: UnitSystem) -> String {
    let mut t = format!(
        "\nerrors of the displacement at {} points at the time {}, against {}:\n       spacing       horizon       m   error (rms)   error (max)   to the next",
        f.points,
        units.show(f.time, Dim::TIME),
        if f.exact.is_empty() {
            "the finest level"
        } else {
            "the exact solution"
        }
    );
    let number = |x: Option<f64>| format!("{:>14}", x.map_or("-".into(), |x| rounded(x, 4)));
    for l in &f.levels {
        t += &format!(
            "\n{:>14}{:>14}{:>8.2}{}{}{}",
            units.show(l.spacing, Dim::LENGTH),
            units.show(l.horizon, Dim::LENGTH),
            l.horizon / l.spacing,
            number(l.error.map(|e| e[0])),
            number(l.error.map(|e| e[1])),
            number(l.difference)
        );
    }
    let line = |name: &str, o: &Option<Order>| {
        o.as_ref().map_or(String::new(), |o| {
            let pairs: Vec<String> = o.pairwise.iter().map(|p| format!("{p:.3}")).collect();
            format!(
                "\n{name}: order {:.3} (between levels {})",
                o.fitted,
                pairs.join(", ")
            )
        })
    };
    t += &line("errors", &f.errors);
    t += &line("differences of neighbours", &f.differences);
    t += &format!(
        "\ntime error of the finest level: {} (from a step twice as long){}",
        rounded(f.time_error, 3),
        if f.exact.is_empty() {
            "; it is common to all levels and drops out"
        } else {
            ""
        }
    );
    match f.order() {
        Some(o) => {
            t += &format!(
                "\n{}: order {:.2} in the {}; {}",
                f.kind.name(),
                o.fitted,
                if f.kind == Kind::M {
                    "spacing"
                } else {
                    "horizon"
                },
                words(o.verdict)
            );
        }
        None => t += "\nno order: some error is 0",
    }
    for note in &f.notes {
        t += &format!("\nnote: {note}");
    }
    t
}
