//! `peridyne fields`: continuum fields from particles.

mod request;
mod words;

use crate::failure::{Failure, note, say};
use crate::run::with_threads;
use peridyne_fields::average::Average;
use peridyne_fields::residuals::{self, Residuals};
use peridyne_fields::{Fields, Frame, Quantity, Targets, evaluate};
use peridyne_io::continuum::frame;
use peridyne_io::read::Atoms;
use peridyne_io::read::frames::Frames;
use peridyne_io::write::atomic::write_file;
use peridyne_io::write::continuum::{self, About, Table, describe};
use peridyne_io::write::folder::Folder;
use peridyne_io::write::pvd::Pvd;
use rayon::prelude::*;
use request::Request;
use std::fs;
use std::path::PathBuf;
use std::time::{Duration, Instant};
pub use words::FieldsArguments;

/// Between lines of progress.
const INTERVAL: Duration = Duration::from_secs(5);

pub fn fields(arguments: &FieldsArguments) -> Result<(), Failure> {
    let words = arguments.words()?;
    let request = Request::new(&words)?;
    with_threads(words.threads, |_| all(&request))
}

/// What came of the frames.
struct Done {
    read: Vec<continuum::Frame>,
    average: Average,
    last: Option<(Table, Option<f64>)>,
    points: Vec<[f64; 3]>,
    grid: Option<([usize; 3], peridyne_fields::Cell)>,
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
    let existed = request.out.exists();
    let mut written = vec![];
    let mut folder = None;
    let outcome = frames(request, chosen.len(), &mut folder, &mut written)
        .and_then(|done| save(request, done, &mut folder));
    if outcome.is_err() {
        // nothing half-written
        written.iter().for_each(|path| drop(fs::remove_file(path)));
        drop(folder);
        if !existed {
            // the folder alone, if it is empty
            let _ = fs::remove_dir(&request.out);
        }
    }
    outcome
}

/// Holds the folder of the results, from the first time that something is to be written.
fn hold(request: &Request, folder: &mut Option<Folder>) -> Result<(), Failure> {
    if folder.is_none() {
        let claimed = Folder::claim(&request.out).map_err(|e| Failure::Run(e.to_string()))?;
        *folder = Some(claimed);
    }
    Ok(())
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

fn frames(
    request: &Request,
    count: usize,
    folder: &mut Option<Folder>,
    written: &mut Vec<PathBuf>,
) -> Result<Done, Failure> {
    let source = Frames::open(&request.frames).map_err(|e| Failure::input(e.to_string()))?;
    let mut chosen = Chosen {
        source,
        index: 0,
        atoms: None,
    };
    let mut done = Done {
        read: vec![],
        average: Average::default(),
        last: None,
        points: vec![],
        grid: None,
    };
    let mut pvd = Pvd::new(request.out.join("frames.pvd"));
    let (begun, mut spoken) = (Instant::now(), Instant::now());
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
        let all: Vec<Result<Computed, Failure>> = std::mem::take(&mut some)
            .into_par_iter()
            .map(|(index, atoms)| computed(request, index, atoms))
            .collect();
        for one in all {
            let one = one?;
            let table = Table::of_frame(
                &one.found,
                request.units,
                one.grid.clone(),
                request.pressure,
            );
            if request.each {
                hold(request, folder)?;
                write_frame(request, &one, &table, &mut pvd, written)?;
            }
            done.average.add(&one.found);
            done.read.push(one.about);
            done.points = one.found.points;
            done.grid = one.grid;
            done.last = Some((table, one.atoms.time));
        }
        if end {
            return Ok(done);
        }
        let n = done.read.len();
        if spoken.elapsed() >= INTERVAL && n < count {
            spoken = Instant::now();
            let left = begun.elapsed().as_secs_f64() / n as f64 * (count - n) as f64;
            note(&format!("frame {n} of {count}, {left:.0} s left"));
        }
    }
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
    atoms: Atoms,
    found: Fields,
    grid: Option<([usize; 3], peridyne_fields::Cell)>,
    about: continuum::Frame,
}

fn computed(request: &Request, index: usize, atoms: Atoms) -> Result<Computed, Failure> {
    let wrong = |message: String| wrong(request, index, message);
    let state = frame(&atoms, request.units, &request.masses, &request.model).map_err(wrong)?;
    let method = request
        .whole_method(&state.cell, state.len())
        .map_err(wrong)?;
    let found = evaluate(&state, &*request.model.sites, &request.targets, &method)
        .map_err(|e| wrong(e.to_string()))?;
    let grid = match &request.targets {
        Targets::Grid(n) => Some((*n, state.cell.clone())),
        Targets::Points(_) => None,
    };
    let residuals = measured(request, &state, &method);
    let about = examined(&atoms, &state, &found, index, residuals, grid.is_some());
    Ok(Computed {
        atoms,
        found,
        grid,
        about,
    })
}

fn write_frame(
    request: &Request,
    one: &Computed,
    table: &Table,
    pvd: &mut Pvd,
    written: &mut Vec<PathBuf>,
) -> Result<(), Failure> {
    let failed = |e: peridyne_io::write::WriteError| Failure::Run(e.to_string());
    let (index, atoms) = (one.about.index, &one.atoms);
    let stem = format!("frame.{index:06}");
    match continuum::write_image(&request.out, &stem, table, atoms.time).map_err(failed)? {
        Some(path) => {
            let own = format!("{}", path.file_name().unwrap_or_default().display());
            let time = atoms.time.or(atoms.step.map(|s| s as f64));
            written.extend([path, pvd.path().to_path_buf()]);
            pvd.push(time.unwrap_or(index as f64), &own)
                .map_err(failed)?;
        }
        None => {
            let path = request.out.join(format!("{stem}.csv"));
            continuum::write_table(&path, table).map_err(failed)?;
            written.push(path);
        }
    }
    Ok(())
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

fn largest(values: &[f64]) -> f64 {
    let finite = values.iter().filter(|x| x.is_finite());
    finite.fold(0.0, |m, x| m.max(x.abs()))
}

/// What a frame's fields say of themselves.
fn examined(
    atoms: &Atoms,
    state: &Frame,
    found: &Fields,
    index: usize,
    residuals: Result<Residuals, String>,
    grid: bool,
) -> continuum::Frame {
    let stress = found
        .get(Quantity::Stress)
        .or_else(|| found.get(Quantity::StressPotential))
        .unwrap_or(&[]);
    let rows = || {
        stress
            .chunks_exact(9)
            .filter(|s| s.iter().all(|c| c.is_finite()))
    };
    let off = rows().fold(0.0f64, |m, s| {
        [(1, 3), (2, 6), (5, 7)]
            .into_iter()
            .fold(m, |m, (a, b)| m.max((s[a] - s[b]).abs()))
    });
    let size = largest(stress);
    let periodic = state.cell.periodic == [true; 3] && grid && found.totals.complete;
    let points = found.len() as f64;
    let volume = state.cell.volume();
    let virial = periodic.then(|| {
        let mut worst = [0.0f64; 2];
        for n in 0..9 {
            let mut mean: f64 = stress.iter().skip(n).step_by(9).sum::<f64>() / points;
            let mut exact = -found.totals.virial[n] / volume;
            if let (Some(rho), Some(v)) =
                (found.get(Quantity::Density), found.get(Quantity::Velocity))
            {
                let flow = (0..found.len())
                    .map(|p| rho[p] * v[3 * p + n / 3] * v[3 * p + n % 3])
                    .filter(|f| f.is_finite());
                mean -= flow.sum::<f64>() / points;
                exact -= found.totals.flow[n] / volume;
            }
            worst = [
                worst[0].max((mean - exact).abs()),
                worst[1].max(exact.abs()),
            ];
        }
        if worst[1] > 0.0 {
            worst[0] / worst[1]
        } else {
            0.0
        }
    });
    let churning = periodic.then(|| {
        let z = found.get(Quantity::Churning).unwrap_or(&[]);
        let mean = |n: usize| z.iter().skip(n).step_by(9).sum::<f64>() / points;
        let most = (0..9).fold(0.0f64, |m, n| m.max(mean(n).abs()));
        let stress = largest(found.get(Quantity::StressPotential).unwrap_or(&[]));
        if stress > 0.0 { most / stress } else { 0.0 }
    });
    let forces = atoms
        .force
        .as_ref()
        .filter(|_| found.totals.complete)
        .map(|file| {
            let size = largest(file.as_flattened());
            let pairs = found.force.as_flattened().iter().zip(file.as_flattened());
            let off = pairs.fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
            if size > 0.0 { off / size } else { off }
        });
    continuum::Frame {
        index,
        step: atoms.step,
        time: atoms.time,
        atoms: atoms.len(),
        totals: found.totals.clone(),
        volume,
        residuals,
        asymmetry: if size > 0.0 { off / size } else { 0.0 },
        virial,
        churning,
        forces,
    }
}

fn save(request: &Request, done: Done, folder: &mut Option<Folder>) -> Result<(), Failure> {
    let failed = |e: peridyne_io::write::WriteError| Failure::Run(e.to_string());
    let frames = done.read.len();
    let Some((last, time)) = done.last else {
        return Err(Failure::input(format!(
            "{}: the file has no frames",
            request.frames.display()
        )));
    };
    // of one frame it is that frame, with the parts of the potential
    let table = match frames {
        1 => last,
        _ => Table::of_average(
            &done.average,
            done.points,
            request.units,
            done.grid,
            request.pressure,
        ),
    };
    let name = request.frames.display().to_string();
    let Some((method, read)) = request.last_method(&table).zip(Some(done.read)) else {
        return Err(Failure::Run("the localization function is gone".into()));
    };
    let about = About {
        frames: &name,
        potential: &request.model.name,
        units: request.units,
        method: &method,
        read,
    };
    let description = describe(&about, &table);
    hold(request, folder)?;
    let out = &request.out;
    if table.grid.is_none() {
        continuum::write_table(&out.join("points.csv"), &table).map_err(failed)?;
    } else {
        let time = time.filter(|_| frames == 1);
        continuum::write_image(out, "fields", &table, time).map_err(failed)?;
        continuum::write_slice(out, &table, request.units).map_err(failed)?;
    }
    continuum::write_arrays(&out.join("fields.npz"), &table).map_err(failed)?;
    // last, so that it stands for all of them
    let text =
        serde_json::to_string_pretty(&description).map_err(|e| Failure::Run(e.to_string()))?;
    write_file(&out.join("fields.json"), |w| {
        use std::io::Write;
        writeln!(w, "{text}")
    })
    .map_err(failed)?;
    summary(&about, table.points.len(), out.display().to_string());
    Ok(())
}

fn summary(about: &About, points: usize, out: String) {
    let frames = about.read.len();
    say(&format!(
        "{frames} frame{} of {}, {points} points: {out}",
        if frames == 1 { "" } else { "s" },
        about.frames,
    ));
    let Some(last) = about.read.last() else {
        return;
    };
    match &last.residuals {
        Ok(r) => say(&format!(
            "  residuals of the last frame over the rates: mass {:.1e}, momentum {:.1e}, energy {:.1e} (the differences alone leave {:.1e}, {:.1e}, {:.1e})",
            r.mass.relative(),
            r.momentum.relative(),
            r.energy.relative(),
            part(r.mass.expected, r.mass.scale),
            part(r.momentum.expected, r.momentum.scale),
            part(r.energy.expected, r.energy.scale),
        )),
        Err(why) => say(&format!("  no residuals: {why}")),
    }
    if let Some(off) = last.forces
        && off > 1e-3
    {
        note(&format!(
            "warning: forces of the file differ from those of the potential by {:.1e} of the largest: is it the potential of these frames?",
            off
        ));
    }
}

fn part(x: f64, of: f64) -> f64 {
    if of > 0.0 { x / of } else { 0.0 }
}
