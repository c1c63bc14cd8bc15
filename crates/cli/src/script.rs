//! `peridyne run` for LAMMPS scripts: LAMMPS's own output, and ours at the end.

use crate::Input;
use crate::deck;
use crate::early::{Early, asked};
use crate::failure::{Failure, note, say};
use crate::signals;
use indicatif::{ProgressBar, ProgressStyle};
use peridyne::observe::observables::USUAL;
use peridyne::run::Simulation;
use peridyne::state::Archive;
use peridyne_comm::Comm;
use peridyne_io::deck::{Dim, UnitSystem, counted, each_once};
use peridyne_io::drive::default_dir;
use peridyne_io::write::atomic::{create_directory, write_file};
use peridyne_io::write::checkpoint::{Asked, Checkpoint, CheckpointSchedule, Checkpoints};
use peridyne_io::write::fields::SIZE;
use peridyne_io::write::folder::{FILES, Folder};
use peridyne_io::write::history::{Column, History};
use peridyne_io::write::picture::PictureOptions;
use peridyne_io::write::picture::shown::About;
use peridyne_io::write::report;
use peridyne_io::write::run_json::{
    self, EnergyReport, FieldNote, RunReport, Setting, Spent, Status, UnitNames,
};
use peridyne_io::write::{Series, SeriesOptions, WriteError};
use peridyne_lammps::host::{Console, Engine, Host, HostError, Setup, Wish};
use peridyne_lammps::model::{ModelEngine, ModelHost, Prepared, Sharing};
use peridyne_lammps::{Options, Outcome, Record, go_on_text, run_text};
use std::cell::RefCell;
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;
use std::time::Instant;

/// The model of a script as it stands at its first `run`, which does not take place. Nothing is written.
pub fn prepare(input: &Input) -> Result<(Prepared, Setup), Failure> {
    let text = deck::text(input)?;
    let name = input.file.display().to_string();
    let options = Options {
        dry: true,
        ..options(input, Path::new(""))?
    };
    let mut host = Inspector {
        host: ModelHost {
            simd: deck::simd(input)?,
            ranks: None,
        },
        found: None,
    };
    let result = run_text(&name, &text, &options, &mut host, &mut Quiet);
    match (host.found, result) {
        (Some(found), _) => {
            for note in &found.0.notes {
                Quiet.note(note);
            }
            Ok(found)
        }
        (None, Err(e)) => Err(Failure::Input((*e).into())),
        (None, Ok(_)) => Err(Failure::input(format!(
            "{name}: the script has no `run`: there is nothing to check"
        ))),
    }
}

/// Builds the model and lets nobody run it.
struct Inspector {
    host: ModelHost,
    found: Option<(Prepared, Setup)>,
}

impl Host for Inspector {
    fn build(&mut self, setup: Setup) -> Result<Box<dyn Engine>, HostError> {
        self.found = self.host.prepare(&setup)?.map(|prepared| (prepared, setup));
        Err(HostError::new("checked"))
    }
}

/// Notes only.
struct Quiet;

impl Console for Quiet {
    fn print(&mut self, _: &str) {}
    fn note(&mut self, line: &str) {
        note(&format!("note: {line}"));
    }
}

fn options(input: &Input, output: &Path) -> Result<Options, Failure> {
    if let Some((key, _)) = input.set.first() {
        return Err(Failure::input(format!(
            "--set {key}: a LAMMPS script has no keys; its index variables are set with --var name=value"
        )));
    }
    let variable = |(name, value): &(String, String)| {
        let values = value.split_whitespace().map(str::to_string);
        (name.clone(), values.collect())
    };
    Ok(Options {
        variables: input.var.iter().map(variable).collect(),
        output: output.to_path_buf(),
        ..Options::default()
    })
}

/// What a script is run with, and where.
pub struct Place<'a> {
    input: &'a Input,
    /// Of the results.
    dir: PathBuf,
    /// Do files that the script names go there, too?
    pub shared: bool,
    allow_outside: bool,
    early: &'a Early,
}

impl<'a> Place<'a> {
    pub fn new(
        input: &'a Input,
        out: Option<&Path>,
        allow_outside: bool,
        early: &'a Early,
    ) -> Place<'a> {
        Place {
            input,
            dir: out.map_or_else(|| folder(&input.file), Path::to_path_buf),
            shared: out.is_some(),
            allow_outside,
            early,
        }
    }
}

/// Runs a script that ranks share, or lets it go on from a state: the first one does, the others read it up to its first `run` and follow the model.
pub fn run_among(
    place: &Place<'_>,
    (comm, threads): (&Arc<Comm>, usize),
    from: Option<(Asked, Checkpoint)>,
) -> Result<(), Failure> {
    if comm.ranks() == 1 {
        return run(place, (None, threads), from);
    }
    let sharing = Sharing::new(comm);
    let ended = match comm.rank() {
        0 => {
            note(&format!("{} ranks: {}", comm.ranks(), comm.carrier()));
            run(place, (Some((&sharing, comm.ranks())), threads), from)
        }
        _ => follow(place.input, from.as_ref().map(|(asked, _)| asked), &sharing),
    };
    match sharing.leave(ended.is_ok()) {
        // there was no run to follow
        Some(true) => ended.or_else(|e| match e {
            Failure::Elsewhere => Ok(()),
            other => Err(other),
        }),
        Some(false) | None => ended,
    }
}

/// Follows the model of a script.
fn follow(input: &Input, asked: Option<&Asked>, sharing: &Sharing) -> Result<(), Failure> {
    // what is wrong the first rank says
    let elsewhere = |_| Failure::Elsewhere;
    let text = deck::text(input).map_err(elsewhere)?;
    let name = name(input, asked);
    let options = Options {
        dry: true,
        ..options(input, Path::new("")).map_err(elsewhere)?
    };
    let mut host = Follower {
        host: ModelHost {
            simd: deck::simd(input).map_err(elsewhere)?,
            ranks: Some(sharing.clone()),
        },
        followed: false,
    };
    // it comes no further than to its first run
    let _ = run_text(&name, &text, &options, &mut host, &mut Silent);
    match host.followed {
        true => Ok(()),
        false => Err(Failure::Elsewhere),
    }
}

/// Has nobody who runs a model, but follows the first rank's.
struct Follower {
    host: ModelHost,
    followed: bool,
}

impl Host for Follower {
    fn build(&mut self, setup: Setup) -> Result<Box<dyn Engine>, HostError> {
        self.followed = self.host.prepare(&setup)?.is_none();
        Err(HostError::new("followed"))
    }
}

/// Says nothing.
struct Silent;

impl Console for Silent {
    fn print(&mut self, _: &str) {}
    fn note(&mut self, _: &str) {}
}

/// Run a script, or let it go on from a state. Files that it names go to the folder of its results where that was given, or to the
/// current folder as with LAMMPS; the report, the picture and the last state go to `out/<name of the script>` then.
fn run(
    place: &Place<'_>,
    (sharing, threads): (Option<(&Sharing, usize)>, usize),
    from: Option<(Asked, Checkpoint)>,
) -> Result<(), Failure> {
    let (input, results) = (place.input, place.dir.clone());
    let (allow_outside, out) = (place.allow_outside, place.shared.then_some(&*results));
    let text = deck::text(input)?;
    let name = name(input, from.as_ref().map(|(asked, _)| asked));
    let command = match &from {
        Some((asked, _)) => asked.command.clone(),
        None => deck::command(input),
    };
    // in the current folder there are files of others
    let made = (out.is_none() && !allow_outside).then(|| Made::of(&results));
    let options = Options {
        allow_outside,
        shared: out.is_some(),
        made: made.as_ref().map(|m| m.files.clone()),
        ..options(input, out.unwrap_or(Path::new("")))?
    };
    let mut host = Holder {
        host: ModelHost {
            simd: deck::simd(input)?,
            ranks: sharing.map(|(sharing, _)| sharing.clone()),
        },
        dir: results.clone(),
        held: None,
        goes_on: from.is_some(),
        states: Rc::default(),
    };
    if out.is_some() {
        host.claim();
    }
    let mut console = Terminal {
        bar: None,
        place,
        begun: Instant::now(),
        records: [&command, &name, &text].map(String::clone),
        states: host.states.clone(),
        kept: false,
        ended_by: None,
    };
    let result = match (&host.held, from) {
        (Some(Err(e)), _) => return Err(Failure::Run(e.to_string())),
        (_, None) => run_text(&name, &text, &options, &mut host, &mut console),
        (_, Some((_, mut from))) => {
            for why in &from.passed_over {
                console.note(&format!(
                    "{why}; the script goes on from the state before it"
                ));
            }
            go_on_text(&name, &text, &options, &mut host, &mut console, &mut from)
        }
    };
    console.end();
    if let Some(Err(e)) = host.held {
        return Err(Failure::Run(e.to_string()));
    }
    if let Some(made) = made {
        made.save(&results)?;
    }
    let outcome = result.map_err(|e| {
        if e.while_running {
            Failure::Run(match &e.help {
                Some(help) => format!("{e}\n{help}"),
                None => e.to_string(),
            })
        } else {
            Failure::Input((*e).into())
        }
    })?;
    let (ended, signal) = (outcome.ended, signals::received());
    let signal = signal.filter(|_| ended && console.ended_by.is_none());
    let ended_by = console.ended_by.take().or(signal.map(|s| s.to_string()));
    let told = Summary {
        name: &name,
        text: &text,
        command,
        ranks: sharing.map_or(1, |(_, ranks)| ranks),
        threads,
        ended_by: ended_by.filter(|_| ended),
    };
    told.finish(outcome, &results)?;
    if let Some(states) = host.states.take() {
        let closed = if ended { states.ended() } else { states.done() };
        closed.map_err(|e| Failure::Run(e.to_string()))?;
    }
    if ended && console.kept {
        say(&format!("go on:    peridyne resume {}", results.display()));
    }
    signal.map_or(Ok(()), |s| Err(Failure::Ended(s)))
}

/// What the script is called in its records: as it was when it began, where that is still it.
fn name(input: &Input, asked: Option<&Asked>) -> String {
    let began = asked.map(|asked| &asked.name);
    let same = |name: &&String| {
        Path::new(name)
            .canonicalize()
            .is_ok_and(|p| p == input.file)
    };
    let now = || input.file.display().to_string();
    began.filter(same).cloned().unwrap_or_else(now)
}

/// Files that a script has made outside the folder of its results, which it may replace when it runs again: whole paths, in
/// the [list](FILES) of that folder.
struct Made {
    files: Rc<RefCell<Vec<PathBuf>>>,
    before: usize,
}

impl Made {
    fn of(results: &Path) -> Made {
        // a list of our own, which is replaced
        let list = results.join(FILES);
        let list = list
            .is_file()
            .then(|| std::fs::read_to_string(list).ok())
            .flatten();
        let files: Vec<PathBuf> = list
            .and_then(|text| serde_json::from_str(&text).ok())
            .unwrap_or_default();
        Made {
            before: files.len(),
            files: Rc::new(RefCell::new(files)),
        }
    }

    /// Also of a script that failed: what it began is its own.
    fn save(&self, results: &Path) -> Result<(), Failure> {
        let files = self.files.borrow();
        if files.len() == self.before {
            return Ok(());
        }
        let failed = |e: &dyn std::fmt::Display| Failure::Run(e.to_string());
        let text = serde_json::to_string_pretty(&*files).map_err(|e| failed(&e))?;
        create_directory(results).map_err(|e| failed(&e))?;
        let list = results.join(FILES);
        write_file(&list, |w| writeln!(w, "{text}")).map_err(|e| failed(&e))
    }
}

/// Holds the folder of the results from the first `run` on (a script that is wrong before makes no folder).
struct Holder {
    host: ModelHost,
    dir: PathBuf,
    held: Option<Result<Folder, WriteError>>,
    goes_on: bool,
    /// States, once the folder is held.
    states: Rc<RefCell<Option<Checkpoints>>>,
}

impl Holder {
    fn claim(&mut self) {
        if self.held.is_none() {
            let held = Folder::claim(&self.dir).and_then(|held| {
                let schedule = Some(CheckpointSchedule::default());
                let states = Checkpoints::new(&self.dir, schedule, self.goes_on)?;
                self.states.replace(Some(states));
                Ok(held)
            });
            self.held = Some(held);
        }
    }
}

impl Host for Holder {
    fn build(&mut self, setup: Setup) -> Result<Box<dyn Engine>, HostError> {
        let engine = self.host.build(setup)?;
        self.claim();
        match &self.held {
            Some(Err(e)) => Err(HostError::new(e.to_string())),
            _ => Ok(engine),
        }
    }
}

/// What a script was, for the files that tell of it.
struct Summary<'a> {
    name: &'a str,
    text: &'a str,
    command: String,
    ranks: usize,
    threads: usize,
    /// Who ended it early.
    ended_by: Option<String>,
}

impl Summary<'_> {
    /// `run.json`, `report.html`, history, last state and picture of a script that ran.
    fn finish(&self, mut outcome: Outcome, dir: &Path) -> Result<(), Failure> {
        let engine = outcome.engine.as_mut().map(|e| e.as_any());
        let Some(model) = engine.and_then(|e| e.downcast_mut::<ModelEngine>()) else {
            say("the script has no `run`: nothing was computed");
            return Ok(());
        };
        let begun = Instant::now();
        let units = model.units();
        let (length_unit, time_unit) = units.labels();
        let mut setting = self.setting(model, &outcome.record, dir);
        let sim = model.simulation();
        setting.dimension = sim.info().dimension;
        setting.spacing = sim.info().spacing;
        let series_options = SeriesOptions {
            pictures: vec![PictureOptions {
                title: info_title(self.name),
                length_unit: length_unit.into(),
                time_unit: time_unit.into(),
                ..PictureOptions::default()
            }],
            units: units.system(),
            ..SeriesOptions::default()
        };
        let seconds = outcome.seconds_stepping;
        let mut report = self.report(sim, units.system(), outcome.steps, seconds);
        if self.ended_by.is_some() {
            report.status = Status::Ended;
            report.ended_by.clone_from(&self.ended_by);
        }
        let snapshot = sim.snapshot(&[&USUAL[..], &[SIZE]].concat(), false);
        let shown = snapshot.columns.iter().filter(|c| c.name() != SIZE);
        let notes = shown.map(|c| FieldNote {
            name: c.name().to_string(),
            unit: units.system().unit(c.declaration.dimension),
            says: c.declaration.doc.to_string(),
        });
        setting.fields = notes.collect();
        let bodies = std::mem::take(&mut outcome.record.rigid);
        // files and picture are made of the snapshot: room for them
        outcome.engine = None;
        let failed = |e: WriteError| Failure::Run(e.to_string());
        let mut series = Series::new(dir, series_options).map_err(failed)?;
        series.write(&snapshot, &bodies).map_err(failed)?;
        let mut spent = Spent {
            frames: begun.elapsed().as_secs_f64(),
            ..Spent::default()
        };
        let drawing = Instant::now();
        let pictures = series
            .finish(&snapshot, &bodies, About::Fracture)
            .map_err(failed)?;
        spent.pictures = drawing.elapsed().as_secs_f64();
        report.pictures = { pictures.iter() }
            .filter_map(|p| Some(p.file_name()?.to_string_lossy().into_owned()))
            .collect();
        if write_history(&outcome.record, time_unit, dir).map_err(failed)? {
            setting.files.insert(0, "history.csv".into());
        }
        setting.files.extend(report.pictures.clone());
        report.setting = Some(setting);
        report.peak_memory_bytes = run_json::peak_memory_bytes();
        spent.all = seconds + begun.elapsed().as_secs_f64();
        report.seconds = spent.clone();
        report.write(&dir.join("run.json")).map_err(failed)?;
        report::of_run(dir, report.ended_by.is_some())
            .map_err(|e| Failure::Run(format!("report.html: {e}")))?;
        let all = seconds + begun.elapsed().as_secs_f64();
        spent.report = all - spent.all;
        spent.all = all;
        say(&format!(
            "{}: {} in {:.2} s{}, {} broken, {}\n{}\nresults in {}",
            report.outcome(),
            counted(report.steps, "step"),
            report.seconds_stepping,
            report.ns_per_bond_step.map_or(String::new(), |ns| format!(
                ", {ns:.2} ns per bond and step"
            )),
            counted(report.broken_bonds, "bond"),
            counted(report.fragments.unwrap_or(0), "fragment"),
            spent.told(seconds),
            dir.display(),
        ));
        for path in pictures {
            say(&format!("picture: {}", path.display()));
        }
        say(&crate::report::told(dir));
        say(&crate::report::state(report.hash));
        Ok(())
    }

    /// What the report tells besides.
    fn setting(&self, model: &ModelEngine, record: &Record, dir: &Path) -> Setting {
        let (length, time) = model.units().labels();
        let inside = |path: &PathBuf| match path.strip_prefix(dir) {
            Ok(name) => name.display().to_string(),
            Err(_) => {
                let whole = path.canonicalize().unwrap_or_else(|_| path.clone());
                whole.display().to_string()
            }
        };
        let dumps: Vec<String> = record.dumps.iter().map(inside).collect();
        // fixes say what acts, and the report has the title
        let own = |l: &&str| *l != self.name && !l.starts_with("acting ");
        let understood = model.understood().lines().filter(own);
        let understood = understood.map(|l| format!("{l}\n"));
        let columns = { record.fields.iter() }.map(|(h, f)| (h.clone(), f.to_string()));
        Setting {
            command: self.command.clone(),
            deck_text: self.text.to_string(),
            understood: understood.collect(),
            sources: model.sources().to_vec(),
            units: UnitNames {
                length: length.into(),
                time: time.into(),
                energy: model.units().system().unit(Dim::ENERGY),
            },
            rigid_bodies: record.notes.clone(),
            columns: columns.collect(),
            files: ["points.pvd".to_string()]
                .into_iter()
                .chain(dumps.clone())
                .collect(),
            dumps,
            ..Setting::default()
        }
    }

    fn report(
        &self,
        sim: &mut dyn Simulation,
        units: UnitSystem,
        steps: u64,
        seconds: f64,
    ) -> RunReport {
        let warnings = sim.info().warnings.iter();
        let mut warnings: Vec<String> = warnings.map(|w| units.tell(w)).collect();
        let ledger = sim.ledger().unwrap_or_else(|e| {
            warnings.push(units.tell(&e.message()));
            Default::default()
        });
        let (broken, fragments, hash) = (sim.broken(), sim.fragments(), sim.state_hash());
        let info = sim.info();
        RunReport {
            version: env!("CARGO_PKG_VERSION").to_string(),
            deck: self.name.to_string(),
            deck_hash: run_json::deck_hash(self.text.as_bytes()),
            title: info_title(self.name),
            status: Status::Done,
            ended_by: None,
            particles: info.points,
            bonds: each_once(info.directed_bonds),
            steps,
            time_step: info.time_step,
            parts_of_a_step: info.parts,
            seconds_stepping: seconds,
            seconds: Spent::default(),
            ns_per_bond_step: run_json::ns_per_bond_step(seconds, info.directed_bonds, steps),
            peak_memory_bytes: run_json::peak_memory_bytes(),
            broken_bonds: each_once(broken),
            fragments: Some(fragments),
            hash,
            ranks: self.ranks,
            threads: self.threads,
            simd: info.simd.to_string(),
            energy: EnergyReport::from(&ledger),
            pictures: vec![],
            warnings,
            setting: None,
        }
    }
}

/// Lines of thermo output as `history.csv`; false where there was none.
fn write_history(record: &Record, time_unit: &str, dir: &Path) -> Result<bool, WriteError> {
    if record.rows.is_empty() {
        return Ok(false);
    }
    // the step and the time stand there anyway
    let own: Vec<usize> = { 0..record.columns.len() }
        .filter(|c| !["Step", "Time"].contains(&&*record.columns[*c]))
        .collect();
    let named = own.iter().map(|c| Column::new(&record.columns[*c], ""));
    let columns: Vec<Column> = [Column::new("time", time_unit)]
        .into_iter()
        .chain(named)
        .collect();
    let mut history = History::create(&dir.join("history.csv"), &columns)?;
    for row in &record.rows {
        let mut values = vec![row.time];
        values.extend(own.iter().map(|c| row.values[*c]));
        history.push(row.step, &values)?;
    }
    history.finish()?;
    Ok(true)
}

/// `decks/in.impact_disk` is called `impact_disk`.
fn info_title(name: &str) -> String {
    let path = Path::new(name);
    let file = path
        .file_name()
        .map_or_else(|| name.to_string(), |f| f.to_string_lossy().into_owned());
    match file.strip_prefix("in.") {
        Some(rest) if !rest.is_empty() => rest.to_string(),
        _ => path
            .file_stem()
            .map_or(file.clone(), |s| s.to_string_lossy().into_owned()),
    }
}

fn folder(script: &Path) -> PathBuf {
    default_dir(Path::new(&info_title(&script.to_string_lossy())))
}

/// LAMMPS's lines on standard output, a bar or notes on standard error.
struct Terminal<'a> {
    bar: Option<ProgressBar>,
    place: &'a Place<'a>,
    begun: Instant,
    /// Command, name and text of the script.
    records: [String; 3],
    states: Rc<RefCell<Option<Checkpoints>>>,
    /// Is there a state of this part?
    kept: bool,
    /// What ended it that is no signal.
    ended_by: Option<String>,
}

impl Terminal<'_> {
    fn end(&mut self) {
        if let Some(bar) = self.bar.take() {
            bar.finish_and_clear();
        }
    }
}

impl Console for Terminal<'_> {
    fn print(&mut self, line: &str) {
        match &self.bar {
            Some(bar) => bar.suspend(|| say(line)),
            None => say(line),
        }
    }

    fn note(&mut self, line: &str) {
        let line = format!("note: {line}");
        match &self.bar {
            Some(bar) => bar.suspend(|| note(&line)),
            None => note(&line),
        }
    }

    fn ended(&mut self) -> bool {
        signals::received().is_some()
    }

    fn wish(&mut self, steps: u64) -> Wish {
        self.ended_by = self.place.early.reached(steps, self.begun);
        let due = { self.states.borrow() }
            .as_ref()
            .is_some_and(Checkpoints::is_due);
        match (&self.ended_by, due || signals::asked_for_checkpoint()) {
            (Some(_), _) => Wish::End,
            (None, true) => Wish::State,
            (None, false) => Wish::Nothing,
        }
    }

    fn keep(&mut self, steps: u64, pass: &mut dyn FnMut(&mut Archive<'_>)) {
        let mut asked = Asked {
            set: self.place.input.var.clone(),
            step: steps,
            ..asked(self.place.input, self.records.clone())
        };
        let mut shared = self.place.shared;
        let written = { self.states.borrow_mut() }.as_mut().map(|states| {
            states.write(&mut asked, |archive| {
                archive.one("shared", &mut shared);
                pass(archive);
            })
        });
        match written {
            Some(Err(error)) => self.note(&format!(
                "step {steps}: no state to go on from was written: {error}"
            )),
            Some(Ok(())) => self.kept = true,
            None => {}
        }
    }

    fn progress(&mut self, done: u64, of: u64) {
        if done == of {
            self.end();
        } else if let Some(bar) = &self.bar {
            bar.set_position(done);
        } else if std::io::stderr().is_terminal() {
            let bar = ProgressBar::new(of);
            let style = "{bar:30.cyan} {pos}/{len} steps  {per_sec}  {eta} left";
            bar.set_style(
                ProgressStyle::with_template(style)
                    .unwrap_or_else(|_| ProgressStyle::default_bar()),
            );
            bar.set_position(done);
            self.bar = Some(bar);
        }
    }
}
