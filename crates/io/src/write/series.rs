//! Everything a run writes of its points, one object: files per snapshot, collections, the last picture.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use peridyne::observe::Snapshot;
use peridyne::state::{Archive, Owner};

use super::atomic::{WriteError, create_directory};
use super::dump::{DumpBox, write_frame};
use super::earlier::{sweep_frames, told};
use super::folder::{CHECKPOINT, WAITING};
use super::grown::{Grown, write_sealed};
use super::picture::film::{Film, HURRY};
use super::picture::rigid::Placed;
use super::picture::shown::About;
use super::picture::{self, PictureOptions};
use super::pvd::Pvd;
use super::shares;
use super::vtu::{write_bonds, write_cells, write_points};
use crate::deck::UnitSystem;
use crate::read::Cells;

/// What frames are of.
const KINDS: [&str; 3] = ["points", "cells", "bonds"];

/// Which files a series writes.
#[derive(Debug, Clone, PartialEq)]
pub struct SeriesOptions {
    /// `points_<step>.vtu` and `points.pvd`.
    pub points: bool,
    /// `cells_<step>.vtu` and `cells.pvd` of the meshes that points stand for; none where it is empty.
    pub cells: Arc<Cells>,
    /// `bonds_<step>.vtu` and `bonds.pvd`; the snapshots must carry bonds.
    pub bonds: bool,
    /// A LAMMPS dump of this name in the directory, all frames in it.
    pub dump: Option<(PathBuf, DumpBox)>,
    /// Pictures of the last state, named after what they show.
    pub pictures: Vec<PictureOptions>,
    /// Of the numbers, which VTU files say.
    pub units: UnitSystem,
}

impl Default for SeriesOptions {
    fn default() -> Self {
        SeriesOptions {
            points: true,
            cells: Arc::default(),
            bonds: false,
            dump: None,
            pictures: vec![PictureOptions::default()],
            units: UnitSystem::default(),
        }
    }
}

impl SeriesOptions {
    /// Are the cells of meshes written beside the points?
    pub fn writes_cells(&self) -> bool {
        self.points && !self.cells.is_empty()
    }
}

/// Writes snapshots into a directory. Whatever happens, each file there is whole, and the collections list
/// exactly the files of this run: frames that those of an earlier run list are removed at the start.
#[derive(Debug)]
pub struct Series {
    dir: PathBuf,
    options: SeriesOptions,
    points: Pvd,
    cells: Pvd,
    bonds: Pvd,
    /// The dump and the step of its last frame.
    dump: Option<(Grown, Option<u64>)>,
    /// One for each picture that asks for it.
    films: Vec<Option<Film>>,
    /// Films are drawn short.
    hurried: bool,
    /// Frames there that are not of this run.
    strange: Vec<String>,
}

impl Owner for Series {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        for list in [&mut self.points, &mut self.cells, &mut self.bonds] {
            archive.part("frames", list);
        }
        archive.given("dump", &mut self.dump, |(file, step), archive| {
            archive.part("file", file);
            archive.one("step", step);
        });
        for film in self.films.iter_mut().flatten() {
            archive.part("film", film);
        }
    }
}

impl Series {
    /// Creates the directory and its parents; frames of an earlier run are removed.
    pub fn new(dir: impl Into<PathBuf>, options: SeriesOptions) -> Result<Self, WriteError> {
        let dir = dir.into();
        create_directory(&dir)?;
        let mut strange = vec![];
        for kind in KINDS {
            strange.extend(sweep_frames(&dir, kind, &[])?);
        }
        let dump = |path: &Path| Grown::create(path, b"");
        Self::made(dir, options, strange, dump, Film::new)
    }

    /// The series of a run that goes on; its state must be read, and [`rewind`](Series::rewind) called, before a snapshot comes.
    pub fn reopen(dir: impl Into<PathBuf>, options: SeriesOptions) -> Result<Self, WriteError> {
        Self::made(dir.into(), options, vec![], Grown::open, Film::reopen)
    }

    fn made(
        dir: PathBuf,
        options: SeriesOptions,
        strange: Vec<String>,
        dump: impl Fn(&Path) -> Result<Grown, WriteError>,
        film: impl Fn(&Path) -> Result<Film, WriteError>,
    ) -> Result<Self, WriteError> {
        let [points, cells, bonds] = KINDS.map(|kind| Pvd::new(dir.join(format!("{kind}.pvd"))));
        let dump = match &options.dump {
            Some((name, _)) => Some((dump(&dir.join(name))?, None)),
            None => None,
        };
        let films = options.pictures.iter().enumerate().map(|(n, p)| {
            let waiting = dir.join(CHECKPOINT).join(format!("film_{n}.{WAITING}"));
            p.film.map(|_| film(&waiting)).transpose()
        });
        Ok(Series {
            hurried: false,
            films: films.collect::<Result<_, _>>()?,
            strange,
            dir,
            options,
            points,
            cells,
            bonds,
            dump,
        })
    }

    /// Takes away what came after the state that was read; this is the snapshot of that state, of which only films see anything.
    ///
    /// # Errors
    /// The operating system's; what is left is not what was written.
    pub fn rewind(&mut self, now: &Snapshot) -> Result<(), WriteError> {
        for (kind, list) in KINDS.iter().zip([&self.points, &self.cells, &self.bonds]) {
            let kept: Vec<&str> = list.files().collect();
            sweep_frames(&self.dir, kind, &kept)?;
            list.holds()?;
            if !kept.is_empty() {
                list.write()?;
            }
        }
        if let Some((dump, _)) = &mut self.dump {
            dump.rewind()?;
        }
        for (film, picture) in self.films.iter_mut().zip(&self.options.pictures) {
            if let Some(film) = film {
                film.rewind(now, picture)?;
            }
        }
        Ok(())
    }

    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// What to say about frames there that are not of this run.
    pub fn strange(&self) -> Option<String> {
        told(&self.dir, &self.strange)
    }

    /// Does it need snapshots of all frames?
    pub fn wants_frames(&self) -> bool {
        let options = &self.options;
        let films = self.films.iter().any(Option::is_some);
        options.points || options.bonds || options.dump.is_some() || films
    }

    /// Is a frame nothing but its points, which ranks can write together ([`shares`])?
    pub fn is_of_points(&self) -> bool {
        let options = &self.options;
        let films = self.films.iter().any(Option::is_some);
        let more = options.writes_cells() || options.bonds || options.dump.is_some() || films;
        options.points && !more
    }

    /// Lets ranks write the points of a frame, of which `ask` brings their answers; false: they do not, or not all of them see the folder.
    ///
    /// # Errors
    /// As of [`Series::write`], of any rank.
    pub fn write_shares(
        &mut self,
        (step, time): (u64, f64),
        ask: impl FnOnce(&str) -> Option<Vec<Vec<u8>>>,
    ) -> Result<bool, WriteError> {
        let name = frame_of_points(step);
        let Some(seal) = shares::write_frame(&self.dir.join(&name), self.options.units, ask)?
        else {
            return Ok(false);
        };
        self.points.push(time, &name, seal)?;
        Ok(true)
    }

    /// Writes all files of a snapshot. One of the same step is replaced, but the dump keeps the first.
    pub fn write(&mut self, s: &Snapshot, bodies: &[Placed]) -> Result<(), WriteError> {
        let units = self.options.units;
        if self.options.points {
            let name = frame_of_points(s.step);
            let seal = write_sealed(&self.dir.join(&name), |w| write_points(w, s, units))?;
            self.points.push(s.time, &name, seal)?;
        }
        if self.options.writes_cells() {
            let name = format!("cells_{:08}.vtu", s.step);
            let cells = &self.options.cells;
            let seal = write_sealed(&self.dir.join(&name), |w| write_cells(w, s, cells, units))?;
            self.cells.push(s.time, &name, seal)?;
        }
        if self.options.bonds {
            let name = format!("bonds_{:08}.vtu", s.step);
            let seal = write_sealed(&self.dir.join(&name), |w| write_bonds(w, s, units))?;
            self.bonds.push(s.time, &name, seal)?;
        }
        if let (Some((dump, last)), Some((_, cell))) = (&mut self.dump, &self.options.dump)
            && *last != Some(s.step)
        {
            dump.push(|mut w| write_frame(&mut w, s, cell))?;
            *last = Some(s.step);
        }
        for (film, picture) in self.films.iter_mut().zip(&self.options.pictures) {
            if let Some(film) = film {
                film.push(s, bodies, picture)?;
            }
        }
        Ok(())
    }

    /// The run was ended from outside, and who ended it does not wait long: films are drawn of fewer frames. Are there any?
    pub fn hurry(&mut self) -> bool {
        self.hurried = true;
        self.films.iter().any(Option::is_some)
    }

    /// Are there pictures or films, for which points must be in one place?
    pub fn draws(&self) -> bool {
        !self.options.pictures.is_empty()
    }

    /// Draws the last snapshot with the rigid bodies beside it, as pictures were asked for; returns their paths.
    pub fn finish(
        self,
        last: &Snapshot,
        bodies: &[Placed],
        about: About,
    ) -> Result<Vec<PathBuf>, WriteError> {
        if let Some((dump, _)) = self.dump {
            dump.finish()?;
        }
        let mut paths = vec![];
        let films = self.films.iter().flatten().count().max(1) as u32;
        for (options, film) in self.options.pictures.iter().zip(self.films) {
            let path = self.dir.join(format!("{}.png", options.stem(about)));
            let begun = Instant::now();
            picture::write(&path, last, bodies, options, about)?;
            // a frame of a film is smaller
            let each = begun.elapsed().max(Duration::from_millis(1));
            let most = (HURRY / films).as_secs_f64() / each.as_secs_f64();
            paths.push(path);
            if let (Some(film), Some(format)) = (film, options.film) {
                let stem = options.stem(About::Motion);
                let name = format!("{stem}_film.{}", format.ending());
                let path = self.dir.join(name);
                film.finish(
                    &path,
                    options.field(About::Motion),
                    options,
                    options.scale_of(last, about),
                    (format, self.hurried.then_some(most as usize)),
                )?;
                paths.push(path);
            }
        }
        Ok(paths)
    }
}

fn frame_of_points(step: u64) -> String {
    format!("points_{step:08}.vtu")
}

#[cfg(test)]
mod tests {
    use super::super::fields::tests::{small, with};
    use super::super::vtu::tests::floats;
    use super::*;
    use peridyne::observe::Values;

    fn names(dir: &Path) -> Vec<String> {
        let entries = std::fs::read_dir(dir).unwrap();
        let mut names: Vec<String> = entries
            .map(|e| e.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn every_file_asked_for_is_there_and_no_other() {
        let dir = tempfile::tempdir().unwrap();
        let out = dir.path().join("a/b");
        let options = SeriesOptions {
            bonds: true,
            dump: Some(("plate.dump".into(), DumpBox::default())),
            ..Default::default()
        };
        let mut series = Series::new(&out, options).unwrap();
        series.write(&small(), &[]).unwrap();
        let later = Snapshot {
            step: 12,
            time: 2e-7,
            ..with(small(), "damage", Values::Scalars(vec![0.5; 3]))
        };
        series.write(&later, &[]).unwrap();
        series.write(&later, &[]).unwrap();
        assert_eq!(
            series.finish(&later, &[], About::Fracture).unwrap(),
            [out.join("damage.png")]
        );
        let files = [
            "bonds.pvd",
            "bonds_00000007.vtu",
            "bonds_00000012.vtu",
            "damage.png",
            "plate.dump",
            "points.pvd",
            "points_00000007.vtu",
            "points_00000012.vtu",
        ];
        assert_eq!(names(&out), files);
        let dump = std::fs::read_to_string(out.join("plate.dump")).unwrap();
        assert_eq!(dump.matches("ITEM: ATOMS").count(), 2);
        let pvd = std::fs::read_to_string(out.join("points.pvd")).unwrap();
        assert_eq!(pvd.matches("<DataSet").count(), 2);
        assert_eq!(
            floats(
                &std::fs::read(out.join("points_00000012.vtu")).unwrap(),
                "damage"
            ),
            [0.5; 3]
        );
    }

    #[test]
    fn frames_of_an_earlier_run_with_another_schedule_are_gone() {
        let dir = tempfile::tempdir().unwrap();
        let run = |steps: &[u64]| {
            let mut series = Series::new(dir.path(), SeriesOptions::default()).unwrap();
            for step in steps {
                let frame = Snapshot {
                    step: *step,
                    ..small()
                };
                series.write(&frame, &[]).unwrap();
            }
            series.strange()
        };
        assert_eq!(run(&[0, 50, 100]), None);
        std::fs::write(dir.path().join("points_00000007.vtu"), "not listed").unwrap();
        let told = run(&[0, 40, 80]).unwrap();
        assert!(
            told.starts_with("1 frame ") && told.contains("points_00000007.vtu"),
            "{told}"
        );
        let files = [
            "points.pvd",
            "points_00000000.vtu",
            "points_00000007.vtu",
            "points_00000040.vtu",
            "points_00000080.vtu",
        ];
        assert_eq!(names(dir.path()), files);
    }

    #[test]
    fn a_snapshot_that_cannot_be_written_is_not_listed() {
        let dir = tempfile::tempdir().unwrap();
        let mut series = Series::new(dir.path(), SeriesOptions::default()).unwrap();
        series.write(&small(), &[]).unwrap();
        let bad = Snapshot {
            step: 8,
            ..with(small(), "velocity", Values::Vectors(vec![[0.0; 3]]))
        };
        let text = series.write(&bad, &[]).unwrap_err().to_string();
        assert!(
            text.contains("points_00000008.vtu") && text.contains("1 values of velocity"),
            "{text}"
        );
        assert_eq!(names(dir.path()), ["points.pvd", "points_00000007.vtu"]);
    }
}
