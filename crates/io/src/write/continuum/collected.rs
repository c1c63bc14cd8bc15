//! What comes of fields frame by frame: a file for each if asked for, means over all, and at the end everything else.

use super::columns::Table;
use super::describe::{About, Frame, describe};
use super::slice::SliceFilm;
use super::{write_arrays, write_image, write_profiles, write_slice, write_table};
use crate::continuum::Units;
use crate::write::atomic::{WriteError, create_directory, write_file};
use crate::write::grown::Seal;
use crate::write::picture::animate::FilmFormat;
use crate::write::pvd::Pvd;
use peridyne::state::{Archive, Owner};
use peridyne_fields::average::Average;
use peridyne_fields::residuals::Residuals;
use peridyne_fields::{Cell, Fields, Method, Quantity};
use std::io::{Error, Write};
use std::path::{Path, PathBuf};

/// Fields of frames on their way into a folder.
pub struct Collected {
    dir: PathBuf,
    units: Units,
    /// Write each frame.
    each: bool,
    /// Write the pressure, too.
    pressure: bool,
    /// Slices of all frames, where a film is wanted.
    film: Option<SliceFilm>,
    format: FilmFormat,
    read: Vec<Frame>,
    average: Average,
    last: Option<(Table, Option<f64>)>,
    /// Frames of a grid.
    pvd: Pvd,
    /// Names of the others, and what is in them.
    tables: Vec<(String, Seal)>,
    written: Vec<PathBuf>,
}

impl Collected {
    /// Nothing is written before the first frame, and no folder made.
    pub fn new(dir: PathBuf, units: Units, each: bool, pressure: bool) -> Collected {
        Collected {
            pvd: Pvd::new(dir.join("frames.pvd")),
            dir,
            units,
            each,
            pressure,
            film: None,
            format: FilmFormat::Png,
            read: vec![],
            average: Average::default(),
            last: None,
            tables: vec![],
            written: vec![],
        }
    }

    /// With a film of the slice, if one is wanted.
    #[must_use]
    pub fn with_film(mut self, wanted: Option<FilmFormat>) -> Collected {
        self.film = wanted.map(|_| SliceFilm::default());
        self.format = wanted.unwrap_or(self.format);
        self
    }

    /// The film, if there is one, is drawn of fewer frames.
    pub fn hurry(&mut self) {
        if let Some(film) = &mut self.film {
            film.hurry();
        }
    }

    /// Passes what was collected through an archive; tables are of this grid.
    pub fn archive(&mut self, grid: Option<([usize; 3], Cell)>, archive: &mut Archive<'_>) {
        archive.given("film", &mut self.film, |film, a| film.archive(a));
        archive.items("frames", &mut self.read, Frame::none, |f, a| f.archive(a));
        archive.part("average", &mut self.average);
        let none = || {
            let table = Table {
                points: vec![],
                grid,
                columns: vec![],
            };
            (table, None)
        };
        archive.option("last", &mut self.last, none, |(table, time), archive| {
            archive.part("table", table);
            archive.one("time", time);
        });
        archive.part("list", &mut self.pvd);
        let none = || (String::new(), Seal::default());
        archive.items("tables", &mut self.tables, none, |(name, seal), archive| {
            archive.text("name", name);
            archive.part("file", seal);
        });
    }

    /// Writes the list of frames as it was when the state was saved, and takes away frames that came after it.
    ///
    /// # Errors
    /// The operating system's; a frame is not as it was.
    pub fn rewind(&mut self) -> Result<(), WriteError> {
        self.pvd.holds()?;
        for (name, seal) in &self.tables {
            seal.holds(&self.dir.join(name))?;
        }
        if self.each {
            // frames are counted: those beyond are of later states
            for index in self.read.len().. {
                let names = ["vti", "vts", "csv"].map(|end| format!("frame.{index:06}.{end}"));
                let there = names.iter().map(|n| self.dir.join(n)).find(|p| p.is_file());
                let Some(path) = there else { break };
                std::fs::remove_file(&path).map_err(WriteError::at("take back", &path))?;
            }
        }
        match self.pvd.files().next() {
            None => Ok(()),
            Some(_) => self.pvd.write(),
        }
    }

    /// Files of frames.
    pub fn written(&self) -> &[PathBuf] {
        &self.written
    }

    pub fn frames(&self) -> usize {
        self.read.len()
    }

    /// Takes the fields of a frame, of a grid with its counts and cell.
    ///
    /// # Errors
    /// The operating system's.
    pub fn push(
        &mut self,
        found: &Fields,
        about: Frame,
        grid: Option<([usize; 3], Cell)>,
    ) -> Result<(), WriteError> {
        let (index, time) = (about.index, about.time);
        let shown = time.or(about.step.map(|s| s as f64));
        self.average.add(found);
        let table = Table::of_frame(found, self.units, grid, self.pressure);
        if self.each {
            create_directory(&self.dir)?;
            let stem = format!("frame.{index:06}");
            match write_image(&self.dir, &stem, &table, time)? {
                Some((path, seal)) => {
                    let own = format!("{}", path.file_name().unwrap_or_default().display());
                    let list = self.pvd.path().to_path_buf();
                    self.written.extend([path, list]);
                    self.pvd.push(shown.unwrap_or(index as f64), &own, seal)?;
                }
                None => {
                    let name = format!("{stem}.csv");
                    let path = self.dir.join(&name);
                    self.tables.push((name, write_table(&path, &table)?));
                    self.written.push(path);
                }
            }
        }
        if let Some(film) = &mut self.film {
            film.push(&table, shown);
        }
        self.read.push(about);
        self.last = Some((table, time));
        Ok(())
    }

    /// Writes what stands for all frames: of one frame that frame, with the parts of its potential, else means. Nothing where there was
    /// none. Returns what the frames say of themselves.
    ///
    /// # Errors
    /// The operating system's.
    pub fn finish(
        self,
        source: &str,
        potential: &str,
        method: &Method,
    ) -> Result<Made, WriteError> {
        let Some((last, time)) = self.last else {
            return Ok(Made::default());
        };
        create_directory(&self.dir)?;
        let frames = self.read.len();
        let table = match frames {
            1 => last,
            _ => Table::of_average(
                &self.average,
                last.points,
                self.units,
                last.grid,
                self.pressure,
            ),
        };
        let about = About {
            frames: source,
            potential,
            units: self.units,
            method,
            read: self.read,
        };
        let time = time.filter(|_| frames == 1);
        let mut pictures = save(&self.dir, &table, &about, time)?;
        if let Some(film) = self.film {
            pictures.extend(film.finish(&self.dir, about.units, self.format)?);
        }
        Ok(Made {
            frames: about.read,
            pictures,
        })
    }
}

/// What was made.
#[derive(Default)]
pub struct Made {
    /// What the frames say of themselves.
    pub frames: Vec<Frame>,
    /// Pictures of slices, and films of them.
    pub pictures: Vec<PathBuf>,
}

/// Gives the pictures.
fn save(
    dir: &Path,
    table: &Table,
    about: &About,
    time: Option<f64>,
) -> Result<Vec<PathBuf>, WriteError> {
    let mut pictures = vec![];
    match table.grid {
        None => {
            write_table(&dir.join("points.csv"), table)?;
        }
        Some(_) => {
            write_image(dir, "fields", table, time)?;
            pictures = write_slice(dir, table, about.units)?;
            pictures.retain(|p| p.extension().is_some_and(|e| e == "png"));
            write_profiles(dir, table, about.units)?;
        }
    }
    write_arrays(&dir.join("fields.npz"), table)?;
    // last, so that it stands for all of them
    let path = dir.join("fields.json");
    let text = serde_json::to_string_pretty(&describe(about, table))
        .map_err(Error::other)
        .map_err(WriteError::at("write", &path))?;
    write_file(&path, |w| writeln!(w, "{text}"))?;
    Ok(pictures)
}

/// Of which frame fields are.
pub struct Origin<'a> {
    pub index: usize,
    pub step: Option<u64>,
    pub time: Option<f64>,
    pub cell: &'a Cell,
    /// Are they those of a grid?
    pub grid: bool,
    /// Forces that somebody else says the particles have.
    pub force: Option<&'a [[f64; 3]]>,
}

fn largest(values: &[f64]) -> f64 {
    let finite = values.iter().filter(|x| x.is_finite());
    finite.fold(0.0, |m, x| m.max(x.abs()))
}

/// What a frame's fields say of themselves.
pub fn examined(found: &Fields, of: &Origin, residuals: Result<Residuals, String>) -> Frame {
    let stress = found
        .get(Quantity::Stress)
        .or_else(|| found.get(Quantity::StressPotential))
        .unwrap_or(&[]);
    let rows = stress.chunks_exact(9);
    let rows = rows.filter(|s| s.iter().all(|c| c.is_finite()));
    let off = rows.fold(0.0f64, |m, s| {
        [(1, 3), (2, 6), (5, 7)]
            .into_iter()
            .fold(m, |m, (a, b)| m.max((s[a] - s[b]).abs()))
    });
    let over = |x: f64, size: f64| if size > 0.0 { x / size } else { 0.0 };
    let periodic = of.cell.periodic == [true; 3] && of.grid && found.totals.complete;
    let points = found.len() as f64;
    let churning = || {
        let z = found.get(Quantity::Churning)?;
        let mean = |n: usize| z.iter().skip(n).step_by(9).sum::<f64>() / points;
        let most = (0..9).fold(0.0f64, |m, n| m.max(mean(n).abs()));
        let stress = largest(found.get(Quantity::StressPotential).unwrap_or(&[]));
        Some(over(most, stress))
    };
    let forces = of.force.filter(|_| found.totals.complete).map(|file| {
        let size = largest(file.as_flattened());
        let pairs = found.force.as_flattened().iter().zip(file.as_flattened());
        let off = pairs.fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
        if size > 0.0 { off / size } else { off }
    });
    Frame {
        index: of.index,
        step: of.step,
        time: of.time,
        atoms: found.force.len(),
        totals: found.totals,
        volume: of.cell.volume(),
        residuals,
        asymmetry: over(off, largest(stress)),
        virial: periodic.then(|| against_virial(found, stress, of.cell.volume())),
        churning: if periodic { churning() } else { None },
        forces,
    }
}

/// How far the mean of `σ − ρ v⊗v` is from the virial, over the largest of its components.
fn against_virial(found: &Fields, stress: &[f64], volume: f64) -> f64 {
    let points = found.len() as f64;
    let mut worst = [0.0f64; 2];
    for n in 0..9 {
        let mut mean: f64 = stress.iter().skip(n).step_by(9).sum::<f64>() / points;
        let mut exact = -found.totals.virial[n] / volume;
        let moving = (found.get(Quantity::Density), found.get(Quantity::Velocity));
        if let (Some(rho), Some(v)) = moving {
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
    match worst[1] > 0.0 {
        true => worst[0] / worst[1],
        false => 0.0,
    }
}
