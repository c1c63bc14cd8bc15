//! How much a run would write, against what the disk has left.

use std::path::Path;

use super::picture::film::Film;

/// A frame of a point in a VTU, an Exodus or a VTKHDF file: positions and vectors as f64, scalars, ids (bytes).
const POINT: f64 = 120.0;
/// A corner of a mesh's cell in a VTU: its place and number.
const CORNER: f64 = 32.0;
/// An undirected bond in a VTU: two ids, offset, type.
const BOND: f64 = 17.0;
/// An atom in a text trajectory: three vectors and an energy in full digits.
const ATOM: f64 = 160.0;
/// A row of `history.csv`, and each of its columns that a probe adds.
const ROW: f64 = 200.0;
const CELL: f64 = 20.0;
/// A number in a text that keeps all its digits.
const NUMBER: f64 = 20.0;
/// A frame of a film as a picture.
const PICTURE: f64 = 100e3;

/// What a run writes again and again.
#[derive(Debug, Clone, Copy)]
pub struct Amount {
    pub steps: u64,
    /// Steps between frames; `None`: first and last.
    pub every: Option<u64>,
    /// Steps between rows.
    pub history: u64,
    pub points: u64,
    /// Files that have all points of a frame: VTU, Exodus, VTKHDF.
    pub files: u64,
    /// Corners of the cells of meshes, where they are written.
    pub corners: u64,
    /// Undirected bonds, where they are written.
    pub bonds: u64,
    /// Atoms of all trajectories.
    pub atoms: u64,
    /// Numbers of a point in the dump of points; 0: there is none.
    pub dump: u64,
    /// Films, and how many of them have arrows.
    pub films: u64,
    pub arrows: u64,
    /// Columns of probes in the history.
    pub probes: u64,
}

impl Amount {
    /// About how many bytes frames of files of all points and trajectories, of the dump of points, of films (as they wait and as they are
    /// drawn), and rows of the history take.
    pub fn bytes(&self) -> [f64; 4] {
        let frames = self
            .every
            .map_or(2.0, |e| self.steps as f64 / e as f64 + 1.0);
        let points = (self.files * self.points) as f64;
        let frame = POINT * points
            + CORNER * self.corners as f64
            + BOND * self.bonds as f64
            + ATOM * self.atoms as f64;
        let film = self.films as f64 * (PICTURE + Film::bytes(self.points, false))
            + self.arrows as f64
                * (Film::bytes(self.points, true) - Film::bytes(self.points, false));
        [
            frames * frame,
            frames * dump_frame(self.points, self.dump),
            frames * film,
            self.steps as f64 / self.history as f64 * (ROW + CELL * self.probes as f64),
        ]
    }
}

/// A frame of a text dump of so many points with so many numbers each (bytes).
pub fn dump_frame(points: u64, numbers: u64) -> f64 {
    NUMBER * points as f64 * numbers as f64
}

/// Bytes that the disk of a folder has left, which need not exist yet; `None` where the system does not say.
#[cfg(unix)]
pub fn free(folder: &Path) -> Option<f64> {
    // the folder of a plain name is the current one
    let folder = match folder.as_os_str().is_empty() {
        true => Path::new("."),
        false => folder,
    };
    let absolute = std::path::absolute(folder).ok()?;
    let stat = absolute
        .ancestors()
        .find_map(|dir| rustix::fs::statvfs(dir).ok())?;
    Some(stat.f_bavail as f64 * stat.f_frsize as f64)
}

/// Bytes that the disk of a folder has left; `None`: the system does not say.
#[cfg(not(unix))]
pub fn free(_: &Path) -> Option<f64> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_and_rows_are_counted() {
        let amount = Amount {
            steps: 1000,
            every: Some(10),
            history: 5,
            points: 100,
            files: 1,
            corners: 8,
            bonds: 0,
            atoms: 0,
            dump: 10,
            films: 2,
            arrows: 1,
            probes: 3,
        };
        let [frames, dump, films, rows] = amount.bytes();
        assert_eq!([frames, rows], [101.0 * 12_256.0, 200.0 * 260.0]);
        assert_eq!(dump, 101.0 * 100.0 * 10.0 * 20.0);
        // four numbers of four bytes wait for each point, seven with arrows
        assert_eq!(films, 101.0 * (200e3 + 1600.0 + 2800.0));
        let ends = Amount {
            every: None,
            ..amount
        };
        assert_eq!(ends.bytes()[0], 24_512.0);
    }

    #[cfg(unix)]
    #[test]
    fn a_folder_that_does_not_exist_yet_has_the_space_of_its_disk() {
        let dir = tempfile::tempdir().unwrap();
        assert!(free(&dir.path().join("a/b/c")).unwrap() > 0.0);
    }

    #[cfg(unix)]
    #[test]
    fn the_folder_of_a_plain_name_has_room() {
        assert!(free(Path::new("")).is_some());
    }
}
