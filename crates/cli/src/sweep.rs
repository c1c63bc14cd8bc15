//! `peridyne sweep`: one deck with many values of its keys, one table of what came out.

mod design;
mod table;

use crate::Input;
use crate::deck::{no_variables, text};
use crate::failure::{Failure, note, say};
use crate::run::with_threads;
use crate::runs::{Run, Stopped};
use crate::signals;
use design::{Design, Setting, settings, vary};
use peridyne::observe::Ledger;
use peridyne_io::deck::Deck;
use peridyne_io::drive::Progress;
use peridyne_io::write::WriteError;
use peridyne_io::write::atomic::{create_directory, write_file};
use peridyne_io::write::checkpoint::Checkpoint;
use serde_json::{Value, json};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

#[derive(clap::Args)]
pub struct SweepArguments {
    #[command(flatten)]
    pub input: Input,
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
    /// Folder for the table and the results; `out/<name of the deck>-sweep` if not given. A study that was ended goes on there.
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Runs at the same time, each on its share of the threads.
    #[arg(long, default_value_t = 1)]
    pub jobs: usize,
    /// Threads in all; all cores if not given.
    #[arg(long)]
    pub threads: Option<usize>,
}

/// What a run of the study has come to.
struct Row {
    setting: Setting,
    dir: PathBuf,
    /// `done`, `ended`, `stopped` or `refused`.
    status: String,
    why: Option<String>,
    record: Option<Value>,
}

/// Nobody listens but signals.
struct Quiet;

impl Progress for Quiet {
    fn step(&mut self, _: u64, _: u64, _: Duration) {}
    fn row(&mut self, _: u64, _: f64, _: &Ledger, _: u64) {}
    fn warning(&mut self, _: &str) {}
    fn ended(&mut self) -> Option<String> {
        signals::received().map(|s| s.to_string())
    }
}

pub fn sweep(arguments: &SweepArguments) -> Result<(), Failure> {
    let input = &arguments.input;
    no_variables(input)?;
    if arguments.jobs == 0 {
        return Err(Failure::input("--jobs 0: at least one run goes on"));
    }
    if input.simd.is_some() {
        return Err(Failure::input("--simd belongs to run and check"));
    }
    let text = text(input)?;
    let settings = settings(
        &arguments.vary,
        arguments.design,
        (arguments.samples, arguments.seed),
    )?;
    // every mistake before the first run
    let decks = settings.iter().map(|setting| read(input, &text, setting));
    let decks = decks.collect::<Result<Vec<_>, Failure>>()?;
    let name = input.file.file_stem().unwrap_or_default().to_string_lossy();
    let own = || PathBuf::from("out").join(format!("{name}-sweep"));
    let dir = arguments.out.clone().unwrap_or_else(own);
    claim(&dir, &text, &settings, input)?;
    let width = settings.len().to_string().len();
    let folder = |n: usize| dir.join(format!("{:0width$}", n + 1));
    say(&format!(
        "{} runs of {}, results in {}",
        settings.len(),
        input.file.display(),
        dir.display()
    ));
    let begun = Instant::now();
    let threads = arguments.threads;
    let work = |n: usize| {
        let row = one(arguments, &decks[n], &settings[n], folder(n));
        say(&told(&row, n, settings.len()));
        row
    };
    let rows = side_by_side(settings.len(), arguments.jobs, threads, &work)?;
    let saved = table::save(&dir, &arguments.vary, &rows);
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

/// The deck with the values of a run.
fn read(input: &Input, text: &str, setting: &Setting) -> Result<Deck, Failure> {
    let set = overrides(input, setting);
    let deck = Deck::parse(text, &input.file.to_string_lossy(), &set);
    let deck = deck.map_err(|e| Failure::Input(e.into()))?;
    // each has a folder of its own
    deck.stays_inside(true)
        .map_err(|e| Failure::Input(e.into()))?;
    Ok(deck)
}

fn overrides(input: &Input, setting: &Setting) -> Vec<(String, String)> {
    input.set.iter().chain(setting).cloned().collect()
}

/// The folder is new, or has the same study.
fn claim(dir: &Path, text: &str, settings: &[Setting], input: &Input) -> Result<(), Failure> {
    let runs: Vec<Value> = { settings.iter() }
        .map(|setting| setting.iter().cloned().collect())
        .collect();
    let study = json!({ "deck": input.file, "text": text, "set": input.set, "runs": runs });
    let path = dir.join("sweep.json");
    if let Ok(before) = std::fs::read(&path) {
        let before: Option<Value> = serde_json::from_slice(&before).ok();
        if before.as_ref() != Some(&study) {
            return Err(Failure::input(format!(
                "{}: this folder has another study, of another deck or with other values; give --out another folder, or take this one away",
                dir.display()
            )));
        }
        return Ok(());
    }
    let failed = |e: WriteError| Failure::Run(e.to_string());
    create_directory(dir).map_err(failed)?;
    let text = format!("{study:#}\n");
    write_file(&path, |file| file.write_all(text.as_bytes())).map_err(failed)
}

/// `work` for each of so many, some at a time, each on its share of the threads.
fn side_by_side<T: Send>(
    count: usize,
    jobs: usize,
    threads: Option<usize>,
    work: &(dyn Fn(usize) -> T + Sync),
) -> Result<Vec<T>, Failure> {
    let jobs = jobs.min(count);
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let each = (threads.unwrap_or(cores) / jobs).max(1);
    let next = std::sync::atomic::AtomicUsize::new(0);
    let (next, order) = (&next, std::sync::atomic::Ordering::Relaxed);
    let done = std::thread::scope(|scope| {
        let worker = || {
            let mut mine = vec![];
            let all = with_threads(Some(each), |_| {
                while signals::received().is_none() {
                    let n = next.fetch_add(1, order);
                    if n >= count {
                        break;
                    }
                    mine.push((n, work(n)));
                }
                Ok(())
            });
            all.map(|()| mine)
        };
        let workers: Vec<_> = (0..jobs).map(|_| scope.spawn(worker)).collect();
        let ends = workers.into_iter().map(|w| w.join());
        ends.map(|end| end.unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
            .collect::<Result<Vec<_>, Failure>>()
    })?;
    let mut done: Vec<(usize, T)> = done.into_iter().flatten().collect();
    done.sort_by_key(|(n, _)| *n);
    Ok(done.into_iter().map(|(_, row)| row).collect())
}

fn record(dir: &Path) -> Option<Value> {
    let text = std::fs::read(dir.join("run.json")).ok()?;
    serde_json::from_slice(&text).ok()
}

/// One run: what it was, if it is done; else from where it was ended, or from the beginning.
fn one(arguments: &SweepArguments, deck: &Deck, setting: &Setting, dir: PathBuf) -> Row {
    let row = |status: &str, why: Option<String>| Row {
        setting: setting.clone(),
        record: record(&dir),
        dir: dir.clone(),
        status: status.into(),
        why: why.map(|why| why.replace('\n', "; ")),
    };
    let is = |status: &str| record(&dir).is_some_and(|r| r["status"] == status);
    if is("done") {
        return row("done", None);
    }
    let from = match is("ended") && Checkpoint::any(&dir) {
        true => Checkpoint::newest(&dir).ok(),
        false => None,
    };
    let set = overrides(&arguments.input, setting);
    let words = set
        .iter()
        .map(|(key, value)| format!(" --set '{key}={value}'"));
    let run = Run {
        deck,
        set: &set,
        command: format!(
            "peridyne run {}{}",
            arguments.input.file.display(),
            words.collect::<String>()
        ),
        dir: dir.clone(),
        allow_outside: false,
    };
    match run.done(from, &mut Quiet) {
        Ok(report) => match report.ended_by {
            None => row("done", None),
            Some(why) => row("ended", Some(why)),
        },
        Err(Stopped::Run(error)) => row("stopped", Some(error.to_string())),
        Err(Stopped::Deck(failure)) => row("refused", Some(failure.words())),
    }
}

/// A line of the terminal.
fn told(row: &Row, n: usize, count: usize) -> String {
    let values = row.setting.iter().map(|(key, value)| {
        let key = key.rsplit('.').next().unwrap_or(key);
        format!("{key} = {value}")
    });
    let values = values.collect::<Vec<_>>().join(", ");
    let why = row.why.as_ref().map_or(String::new(), |w| format!(": {w}"));
    format!("{:>3} of {count}  {values}: {}{why}", n + 1, row.status)
}
