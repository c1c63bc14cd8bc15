//! Reads a script line by line and runs it.

use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use super::error::{Problem, Result, ScriptError};
use super::files::Folder;
use super::host::{Console, Engine, Host};
use super::input;
use super::record::Record;
use super::session::{Session, Store};
use super::text::{Text, logical_lines, words};
use peridyne_io::write::checkpoint::Checkpoint;

/// How a script is run.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// `--var name=value`: index variables that the script cannot redefine.
    pub variables: Vec<(String, Vec<String>)>,
    /// Folder of output files (`dump`, `write_data`, `print file`); the current one if empty.
    pub output: PathBuf,
    /// Files may be written anywhere, not only there and beside the script.
    pub allow_outside: bool,
    /// Nothing is written at all: the script is only checked.
    pub dry: bool,
    /// Are results of the program's own in the folder, too? Their names are then not the script's.
    pub shared: bool,
    /// Files that earlier runs of the script have made, and then this one: no other that is there is replaced. `None`: any is.
    pub made: Option<Rc<RefCell<Vec<PathBuf>>>>,
}

/// What a script left behind.
pub struct Outcome {
    /// The model, if there was a `run`.
    pub engine: Option<Box<dyn Engine>>,
    pub steps: u64,
    pub time_step: f64,
    /// Simulated time.
    pub time: f64,
    /// Wall seconds in the time loops.
    pub seconds_stepping: f64,
    /// Did [`Console::ended`] end it?
    pub ended: bool,
    /// What it printed and wrote.
    pub record: Record,
}

/// A script file that is being read.
pub struct Source {
    pub path: String,
    pub text: Rc<str>,
    lines: Rc<[Text]>,
    pub next: usize,
}

impl Source {
    pub fn new(path: &str, text: &str) -> Source {
        Source {
            path: path.to_string(),
            text: text.into(),
            lines: logical_lines(text).into(),
            next: 0,
        }
    }
}

/// A running script.
pub struct Script<'a> {
    pub session: Session<'a>,
    pub open: Vec<Source>,
    /// Set by `next` on an exhausted variable: the next `jump` is passed over.
    pub skip_jump: bool,
    /// Commands inside commands.
    pub depth: usize,
    /// A `run` to this step that was left and goes on, and whether it reports.
    pub within: Option<(u64, bool)>,
}

/// Runs the script in the file `path`.
///
/// # Errors
/// File, line and place of the first mistake.
pub fn run_file(
    path: &Path,
    options: &Options,
    host: &mut dyn Host,
    console: &mut dyn Console,
) -> std::result::Result<Outcome, Box<ScriptError>> {
    let shown = path.display().to_string();
    let text =
        input::text(path, &shown).map_err(|p| ScriptError::locate(*p, &shown, "", (0, 0)))?;
    run_text(&shown, &text, options, host, console)
}

/// Runs a script given as text; `name` is the file name for messages.
///
/// # Errors
/// As for [`run_file`].
pub fn run_text(
    name: &str,
    text: &str,
    options: &Options,
    host: &mut dyn Host,
    console: &mut dyn Console,
) -> std::result::Result<Outcome, Box<ScriptError>> {
    start(name, text, options, (host, console), None)
}

/// The same of a script that goes on from a state of it, of which nothing was read but how it was asked for.
///
/// # Errors
/// As for [`run_file`]; the state is of another script, or files are not as they were.
pub fn go_on_text(
    name: &str,
    text: &str,
    options: &Options,
    host: &mut dyn Host,
    console: &mut dyn Console,
    from: &mut Checkpoint,
) -> std::result::Result<Outcome, Box<ScriptError>> {
    start(name, text, options, (host, console), Some(from))
}

fn start<'a>(
    name: &str,
    text: &str,
    options: &Options,
    (host, console): (&'a mut dyn Host, &'a mut dyn Console),
    from: Option<&'a mut Checkpoint>,
) -> std::result::Result<Outcome, Box<ScriptError>> {
    let folder = Folder {
        output: options.output.clone(),
        script: Path::new(name)
            .parent()
            .map(Path::to_path_buf)
            .unwrap_or_default(),
        outside: options.allow_outside,
        // what is repeated is not written again
        dry: options.dry || from.is_some(),
        shared: options.shared,
        made: options.made.clone(),
        open: Rc::default(),
        closed: Rc::default(),
    };
    let mut session = Session::new(host, console, folder, name.to_string());
    session.console.quiet = from.is_some();
    session.from = from;
    let mut script = Script {
        session,
        open: Vec::new(),
        skip_jump: false,
        depth: 0,
        within: None,
    };
    for (variable, values) in &options.variables {
        script
            .session
            .define(variable, values)
            .map_err(|p| ScriptError::locate(*p, name, text, (0, 0)))?;
    }
    script.push(name, text);
    let done = script.run_open();
    let s = script.session;
    let ended = s.ended;
    if !ended {
        done?;
    }
    let (steps, time_step, time) = (
        s.progress.steps_done,
        s.progress.time_step,
        s.progress.time(),
    );
    let seconds_stepping = s.progress.stepping_seconds;
    let engine = match s.population.store {
        Store::Engine(e) => Some(e),
        Store::Atoms(_) => None,
    };
    Ok(Outcome {
        engine,
        steps,
        time_step,
        time,
        seconds_stepping,
        ended,
        record: s.watch.record,
    })
}

impl Script<'_> {
    fn push(&mut self, path: &str, text: &str) {
        self.open.push(Source::new(path, text));
    }

    fn run_open(&mut self) -> std::result::Result<(), Box<ScriptError>> {
        while let Some(source) = self.open.last_mut() {
            let (path, text) = (source.path.clone(), source.text.clone());
            let Some(line) = source.lines.get(source.next).cloned() else {
                self.open.pop();
                continue;
            };
            source.next += 1;
            self.session.here = (path.clone(), text.clone(), line.whole());
            let mut done = self.line(&line);
            if std::mem::take(&mut self.session.went_on) {
                done = self.finish_run();
            }
            done.and_then(|()| self.look_for_wish(None))
                .map_err(|p| ScriptError::locate(*p, &path, &text, line.whole()))?;
        }
        match self.session.from {
            // of another script
            Some(_) => Err(ScriptError::locate(
                *Problem::new("the script has no `run` to go on with"),
                "",
                "",
                (0, 0),
            )),
            None => Ok(()),
        }
    }

    /// Ends the script.
    pub fn stop(&mut self) {
        self.open.clear();
    }

    /// Reads another file next.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn include(&mut self, name: &str) -> Result<()> {
        if self.open.len() >= 20 {
            return Err(Problem::new(
                "scripts include each other in more than 20 levels",
            ));
        }
        let path = self.session.input_path(name);
        let text = input::text(&path, &path.display().to_string())?;
        self.push(&path.display().to_string(), &text);
        Ok(())
    }

    /// Goes on at a label of this (`SELF`) or another file.
    ///
    /// # Errors
    /// No such file or label.
    pub fn jump(&mut self, file: &str, label: Option<&str>) -> Result<()> {
        if file != "SELF" {
            self.include(file)?;
            let target = self.open.pop();
            self.open.pop();
            self.open.extend(target);
        }
        let Some(source) = self.open.last_mut() else {
            return Ok(());
        };
        let Some(label) = label else {
            source.next = 0;
            return Ok(());
        };
        let found = source.lines.iter().position(|line| {
            words(line)
                .is_ok_and(|w| w.len() >= 2 && w[0].as_str() == "label" && w[1].as_str() == label)
        });
        source.next = found.ok_or_else(|| {
            Problem::new(format!("there is no label `{label}` in {}", source.path))
                .help(format!("write `label {label}`"))
        })?;
        Ok(())
    }
}
