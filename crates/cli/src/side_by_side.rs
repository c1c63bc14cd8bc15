//! A deck and those that were made of it, run one after the other and compared at the points that both have.

use crate::failure::{Failure, say};
use peridyne::run::{Options, Simulation, build};
use peridyne_io::deck::upscaled::Rewritten;
use peridyne_io::deck::{Deck, Dim};
use peridyne_io::read::{source, text_of};
use peridyne_io::write::atomic::{create_directory, write_file};
use peridyne_io::write::card::{Energies, Measured};
use std::collections::HashMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

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
    /// Time, kinetic energy, strain energy less that of the body at rest; so many at most as [`LOOKS`].
    energies: Vec<[f64; 3]>,
}

/// How often energies are looked at over a run, at most.
const LOOKS: u64 = 400;

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
        && deck.spec.run.schedule.statics().is_none()
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
    let failed = |e: &dyn std::fmt::Display| Failure::Run(format!("{name}: {e}"));
    let rest = at_rest(&deck).map_err(|e| failed(&e))?;
    sim.start(true);
    let mut energies = vec![];
    let mut look = |sim: &mut dyn Simulation| -> Result<(), Failure> {
        let ledger = sim.ledger().map_err(|e| failed(&e))?;
        energies.push([sim.clock(), ledger.kinetic, ledger.strain - rest]);
        Ok(())
    };
    look(sim.as_mut())?;
    let every = steps.div_ceil(LOOKS).max(1);
    let mut stepping = Duration::ZERO;
    for n in 1..=steps {
        let began = Instant::now();
        sim.step().map_err(|e| failed(&e))?;
        stepping += began.elapsed();
        if n % every == 0 || n == steps {
            look(sim.as_mut())?;
        }
    }
    Ok(Ran {
        reference: sim.vectors("reference"),
        displacement: sim.displacements(),
        spacing: sim.info().spacing,
        time: sim.time(),
        seconds: stepping.as_secs_f64(),
        steps,
        energies,
    })
}

/// Strain energy of the body where nothing has moved: atoms have some there.
fn at_rest(deck: &Deck) -> Result<f64, Box<dyn std::error::Error>> {
    if deck.spec.potential().is_none() {
        return Ok(0.0);
    }
    let mut spec = deck.spec.clone();
    spec.loading.initial.clear();
    let mut sim = build(&spec, Options::default())?;
    sim.start(false);
    Ok(sim.ledger()?.strain)
}

/// A value at `time` by the cubic through the four rows about it; rows are in the order of time.
fn between(rows: &[[f64; 3]], time: f64, value: impl Fn(&[f64; 3]) -> f64) -> f64 {
    let near = 4.min(rows.len());
    let after = rows.partition_point(|r| r[0] < time);
    let first = after.saturating_sub(2).min(rows.len() - near);
    let about = &rows[first..first + near];
    let part = |(i, row): (usize, &[f64; 3])| {
        let others = about.iter().enumerate().filter(|(j, _)| *j != i);
        let weight: f64 = others
            .map(|(_, o)| (time - o[0]) / (row[0] - o[0]))
            .product();
        weight * value(row)
    };
    about.iter().enumerate().map(part).sum()
}

/// Of both runs at the times of the coarse one; none where a load that may fall takes the place of time.
fn energies(fine: &Ran, coarse: &Ran) -> Energies {
    let rises = |rows: &[[f64; 3]]| rows.windows(2).all(|w| w[0][0] < w[1][0]);
    if !rises(&fine.energies) || !rises(&coarse.energies) {
        return Energies::default();
    }
    let sums: [fn(&[f64; 3]) -> f64; 3] = [|r| r[1], |r| r[2], |r| r[1] + r[2]];
    let rows = &coarse.energies;
    Energies {
        time: rows.iter().map(|r| r[0]).collect(),
        of: [
            sums.map(|of| {
                rows.iter()
                    .map(|r| between(&fine.energies, r[0], of))
                    .collect()
            }),
            sums.map(|of| rows.iter().map(of).collect()),
        ],
    }
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
        energies: energies(fine, coarse),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn energies_between_rows_are_those_of_a_cubic() {
        let cubic = |t: f64| 1.0 - 2.0 * t + 0.5 * t * t * t;
        let rows: Vec<[f64; 3]> = [0.0, 0.4, 1.0, 1.3, 2.0, 2.1]
            .map(|t| [t, cubic(t), 0.0])
            .to_vec();
        for t in [0.0, 0.1, 0.4, 0.7, 1.9, 2.05, 2.1] {
            let found = between(&rows, t, |r| r[1]);
            assert!((found - cubic(t)).abs() < 1e-13, "{t}: {found}");
        }
        assert_eq!(between(&rows[..1], 0.0, |r| r[1]), 1.0);
    }
}
