//! Frames that ranks write together: each its share of the points, at its place in one file, so that nobody has all of them. The bytes are those of one process.

use super::atomic::{WriteError, write_file};
use super::grown::Seal;
use super::vtu::{self, Part};
use crate::deck::{Constants, UnitSystem};
use crc32fast::Hasher;
use peridyne::observe::Snapshot;
use peridyne::run::ranks::Share;
use std::fs::File;
use std::io;
use std::path::Path;

/// Writes a rank's share of a frame as [`write_frame`] asks, which says units and name of a file that is there; answers for it.
pub fn write_share(asked: &str, frame: &Snapshot, share: Share) -> Vec<u8> {
    let (units, name) = asked.split_once(' ').unwrap_or(("", asked));
    let units = UNITS
        .iter()
        .find(|of| of.0 == units)
        .map_or(UnitSystem::None, |of| of.1);
    let written = File::options().write(true).open(name).and_then(|mut file| {
        let parts = vtu::write_share(&mut file, frame, units, share)?;
        file.sync_all()?;
        Ok(parts)
    });
    match written {
        Ok(parts) => {
            let words = { parts.iter() }.flat_map(|p| [p.at, p.seal.length, p.seal.sum.into()]);
            let bytes = words.flat_map(u64::to_le_bytes);
            [WRITTEN].into_iter().chain(bytes).collect()
        }
        Err(e) if e.kind() == io::ErrorKind::NotFound => vec![NOT_SEEN],
        Err(e) => [&[FAILED], e.to_string().as_bytes()].concat(),
    }
}

/// Units of a frame in a word.
const UNITS: [(&str, UnitSystem); 3] = [
    ("si", UnitSystem::Si),
    // units of columns are those of any constants
    ("metal", UnitSystem::Metal(Constants::Codata2018)),
    ("none", UnitSystem::None),
];

fn word(units: UnitSystem) -> &'static str {
    match units {
        UnitSystem::Si => "si",
        UnitSystem::Metal(_) => "metal",
        UnitSystem::Lj | UnitSystem::None => "none",
    }
}

/// What the answer of a rank begins with: it has written these parts, it does not see the file, it could not write.
const WRITTEN: u8 = 0;
const NOT_SEEN: u8 = 1;
const FAILED: u8 = 2;

/// Lets ranks write a frame into a file, `ask` told its units and name for the time being; `None`: `ask` says that there are none, or not all of them see the folder.
///
/// # Errors
/// As of [`write_file`], of any rank.
pub fn write_frame(
    path: &Path,
    units: UnitSystem,
    ask: impl FnOnce(&str) -> Option<Vec<Vec<u8>>>,
) -> Result<Option<Seal>, WriteError> {
    let mut seal = None;
    let mut left = false;
    let written = write_file(path, |w| {
        let name = w
            .get_ref()
            .path()
            .to_str()
            .filter(|name| !name.contains('\n'));
        let said = name.and_then(|name| ask(&format!("{} {name}", word(units))));
        seal = said.map(|said| joined(&said)).transpose()?.flatten();
        left = seal.is_none();
        match left {
            // what was there before stays
            true => Err(io::ErrorKind::Interrupted.into()),
            false => Ok(()),
        }
    });
    match left {
        true => Ok(None),
        false => written.map(|()| seal),
    }
}

/// The seal of the whole file; `None`: a rank does not see it.
fn joined(said: &[Vec<u8>]) -> io::Result<Option<Seal>> {
    let mut parts = vec![];
    for (rank, said) in said.iter().enumerate() {
        match said.split_first() {
            Some((&WRITTEN, words)) => {
                let words = words.as_chunks().0.iter().copied().map(u64::from_le_bytes);
                let words: Vec<u64> = words.collect();
                parts.extend(words.as_chunks().0.iter().map(|[at, length, sum]| Part {
                    at: *at,
                    seal: Seal {
                        length: *length,
                        sum: *sum as u32,
                    },
                }));
            }
            Some((&NOT_SEEN, _)) => return Ok(None),
            Some((_, why)) => {
                let why = String::from_utf8_lossy(why);
                return Err(io::Error::other(format!("rank {rank}: {why}")));
            }
            None => return Err(io::Error::other(format!("rank {rank} says nothing"))),
        }
    }
    parts.sort_by_key(|part| part.at);
    let mut all = Hasher::new();
    let mut length = 0;
    for part in parts {
        if part.at != length {
            return Err(io::Error::other(format!(
                "nobody wrote from byte {length} on"
            )));
        }
        length += part.seal.length;
        all.combine(&Hasher::new_with_initial_len(
            part.seal.sum,
            part.seal.length,
        ));
    }
    let sum = all.finalize();
    Ok(Some(Seal { length, sum }))
}

#[cfg(test)]
mod tests {
    use super::super::fields::tests::small;
    use super::super::grown::write_sealed;
    use super::*;
    use peridyne::observe::{Column, Values};

    /// Points of a snapshot with these ids.
    fn part(s: &Snapshot, of: std::ops::Range<usize>) -> Snapshot {
        let values = |values: &Values| match values {
            Values::Scalars(v) => Values::Scalars(v[of.clone()].to_vec()),
            Values::Vectors(v) => Values::Vectors(v[of.clone()].to_vec()),
            Values::Symmetric(v) => Values::Symmetric(v[of.clone()].to_vec()),
            Values::Tensors(v) => Values::Tensors(v[of.clone()].to_vec()),
            Values::Integers(v) => Values::Integers(v[of.clone()].to_vec()),
            Values::Counts(v) => Values::Counts(v[of.clone()].to_vec()),
        };
        let columns = s.columns.iter().map(|c| Column {
            values: values(&c.values),
            ..c.clone()
        });
        Snapshot {
            columns: columns.collect(),
            reference: s.reference[of.clone()].to_vec(),
            ..s.clone()
        }
    }

    #[test]
    fn shares_make_the_file_of_one_process() {
        let dir = tempfile::tempdir().unwrap();
        let (one, many) = (dir.path().join("one.vtu"), dir.path().join("many.vtu"));
        let mut s = small();
        s.bonds = None;
        let seal = write_sealed(&one, |w| vtu::write_points(w, &s, UnitSystem::Si)).unwrap();
        let points = s.reference.len();
        for cuts in [vec![0, 3, 3, 3], vec![0, 1, 2, 3], vec![0, 2, 3, 3]] {
            let said = |name: &str| {
                let own = cuts.windows(2).map(|ends| {
                    let share = Share {
                        first: ends[0],
                        points,
                    };
                    write_share(name, &part(&s, ends[0]..ends[1]), share)
                });
                Some(own.collect())
            };
            assert_eq!(
                write_frame(&many, UnitSystem::Si, said).unwrap(),
                Some(seal)
            );
            let [a, b] = [&one, &many].map(|path| std::fs::read(path).unwrap());
            assert_eq!(a, b);
            seal.holds(&many).unwrap();
        }
    }

    #[test]
    fn what_not_all_ranks_write_is_not_there() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("frame.vtu");
        std::fs::write(&path, "of before").unwrap();
        let whole = Share {
            first: 0,
            points: 3,
        };
        let s = Snapshot {
            bonds: None,
            ..small()
        };
        let written = |name: &str| write_share(name, &s, whole);
        let elsewhere = |_: &str| write_share("si /nowhere/frame.vtu", &s, whole);
        let none = write_frame(&path, UnitSystem::Si, |name| {
            Some(vec![written(name), elsewhere(name)])
        });
        assert_eq!(none.unwrap(), None);
        assert_eq!(write_frame(&path, UnitSystem::Si, |_| None).unwrap(), None);
        let full = |name: &str| Some(vec![written(name), b"\x02disk full".to_vec()]);
        let text = write_frame(&path, UnitSystem::Si, full)
            .unwrap_err()
            .to_string();
        assert!(
            text.contains("frame.vtu") && text.ends_with("rank 1: disk full"),
            "{text}"
        );
        let half = |name: &str| {
            let second = Share { first: 1, ..whole };
            Some(vec![write_share(name, &part(&s, 1..3), second)])
        };
        let text = write_frame(&path, UnitSystem::Si, half)
            .unwrap_err()
            .to_string();
        assert!(text.contains("nobody wrote from byte 0 on"), "{text}");
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "of before");
        assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 1);
    }
}
