//! Everything a run writes of its points, one object: files per snapshot, collections, the last picture.

use std::path::{Path, PathBuf};

use peridyne::observe::Snapshot;

use super::atomic::{WriteError, create_directory, write_file};
use super::dump::{DumpBox, write_frame};
use super::picture::{self, PictureOptions};
use super::pvd::Pvd;
use super::trajectory::Frames;
use super::vtu::{write_bonds, write_points};

/// Which files a series writes.
#[derive(Debug, Clone, PartialEq)]
pub struct SeriesOptions {
    /// `points_<step>.vtu` and `points.pvd`.
    pub points: bool,
    /// `bonds_<step>.vtu` and `bonds.pvd`; the snapshots must carry bonds.
    pub bonds: bool,
    /// A LAMMPS dump of this name in the directory, all frames in it.
    pub dump: Option<(PathBuf, DumpBox)>,
    /// `damage.png` at the end.
    pub picture: Option<PictureOptions>,
}

impl Default for SeriesOptions {
    fn default() -> Self {
        SeriesOptions {
            points: true,
            bonds: false,
            dump: None,
            picture: Some(PictureOptions::default()),
        }
    }
}

/// Writes snapshots into a directory. Whatever happens, each file there is whole, and the collections list
/// exactly the files of this run: those of an older run in the same directory are replaced where they
/// have the same step, and otherwise left alone.
#[derive(Debug)]
pub struct Series {
    dir: PathBuf,
    options: SeriesOptions,
    points: Pvd,
    bonds: Pvd,
    /// The dump and the step of its last frame.
    dump: Option<(Frames, Option<u64>)>,
}

impl Series {
    /// Creates the directory and its parents.
    pub fn new(dir: impl Into<PathBuf>, options: SeriesOptions) -> Result<Self, WriteError> {
        let dir = dir.into();
        create_directory(&dir)?;
        let (points, bonds) = (
            Pvd::new(dir.join("points.pvd")),
            Pvd::new(dir.join("bonds.pvd")),
        );
        let dump = match &options.dump {
            Some((name, _)) => Some((Frames::create(&dir.join(name))?, None)),
            None => None,
        };
        Ok(Series {
            dir,
            options,
            points,
            bonds,
            dump,
        })
    }

    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// Writes all files of a snapshot. One of the same step is replaced, but the dump keeps the first.
    pub fn write(&mut self, s: &Snapshot) -> Result<(), WriteError> {
        if self.options.points {
            let name = format!("points_{:08}.vtu", s.step);
            write_file(&self.dir.join(&name), |w| write_points(w, s))?;
            self.points.push(s.time, &name)?;
        }
        if self.options.bonds {
            let name = format!("bonds_{:08}.vtu", s.step);
            write_file(&self.dir.join(&name), |w| write_bonds(w, s))?;
            self.bonds.push(s.time, &name)?;
        }
        if let (Some((dump, last)), Some((_, cell))) = (&mut self.dump, &self.options.dump)
            && *last != Some(s.step)
        {
            dump.push(|w| write_frame(w, s, cell))?;
            *last = Some(s.step);
        }
        Ok(())
    }

    /// Draws the last snapshot, if a picture was asked for; returns its path.
    pub fn finish(self, last: &Snapshot) -> Result<Option<PathBuf>, WriteError> {
        if let Some((dump, _)) = self.dump {
            dump.finish()?;
        }
        let Some(options) = &self.options.picture else {
            return Ok(None);
        };
        let path = self.dir.join("damage.png");
        picture::write(&path, last, options)?;
        Ok(Some(path))
    }
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
        series.write(&small()).unwrap();
        let later = Snapshot {
            step: 12,
            time: 2e-7,
            ..with(small(), "damage", Values::Scalars(vec![0.5; 3]))
        };
        series.write(&later).unwrap();
        series.write(&later).unwrap();
        assert_eq!(series.finish(&later).unwrap(), Some(out.join("damage.png")));
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
    fn a_snapshot_that_cannot_be_written_is_not_listed() {
        let dir = tempfile::tempdir().unwrap();
        let mut series = Series::new(dir.path(), SeriesOptions::default()).unwrap();
        series.write(&small()).unwrap();
        let bad = Snapshot {
            step: 8,
            ..with(small(), "velocity", Values::Vectors(vec![[0.0; 3]]))
        };
        let text = series.write(&bad).unwrap_err().to_string();
        assert!(
            text.contains("points_00000008.vtu") && text.contains("1 values of velocity"),
            "{text}"
        );
        assert_eq!(names(dir.path()), ["points.pvd", "points_00000007.vtu"]);
    }
}
