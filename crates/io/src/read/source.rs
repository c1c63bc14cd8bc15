//! The one door through which files come in: plain files only (a folder, device or pipe may have no end), what is read whole weighed
//! before it is asked for, lines and counts that end. What came in is remembered, so that no output takes its place.

use std::fs::{File, Metadata};
use std::io::{self, ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use peridyne::error::size;
use peridyne::execute::memory::{afford, available};

/// Bytes that are read of a file that does not say its length, as those of the kernel.
const UNTOLD: u64 = 16 << 20;
/// Bytes that a text takes for each of its own, with what is made of it.
const MADE: f64 = 2.0;

/// Opens a plain file.
///
/// # Errors
/// The operating system's; it is something else than a plain file.
pub fn open(path: &Path) -> io::Result<File> {
    // looked at before it is opened: a pipe without a writer would never open
    if !std::fs::metadata(path)?.is_file() {
        let what = "it is a folder, device or pipe: give the name of a plain file";
        return Err(io::Error::new(ErrorKind::InvalidInput, what));
    }
    let file = File::open(path)?;
    let mut known = known();
    known.places.extend(path.canonicalize());
    known.read.push(identity(&file.metadata()?));
    // of a link, the link too
    known.read.push(identity(&path.symlink_metadata()?));
    Ok(file)
}

/// Opens what a command line names itself, which may be the pipe that a shell makes: `/dev/stdin`, `<(…)`.
///
/// # Errors
/// As [`open`].
pub fn open_given(path: &Path) -> io::Result<File> {
    let piped = ["/dev/stdin", "/dev/fd", "/proc/self/fd"];
    match piped.iter().any(|p| path.starts_with(p)) {
        true => File::open(path),
        false => open(path),
    }
}

/// A whole file.
///
/// # Errors
/// As [`open`]; it is larger than memory.
pub fn bytes(path: &Path) -> io::Result<Vec<u8>> {
    let file = open(path)?;
    let told = file.metadata()?.len();
    room("a file of this size", MADE * told as f64)?;
    within(file, told.max(UNTOLD))
}

/// A whole file of at most so many bytes.
///
/// # Errors
/// The operating system's; there are more.
pub fn within(file: impl Read, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = vec![];
    file.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
    match bytes.len() as u64 > most {
        true => Err(io::Error::new(
            ErrorKind::InvalidData,
            format!("it is larger than {}", size(most as f64)),
        )),
        false => Ok(bytes),
    }
}

/// Do so many bytes fit into memory? `what` is what takes them.
///
/// # Errors
/// They do not: how many there would be, and how many are left.
pub fn room(what: &str, bytes: f64) -> io::Result<()> {
    let wrong = |text: String| io::Error::new(ErrorKind::OutOfMemory, text);
    if !bytes.is_finite() {
        return Err(wrong(format!("{what} cannot be counted")));
    }
    afford("memory", what, bytes, "").map_err(|e| wrong(e.message.to_string()))
}

/// Bytes that memory has left, where the system says it.
pub fn left() -> Option<f64> {
    available()
}

/// What tells two files apart, whatever their names: numbers are given again to new files, which were made later.
#[cfg(unix)]
type Identity = (u64, u64, Option<std::time::SystemTime>);

#[cfg(unix)]
fn identity(of: &Metadata) -> Identity {
    use std::os::unix::fs::MetadataExt;
    (of.dev(), of.ino(), of.created().ok())
}

/// Without numbers of files: when it was made and how long it is.
#[cfg(not(unix))]
type Identity = (Option<std::time::SystemTime>, u64);

#[cfg(not(unix))]
fn identity(of: &Metadata) -> Identity {
    (of.created().ok(), of.len())
}

/// Files that this process has read, and those that it has made.
struct Known {
    read: Vec<Identity>,
    made: Vec<Identity>,
    /// Where those lie that were read.
    places: Vec<PathBuf>,
}

static KNOWN: Mutex<Known> = Mutex::new(Known {
    read: vec![],
    made: vec![],
    places: vec![],
});

fn known() -> MutexGuard<'static, Known> {
    KNOWN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Would a file of this name take the place of one that was read? (Not of one that this process has made itself.)
pub fn was_read(path: &Path) -> bool {
    let there = [path.symlink_metadata(), path.metadata()];
    let known = known();
    there.into_iter().flatten().any(|of| {
        let of = identity(&of);
        known.read.contains(&of) && !known.made.contains(&of)
    })
}

/// Lets a file be made in this place.
///
/// # Errors
/// It would replace a file that was read.
pub fn replaceable(path: &Path) -> io::Result<()> {
    match was_read(path) {
        true => Err(kept()),
        false => Ok(()),
    }
}

/// The error of whoever would replace a file that was read.
pub fn kept() -> io::Error {
    io::Error::new(
        ErrorKind::AlreadyExists,
        "this run has read the file of this name, which is never replaced; give the output another name, or another folder with --out",
    )
}

/// Names of files inside a folder that were read and not made.
pub fn read_inside(dir: &Path) -> Vec<PathBuf> {
    let Ok(home) = dir.canonicalize() else {
        return vec![];
    };
    let places = known().places.clone();
    let inside = places.iter().filter(|path| was_read(path));
    inside
        .filter_map(|path| path.strip_prefix(&home).ok())
        .map(Path::to_path_buf)
        .collect()
}

/// What was done, and where the files lie that were read meanwhile.
pub fn during<T>(work: impl FnOnce() -> T) -> (T, Vec<PathBuf>) {
    let before = known().places.len();
    let done = work();
    (done, known().places[before..].to_vec())
}

/// Files that were read, as [`sums_of`] has them.
pub fn sums() -> Vec<(PathBuf, u32)> {
    let places = known().places.clone();
    sums_of(places)
}

/// Files, each with the CRC-32 of its bytes as they are now, in order of their places. What cannot be read any more is left out.
pub fn sums_of(mut places: Vec<PathBuf>) -> Vec<(PathBuf, u32)> {
    places.sort();
    places.dedup();
    let sum = |path: &PathBuf| -> io::Result<u32> {
        let (mut file, mut sum) = (File::open(path)?, crc32fast::Hasher::new());
        let mut room = vec![0; 1 << 18];
        loop {
            match file.read(&mut room)? {
                0 => return Ok(sum.finalize()),
                count => sum.update(&room[..count]),
            }
        }
    };
    let each = places.into_iter();
    each.filter_map(|path| Some((path.clone(), sum(&path).ok()?)))
        .collect()
}

/// This process has made the file: it may replace it.
pub fn made(file: &File) {
    if let Ok(of) = file.metadata() {
        known().made.push(identity(&of));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_plain_files_come_in() {
        let dir = tempfile::tempdir().unwrap();
        assert!(open(dir.path()).is_err());
        #[cfg(unix)]
        for device in ["/dev/zero", "/dev/null"] {
            let text = bytes(Path::new(device)).unwrap_err().to_string();
            assert!(text.contains("plain file"), "{device}: {text}");
        }
    }

    #[test]
    fn what_was_read_is_not_replaced_and_what_was_made_is() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a");
        std::fs::write(&path, "theirs").unwrap();
        replaceable(&path).unwrap();
        assert_eq!(bytes(&path).unwrap(), b"theirs");
        assert!(replaceable(&path).is_err());
        #[cfg(unix)]
        {
            let link = dir.path().join("link");
            std::os::unix::fs::symlink(&path, &link).unwrap();
            assert!(replaceable(&link).is_err(), "it leads there");
            let hard = dir.path().join("hard");
            std::fs::hard_link(&path, &hard).unwrap();
            assert!(replaceable(&hard).is_err(), "another name of it");
        }
        made(&File::open(&path).unwrap());
        replaceable(&path).unwrap();
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn what_does_not_fit_is_told_in_numbers() {
        let text = room("an array of 10 PB", 1e16).unwrap_err().to_string();
        assert!(
            text.contains("an array of 10 PB would take about"),
            "{text}"
        );
        room("a byte", 1.0).unwrap();
        assert!(room("nothing", f64::INFINITY).is_err());
        // sparse: it takes no disk
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("large");
        File::create(&path).unwrap().set_len(1 << 42).unwrap();
        let error = bytes(&path).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::OutOfMemory);
    }
}
