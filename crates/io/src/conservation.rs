//! Runs a conservation law: frames and history at their times, pictures and a report at the end.

use crate::deck::Dim;
use crate::deck::conservation::LawDeck;
use crate::write::WriteError;
use crate::write::checkpoint::{Asked, Checkpoint, CheckpointSchedule, Checkpoints, ResumeError};
use crate::write::conservation::{Compared, Frames, Report, write_pictures};
use crate::write::folder::Folder;
use crate::write::history::{Column, History};
use crate::write::report::{self, ReportError};
use crate::write::run_json::{FieldNote, Setting, Status, UnitNames, deck_hash, peak_memory_bytes};
use peridyne::observe::StateHash;
use peridyne::quantity::rounded;
use peridyne::state::{Archive, Owner};
use peridyne_transport::{Evaluation, Evolution, Method, RunError, StepSize, measure};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Why a run did not end well.
#[derive(Debug, thiserror::Error)]
pub enum LawError {
    #[error(transparent)]
    Write(#[from] WriteError),
    #[error(transparent)]
    Resume(#[from] ResumeError),
    #[error("report.html: {0}")]
    Report(#[from] ReportError),
    #[error("{error}\nthe last good state, t = {} after {steps} steps, is in {}", rounded(*.time, 6), dir.display())]
    Run {
        error: RunError,
        time: f64,
        steps: u64,
        dir: PathBuf,
    },
}

/// Listens to a run.
pub trait Listener {
    /// After each step: at which part of the duration, and how many steps.
    fn step(&mut self, part: f64, steps: u64);
    /// Shall the run end here, and who says so?
    fn ended(&mut self) -> Option<String>;
    /// Shall a state to go on from be written now?
    fn wants_checkpoint(&mut self) -> bool;
    /// Something that the user should know now.
    fn warning(&mut self, text: &str);
}

/// Name of a method in reports.
pub fn method_name(method: Method) -> &'static str {
    match method {
        Method::Ssprk3 => "ssprk3",
        Method::Rk4 => "rk4",
        Method::Imex => "imex",
    }
}

/// Name of an evaluation in reports.
pub fn evaluation_name(evaluation: Evaluation) -> &'static str {
    match evaluation {
        Evaluation::Direct => "direct",
        Evaluation::Fourier => "fourier",
    }
}

fn columns(deck: &LawDeck) -> Vec<Column> {
    let unit = |dim| deck.units.unit(dim);
    let u = deck.dimension;
    let length = |power: i8| Dim([power, 0, 0, 0]);
    let space = deck.grid().dimension as i8;
    let of = |square: i8, more: i8, time: i8| {
        let value = (0..square).try_fold(Dim([0, 0, time, 0]), |d, _| d.times(u, 1));
        value
            .and_then(|d| d.times(length(more), 1))
            .map_or(String::new(), unit)
    };
    [
        ("t", unit(Dim::TIME)),
        ("mass", of(1, space, 0)),
        ("energy", of(2, space, 0)),
        ("energy_rate", of(2, space, -1)),
        ("energy_rate_exact", of(2, space, -1)),
        ("total_variation", of(1, space - 1, 0)),
        ("min", unit(u)),
        ("max", unit(u)),
        ("time_error", unit(u)),
    ]
    .into_iter()
    .chain(
        errors_beside(deck)
            .iter()
            .map(|name| (*name, String::new())),
    )
    .map(|(name, unit)| Column::new(name, &unit))
    .collect()
}

/// Columns of a run that compares itself with the local law.
fn errors_beside(deck: &LawDeck) -> &'static [&'static str] {
    match deck.reference {
        Some(_) => &["error_l1", "error_l2", "error_max"],
        None => &[],
    }
}

/// The solution of the local law now, where the run compares itself with it.
fn exact(deck: &LawDeck) -> Option<Vec<f64>> {
    let reference = deck.reference.as_ref()?;
    Some(reference.values(deck.evolution.time))
}

/// The row of now, with how far u is from `exact`.
fn row(deck: &mut LawDeck, exact: Option<&[f64]>) -> Result<Vec<f64>, RunError> {
    let beside = exact.and_then(|exact| Compared::new(deck, exact));
    let e = &mut deck.evolution;
    let dt = e.next_step(e.time + deck.duration / deck.rows as f64)?;
    let dt = match e.size() {
        StepSize::Within { .. } => 0.5 * dt,
        StepSize::Part(_) | StepSize::Fixed { .. } => dt,
    };
    let slope = e.energy_slope(dt)?;
    let exact = e.operator.energy_rate(&e.u, e.time);
    if e.operator.stopped() {
        return Err(RunError::Ended { time: e.time });
    }
    let (law, u) = (e.operator.law(), &e.u);
    let grid = law.grid;
    let [low, high] = measure::extremes(u);
    let own = [
        e.time,
        measure::mass(u, grid.cell()),
        measure::energy(u, grid.cell()),
        slope,
        exact,
        measure::total_variation(u, grid.cells, grid.spacing, law.periodic()),
        low,
        high,
        e.error().map_or(f64::NAN, |[now, _]| now),
    ];
    let beside = beside.into_iter().flat_map(|c| c.errors());
    Ok(own.into_iter().chain(beside).collect())
}

/// What steps have added to u at most so far, and may add, both in u; infinite where it is not known.
fn errors(e: &Evolution) -> (Option<f64>, Option<f64>) {
    let allowed = match (e.size(), e.scale()) {
        (StepSize::Within { tolerance, .. }, Some(scale)) => Some(tolerance * scale),
        _ => None,
    };
    (e.error().map(|[_, most]| most), allowed)
}

/// Who ended a step before its end.
fn who(listener: &mut dyn Listener) -> String {
    listener.ended().unwrap_or_else(|| "its caller".into())
}

/// Steps to a time; who ended the run there, if somebody did.
fn advance(
    deck: &mut LawDeck,
    end: f64,
    stepping: &mut Duration,
    listener: &mut dyn Listener,
) -> Result<Option<String>, RunError> {
    let e = &mut deck.evolution;
    while e.time < end * (1.0 - 1e-12) {
        if let Some(signal) = listener.ended() {
            return Ok(Some(signal));
        }
        let begin = Instant::now();
        let done = e.step_to(end);
        *stepping += begin.elapsed();
        match done {
            Err(RunError::Ended { .. }) => return Ok(Some(who(listener))),
            _ => done?,
        }
        listener.step(e.time / deck.duration, e.steps);
    }
    Ok(None)
}

/// What makes the same run again, and what was understood: for the report.
#[derive(Debug, Clone, Default)]
pub struct RunInputs {
    pub command: String,
    pub understood: String,
    /// What a state to go on from says of how the run was asked for.
    pub asked: Asked,
}

/// What goes on beside the state of the law.
struct Written {
    history: History,
    frames: Frames,
    /// The next ones.
    frame: u64,
    line: u64,
    stepping: Duration,
}

impl Owner for Written {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.part("history", &mut self.history);
        archive.part("frames", &mut self.frames);
        archive.one("frame", &mut self.frame);
        archive.one("line", &mut self.line);
        let mut stepping = self.stepping.as_secs_f64();
        archive.one("stepping", &mut stepping);
        self.stepping = Duration::try_from_secs_f64(stepping).unwrap_or_default();
    }
}

fn pass(deck: &mut LawDeck, written: &mut Written, archive: &mut Archive<'_>) {
    archive.part("law", &mut deck.evolution);
    archive.part("files", written);
}

/// Writes a state to go on from; where it cannot be written, the one before stays and the run goes on.
fn save(
    states: &mut Checkpoints,
    deck: &mut LawDeck,
    written: &mut Written,
    told: &RunInputs,
    listener: &mut dyn Listener,
) {
    let mut asked = Asked {
        step: deck.evolution.steps,
        ..told.asked.clone()
    };
    if let Err(error) = states.write(&mut asked, |archive| pass(deck, written, archive)) {
        let time = deck.units.show(deck.evolution.time, Dim::TIME);
        listener.warning(&format!(
            "t = {time}: no state to go on from was written: {error}"
        ));
    }
}

fn setting(deck: &LawDeck, told: RunInputs) -> Setting {
    let (grid, units) = (deck.grid(), deck.units);
    let mut files = vec!["history.csv", "frames.npz"];
    if deck.pictures {
        files.push("profiles.png");
        files.push(if grid.dimension > 1 {
            "last.png"
        } else {
            "space_time.png"
        });
    }
    Setting {
        command: told.command,
        deck_text: deck.text().to_string(),
        understood: told.understood,
        dimension: grid.dimension,
        spacing: grid.spacing,
        units: UnitNames {
            length: units.unit(Dim::LENGTH),
            time: units.unit(Dim::TIME),
            energy: String::new(),
        },
        fields: vec![FieldNote {
            name: "u".into(),
            unit: units.unit(deck.dimension),
            says: "The solution.".into(),
        }],
        files: files.into_iter().map(String::from).collect(),
        ..Setting::default()
    }
}

/// What `run.json` says.
fn record(
    deck: &LawDeck,
    told: RunInputs,
    compared: Option<Compared>,
    (ended, stopped): (Option<String>, Option<&RunError>),
    stepping: Duration,
) -> Report {
    let e = &deck.evolution;
    let (time_error, allowed) = errors(e);
    let mut warnings = deck.warnings.clone();
    if let (Some(error), Some(allowed)) = (time_error, allowed)
        && !(error <= allowed)
    {
        let [error, allowed] = [error, allowed].map(|e| deck.units.show(e, deck.dimension));
        warnings.push(format!("steps have added up to {error} to u, more than the {allowed} of run.tolerance: the law lets small differences grow; take a smaller tolerance, or read nothing into what differs by less"));
    }
    let seconds = stepping.as_secs_f64();
    let visits = e.u.len() as f64 * e.steps as f64;
    Report {
        version: env!("CARGO_PKG_VERSION").to_string(),
        kind: "conservation_law",
        // of a run that goes on as it was called when it began
        deck: told.asked.name.clone(),
        deck_hash: deck_hash(deck.text().as_bytes()),
        title: deck.title.clone(),
        status: match stopped {
            Some(error) => Status::Stopped(error.to_string()),
            None if ended.is_some() => Status::Ended,
            None => Status::Done,
        },
        ended_by: ended,
        points: e.u.len(),
        bonds_of_a_point: e.operator.law().bonds(),
        evaluation: evaluation_name(e.operator.evaluation()),
        method: method_name(e.method()),
        time: e.time,
        steps: e.steps,
        seconds_stepping: seconds,
        ns_per_point_step: (visits > 0.0).then(|| seconds * 1e9 / visits),
        peak_memory_bytes: peak_memory_bytes(),
        hash: StateHash::of([e.time].into_iter().chain(e.u.iter().copied())),
        time_error,
        time_error_allowed: allowed,
        compared,
        warnings,
        setting: setting(deck, told),
    }
}

/// Runs and writes: `frames.npz`, `history.csv`, pictures and `run.json` in `dir`. A run that fails or is ended leaves its last good state as a last frame,
/// one that is ended a state to go on from.
///
/// `from`: the run goes on from this state, in the folder where it was.
///
/// # Errors
/// What stopped the run, or the first file that could not be written.
pub fn run(
    deck: &mut LawDeck,
    dir: &Path,
    told: RunInputs,
    listener: &mut dyn Listener,
    from: Option<Checkpoint>,
) -> Result<Report, LawError> {
    let _held = Folder::claim(dir)?;
    deck.evolution.estimate();
    let path = dir.join("history.csv");
    let history = match &from {
        None => History::create(&path, &columns(deck))?,
        Some(_) => History::reopen(&path, &columns(deck)).map_err(ResumeError::Files)?,
    };
    let schedule = Some(CheckpointSchedule::default());
    let mut states = Checkpoints::new(dir, schedule, from.is_some())?;
    let mut written = Written {
        history,
        frames: Frames::new(deck.grid()),
        frame: 0,
        line: 0,
        stepping: Duration::ZERO,
    };
    if let Some(mut from) = from {
        from.load(|archive| pass(deck, &mut written, archive))?;
        written.history.rewind().map_err(ResumeError::Files)?;
    }
    let (mut ended, mut stopped) = (None, None);
    let at = |number: u64, of: u64, end: f64| end * number as f64 / of as f64;
    loop {
        if states.is_due() || listener.wants_checkpoint() {
            save(&mut states, deck, &mut written, &told, listener);
        }
        let [next_frame, next_row] = [
            at(written.frame, deck.frames, deck.duration),
            at(written.line, deck.rows, deck.duration),
        ];
        let due = next_frame.min(next_row);
        match advance(deck, due, &mut written.stepping, listener) {
            Ok(signal) => ended = signal,
            Err(error) => stopped = Some(error),
        }
        if ended.is_some() {
            save(&mut states, deck, &mut written, &told, listener);
        }
        let whole = ended.is_none() && stopped.is_none();
        let solution = exact(deck);
        if next_frame <= due * (1.0 + 1e-12) || !whole {
            written.frames.push(deck, solution.as_deref());
            written.frame += 1;
        }
        if whole && next_row <= due * (1.0 + 1e-12) {
            match row(deck, solution.as_deref()) {
                Ok(values) => written.history.push(deck.evolution.steps, &values)?,
                Err(RunError::Ended { .. }) => ended = Some(who(listener)),
                Err(error) => stopped = Some(error),
            }
            written.line += 1;
        }
        let done = written.frame > deck.frames && written.line > deck.rows;
        if ended.is_some() || stopped.is_some() || done {
            break;
        }
    }
    match ended.is_none() && stopped.is_none() {
        true => states.done()?,
        false => states.ended()?,
    }
    let Written {
        history,
        mut frames,
        stepping,
        ..
    } = written;
    history.finish()?;
    let solution = exact(deck);
    if !frames.has(deck.evolution.time) {
        frames.push(deck, solution.as_deref());
    }
    let compared = solution.and_then(|exact| Compared::new(deck, &exact));
    frames.write(&dir.join("frames.npz"))?;
    if deck.pictures {
        write_pictures(dir, deck, &frames)?;
    }
    let report = record(deck, told, compared, (ended, stopped.as_ref()), stepping);
    report.write(&dir.join("run.json"))?;
    if deck.report {
        report::write(dir)?;
    }
    match stopped {
        None => Ok(report),
        Some(error) => Err(LawError::Run {
            error,
            time: deck.evolution.time,
            steps: deck.evolution.steps,
            dir: dir.to_path_buf(),
        }),
    }
}
