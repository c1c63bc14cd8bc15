//! `peridyne sweep`: one deck with many values of its keys, one table of what came out.

pub mod design;
mod table;

use crate::failure::{Failure, note, say};
use crate::signals;
use crate::study::{Row, Study, StudyArguments};
use design::{Design, settings, vary};
use peridyne_io::deck::Deck;
use serde_json::Value;
use std::time::Instant;

#[derive(clap::Args)]
pub struct SweepArguments {
    #[command(flatten)]
    pub study: StudyArguments,
    /// A key and its values, e.g. `--vary horizon.m_ratio=2,3,4`, or their ends, e.g. `--vary 'material.law.pmb.young=60 GPa:80 GPa'`; may be repeated.
    #[arg(long, value_name = "KEY=VALUES", required = true, value_parser = vary)]
    pub vary: Vec<(String, design::Values)>,
    /// How values of several keys meet: each with each, the first ones and so on, or a Latin hypercube between ends.
    #[arg(long, value_enum, default_value = "grid")]
    pub design: Design,
    /// Runs of a Latin hypercube.
    #[arg(long, default_value_t = 12)]
    pub samples: usize,
    /// Of a Latin hypercube: the same seed, the same runs.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
}

pub fn sweep(arguments: &SweepArguments) -> Result<(), Failure> {
    let study = Study::of(&arguments.study, "sweep")?;
    let settings = settings(
        &arguments.vary,
        arguments.design,
        (arguments.samples, arguments.seed),
    )?;
    // every mistake before the first run
    let decks = settings.iter().map(|setting| study.deck(setting));
    let decks = decks.collect::<Result<Vec<Deck>, Failure>>()?;
    let runs: Vec<Value> = { settings.iter() }
        .map(|setting| setting.iter().cloned().collect())
        .collect();
    study.claim("sweep.json", ("runs", runs.into()))?;
    let width = settings.len().to_string().len();
    let folder = |n: usize| study.dir.join(format!("{:0width$}", n + 1));
    say(&format!(
        "{} runs of {}, results in {}",
        settings.len(),
        study.arguments.input.name(),
        study.dir.display()
    ));
    let begun = Instant::now();
    let work = |n: usize| {
        let row = study.one(&decks[n], &settings[n], folder(n));
        say(&told(&row, n, settings.len()));
        row
    };
    let rows = study.side_by_side(settings.len(), &work)?;
    let saved = table::save(&study.dir, &arguments.vary, &rows);
    let files = saved.map_err(|e| Failure::Run(e.to_string()))?;
    for file in files {
        say(&format!("wrote     {}", file.display()));
    }
    let left = rows.iter().filter(|r| r.status != "done").count();
    let took = crate::numbers::duration(begun.elapsed().as_secs_f64());
    match (signals::received(), left) {
        (Some(signal), _) => {
            note("ended: the same command goes on");
            Err(Failure::Ended(signal))
        }
        (None, 0) => {
            say(&format!("done in {took}"));
            Ok(())
        }
        (None, left) => Err(Failure::Run(format!(
            "{left} of {} runs did not come to their end; the table says why",
            rows.len()
        ))),
    }
}

/// A line of the terminal.
fn told(row: &Row, n: usize, count: usize) -> String {
    let values = row.told();
    let why = row.why.as_ref().map_or(String::new(), |w| format!(": {w}"));
    format!("{:>3} of {count}  {values}: {}{why}", n + 1, row.status)
}
