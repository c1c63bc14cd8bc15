//! All frames of a file of atoms, one after the other: a trajectory does not fit in memory. Text or packed by gzip; boxes may be tilted.

use super::atoms::{Atoms, Tilted};
use super::error::ReadError;
use super::stream::{Source, Stream};
use super::{data, dump, extxyz};
use std::path::{Path, PathBuf};

/// Kinds of files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Extended,
    Dump,
    /// One state.
    Data,
}

/// Frames of a file, from the first on.
pub struct Frames {
    kind: Kind,
    path: PathBuf,
    stream: Option<Stream<Source>>,
}

impl Frames {
    /// Opens a file by its extension (`.gz` may follow): `.extxyz` and `.xyz`, `.lammpstrj` and `.dump`, `.data` and `.lmp`; any other name
    /// by its first line.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn open(path: &Path) -> Result<Frames, ReadError> {
        let name = path.file_name().and_then(|n| n.to_str()).unwrap_or("");
        let name = name.to_lowercase();
        let plain = name.strip_suffix(".gz").unwrap_or(&name);
        let kind = match plain.rsplit_once('.').map(|(_, e)| e) {
            Some("extxyz" | "xyz") => Kind::Extended,
            Some("lammpstrj" | "dump") => Kind::Dump,
            Some("data" | "lmp") => Kind::Data,
            Some(_) | None => guess(path)?,
        };
        let stream = match kind {
            Kind::Data => None,
            Kind::Extended | Kind::Dump => Some(Stream::open(path)?),
        };
        Ok(Frames {
            kind,
            path: path.to_path_buf(),
            stream,
        })
    }

    /// The next frame; `None` after the last.
    ///
    /// # Errors
    /// File and line of the first mistake.
    pub fn next_frame(&mut self) -> Result<Option<Atoms>, ReadError> {
        match (self.kind, &mut self.stream) {
            (Kind::Data, _) => {
                if self.path.as_os_str().is_empty() {
                    return Ok(None);
                }
                data::data(&std::mem::take(&mut self.path)).map(Some)
            }
            (_, None) => Ok(None),
            (Kind::Dump, Some(stream)) => match dump::head(stream, Tilted::Taken)? {
                Some(head) => dump::frame(stream, head).map(Some),
                None => Ok(None),
            },
            (Kind::Extended, Some(stream)) => {
                let Some(count) = extxyz::next_frame(stream)? else {
                    return Ok(None);
                };
                stream.expect(|| "the line with Lattice and Properties is missing".into())?;
                let head = extxyz::Head::read(stream, Tilted::Taken)?;
                extxyz::frame(stream, count, head).map(Some)
            }
        }
    }

    /// Number of frames of a file, which is read to its end.
    ///
    /// # Errors
    /// File and line where it is damaged or cut off.
    pub fn count(path: &Path) -> Result<usize, ReadError> {
        match Frames::open(path)?.kind {
            Kind::Data => Ok(1),
            Kind::Dump => dump::frames(path),
            Kind::Extended => extxyz::frames(path),
        }
    }
}

/// By the first line.
fn guess(path: &Path) -> Result<Kind, ReadError> {
    let mut stream = Stream::open(path)?;
    let line = stream.next()?.unwrap_or("").trim().to_string();
    if line.starts_with("ITEM:") {
        Ok(Kind::Dump)
    } else if line.parse::<usize>().is_ok() {
        Ok(Kind::Extended)
    } else {
        Err(stream.whole(
            "it is no file of atoms that is known: extended XYZ (.extxyz), a LAMMPS text dump (.lammpstrj) or data file (.data), each also packed (.gz)",
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::Compression;
    use flate2::write::GzEncoder;
    use std::io::Write;

    const TILTED: &str = "ITEM: TIMESTEP\n7\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS xy xz yz pp pp ff\n-0.5 6 1\n0 5 -0.5\n0 6 1\nITEM: ATOMS id type xs ys zs\n2 1 0.5 0.5 0.5\n1 1 0 0 0\n";

    fn all(path: &Path) -> Result<Vec<Atoms>, ReadError> {
        let mut frames = Frames::open(path)?;
        let mut found = vec![];
        while let Some(atoms) = frames.next_frame()? {
            found.push(atoms);
        }
        Ok(found)
    }

    fn pack(text: &str) -> Vec<u8> {
        let mut packed = GzEncoder::new(vec![], Compression::default());
        packed.write_all(text.as_bytes()).unwrap();
        packed.finish().unwrap()
    }

    #[test]
    fn tilted_boxes_and_scaled_coordinates_plain_and_packed() {
        let dir = tempfile::tempdir().unwrap();
        let two = format!("{TILTED}{TILTED}");
        for (name, bytes) in [
            ("a.dump", two.clone().into_bytes()),
            ("b.lammpstrj.gz", pack(&two)),
            ("c", pack(&two)),
        ] {
            let path = dir.path().join(name);
            std::fs::write(&path, bytes).unwrap();
            assert_eq!(Frames::count(&path).unwrap(), 2);
            let found = all(&path).unwrap();
            assert_eq!(found.len(), 2);
            let atoms = &found[1];
            // xlo = -0.5 - min(0, 1, -0.5, 0.5) = 0, xhi = 6 - 1
            assert_eq!((atoms.low, atoms.high), ([0.0, 0.0, 0.0], [5.0, 4.0, 6.0]));
            let edges = [[5.0, 0.0, 0.0], [1.0, 4.0, 0.0], [-0.5, 1.0, 6.0]];
            assert_eq!(atoms.edges, Some(edges));
            assert_eq!(atoms.position, [[0.0; 3], [2.75, 2.5, 3.0]]);
            assert_eq!(atoms.periodic, [true, true, false]);
        }
    }

    #[test]
    fn any_lattice_of_extended_xyz() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.xyz");
        std::fs::write(&path, "1\nLattice=\"2 0 0 1 2 0 0 0 2\" Origin=\"1 0 0\" Properties=species:S:1:pos:R:3\nCu 0 0 0\n").unwrap();
        let atoms = &all(&path).unwrap()[0];
        assert_eq!(
            atoms.edges,
            Some([[2.0, 0.0, 0.0], [1.0, 2.0, 0.0], [0.0, 0.0, 2.0]])
        );
        assert_eq!(atoms.low, [1.0, 0.0, 0.0]);
    }

    #[test]
    fn what_is_damaged_is_told() {
        let dir = tempfile::tempdir().unwrap();
        let whole = pack(&TILTED.repeat(50));
        for (name, bytes, part) in [
            (
                "cut.dump.gz",
                whole[..whole.len() / 2].to_vec(),
                "damaged or cut off",
            ),
            (
                "short.dump",
                TILTED.as_bytes()[..TILTED.len() - 12].to_vec(),
                "1 of 2 atoms",
            ),
            ("a.pdf", b"%PDF".to_vec(), "no file of atoms"),
        ] {
            let path = dir.path().join(name);
            std::fs::write(&path, bytes).unwrap();
            let error = Frames::count(&path).unwrap_err().to_string();
            assert!(error.contains(part), "{name}: {error}");
        }
        let mut bytes = whole.clone();
        let middle = bytes.len() / 2;
        bytes[middle] ^= 0xff;
        let path = dir.path().join("bits.dump.gz");
        std::fs::write(&path, bytes).unwrap();
        assert!(all(&path).is_err());
    }
}
