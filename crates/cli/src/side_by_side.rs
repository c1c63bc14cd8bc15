//! A deck and those that were made of it, run one after the other and compared at the points that both have.

use crate::failure::{Failure, say};
use peridyne::run::{Options, build};
use peridyne_io::deck::upscaled::Rewritten;
use peridyne_io::deck::{Deck, Dim};
use peridyne_io::read::{source, text_of};
use peridyne_io::write::atomic::{create_directory, write_file};
use peridyne_io::write::card::Measured;
use std::collections::HashMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Writes a deck and the files that it names.
pub fn save(dir: &Path, name: &str, deck: &Rewritten) -> Result<(), Failure> {
    let failed = |e: &dyn std::fmt::Display| Failure::Run(e.to_string());
    create_directory(dir).map_err(|e| failed(&e))?;
    for (from, to) in &deck.files {
        let bytes =
            source::bytes(from).map_err(|e| Failure::input(format!("{}: {e}", from.display())))?;
        write_file(&dir.join(to), |w| w.write_all(&bytes)).map_err(|e| failed(&e))?;
    }
    write_file(&dir.join(name), |w| w.write_all(deck.text.as_bytes())).map_err(|e| failed(&e))
}

/// The end of a run.
pub struct Ran {
    pub reference: Vec<[f64; 3]>,
    pub displacement: Vec<[f64; 3]>,
    pub spacing: f64,
    pub time: f64,
    pub seconds: f64,
    pub steps: u64,
}

/// A deck that others are compared with, each at its own end.
pub struct Reference {
    path: PathBuf,
    ran: Vec<Ran>,
}

impl Reference {
    pub fn new(path: PathBuf) -> Reference {
        Reference { path, ran: vec![] }
    }

    /// Its run that ends when that of another does, with its own or a slightly shorter step: decks end at whole steps, and not at the same time.
    pub fn until(&mut self, time: f64) -> Result<&Ran, Failure> {
        let same = |ran: &Ran| (ran.time - time).abs() <= 1e-12 * time.abs();
        let place = match self.ran.iter().position(same) {
            Some(place) => place,
            None => {
                self.ran.push(run(&self.path, Some(time))?);
                self.ran.len() - 1
            }
        };
        Ok(&self.ran[place])
    }
}

/// Runs a deck as it is written, or to the time `until` with its own or a slightly shorter step.
pub fn run(path: &Path, until: Option<f64>) -> Result<Ran, Failure> {
    let name = path.display().to_string();
    let (text, _) = text_of(path).map_err(|e| Failure::Run(e.to_string()))?;
    let deck = Deck::parse(&text, &name, &[]).map_err(|e| Failure::Input(e.into()))?;
    let mut sim = build(&deck.spec, Options::default())
        .map_err(|e| Failure::Input(deck.explain(&e).into()))?;
    let mut steps = deck.steps(sim.info().time_step);
    if let Some(until) = until
        && deck.spec.schedule.statics().is_none()
        && deck.increments() == 0
    {
        steps = (until / sim.info().time_step - 1e-6).ceil().max(1.0) as u64;
        sim.set_time_step(until / steps as f64);
    }
    say(&format!(
        "running {name}: {} points, {} bonds, {steps} steps of {}",
        sim.info().points,
        sim.info().directed_bonds,
        deck.units.show(sim.info().time_step, Dim::TIME)
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
        reference: sim.vectors("reference"),
        displacement: sim.displacements(),
        spacing: sim.info().spacing,
        time: sim.time(),
        seconds,
        steps,
    })
}

/// At the points that both have.
pub fn compare(fine: &Ran, coarse: &Ran) -> Measured {
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
        time: coarse.time,
    }
}
