//! `peridyne upscale`: decks of coarse models with the same dynamics, and how far they agree.

mod crystal;

use crate::Input;
use crate::deck;
use crate::failure::{Failure, say};
use crate::run::with_threads;
use crate::side_by_side::{Reference, compare, run, save};
use peridyne::quantity::Message;
use peridyne::run::{Options, build};
use peridyne::spec::TimeStep;
use peridyne_io::deck::upscaled::{copied, upscaled};
use peridyne_io::deck::{Deck, Dim};
use peridyne_io::write::card::{self, energies_told, kernel_rows};
use peridyne_theory::upscale::kernels::kernels;
use peridyne_theory::upscale::{self, Keep, UpscaleError, card::card};
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub struct UpscaleArguments {
    /// Deck (`-`: from standard input) of atoms or fine points on a lattice; or a law and a lattice, see below.
    #[arg(conflicts_with = "potential")]
    pub file: Option<PathBuf>,
    /// Set a key of the deck, e.g. `--set run.steps=100`; may be repeated.
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = crate::pair)]
    pub set: Vec<(String, String)>,
    /// Coarse spacing in fine spacings; may be repeated, e.g. `--factor 2 --factor 4`.
    #[arg(long, default_values_t = [2])]
    pub factor: Vec<u32>,
    /// What is kept: the reach of the points (springs, solids, Lennard-Jones chains), or the number of shells of neighbours
    /// (every law). By the law if not given: the reach where it can be kept.
    #[arg(long, value_enum)]
    pub keep: Option<KeepName>,
    /// Run the deck and its coarse models, and measure errors of displacement and energies and speed-up.
    #[arg(long)]
    pub run: bool,
    /// Compare influence functions and horizons for the coarse model, each fitted to the same moduli: which is nearest to the fine one?
    #[arg(long)]
    pub kernels: bool,
    /// Folder for the results; `out/<name of the deck or law>-upscaled` if not given.
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Threads; all cores if not given.
    #[arg(long)]
    pub threads: Option<usize>,
    #[command(flatten)]
    pub crystal: crystal::CrystalArguments,
}

#[derive(Clone, Copy, clap::ValueEnum)]
pub enum KeepName {
    Reach,
    Shells,
}

pub fn upscale(arguments: &UpscaleArguments) -> Result<(), Failure> {
    let (fine, name) = match (&arguments.file, &arguments.crystal.potential) {
        (Some(file), _) => {
            let input = Input {
                file: file.clone(),
                set: arguments.set.clone(),
                var: vec![],
                simd: None,
            };
            if !deck::is_deck(&input) {
                return Err(Failure::input(
                    "upscale takes a deck (.toml): a lattice body with a law of springs, solids or atoms",
                ));
            }
            let name = Some(input.stem());
            let deck = deck::read(&input)?;
            deck::is_plain(&deck, "upscale")?;
            (deck, name)
        }
        (None, Some(law)) => {
            let (deck, found) =
                crystal::deck(&arguments.crystal, law, &arguments.set, &arguments.factor)?;
            found.iter().for_each(|line| say(line));
            (deck, Some(law.name().to_string()))
        }
        (None, None) => {
            return Err(Failure::input(
                "upscale takes a deck (.toml), or a law and a lattice: --potential LAW --lattice NAME",
            ));
        }
    };
    let name = name.unwrap_or_else(|| "deck".into());
    with_threads(arguments.threads, |_| all(arguments, &fine, &name))
}

fn all(arguments: &UpscaleArguments, fine: &Deck, name: &str) -> Result<(), Failure> {
    let out = arguments.out.clone().unwrap_or_else(|| {
        let name = format!("{name}-upscaled");
        Path::new("out").join(name)
    });
    let keep = arguments.keep.map(|k| match k {
        KeepName::Reach => Keep::Reach,
        KeepName::Shells => Keep::Shells,
    });
    // everything that can be wrong is found before anything is written
    let end = end(fine)?;
    let mut made = vec![];
    for &factor in &arguments.factor {
        let wrong = |m: String| match arguments.file {
            Some(_) => Failure::input(format!("{}, factor {factor}: {m}", fine.file())),
            None => Failure::input(format!(
                "--factor {factor}: {}",
                m.replace("body.cells", "--cells")
            )),
        };
        let refused = |e: &UpscaleError| wrong(fine.units.tell(&e.message()));
        let (spec, rule) =
            upscale::upscale_keeping(&fine.spec, factor, keep).map_err(|e| refused(&e))?;
        let mut card = card(&fine.spec, &spec, factor, rule).map_err(|e| refused(&e))?;
        if arguments.kernels {
            card.kernels = kernels(&fine.spec, &spec).map_err(|e| refused(&e))?;
        }
        let text = upscaled(fine, &spec, factor, end).map_err(wrong)?;
        card.notes.extend(text.notes.iter().map(Message::from));
        made.push((factor, text, card));
    }
    let original = copied(fine).map_err(Failure::input)?;
    save(&out, "fine.toml", &original)?;
    let mut reference = Reference::new(out.join("fine.toml"));
    for (factor, text, card) in made {
        let dir = out.join(format!("h{factor}"));
        save(&dir, "coarse.toml", &text)?;
        let mut measured = None;
        if arguments.run {
            let coarse = run(&dir.join("coarse.toml"), None)?;
            measured = Some(compare(reference.until(coarse.time)?, &coarse));
        }
        card::write(&dir, &card, fine.units, measured.as_ref())
            .map_err(|e| Failure::Run(e.to_string()))?;
        say(&format!(
            "h = {factor} a: {}\n  deck {}, card {}",
            card.rule.describe(),
            dir.join("coarse.toml").display(),
            dir.join("card.md").display()
        ));
        say(&format!("  gradient equations {}", card.verdict));
        for d in &card.dispersion {
            let words: Vec<String> = d
                .wavelengths
                .iter()
                .map(|(t, l)| match l {
                    Some(l) => {
                        let length = fine.units.show(*l, Dim::LENGTH);
                        format!("{} % below {length}", 100.0 * t)
                    }
                    None => format!("{} % nowhere", 100.0 * t),
                })
                .collect();
            say(&format!(
                "  waves along {}: error above {}",
                d.direction,
                words.join(", ")
            ));
        }
        say(&format!("  predicted cost 1 : {:.1}", card.cost));
        if !card.kernels.is_empty() {
            say(&table(&kernel_rows(&card.kernels, fine.units)));
        }
        if let Some(m) = measured {
            say(&format!(
                "  measured: {:.1} times as fast, displacement error {:.3} %",
                m.seconds[0] / m.seconds[1],
                100.0 * m.error
            ));
            say(&format!("  {}", energies_told(&m.energies)));
        }
        for note in &card.notes {
            say(&format!("  note: {}", fine.units.tell(note)));
        }
    }
    Ok(())
}

/// Headings of the table of kernels.
const KERNELS: [&str; 7] = [
    "influence",
    "horizon",
    "bonds",
    "gradient equations",
    "c₄",
    "√|c₄/c₂|",
    "1 % below",
];

/// The table of kernels in columns.
fn table(rows: &[[String; 7]]) -> String {
    let headings = KERNELS.map(String::from);
    let lines: Vec<&[String; 7]> = std::iter::once(&headings).chain(rows).collect();
    let width = |c: usize| { lines.iter() }.map(|l| l[c].chars().count()).max();
    let widths: [usize; 7] = std::array::from_fn(|c| width(c).unwrap_or(0));
    let line = |cells: &&[String; 7]| {
        let each = cells.iter().zip(widths);
        let each: Vec<String> = each.map(|(cell, w)| format!("{cell:<w$}")).collect();
        format!("    {}", each.join("  ").trim_end())
    };
    let text: Vec<String> = lines.iter().map(line).collect();
    format!(
        "  kernels of the coarse model, the best first\n{}",
        text.join("\n")
    )
}

/// When a deck ends that counts steps which the program finds: those of the coarse model are others, and it is to end then, too.
fn end(deck: &Deck) -> Result<Option<f64>, Failure> {
    let schedule = &deck.spec.run.schedule;
    let found = match schedule.time_step {
        TimeStep::Auto | TimeStep::Fraction(_) => true,
        TimeStep::Fixed(_) => false,
    };
    if !found || deck.duration.is_some() || schedule.statics().is_some() {
        return Ok(None);
    }
    let model = build(&deck.spec, Options::default())
        .map_err(|e| Failure::Input(deck.explain(&e).into()))?;
    Ok(Some(schedule.steps as f64 * model.info().time_step))
}
