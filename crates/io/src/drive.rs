//! Drives a simulation through its steps: observers at their intervals, files as they come, a report at the end.

mod atoms;
mod names;
mod options;
mod plan;
mod rigid;
mod row;
mod setting;
mod writers;

use crate::deck::each_once;
use crate::write::checkpoint::{Asked, Checkpoint, Checkpoints, ResumeError};
use crate::write::earlier::sweep_pictures;
use crate::write::folder::Folder;
use crate::write::report;
use crate::write::run_json::{self, EnergyReport, RunReport, Setting, Spent, Status};
pub use atoms::AtomsPlan;
pub use options::{ExodusPlan, SpaceTimeOptions};
use peridyne::error::{RunError, SolveError};
use peridyne::run::Simulation;
use peridyne::spec::Control;
use peridyne::state::Archive;
pub use plan::{DriveError, Plan, Progress};
pub use rigid::RigidBodies;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use writers::{Due, Known, Made, Now, Writer};

/// Run and write. [`Progress::ended`] ends a run early, and leaves a state from which it goes on. On a [`RunError`] the last good state is
/// written like a last frame and `run.json` says why.
///
/// `from`: the run goes on from this state, in the folder where it was.
///
/// # Errors
/// What stopped the run, or the first file that could not be written.
pub fn drive(
    sim: &mut dyn Simulation,
    plan: &Plan,
    progress: &mut dyn Progress,
    from: Option<Checkpoint>,
) -> Result<RunReport, DriveError> {
    let begin = Instant::now();
    let _held = Folder::claim(&plan.dir)?;
    plan.stays_inside()?;
    let mut run = Run::begin(sim, plan, progress, (from, begin))?;
    run.go_on(sim, plan, progress)?;
    run.end(sim, plan, progress)
}

/// A run between its first step and its last.
struct Run {
    writers: Vec<Box<dyn Writer>>,
    checkpoints: Checkpoints,
    known: Known,
    /// In parts before this one, and in this one what is no steps.
    spent: Spent,
    begin: Instant,
    /// Steps done.
    step: u64,
    goes_on: bool,
    stopped: Option<RunError>,
    /// Who ended it early.
    ended: Option<String>,
}

impl Run {
    /// Opens what is written, and brings the model to where the run begins or goes on.
    fn begin(
        sim: &mut dyn Simulation,
        plan: &Plan,
        progress: &mut dyn Progress,
        (from, begin): (Option<Checkpoint>, Instant),
    ) -> Result<Run, DriveError> {
        let goes_on = from.is_some();
        // of the part before, too: all are drawn at the end
        sweep_pictures(&plan.dir)?;
        let columns = plan.columns(sim);
        let told = sim.info().warnings.iter().map(|w| plan.units.tell(w));
        let mut run = Run {
            writers: writers::all(&columns),
            checkpoints: Checkpoints::new(&plan.dir, plan.output.checkpoints, goes_on)?,
            known: Known {
                ways: row::Way::all(sim, plan),
                warnings: plan.warnings.iter().cloned().chain(told).collect(),
                ..Known::default()
            },
            spent: Spent::default(),
            begin,
            step: 0,
            goes_on,
            stopped: None,
            ended: None,
        };
        let opened = run.each(sim, plan, progress, run.due(plan), |writer, now| {
            writer.open(now, goes_on)
        });
        match goes_on {
            true => opened.map_err(as_found)?,
            false => opened?,
        }
        let Some(mut from) = from else {
            sim.start(true);
            run.known.broken = sim.broken();
            return Ok(run);
        };
        run.step = from.asked.step;
        from.load(|archive| pass(sim, &mut run.known, &mut run.writers, archive))?;
        run.spent = run.known.spent.clone();
        from.passed_over.into_iter().for_each(|why| {
            progress.warning(&format!("{why}; the run goes on from the state before it"));
        });
        let rewound = run.each(sim, plan, progress, run.due(plan), |writer, now| {
            writer.rewind(now)
        });
        rewound.map_err(as_found)?;
        Ok(run)
    }

    /// What is due after the steps that are done.
    fn due(&self, plan: &Plan) -> Due {
        // steps of motion count from its beginning; every increment before it is told
        let (loads, moved) = (
            self.step < plan.increments,
            self.step.saturating_sub(plan.increments),
        );
        let every = |e: u64| !loads && moved.is_multiple_of(e);
        Due {
            step: self.step,
            moved,
            loads,
            row: loads || every(plan.history),
            frame: self.step == 0 || self.step == plan.increments || plan.every.is_some_and(every),
            last: false,
        }
    }

    fn each(
        &mut self,
        sim: &mut dyn Simulation,
        plan: &Plan,
        progress: &mut dyn Progress,
        due: Due,
        mut visit: impl FnMut(&mut dyn Writer, &mut Now<'_>) -> Result<(), DriveError>,
    ) -> Result<(), DriveError> {
        let hurried = self.ended.is_some();
        let mut now = Now::new(
            (sim, plan, progress),
            (&mut self.known, &mut self.spent),
            &mut self.stopped,
            (due, hurried),
        );
        for writer in &mut self.writers {
            visit(writer.as_mut(), &mut now)?;
            if now.stopped.is_some() {
                break;
            }
        }
        Ok(())
    }

    fn look(
        &mut self,
        sim: &mut dyn Simulation,
        plan: &Plan,
        progress: &mut dyn Progress,
        due: Due,
    ) -> Result<(), DriveError> {
        self.each(sim, plan, progress, due, |writer, now| writer.look(now))
    }

    /// Step by step to the end, or to what ends the run before it.
    fn go_on(
        &mut self,
        sim: &mut dyn Simulation,
        plan: &Plan,
        progress: &mut dyn Progress,
    ) -> Result<(), DriveError> {
        // what is due where a run goes on was written before its state
        if !self.goes_on {
            self.look(sim, plan, progress, self.due(plan))?;
        }
        let mut stepping = Duration::from_secs_f64(self.known.stepping);
        while self.step < plan.steps && self.stopped.is_none() {
            self.ended = progress.ended();
            if self.ended.is_some() {
                break;
            }
            if self.checkpoints.is_due() || progress.wants_checkpoint() {
                self.save(sim, plan, progress);
            }
            let begin = Instant::now();
            let result = progress.advance(sim);
            stepping += begin.elapsed();
            self.known.stepping = stepping.as_secs_f64();
            match result {
                Ok(true) => {
                    self.step += 1;
                    progress.step(self.step, plan.steps, stepping);
                    progress.look(sim, self.step);
                    self.look(sim, plan, progress, self.due(plan))?;
                }
                // within an increment or an implicit step, which is undone
                Ok(false)
                | Err(
                    RunError::Equilibrium {
                        error: SolveError::Stopped,
                        ..
                    }
                    | RunError::Implicit {
                        error: SolveError::Stopped,
                        ..
                    },
                ) => {
                    self.ended = Some(progress.ended().unwrap_or_default());
                    break;
                }
                Err(error) => {
                    self.stopped = Some(error);
                    return Ok(());
                }
            }
        }
        if self.stopped.is_some() {
            return Ok(());
        }
        if self.ended.is_some() {
            self.save(sim, plan, progress);
        }
        let due = Due {
            last: true,
            ..self.due(plan)
        };
        self.look(sim, plan, progress, due)
    }

    /// Writes a state to go on from; where it cannot be written, the one before stays and the run goes on.
    fn save(&mut self, sim: &mut dyn Simulation, plan: &Plan, progress: &mut dyn Progress) {
        let begin = Instant::now();
        self.known.spent = self.spent_so_far();
        let mut asked = Asked {
            step: self.step,
            steps: plan.steps,
            ..plan.asked.clone()
        };
        let (known, writers) = (&mut self.known, &mut self.writers);
        let written = self.checkpoints.write(&mut asked, |archive| {
            pass(sim, known, writers, archive);
        });
        // without it a run that goes on shares its body out by points
        let _ = self.checkpoints.write_work(&sim.work_of_ranks());
        if let Err(error) = written {
            let text = format!(
                "step {}: no state to go on from was written: {error}",
                self.step
            );
            progress.warning(&text);
            self.known.warnings.push(text);
        }
        self.spent.checkpoints += begin.elapsed().as_secs_f64();
    }

    /// In all parts up to now.
    fn spent_so_far(&self) -> Spent {
        let part = self.begin.elapsed().as_secs_f64();
        let mut spent = self.spent.clone();
        spent.parts.push(0.0);
        spent.goes_on(part);
        spent
    }

    /// Writes what stands for all of the run, and its record.
    fn end(
        mut self,
        sim: &mut dyn Simulation,
        plan: &Plan,
        progress: &mut dyn Progress,
    ) -> Result<RunReport, DriveError> {
        let due = self.due(plan);
        let mut made = Made::default();
        let mut stopped = self.stopped.take();
        let mut now = Now::new(
            (sim, plan, progress),
            (&mut self.known, &mut self.spent),
            &mut stopped,
            (due, self.ended.is_some()),
        );
        for writer in std::mem::take(&mut self.writers) {
            writer.end(&mut now, &mut made)?;
        }
        let hash = sim.state_hash();
        let status = match &stopped {
            Some(error) => Status::Stopped(plan.units.tell(&error.message())),
            None if self.ended.is_some() => Status::Ended,
            None => Status::Done,
        };
        let (looked, mut spent) = (Instant::now(), self.spent_so_far());
        match status {
            Status::Done => self.checkpoints.done()?,
            Status::Ended | Status::Stopped(_) => self.checkpoints.ended()?,
        }
        let (info, known) = (sim.info(), self.known);
        let elsewhere = known.stepping + spent.fields + spent.pictures + spent.checkpoints;
        spent.frames = (spent.all - elsewhere).max(0.0);
        let mut report = RunReport {
            version: env!("CARGO_PKG_VERSION").to_string(),
            deck: plan.deck.clone(),
            deck_hash: run_json::deck_hash(plan.deck_text.as_bytes()),
            title: plan.title.clone(),
            status,
            ended_by: self.ended,
            particles: info.points,
            bonds: each_once(info.directed_bonds),
            steps: sim.step_number(),
            time_step: info.time_step,
            parts_of_a_step: info.parts,
            seconds_stepping: known.stepping,
            seconds: spent,
            ns_per_bond_step: run_json::ns_per_bond_step(
                known.stepping,
                info.directed_bonds,
                sim.step_number(),
            ),
            peak_memory_bytes: run_json::peak_memory_bytes(),
            broken_bonds: each_once(sim.broken()),
            fragments: plan.atoms.is_none().then(|| sim.fragments()),
            hash,
            ranks: plan.ranks,
            threads: plan.threads,
            simd: info.simd.to_string(),
            energy: EnergyReport::from(&known.ledger),
            warnings: known.warnings,
            setting: Some(Setting {
                slices: made.slices,
                ..plan.setting(sim, &made.pictures, made.paths)
            }),
            pictures: made.pictures,
        };
        report.write(&plan.dir.join("run.json"))?;
        if plan.output.report {
            progress.phase("report");
            report::of_run(&plan.dir, report.ended_by.is_some())?;
        }
        report.seconds.report = looked.elapsed().as_secs_f64();
        report.seconds.goes_on(report.seconds.report);
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
}

/// Brings a model that was not started to the state of a checkpoint; nothing of its run's files is looked at.
///
/// # Errors
/// The state is of another body.
pub fn take_state(sim: &mut dyn Simulation, from: &mut Checkpoint) -> Result<(), ResumeError> {
    from.load(|archive| pass_model(sim, archive))
}

fn pass_model(sim: &mut dyn Simulation, archive: &mut Archive<'_>) {
    archive.same("body", &mut sum_of_body(sim));
    archive.part("model", sim);
}

/// What is wrong with files that a run goes on with is wrong input.
fn as_found(error: DriveError) -> DriveError {
    match error {
        DriveError::Write(error) => ResumeError::Files(error).into(),
        other => other,
    }
}

/// All that is needed to go on.
fn pass(
    sim: &mut dyn Simulation,
    known: &mut Known,
    writers: &mut [Box<dyn Writer>],
    archive: &mut Archive<'_>,
) {
    pass_model(sim, archive);
    archive.part("run", known);
    for writer in writers {
        archive.part("files", writer.as_mut());
    }
}

/// A checksum of where points are in the reference, and what they are.
fn sum_of_body(sim: &mut dyn Simulation) -> u32 {
    let mut sum = crc32fast::Hasher::new();
    let mut add = |x: &[f64]| x.iter().for_each(|x| sum.update(&x.to_le_bytes()));
    add(sim.vectors("reference").as_flattened());
    add(&sim.scalars("volume"));
    add(&sim.scalars("density"));
    if let Some(material) = sim.column("material") {
        (0..material.values.len()).for_each(|i| add(&[material.values.at(i, 0)]));
    }
    sum.finalize()
}

/// Time of a frame, as a snapshot has it: of loads that may fall the number of the equilibrium.
fn frame_time(sim: &dyn Simulation) -> f64 {
    let statics = sim.info().stepper.statics();
    match statics.is_some_and(|s| s.control != Control::Load) {
        true => sim.step_number() as f64,
        false => sim.clock(),
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
