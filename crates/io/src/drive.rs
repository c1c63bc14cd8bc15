//! Drives a simulation through its steps: observers at their intervals, files as they come, a report at the end.

mod atoms;
mod exodus;
mod modes;
mod names;
mod rigid;
mod row;
mod setting;
mod space_time;

pub use atoms::AtomsPlan;
pub use exodus::ExodusPlan;
use modes::{sweep_modes, write_modes};
use rigid::Paths;
pub use rigid::RigidBodies;
pub use space_time::SpaceTimeOptions;
use space_time::SpaceTimes;

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use peridyne::error::{RunError, SolveError};
use peridyne::observe::{Ledger, Snapshot};
use peridyne::run::Simulation;
use peridyne::spec::{AnyLinearBody, Control, Stepper};
use peridyne_fields::FieldsError;

use crate::balance::BalanceWatch;
use crate::continuum::run::{FieldsPlan, RunningFields};
use crate::deck::UnitSystem;
use crate::write::data::write_data;
use crate::write::earlier::sweep_pictures;
use crate::write::folder::Folder;
use crate::write::history::History;
use crate::write::linear::write_linear;
use crate::write::picture::film::HURRY;
use crate::write::picture::rigid::Placed;
use crate::write::picture::shown::About;
use crate::write::report::{self, ReportError};
use crate::write::run_json::{self, EnergyReport, MarkNotes, RunReport, Setting, Spent, Status};
use crate::write::trajectory::Trajectory;
use crate::write::{Series, SeriesOptions, WriteError};

/// What to do and what to write.
#[derive(Debug, Clone)]
pub struct Plan {
    pub title: String,
    /// File name of the deck and its text, for the report.
    pub deck: String,
    pub deck_text: String,
    pub dir: PathBuf,
    /// What makes the same run again, what was understood, and where the laws come from: for the report.
    pub command: String,
    pub understood: String,
    pub sources: Vec<String>,
    /// What looks wrong in the deck; the model's own are added.
    pub warnings: Vec<String>,
    /// What pictures and the report show beside the points.
    pub rigid: RigidBodies,
    /// What is done to the body, for the report.
    pub marks: MarkNotes,
    /// Write `report.html` at the end.
    pub report: bool,
    /// May files that the deck names lie outside `dir`?
    pub allow_outside: bool,
    pub steps: u64,
    /// Of these, increments of statics before motion.
    pub increments: u64,
    /// Steps between frames; `None`: first and last.
    pub every: Option<u64>,
    /// Steps between rows of `history.csv`.
    pub history: u64,
    /// Modes of vibration about the last state.
    pub modes: usize,
    /// Write `linear_body.npz` about the last state.
    pub linear_body: bool,
    pub series: SeriesOptions,
    /// Fields of a body on a line over place and time.
    pub space_time: Vec<SpaceTimeOptions>,
    /// Frames in an Exodus file.
    pub exodus: Option<ExodusPlan>,
    /// Columns of a frame.
    pub fields: Vec<String>,
    /// Of the numbers that are computed, for headers of probes.
    pub units: UnitSystem,
    /// Units of time and energy, for headers.
    pub time_unit: String,
    pub energy_unit: String,
    pub threads: usize,
    /// What atoms have besides.
    pub atoms: Option<AtomsPlan>,
    /// Continuum fields, where any are asked for.
    pub continuum: Option<FieldsPlan>,
}

impl Plan {
    /// What a frame shows.
    fn look(&self, sim: &mut dyn Simulation) -> Snapshot {
        let mut fields: Vec<&str> = self.fields.iter().map(String::as_str).collect();
        for picture in &self.series.pictures {
            let shown = match &picture.field {
                Some(field) => vec![field.as_str()],
                // what a run is about is known in the end
                None => {
                    let spread = { sim.transfers().into_iter() }.map(|(q, _)| q.column());
                    let others = [About::Fracture.field(), About::Motion.field()];
                    spread.chain(others).collect()
                }
            };
            for field in shown.into_iter().chain(picture.arrows.as_deref()) {
                if !fields.contains(&field) {
                    fields.push(field);
                }
            }
        }
        sim.snapshot(&fields, self.series.bonds)
    }

    /// Has motion begun? It does with the first step after those of statics.
    fn begun(&self, sim: &dyn Simulation) -> bool {
        self.increments == 0 || sim.step_number() > self.increments
    }

    /// Rigid bodies where they are now.
    fn placed(&self, sim: &mut dyn Simulation) -> Vec<Placed> {
        let begun = self.begun(sim);
        self.rigid.placed(sim, begun)
    }
}

/// Listens to a run.
pub trait Progress {
    /// Called often; `stepping` is the time spent in steps alone.
    fn step(&mut self, done: u64, total: u64, stepping: Duration);
    /// A row of the history.
    fn row(&mut self, step: u64, time: f64, ledger: &Ledger, broken: u64);
    /// Something else than steps begins: fields, pictures, the report.
    fn phase(&mut self, _what: &str) {}
    /// Something that the user should know now.
    fn warning(&mut self, message: &str);
    /// Asked after each step: shall the run end here, and who says so? What it has done is then written as at its end.
    /// ([`Simulation::stop_when`] asks within a long increment of statics.)
    fn ended(&mut self) -> Option<String> {
        None
    }
}

/// Why a run did not end well.
#[derive(Debug, thiserror::Error)]
pub enum DriveError {
    #[error(transparent)]
    Write(#[from] WriteError),
    #[error("{told}\nthe last good state, step {step}, is in {}", dir.display())]
    Run {
        error: RunError,
        /// The error with units.
        told: String,
        step: u64,
        dir: PathBuf,
    },
    #[error("[[fields]]: {0}")]
    Fields(#[from] FieldsError),
    #[error("report.html: {0}")]
    Report(#[from] ReportError),
    #[error("the modes were not found: {error}\nthe last state is in {}", dir.display())]
    Modes { error: SolveError, dir: PathBuf },
}

/// Run and write. [`Progress::ended`] ends a run early. On a [`RunError`] the last good state is written like a last frame and `run.json` says why.
///
/// # Errors
/// What stopped the run, or the first file that could not be written.
pub fn drive(
    sim: &mut dyn Simulation,
    plan: &Plan,
    progress: &mut dyn Progress,
) -> Result<RunReport, DriveError> {
    let begin = Instant::now();
    let mut spent = Spent::default();
    let _held = Folder::claim(&plan.dir)?;
    plan.stays_inside()?;
    sweep_pictures(&plan.dir)?;
    sweep_modes(&plan.dir)?;
    let mut series = Series::new(&plan.dir, plan.series.clone())?;
    let columns = row::columns(sim, plan);
    let mut trajectories = Vec::new();
    if let Some(atoms) = &plan.atoms {
        for (path, format) in &atoms.trajectories {
            let trajectory = Trajectory::create(&plan.dir.join(path), *format)?;
            trajectories.push(trajectory.with_ase_velocity(atoms.ase_velocity));
        }
    }
    let asked = plan.continuum.as_ref();
    let running = asked.map(|asked| RunningFields::new(sim, asked, &plan.dir));
    let mut running = running.transpose()?;
    let mut history = History::create(&plan.dir.join("history.csv"), &columns)?;
    let mut exodus = plan.exodus.as_ref().map(|asked| {
        let place = (&*plan.dir, &*plan.title);
        exodus::Frames::new(asked, place, sim, &columns)
    });
    sim.start(true);
    let mut over_time = SpaceTimes::new(sim, plan);
    let broken = sim.broken();
    let mut stepping = Duration::ZERO;
    let mut stopped = None;
    let mut ledger = Ledger::default();
    let mut paths = Paths::default();
    let mut framed = None;
    let mut balance = BalanceWatch::default();
    let told = sim.info().warnings.iter().map(|w| plan.units.tell(w));
    let mut warnings: Vec<String> = plan.warnings.iter().cloned().chain(told).collect();
    if let Some(text) = series.strange() {
        progress.warning(&text);
        warnings.push(text);
    }
    let mut ended = None;
    // what the history and the trajectories tell of already
    let mut told = None;
    let mut row = None;
    for n in 0..=plan.steps {
        if n > 0 {
            let begin = Instant::now();
            let result = sim.step();
            stepping += begin.elapsed();
            match result {
                Ok(()) => progress.step(n, plan.steps, stepping),
                // within an increment or an implicit step, which is undone
                Err(
                    RunError::Equilibrium {
                        error: SolveError::Stopped,
                        ..
                    }
                    | RunError::Implicit {
                        error: SolveError::Stopped,
                        ..
                    },
                ) => ended = Some(progress.ended().unwrap_or_default()),
                Err(error) => {
                    stopped = Some(error);
                    break;
                }
            }
        }
        if n < plan.steps && ended.is_none() {
            ended = progress.ended();
        }
        let last = n == plan.steps || ended.is_some();
        // steps of motion count from its beginning; every increment before it is told
        let loads = n < plan.increments;
        let moved = n.saturating_sub(plan.increments);
        let every = |e: u64| !loads && moved % e == 0;
        let frame = n == 0 || n == plan.increments || plan.every.is_some_and(every);
        let rows = (loads || every(plan.history) || last) && told != Some(sim.step_number());
        let placed = match rows || frame || last {
            true => plan.placed(sim),
            false => vec![],
        };
        paths.push(frame_time(sim), plan.begun(sim), &placed);
        if rows || (frame && exodus.is_some()) {
            match sim.ledger() {
                Ok(l) => ledger = l,
                Err(error) => {
                    stopped = Some(error);
                    break;
                }
            }
            row = Some((sim.step_number(), row::row(sim, plan, &ledger)));
        }
        if let Some((step, row)) = row.as_ref().filter(|_| rows) {
            history.push(*step, row)?;
            told = Some(*step);
            progress.row(*step, sim.clock(), &ledger, sim.broken());
            let statics = loads || matches!(sim.info().stepper, Stepper::Statics(_));
            if let Some(jump) = balance.row(*step, &ledger, statics) {
                let jump = plan.units.tell(&jump);
                progress.warning(&jump);
                warnings.push(jump);
            }
            let explicit = matches!(sim.info().stepper, Stepper::Verlet) && !loads;
            stopped = balance
                .gone(sim.step_number(), &ledger, sim.info())
                .filter(|_| explicit);
            if stopped.is_some() {
                break;
            }
        }
        if let Some(atoms) = plan.atoms.as_ref().filter(|_| !trajectories.is_empty())
            && (frame || last)
            && framed != Some(sim.step_number())
        {
            let frame = atoms.frame(sim);
            trajectories.iter_mut().try_for_each(|t| t.push(&frame))?;
            framed = Some(sim.step_number());
        }
        if let Some(running) = &mut running {
            let begin = Instant::now();
            for text in running.look(sim, n, last)? {
                progress.warning(&text);
                warnings.push(text);
            }
            spent.fields += begin.elapsed().as_secs_f64();
        }
        if !last && frame && (series.wants_frames() || exodus.is_some()) {
            let snapshot = plan.look(sim);
            series.write(&snapshot, &placed)?;
            if let (Some(exodus), Some((_, row))) = (&mut exodus, &row) {
                exodus.push(&snapshot, row)?;
            }
        }
        if !loads {
            over_time.look(sim, moved);
        }
        if plan.modes > 0 && plan.increments > 0 && n == plan.increments {
            let loaded = plan.look(sim);
            write_modes(sim, plan, &loaded)?;
        }
        if last {
            break;
        }
    }
    let snapshot = plan.look(sim);
    let placed = plan.placed(sim);
    paths.push(snapshot.time, plan.begun(sim), &placed);
    series.write(&snapshot, &placed)?;
    if let Some(mut exodus) = exodus {
        let row = row.filter(|(step, _)| *step == sim.step_number());
        // of a run that stopped, what can be said of the last good state
        let row = row
            .map(|(_, row)| row)
            .unwrap_or_else(|| match sim.ledger() {
                Ok(ledger) => row::row(sim, plan, &ledger),
                Err(_) => vec![f64::NAN; columns.len()],
            });
        exodus.push(&snapshot, &row)?;
        exodus.finish()?;
    }
    let about = match (sim.broken() > broken, &sim.info().stepper) {
        (true, _) => About::Fracture,
        (false, Stepper::Statics(_)) => About::Equilibrium,
        (false, Stepper::Verlet | Stepper::Newmark(_)) => About::Motion,
        (false, Stepper::Still) => match sim.transfers().first() {
            Some((quantity, _)) => About::Spread(quantity.column()),
            None => About::Motion,
        },
    };
    progress.phase("pictures");
    let hurried = ended.is_some();
    if hurried && series.hurry() {
        let text = format!(
            "the run was ended: films have no more frames than are drawn in {} s",
            HURRY.as_secs()
        );
        progress.warning(&text);
        warnings.push(text);
    }
    let drawing = Instant::now();
    let pictures = series.finish(&snapshot, &placed, about)?;
    let pictures = pictures.iter().filter_map(|p| p.file_name());
    let mut pictures: Vec<String> = pictures.map(|p| p.to_string_lossy().into_owned()).collect();
    pictures.extend(over_time.finish(plan)?);
    spent.pictures = drawing.elapsed().as_secs_f64();
    history.finish()?;
    let collecting = Instant::now();
    let slices = match running {
        Some(running) => {
            progress.phase("fields");
            running.finish(hurried)?
        }
        None => vec![],
    };
    spent.fields += collecting.elapsed().as_secs_f64();
    for mut trajectory in trajectories {
        // of a run that stopped, the last good state
        if let Some(atoms) = plan
            .atoms
            .as_ref()
            .filter(|_| framed != Some(sim.step_number()))
        {
            trajectory.push(&atoms.frame(sim))?;
        }
        trajectory.finish()?;
    }
    if let Some(atoms) = &plan.atoms
        && let Some(name) = &atoms.data
    {
        write_data(&plan.dir.join(name), &atoms.last(sim))?;
    }
    if plan.modes > 0 && plan.increments == 0 && stopped.is_none() && ended.is_none() {
        write_modes(sim, plan, &snapshot)?;
    }
    if plan.linear_body {
        let path = plan.dir.join("linear_body.npz");
        match sim.linear_body() {
            AnyLinearBody::One(body) => write_linear(&path, &body)?,
            AnyLinearBody::Two(body) => write_linear(&path, &body)?,
            AnyLinearBody::Three(body) => write_linear(&path, &body)?,
        }
    }
    let status = match &stopped {
        Some(error) => Status::Stopped(plan.units.tell(&error.message())),
        None if ended.is_some() => Status::Ended,
        None => Status::Done,
    };
    let info = sim.info();
    spent.all = begin.elapsed().as_secs_f64();
    spent.frames = spent.all - stepping.as_secs_f64() - spent.fields - spent.pictures;
    let mut report = RunReport {
        version: env!("CARGO_PKG_VERSION").to_string(),
        deck: plan.deck.clone(),
        deck_hash: run_json::deck_hash(plan.deck_text.as_bytes()),
        title: plan.title.clone(),
        status,
        ended_by: ended,
        particles: info.points,
        directed_bonds: info.directed_bonds,
        steps: sim.step_number(),
        time_step: info.time_step,
        parts_of_a_step: info.parts,
        seconds_stepping: stepping.as_secs_f64(),
        seconds: spent,
        ns_per_bond_step: run_json::ns_per_bond_step(
            stepping.as_secs_f64(),
            info.directed_bonds,
            sim.step_number(),
        ),
        peak_memory_bytes: run_json::peak_memory_bytes(),
        broken_directed_bonds: sim.broken(),
        fragments: plan.atoms.is_none().then(|| sim.fragments()),
        threads: plan.threads,
        simd: info.simd.to_string(),
        energy: EnergyReport::from(&ledger),
        warnings,
        setting: Some(Setting {
            slices,
            ..plan.setting(sim, &snapshot, &pictures, paths.all())
        }),
        pictures,
    };
    report.write(&plan.dir.join("run.json"))?;
    if plan.report {
        progress.phase("report");
        report::of_run(&plan.dir, report.ended_by.is_some())?;
    }
    report.seconds.all = begin.elapsed().as_secs_f64();
    report.seconds.report = report.seconds.all - spent.all;
    match stopped {
        None => Ok(report),
        Some(error) => Err(DriveError::Run {
            told: plan.units.tell(&error.message()),
            error,
            step: sim.step_number(),
            dir: plan.dir.to_path_buf(),
        }),
    }
}

/// Time of a frame, as a snapshot has it: of loads that may fall the number of the equilibrium.
fn frame_time(sim: &dyn Simulation) -> f64 {
    match sim.info().stepper {
        Stepper::Statics(s) if s.control != Control::Load => sim.step_number() as f64,
        Stepper::Statics(_) | Stepper::Verlet | Stepper::Newmark(_) | Stepper::Still => sim.clock(),
    }
}

fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Threads of a core that are begun at most, and threads that any machine may begin.
const THREADS: [usize; 2] = [16, 256];

/// Why so many threads are not begun.
pub fn refused_threads(threads: usize) -> Option<String> {
    let most = THREADS[1].max(THREADS[0] * cores());
    (threads > most).then(|| {
        format!(
            "{threads} threads: this machine has {} cores, and at most {most} threads are begun on it; leave `threads` out to use all cores",
            cores()
        )
    })
}

/// What to say about so many threads.
pub fn too_many_threads(threads: usize) -> Option<String> {
    let cores = cores();
    (threads > cores).then(|| {
        format!(
            "{threads} threads on {cores} cores are slower than {cores}: leave `threads` out to use all cores"
        )
    })
}

/// The folder a deck's results go to if nobody says otherwise: `out/<deck name>`.
pub fn default_dir(deck: &Path) -> PathBuf {
    let name = deck
        .file_stem()
        .map_or_else(|| "run".into(), |s| s.to_string_lossy().into_owned());
    Path::new("out").join(name)
}
