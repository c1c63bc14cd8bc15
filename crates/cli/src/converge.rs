//! `peridyne converge`: one deck, several finer bodies, the order with which the error falls.

mod around;
mod files;
mod level;

use crate::Input;
use crate::deck;
use crate::failure::{Failure, say};
use crate::run::with_threads;
use level::{Level, Reference, measure};
use peridyne::expression::Expression;
use peridyne_io::deck::{Deck, Dim, UnitSystem, rounded};
use peridyne_theory::convergence::{Kind, Order, Verdict, order};
use peridyne_theory::refine::refine;
use std::path::{Path, PathBuf};

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Study {
    /// Horizon and spacing shrink together, m = δ/Δx stays.
    Delta,
    /// The spacing shrinks, the horizon δ stays.
    M,
    /// The horizon shrinks, the spacing faster: m grows by √2 per level.
    DeltaM,
}

#[derive(clap::Args)]
pub struct ConvergeArguments {
    /// Deck of solids on a lattice: the coarsest level.
    #[command(flatten)]
    pub input: Input,
    /// Which lengths shrink.
    #[arg(long, value_enum)]
    study: Study,
    /// Levels, each with half the spacing of the one before.
    #[arg(long, default_value_t = 4)]
    pub levels: u32,
    /// Exact displacement along x, y, z at the end, an expression of x, y, z, t and `pi`; once per component, `0` for none.
    /// Without it, levels are compared with the finest.
    #[arg(long, value_name = "EXPRESSION")]
    pub exact: Vec<String>,
    /// All levels take the deck's step on the finest level (its fraction of the stability limit there) over this number.
    #[arg(long, default_value_t = 4)]
    pub substeps: u32,
    /// Folder for the results; `out/<name of the deck>-<study>` if not given.
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Threads; all cores if not given.
    #[arg(long)]
    pub threads: Option<usize>,
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
        Verdict::Converges => "errors fall with one order",
        Verdict::Preasymptotic => {
            "errors fall, the order has not settled: more levels, or a finer first one, would tell"
        }
        Verdict::Stalls => {
            "errors stop falling: another error remains (the model's distance from the exact solution, the time step, round-off)"
        }
        Verdict::Diverges => "errors do not fall",
        Verdict::Undecided => {
            "one pair of levels has an order and no verdict: more levels tell whether it is settled"
        }
    }
}

pub fn converge(arguments: &ConvergeArguments) -> Result<(), Failure> {
    if !deck::is_deck(&arguments.input) {
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
    let deck = deck::read(&arguments.input)?;
    deck::is_plain(&deck, "converge")?;
    let exact = expressions(&arguments.exact, deck.spec.space.dimension)?;
    let threads = arguments.threads.or(deck.threads);
    with_threads(threads, |_| all(arguments, &deck, &exact))
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

fn all(arguments: &ConvergeArguments, deck: &Deck, exact: &[Expression]) -> Result<(), Failure> {
    let kind = match arguments.study {
        Study::Delta => Kind::Delta,
        Study::M => Kind::M,
        Study::DeltaM => Kind::DeltaM,
    };
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
    let step = level::common_step(&decks, &arguments.input, arguments.substeps)?;
    say(&format!(
        "{}: {} levels to the time {}, all with the step {}",
        kind.name(),
        arguments.levels,
        deck.units.show(step.time, Dim::TIME),
        deck.units.show(step.time_step, Dim::TIME)
    ));
    let mut levels = vec![];
    for finer in &decks {
        let level = Level::run(finer, &arguments.input, &step, 1)?;
        say(&format!(
            "  spacing {}, horizon {}: {} points, volume {}, {} steps in {:.2} s",
            deck.units.show(level.spacing, Dim::LENGTH),
            deck.units.show(level.horizon, Dim::LENGTH),
            level.points,
            deck.units.show(level.volume, Dim::VOLUME),
            level.steps,
            level.seconds
        ));
        levels.push(level);
    }
    let finest = decks.last().ok_or_else(|| Failure::input("no levels"))?;
    let coarser_step = Level::run(finest, &arguments.input, &step, 2)?;
    let finished = finish(kind, levels, &coarser_step, exact, &step)
        .map_err(|m| Failure::input(format!("{}: {m}", deck.file())))?;
    let out = arguments.out.clone().unwrap_or_else(|| {
        let name = arguments.input.file.file_stem();
        let name = name.map_or("deck".into(), |n| n.to_string_lossy());
        let study = ["delta", "m", "delta-m"][kind as usize];
        Path::new("out").join(format!("{name}-{study}"))
    });
    files::write(&out, &finished, deck.units).map_err(|e| Failure::Run(e.to_string()))?;
    say(&report(&finished, deck.units));
    say(&format!("written: {}", out.display()));
    Ok(())
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
            "The levels draw together with order {:.2}, towards another solution than the exact one: at fixed δ the nonlocal one, at fixed m that of the lattice's own stiffness (`peridyne waves` tells it).",
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
