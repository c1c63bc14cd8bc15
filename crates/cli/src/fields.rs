//! `peridyne fields`: continuum fields from particles.

mod request;
mod words;

use crate::failure::{Failure, note, say};
use crate::run::with_threads;
use peridyne::error::size;
use peridyne_fields::residuals::{self, Residuals};
use peridyne_fields::{Fields, Frame, Method, Progress, Targets, evaluate};
use peridyne_io::continuum::plan::bytes;
use peridyne_io::continuum::{frame, of_unit_mass};
use peridyne_io::deck::rounded;
use peridyne_io::read::Atoms;
use peridyne_io::read::frames::Frames;
use peridyne_io::write::WriteError;
use peridyne_io::write::continuum::{self, Collected, Origin, examined};
use peridyne_io::write::folder::Folder;
use peridyne_io::write::space::free;
use rayon::prelude::*;
use request::Request;
use std::fs;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};
pub use words::{FieldsArguments, schema};

/// Between lines of progress.
const INTERVAL: Duration = Duration::from_secs(5);

pub fn fields(arguments: &FieldsArguments) -> Result<(), Failure> {
    let words = arguments.words()?;
    let request = Request::new(&words)?;
    with_threads(words.threads, |_| all(&request))
}

fn all(request: &Request) -> Result<(), Failure> {
    // a file that is damaged at its end is known before anything is computed
    let count = Frames::count(&request.frames).map_err(|e| Failure::input(e.to_string()))?;
    if count == 0 {
        let name = request.frames.display();
        return Err(Failure::input(format!("{name}: the file has no frames")));
    }
    let chosen: Vec<usize> = (request.skip..count).step_by(request.every).collect();
    if chosen.is_empty() {
        return Err(Failure::input(format!(
            "--skip {}: {} has {count} frames",
            request.skip,
            request.frames.display()
        )));
    }
    if request.parts && chosen.len() > 1 && !request.each {
        return Err(Failure::input(format!(
            "--parts: {} frames are taken, and parts of the potential are kept apart in each alone: add --each, or take one frame (--skip, --every)",
            chosen.len()
        )));
    }
    enough_disk(request, chosen.len())?;
    let existed = request.out.exists();
    let mut made = Made {
        collected: Collected::new(
            request.out.clone(),
            request.units,
            request.each,
            request.pressure,
        ),
        method: None,
        folder: None,
    };
    let outcome = frames(request, chosen.len(), &mut made);
    let written = made.collected.written().to_vec();
    // what was made lets go of the folder
    let outcome = match outcome {
        Ok(()) => save(request, made),
        Err(failure) => {
            drop(made);
            Err(failure)
        }
    };
    if outcome.is_err() {
        // nothing half-written
        written.iter().for_each(|path| drop(fs::remove_file(path)));
        if !existed {
            // the folder alone, if it is empty
            let _ = fs::remove_dir(&request.out);
        }
    }
    outcome
}

/// Does the disk have room for the fields of so many frames?
fn enough_disk(request: &Request, frames: usize) -> Result<(), Failure> {
    let frames = if request.each { frames as u64 } else { 0 };
    let most = bytes(request.targets.len() as u64, frames, request.coordinate);
    match free(&request.out) {
        Some(free) if most > free => Err(Failure::input(format!(
            "fields at {} points would take up to {} on the disk; it has {} left: take fewer points, leave --each out, or give --out on another disk",
            request.targets.len(),
            size(most),
            size(free)
        ))),
        _ => Ok(()),
    }
}

/// What came of the frames.
struct Made {
    collected: Collected,
    /// Of the last one.
    method: Option<Method>,
    /// Held from the first time that something is to be written.
    folder: Option<Folder>,
}

impl Made {
    fn hold(&mut self, request: &Request) -> Result<(), Failure> {
        if self.folder.is_none() {
            let claimed = Folder::claim(&request.out).map_err(|e| Failure::Run(e.to_string()))?;
            self.folder = Some(claimed);
        }
        Ok(())
    }
}

fn unwritten(error: WriteError) -> Failure {
    Failure::Run(error.to_string())
}

/// Atoms and points up to which several frames are computed at once, one for each thread.
const SMALL: [usize; 2] = [20_000, 100_000];

fn at_once(request: &Request, atoms: usize) -> usize {
    match atoms <= SMALL[0] && request.targets.len() <= SMALL[1] {
        true => rayon::current_num_threads(),
        false => 1,
    }
}

fn wrong(request: &Request, index: usize, message: impl std::fmt::Display) -> Failure {
    let name = request.frames.display();
    Failure::input(format!("{name}: frame {index}: {message}"))
}

fn frames(request: &Request, count: usize, made: &mut Made) -> Result<(), Failure> {
    let source = Frames::open(&request.frames).map_err(|e| Failure::input(e.to_string()))?;
    let mut chosen = Chosen {
        source,
        index: 0,
        atoms: None,
    };
    let clock = Arc::new(Clock::new(count));
    let mut some = vec![];
    loop {
        let read = chosen.next(request)?;
        let end = read.is_none();
        some.extend(read);
        let wide = some
            .first()
            .map_or(1, |(_, atoms)| at_once(request, atoms.len()));
        if some.len() < wide && !end {
            continue;
        }
        // of several at once none stands for all
        let within = (wide == 1).then_some(&clock);
        let all: Vec<Result<Computed, Failure>> = std::mem::take(&mut some)
            .into_par_iter()
            .map(|(index, atoms)| computed(request, index, atoms, within))
            .collect();
        for one in all {
            let one = one?;
            if request.each {
                made.hold(request)?;
            }
            let pushed = made.collected.push(&one.found, one.about, one.grid);
            pushed.map_err(unwritten)?;
            made.method = Some(one.method);
        }
        if end {
            return Ok(());
        }
        clock.finished(made.collected.frames());
    }
}

/// Tells how far the work is, and how long it will last.
struct Clock {
    begun: Instant,
    frames: usize,
    told: Mutex<Progressed>,
}

struct Progressed {
    /// Frames that are done, and when the last of them was.
    done: usize,
    since: Instant,
    spoken: Instant,
}

impl Clock {
    fn new(frames: usize) -> Clock {
        let begun = Instant::now();
        Clock {
            begun,
            frames,
            told: Mutex::new(Progressed {
                done: 0,
                since: begun,
                spoken: begun,
            }),
        }
    }

    fn finished(&self, done: usize) {
        let Ok(mut told) = self.told.lock() else {
            return;
        };
        (told.done, told.since) = (done, Instant::now());
        if told.spoken.elapsed() >= INTERVAL && done < self.frames {
            told.spoken = Instant::now();
            let each = self.begun.elapsed().as_secs_f64() / done.max(1) as f64;
            let left = each * (self.frames - done) as f64;
            note(&format!(
                "frame {done} of {}, {left:.0} s left",
                self.frames
            ));
        }
    }

    /// A part of a frame is done.
    fn within(&self, part: f64) {
        let Ok(mut told) = self.told.lock() else {
            return;
        };
        if told.spoken.elapsed() < INTERVAL || !(part > 0.0 && part < 1.0) {
            return;
        }
        told.spoken = Instant::now();
        let left = remaining(
            told.since.elapsed().as_secs_f64(),
            (told.since - self.begun).as_secs_f64(),
            part,
            [told.done, self.frames],
        );
        note(&format!(
            "frame {} of {}, {:.0} % of it, {left:.0} s left",
            told.done + 1,
            self.frames,
            100.0 * part
        ));
    }
}

/// Seconds that are left, where a part of a frame took `now` and the frames before it `before`.
fn remaining(now: f64, before: f64, part: f64, [done, frames]: [usize; 2]) -> f64 {
    let this = now / part;
    let each = (before + this) / (done + 1) as f64;
    this - now + each * (frames - done - 1) as f64
}

/// Frames of the file that are taken, one after the other.
struct Chosen {
    source: Frames,
    index: usize,
    /// Of the frames so far.
    atoms: Option<usize>,
}

impl Chosen {
    fn next(&mut self, request: &Request) -> Result<Option<(usize, Atoms)>, Failure> {
        loop {
            let read = self.source.next_frame();
            let Some(atoms) = read.map_err(|e| Failure::input(e.to_string()))? else {
                return Ok(None);
            };
            let index = self.index;
            self.index += 1;
            if index < request.skip || !(index - request.skip).is_multiple_of(request.every) {
                continue;
            }
            if let Some(before) = self.atoms.replace(atoms.len())
                && before != atoms.len()
            {
                let message = format!(
                    "it has {} atoms, frames before it {before}: fields are averaged over frames of the same atoms",
                    atoms.len()
                );
                return Err(wrong(request, index, message));
            }
            if atoms.bonded && !request.knows_bonds() {
                let message = "the file has bonds: give --molecules FILE (the same, with coefficients) and --special A,B,C";
                return Err(wrong(request, index, message));
            }
            return Ok(Some((index, atoms)));
        }
    }
}

/// The fields of a frame.
struct Computed {
    found: Fields,
    method: Method,
    grid: Option<([usize; 3], peridyne_fields::Cell)>,
    about: continuum::Frame,
}

fn computed(
    request: &Request,
    index: usize,
    atoms: Atoms,
    clock: Option<&Arc<Clock>>,
) -> Result<Computed, Failure> {
    let wrong = |message: String| wrong(request, index, message);
    if index == request.skip {
        let all = of_unit_mass(&atoms, request.units, &request.masses, &request.model);
        if !all.is_empty() {
            note(&format!(
                "nobody says the mass of {}: it is taken as 1, the unit of mass (--mass NAME=MASS says another)",
                all.join(", ")
            ));
        }
    }
    let state = frame(&atoms, request.units, &request.masses, &request.model).map_err(wrong)?;
    let method = request
        .whole_method(&state.cell, state.len())
        .map_err(wrong)?;
    let told = Method {
        progress: clock
            .cloned()
            .map(|c| Progress(Arc::new(move |part| c.within(part)))),
        ..method.clone()
    };
    let found = evaluate(&state, &*request.model.sites, &request.targets, &told)
        .map_err(|e| wrong(e.to_string()))?;
    let grid = match &request.targets {
        Targets::Grid(n) => Some((*n, state.cell.clone())),
        Targets::Points(_) => None,
    };
    let residuals = measured(request, &state, &method);
    let origin = Origin {
        index,
        step: atoms.step,
        time: atoms.time,
        cell: &state.cell,
        grid: grid.is_some(),
        force: atoms.force.as_deref(),
    };
    let about = examined(&found, &origin, residuals);
    Ok(Computed {
        found,
        method,
        grid,
        about,
    })
}

/// Points at which residuals are measured, evenly from those asked for.
fn measured(
    request: &Request,
    state: &Frame,
    method: &peridyne_fields::Method,
) -> Result<Residuals, String> {
    if request.residuals == 0 {
        return Err("not asked for".into());
    }
    let all = request.targets.positions(&state.cell);
    let step = all.len().div_ceil(request.residuals).max(1);
    let points: Vec<[f64; 3]> = all.into_iter().step_by(step).collect();
    // a small part of the distance over which φ changes
    let h = request.kernel.width() / 40.0;
    residuals::of_frame(state, &*request.model.sites, method, &points, h).map_err(|e| e.to_string())
}

fn save(request: &Request, mut made: Made) -> Result<(), Failure> {
    let Some(method) = made.method.take() else {
        return Err(Failure::Run("the localization function is gone".into()));
    };
    made.hold(request)?;
    let name = request.frames.display().to_string();
    let finished = made.collected.finish(&name, &request.model.name, &method);
    summary(request, &finished.map_err(unwritten)?.frames);
    Ok(())
}

fn summary(request: &Request, read: &[continuum::Frame]) {
    let frames = read.len();
    say(&format!(
        "{frames} frame{} of {}, {} points: {}",
        if frames == 1 { "" } else { "s" },
        request.frames.display(),
        request.targets.len(),
        request.out.display(),
    ));
    let Some(last) = read.last() else {
        return;
    };
    let small = |x: f64| rounded(x, 2);
    match &last.residuals {
        Ok(r) => say(&format!(
            "  residuals of the last frame over the rates: mass {}, momentum {}, energy {} (the differences alone leave {}, {}, {})",
            small(r.mass.relative()),
            small(r.momentum.relative()),
            small(r.energy.relative()),
            small(part(r.mass.expected, r.mass.scale)),
            small(part(r.momentum.expected, r.momentum.scale)),
            small(part(r.energy.expected, r.energy.scale)),
        )),
        Err(why) => say(&format!("  no residuals: {why}")),
    }
    if let Some(off) = last.forces
        && off > 1e-3
    {
        note(&format!(
            "warning: forces of the file differ from those of the potential by {} of the largest: is it the potential of these frames?",
            small(off)
        ));
    }
}

fn part(x: f64, of: f64) -> f64 {
    if of > 0.0 { x / of } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::remaining;

    #[test]
    fn what_is_left_is_of_this_frame_and_those_to_come() {
        // a quarter of the first of one took 2 s
        assert_eq!(remaining(2.0, 0.0, 0.25, [0, 1]), 6.0);
        // and two more to come, of 8 s each
        assert_eq!(remaining(2.0, 0.0, 0.25, [0, 3]), 22.0);
        // after one that took 4 s
        assert_eq!(remaining(2.0, 4.0, 0.25, [1, 3]), 12.0);
    }
}
