//! Studies: runs of one deck with values of their own for some keys, each in a folder of its own. What was done is not done again.

use crate::Input;
use crate::deck::{command, no_variables, text};
use crate::failure::Failure;
use crate::run::with_threads;
use crate::runs::{Run, Stopped};
use crate::signals;
use peridyne::observe::Ledger;
use peridyne_io::deck::Deck;
use peridyne_io::drive::Progress;
use peridyne_io::write::WriteError;
use peridyne_io::write::atomic::{create_directory, write_file};
use peridyne_io::write::checkpoint::Checkpoint;
use peridyne_io::write::history::Column;
use serde_json::{Value, json};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Duration;

#[derive(clap::Args)]
pub struct StudyArguments {
    #[command(flatten)]
    pub input: Input,
    /// Folder for the table and the results; `out/<name of the deck>-sweep`, `-calibrate` or `-delta` (`-m`, `-delta-m`) if not given. A study that was ended goes on there.
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Runs at the same time, each on its share of the threads.
    #[arg(long, default_value_t = 1)]
    pub jobs: usize,
    /// Threads in all; all cores if not given.
    #[arg(long)]
    pub threads: Option<usize>,
}

/// Keys with their values in one run.
pub type Setting = Vec<(String, String)>;

/// What a run of the study has come to.
pub struct Row {
    pub setting: Setting,
    pub dir: PathBuf,
    /// `done`, `ended`, `stopped` or `refused`.
    pub status: String,
    pub why: Option<String>,
    pub record: Option<Value>,
}

impl Row {
    /// Its values in short.
    pub fn told(&self) -> String {
        let values = self.setting.iter().map(|(key, value)| {
            let key = key.rsplit('.').next().unwrap_or(key);
            format!("{key} = {}", value.trim_matches('"'))
        });
        values.collect::<Vec<_>>().join(", ")
    }
}

/// Nobody listens but signals.
pub struct Quiet;

impl Progress for Quiet {
    fn step(&mut self, _: u64, _: u64, _: Duration) {}
    fn row(&mut self, _: u64, _: f64, _: &Ledger, _: u64) {}
    fn warning(&mut self, _: &str) {}
    fn ended(&mut self) -> Option<String> {
        signals::received().map(|s| s.to_string())
    }
}

/// A deck and where its runs go.
pub struct Study<'a> {
    pub arguments: &'a StudyArguments,
    text: String,
    pub dir: PathBuf,
    /// What makes its runs where `peridyne run` does not.
    made_by: Option<String>,
}

impl<'a> Study<'a> {
    /// Reads the deck; `verb` names the folder.
    pub fn of(arguments: &'a StudyArguments, verb: &str) -> Result<Study<'a>, Failure> {
        let input = &arguments.input;
        no_variables(input)?;
        if arguments.jobs == 0 {
            return Err(Failure::input("--jobs 0: at least one run goes on"));
        }
        if input.simd.is_some() {
            return Err(Failure::input("--simd belongs to run and check"));
        }
        let name = input.stem();
        let own = || PathBuf::from("out").join(format!("{name}-{verb}"));
        Ok(Study {
            arguments,
            text: text(input)?,
            dir: arguments.out.clone().unwrap_or_else(own),
            made_by: None,
        })
    }

    /// Its decks are changed beyond their keys, by this verb.
    pub fn made_by(&mut self, verb: &str, flags: &str) {
        let run = self.command_of(&self.arguments.input.set);
        let words = run.trim_start_matches("peridyne run");
        self.made_by = Some(format!("peridyne {verb}{words} {flags}"));
    }

    /// The deck with the values of a run.
    pub fn deck(&self, setting: &Setting) -> Result<Deck, Failure> {
        let name = self.arguments.input.name();
        let deck = Deck::parse(&self.text, &name, &self.overrides(setting));
        let deck = deck.map_err(|e| Failure::Input(e.into()))?;
        // each has a folder of its own
        deck.stays_inside(true)
            .map_err(|e| Failure::Input(e.into()))?;
        Ok(deck)
    }

    fn overrides(&self, setting: &Setting) -> Vec<(String, String)> {
        let given = self.arguments.input.set.iter();
        given.chain(setting).cloned().collect()
    }

    /// The command that makes a run by itself.
    pub fn command(&self, setting: &Setting) -> String {
        self.command_of(&self.overrides(setting))
    }

    fn command_of(&self, set: &[(String, String)]) -> String {
        command(&Input {
            set: set.to_vec(),
            ..self.arguments.input.clone()
        })
    }

    /// The folder is new, or has the same study: of the same deck, and with the same `own` in `file`.
    pub fn claim(&self, file: &str, (name, own): (&str, Value)) -> Result<(), Failure> {
        let input = &self.arguments.input;
        let study = json!({ "deck": input.file, "text": self.text, "set": input.set, name: own });
        let path = self.dir.join(file);
        if let Ok(before) = std::fs::read(&path) {
            let before: Option<Value> = serde_json::from_slice(&before).ok();
            if before.as_ref() != Some(&study) {
                return Err(Failure::input(format!(
                    "{}: this folder has another study, of another deck or with other values; give --out another folder, or take this one away",
                    self.dir.display()
                )));
            }
            return Ok(());
        }
        let failed = |e: WriteError| Failure::Run(e.to_string());
        create_directory(&self.dir).map_err(failed)?;
        let text = format!("{study:#}\n");
        write_file(&path, |file| file.write_all(text.as_bytes())).map_err(failed)
    }

    /// A run of its own, before anything of it is done.
    fn run<'b>(&self, deck: &'b Deck, set: &'b [(String, String)], dir: &Path) -> Run<'b> {
        Run {
            deck,
            set,
            command: { self.made_by.clone() }.unwrap_or_else(|| self.command_of(set)),
            dir: dir.to_path_buf(),
            allow_outside: false,
        }
    }

    /// Columns of the `history.csv` of such a run.
    pub fn columns(&self, deck: &Deck, setting: &Setting) -> Result<Vec<Column>, Failure> {
        let set = self.overrides(setting);
        let mut columns = vec![];
        with_threads(self.arguments.threads, |_| {
            columns = self.run(deck, &set, &self.dir.join("run")).columns()?;
            Ok(())
        })?;
        Ok(columns)
    }

    /// One run: what it was, if it is done; else from where it was ended, or from the beginning.
    pub fn one(&self, deck: &Deck, setting: &Setting, dir: PathBuf) -> Row {
        self.watched(deck, setting, dir, &mut Quiet)
    }

    /// The same, with somebody who listens.
    pub fn watched(
        &self,
        deck: &Deck,
        setting: &Setting,
        dir: PathBuf,
        progress: &mut dyn Progress,
    ) -> Row {
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
        let set = self.overrides(setting);
        match self.run(deck, &set, &dir).done(from, progress) {
            Ok(report) => match report.ended_by {
                None => row("done", None),
                Some(why) => row("ended", Some(why)),
            },
            Err(Stopped::Run(error)) => row("stopped", Some(error.to_string())),
            Err(Stopped::Deck(failure)) => row("refused", Some(failure.words())),
        }
    }

    /// `work` for each of so many, some at a time, each on its share of the threads.
    pub fn side_by_side<T: Send>(
        &self,
        count: usize,
        work: &(dyn Fn(usize) -> T + Sync),
    ) -> Result<Vec<T>, Failure> {
        let jobs = self.arguments.jobs.min(count);
        let threads = self.arguments.threads;
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
}

fn record(dir: &Path) -> Option<Value> {
    let text = std::fs::read(dir.join("run.json")).ok()?;
    serde_json::from_slice(&text).ok()
}
