//! One level of a study: its run, and its displacements at given places.

use super::around::Around;
use crate::Input;
use crate::deck;
use crate::failure::Failure;
use crate::study::{Quiet, Row};
use peridyne::expression::Expression;
use peridyne::observe::Ledger;
use peridyne::run::Simulation;
use peridyne::spec::TimeStep;
use peridyne_io::deck::Deck;
use peridyne_io::drive::Progress;
use peridyne_io::read::npz::read_npz;
use peridyne_io::write::WriteError;
use peridyne_io::write::npz::write_npz;
use peridyne_theory::convergence::Kind;
use rayon::prelude::*;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Reference positions and displacements of a level at the end, in its folder.
const FILE: &str = "displacement.npz";
const ARRAYS: [&str; 3] = ["reference", "displacement", "spacing_horizon_volume"];

/// The end of all runs, and the step of all levels.
pub struct Step {
    pub time: f64,
    pub time_step: f64,
}

/// What a level was, and what it came to.
pub struct Level {
    pub spacing: f64,
    pub horizon: f64,
    pub points: u64,
    /// Of the body (length^D times the section).
    pub volume: f64,
    pub steps: u64,
    pub seconds: f64,
    pub reference: Vec<[f64; 3]>,
    displacement: Vec<[f64; 3]>,
    /// Relative root mean square and largest error against the reference.
    pub error: Option<[f64; 2]>,
    /// Relative root mean square difference to the next level.
    pub difference: Option<f64>,
}

/// The deck's final time, and a step for all: its fraction of the stability limit on the most demanding level, over
/// `substeps`. One step for all has one time error for all: it drops out of differences between levels, and is small and
/// told beside errors against an exact solution.
///
/// # Errors
/// A level that cannot be built.
pub fn common_step(decks: &[Deck], input: &Input, substeps: u32) -> Result<Step, Failure> {
    let mut found: Option<(f64, f64)> = None;
    let mut stable = f64::INFINITY;
    for (k, deck) in decks.iter().enumerate() {
        let mut trusting = deck.clone();
        // a fixed step is for the first level, which tells if it is too long
        trusting.spec.run.schedule.force_unstable |= k > 0;
        let sim = deck::model(&trusting, input)?;
        let info = sim.info();
        stable = stable.min(info.stable_step);
        if found.is_none() {
            let time = deck
                .duration
                .unwrap_or(deck.spec.run.schedule.steps as f64 * info.time_step);
            found = Some((time, info.time_step / info.stable_step));
        }
    }
    let (time, fraction) = found.ok_or_else(|| Failure::input("no levels"))?;
    if !(time > 0.0 && time.is_finite()) {
        return Err(Failure::input(
            "the deck runs for no time: give run.duration or run.steps",
        ));
    }
    let longest = fraction.min(1.0) * stable / f64::from(substeps);
    let steps = (time / longest - 1e-6).ceil().max(2.0);
    Ok(Step {
        time,
        time_step: time / steps,
    })
}

impl Step {
    /// The deck with steps of about `stretch` times this one, whole ones up to the final time, and no other output than history and states.
    pub fn of(&self, deck: &Deck, stretch: u32) -> Deck {
        let mut deck = deck.clone();
        let steps = (self.time / (self.time_step * f64::from(stretch)) - 1e-6).ceil();
        let schedule = &mut deck.spec.run.schedule;
        schedule.steps = steps as u64;
        schedule.time_step = TimeStep::Fixed(self.time / steps);
        // it is a fraction of the deck's own on the finest level
        schedule.force_unstable = true;
        deck.duration = None;
        deck.fields.clear();
        deck.output.quiet();
        deck
    }
}

/// Keeps the end of a run in its folder.
pub struct Keep {
    path: PathBuf,
    steps: u64,
    /// Why it could not.
    pub failed: Option<WriteError>,
}

impl Keep {
    /// Of a deck that [`Step::of`] made.
    pub fn of(deck: &Deck, dir: &Path) -> Keep {
        Keep {
            path: dir.join(FILE),
            steps: deck.spec.run.schedule.steps,
            failed: None,
        }
    }
}

impl Progress for Keep {
    fn step(&mut self, _: u64, _: u64, _: Duration) {}
    fn row(&mut self, _: u64, _: f64, _: &Ledger, _: u64) {}
    fn warning(&mut self, _: &str) {}
    fn ended(&mut self) -> Option<String> {
        Quiet.ended()
    }
    fn look(&mut self, sim: &mut dyn Simulation, step: u64) {
        if step < self.steps {
            return;
        }
        let info = sim.info();
        let lengths = [info.spacing, info.horizon, info.volume];
        let (reference, displacement) = (sim.vectors("reference"), sim.displacements());
        let shape = || vec![reference.len(), 3];
        let arrays = [
            (ARRAYS[0], reference.as_flattened(), shape()),
            (ARRAYS[1], displacement.as_flattened(), shape()),
            (ARRAYS[2], &lengths[..], vec![3]),
        ];
        self.failed = write_npz(&self.path, &arrays).err();
    }
}

impl Level {
    /// Of a run that is done.
    pub fn of(row: &Row) -> Result<Level, Failure> {
        let path = row.dir.join(FILE);
        let wrong = |why: String| {
            let path = path.display();
            Failure::Run(format!(
                "{path}: {why}. Take its folder away: the same command makes it again"
            ))
        };
        let [reference, displacement, lengths] = read_npz(&path, ARRAYS).map_err(wrong)?;
        let [reference, displacement] = [reference, displacement].map(|x| x.as_chunks().0.to_vec());
        let (&[spacing, horizon, volume], true) =
            (&lengths[..], reference.len() == displacement.len())
        else {
            return Err(wrong("its arrays have other lengths".into()));
        };
        let number = |key: &str| row.record.as_ref().and_then(|r| r[key].as_f64());
        Ok(Level {
            spacing,
            horizon,
            volume,
            points: reference.len() as u64,
            steps: number("steps").unwrap_or(f64::NAN) as u64,
            seconds: number("seconds_stepping").unwrap_or(f64::NAN),
            reference,
            displacement,
            error: None,
            difference: None,
        })
    }

    /// The length in whose powers errors fall.
    pub fn length(&self, kind: Kind) -> f64 {
        match kind {
            Kind::M => self.spacing,
            Kind::Delta | Kind::DeltaM => self.horizon,
        }
    }

    /// Displacements at points of a coarser level: those of the point there, or of a polynomial through the points around.
    pub fn at(&self, places: &[[f64; 3]]) -> Result<Vec<[f64; 3]>, String> {
        let near = |c: f64| (c / (0.1 * self.spacing)).round() as i64;
        let own: HashMap<[i64; 3], usize> = { self.reference.iter().enumerate() }
            .map(|(i, x)| (x.map(near), i))
            .collect();
        let around = Around::new(&self.reference, self.spacing);
        let each = places.par_iter().map(|x| match own.get(&x.map(near)) {
            Some(&i) => Ok(self.displacement[i]),
            None => around.fitted(x, &self.displacement).ok_or_else(|| {
                format!(
                    "around the point {x:?} of the coarsest level there are too few points of the level with spacing {} for its displacement: the body is too thin there",
                    self.spacing
                )
            }),
        });
        each.collect()
    }
}

/// What displacements are compared with.
pub enum Reference<'a> {
    Values(&'a [[f64; 3]]),
    /// One expression per component; those left out are not compared. At this time.
    Exact(&'a [Expression], f64),
}

/// Root mean square and largest difference, both relative to the same of the reference.
///
/// # Errors
/// The reference does not move, or is no number somewhere.
pub fn measure(
    places: &[[f64; 3]],
    values: &[[f64; 3]],
    reference: &Reference,
) -> Result<[f64; 2], String> {
    let (mut square, mut size, mut worst, mut largest) = (0.0, 0.0, 0.0f64, 0.0f64);
    for (i, (x, u)) in places.iter().zip(values).enumerate() {
        for a in 0..3 {
            let v = match reference {
                Reference::Values(v) => v[i][a],
                Reference::Exact(e, t) => match e.get(a) {
                    Some(e) => e.eval(x, *t),
                    None => continue,
                },
            };
            if !v.is_finite() {
                return Err(format!("the exact solution has no value at {x:?}"));
            }
            square += (u[a] - v) * (u[a] - v);
            size += v * v;
            worst = worst.max((u[a] - v).abs());
            largest = largest.max(v.abs());
        }
    }
    if size == 0.0 {
        return Err(
            "nothing is displaced at the end: an error relative to nothing has no value; check initial values, loads and duration"
                .into(),
        );
    }
    Ok([(square / size).sqrt(), worst / largest])
}
