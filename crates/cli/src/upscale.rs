//! `peridyne upscale`: decks of coarse models with the same dynamics, and how far they agree.

use crate::Input;
use crate::deck;
use crate::failure::{Failure, say};
use crate::run::with_threads;
use peridyne::run::{Options, build};
use peridyne_io::deck::upscaled::{Rewritten, copied, upscaled};
use peridyne_io::deck::{Deck, UnitSystem};
use peridyne_io::write::atomic::{create_directory, write_file};
use peridyne_io::write::card::{self, Measured};
use peridyne_theory::upscale::{self, card::card};
use std::collections::HashMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

#[derive(clap::Args)]
pub struct UpscaleArguments {
    /// Deck of atoms or fine points on a lattice.
    #[command(flatten)]
    pub input: Input,
    /// Coarse spacing in fine spacings; may be repeated, e.g. `--factor 2 --factor 4`.
    #[arg(long, default_values_t = [2])]
    pub factor: Vec<u32>,
    /// Run the deck and its coarse models, and measure error and speed-up.
    #[arg(long)]
    pub run: bool,
    /// Folder for the results; `out/<name of the deck>-upscaled` if not given.
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Threads; all cores if not given.
    #[arg(long)]
    pub threads: Option<usize>,
}

pub fn upscale(arguments: &UpscaleArguments) -> Result<(), Failure> {
    if !deck::is_deck(&arguments.input) {
        return Err(Failure::input(
            "upscale takes a deck (.toml): a lattice body with a law of springs, solids or atoms",
        ));
    }
    let fine = deck::read(&arguments.input)?;
    with_threads(arguments.threads, |_| all(arguments, &fine))
}

fn all(arguments: &UpscaleArguments, fine: &Deck) -> Result<(), Failure> {
    let out = arguments.out.clone().unwrap_or_else(|| {
        let name = arguments.input.file.file_stem();
        let name = name.map_or("deck".into(), |n| n.to_string_lossy());
        Path::new("out").join(format!("{name}-upscaled"))
    });
    // everything that can be wrong is found before anything is written
    let mut made = vec![];
    for &factor in &arguments.factor {
        let wrong = |m: String| Failure::input(format!("{}, factor {factor}: {m}", fine.file()));
        let (spec, rule) =
            upscale::upscale(&fine.spec, factor).map_err(|e| wrong(e.to_string()))?;
        let mut card = card(&fine.spec, &spec, factor, rule).map_err(|e| wrong(e.to_string()))?;
        let text = upscaled(fine, &spec, factor).map_err(wrong)?;
        card.notes.extend(text.notes.iter().cloned());
        made.push((factor, text, card));
    }
    let original = copied(fine).map_err(Failure::input)?;
    save(&out, "fine.toml", &original)?;
    let mut reference = None;
    for (factor, text, card) in made {
        let dir = out.join(format!("h{factor}"));
        save(&dir, "coarse.toml", &text)?;
        let mut measured = None;
        if arguments.run {
            if reference.is_none() {
                reference = Some(run(&out.join("fine.toml"), None)?);
            }
            let until = reference.as_ref().map(|fine| fine.time);
            let coarse = run(&dir.join("coarse.toml"), until)?;
            measured = reference.as_ref().map(|fine| compare(fine, &coarse));
        }
        let length = match fine.units {
            UnitSystem::Si => "m",
            UnitSystem::Metal => "Å",
            UnitSystem::Lj | UnitSystem::None => "",
        };
        card::write(&dir, &card, length, measured.as_ref())
            .map_err(|e| Failure::Run(e.to_string()))?;
        say(&format!(
            "h = {factor} a: {}\n  deck {}, card {}",
            card.rule.describe(),
            dir.join("coarse.toml").display(),
            dir.join("card.md").display()
        ));
        for d in &card.dispersion {
            let words: Vec<String> = d
                .wavelengths
                .iter()
                .map(|(t, l)| match l {
                    Some(l) => format!("{} % below {:.4e}", 100.0 * t, l),
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
        if let Some(m) = measured {
            say(&format!(
                "  measured: {:.1} times as fast, displacement error {:.3} %",
                m.seconds[0] / m.seconds[1],
                100.0 * m.error
            ));
        }
        for note in &card.notes {
            say(&format!("  note: {note}"));
        }
    }
    Ok(())
}

fn save(dir: &Path, name: &str, deck: &Rewritten) -> Result<(), Failure> {
    let failed = |e: &dyn std::fmt::Display| Failure::Run(e.to_string());
    create_directory(dir).map_err(|e| failed(&e))?;
    for (from, to) in &deck.files {
        let bytes =
            std::fs::read(from).map_err(|e| Failure::input(format!("{}: {e}", from.display())))?;
        write_file(&dir.join(to), |w| w.write_all(&bytes)).map_err(|e| failed(&e))?;
    }
    write_file(&dir.join(name), |w| w.write_all(deck.text.as_bytes())).map_err(|e| failed(&e))
}

/// The end of a run.
struct Ran {
    reference: Vec<[f64; 3]>,
    displacement: Vec<[f64; 3]>,
    spacing: f64,
    time: f64,
    seconds: f64,
    steps: u64,
}

/// Runs a deck to its end, or to the time `until` with its own or a slightly shorter step.
fn run(path: &Path, until: Option<f64>) -> Result<Ran, Failure> {
    let name = path.display().to_string();
    let text = std::fs::read_to_string(path).map_err(|e| Failure::Run(format!("{name}: {e}")))?;
    let deck = Deck::parse(&text, &name, &[]).map_err(|e| Failure::Input(e.into()))?;
    let mut sim = build(&deck.spec, Options::default())
        .map_err(|e| Failure::Input(deck.explain(&e).into()))?;
    let mut steps = deck.steps(sim.info().time_step);
    if let Some(until) = until.or(deck.duration) {
        steps = (until / sim.info().time_step - 1e-6).ceil().max(1.0) as u64;
        sim.set_time_step(until / steps as f64);
    }
    say(&format!(
        "running {name}: {} points, {} bonds, {steps} steps of {:.4e}",
        sim.info().points,
        sim.info().directed_bonds,
        sim.info().time_step
    ));
    sim.start(true);
    let began = Instant::now();
    for n in 0..steps {
        sim.step()
            .map_err(|e| Failure::Run(format!("{name}: {e}")))?;
        if n % 256 == 0 {
            sim.ledger()
                .map_err(|e| Failure::Run(format!("{name}: {e}")))?;
        }
    }
    let seconds = began.elapsed().as_secs_f64();
    sim.ledger()
        .map_err(|e| Failure::Run(format!("{name}: {e}")))?;
    Ok(Ran {
        reference: sim.reference(),
        displacement: sim.displacements(),
        spacing: sim.info().spacing,
        time: sim.time(),
        seconds,
        steps,
    })
}

/// At the points that both have.
fn compare(fine: &Ran, coarse: &Ran) -> Measured {
    let key = |x: &[f64; 3]| x.map(|c| (c / (0.1 * fine.spacing)).round() as i64);
    let places: HashMap<[i64; 3], usize> = fine
        .reference
        .iter()
        .enumerate()
        .map(|(i, x)| (key(x), i))
        .collect();
    let (mut difference, mut size, mut largest, mut points) = (0.0, 0.0, 0.0f64, 0);
    for (x, u) in coarse.reference.iter().zip(&coarse.displacement) {
        if let Some(&i) = places.get(&key(x)) {
            let v = &fine.displacement[i];
            let square: f64 = v.iter().map(|c| c * c).sum();
            difference += u.iter().zip(v).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
            size += square;
            largest = largest.max(square.sqrt());
            points += 1;
        }
    }
    Measured {
        error: (difference / size).sqrt(),
        largest,
        points,
        seconds: [fine.seconds, coarse.seconds],
        steps: [fine.steps, coarse.steps],
    }
}
