//! One level of a study: its run, and its displacements at given places.

use super::around::Around;
use crate::Input;
use crate::deck;
use crate::failure::Failure;
use peridyne::error::RunError;
use peridyne::expression::Expression;
use peridyne_io::deck::{Deck, Dim};
use peridyne_theory::convergence::Kind;
use rayon::prelude::*;
use std::collections::HashMap;
use std::time::Instant;

/// Steps between looks at the energy balance.
const WATCH: u64 = 256;

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

impl Level {
    /// Runs to the final time, on which whole steps land, of about `stretch` times the common step.
    pub fn run(deck: &Deck, input: &Input, step: &Step, stretch: u32) -> Result<Level, Failure> {
        let mut trusting = deck.clone();
        // the common step is set below
        trusting.spec.run.schedule.force_unstable = true;
        let mut sim = deck::model(&trusting, input)?;
        let failed = |e: RunError| {
            Failure::Run(format!(
                "spacing {}: {}",
                deck.units
                    .show(deck.spec.body.spacing().unwrap_or(0.0), Dim::LENGTH),
                deck.units.tell(&e.message())
            ))
        };
        let steps = (step.time / (step.time_step * f64::from(stretch)) - 1e-6).ceil();
        sim.set_time_step(step.time / steps);
        let steps = steps as u64;
        sim.start(true);
        let began = Instant::now();
        for n in 0..steps {
            sim.step().map_err(failed)?;
            if n % WATCH == 0 {
                sim.ledger().map_err(failed)?;
            }
        }
        sim.ledger().map_err(failed)?;
        let info = sim.info();
        Ok(Level {
            spacing: info.spacing,
            horizon: info.horizon,
            points: info.points,
            volume: info.volume,
            steps,
            seconds: began.elapsed().as_secs_f64(),
            reference: sim.vectors("reference"),
            displacement: sim.displacements(),
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
                    "around the point {x:?} of the coarsest level too few points of the level with spacing {} lie to tell its displacement: the body is too thin there",
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
