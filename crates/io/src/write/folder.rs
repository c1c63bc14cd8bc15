//! The folder of a run's results: held by one run at a time, swept of what a killed one left, and the only place
//! that a deck writes to.

use peridyne_comm::launcher::launched;
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Component, Path, PathBuf};

use super::atomic::{self, WriteError, create_directory};

/// A folder that this run holds for itself until the value is dropped or the process ends, however it ends.
#[derive(Debug)]
pub struct Folder {
    _lock: File,
}

impl Folder {
    /// Creates the folder and its parents, locks it, and removes temporaries of runs that were killed.
    ///
    /// # Errors
    /// It cannot be created, or another run holds it.
    pub fn claim(dir: &Path) -> Result<Folder, WriteError> {
        create_directory(dir)?;
        let lock = open(dir).map_err(WriteError::at("lock", dir))?;
        match lock.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                let mut why = "another run writes there".to_string();
                if let Some(launched) = launched().filter(|launched| launched.ranks > 1) {
                    why += &format!(
                        ": {launched}, and each runs alone (PERIDYNE_MPI=off); give each a folder of its own, by --out"
                    );
                }
                let busy = io::Error::new(io::ErrorKind::ResourceBusy, why);
                return Err(WriteError::at("write into", dir)(busy));
            }
            // file systems without locks: as safe as before there were any
            Err(TryLockError::Error(e)) if without_locks(&e) => {}
            Err(TryLockError::Error(e)) => return Err(WriteError::at("lock", dir)(e)),
        }
        sweep(dir).map_err(WriteError::at("remove old temporaries of", dir))?;
        Ok(Folder { _lock: lock })
    }
}

/// What is locked: the folder itself, so that nothing is left behind.
#[cfg(unix)]
fn open(dir: &Path) -> io::Result<File> {
    File::open(dir)
}

/// What is locked, where folders cannot be opened.
#[cfg(not(unix))]
fn open(dir: &Path) -> io::Result<File> {
    File::options()
        .write(true)
        .create(true)
        .truncate(false)
        .open(dir.join("peridyne.lock"))
}

/// Does the file system know no locks? (Network file systems answer EBADF to the lock of a folder, which cannot be
/// opened for writing.)
fn without_locks(error: &io::Error) -> bool {
    const EBADF: i32 = 9;
    error.kind() == io::ErrorKind::Unsupported || error.raw_os_error() == Some(EBADF)
}

/// Removes temporaries: nobody else writes here, so they belong to runs that were killed.
fn sweep(dir: &Path) -> io::Result<()> {
    for entry in fs::read_dir(dir)? {
        let entry = entry?;
        if atomic::is_temporary(&entry.file_name()) && entry.file_type()?.is_file() {
            fs::remove_file(entry.path())?;
        }
    }
    Ok(())
}

/// Does a name stay inside the folder that it is relative to, as far as its letters say: no `..`, no absolute path?
pub fn stays(name: &Path) -> bool {
    let plain = |c: Component| matches!(c, Component::Normal(_) | Component::CurDir);
    name.components().all(plain)
}

/// Files of the results that have fixed names.
const OWN: [&str; 15] = [
    "history.csv",
    "damage.png",
    "displacement.png",
    "velocity.png",
    "run.json",
    "report.html",
    "points.pvd",
    "bonds.pvd",
    "modes.csv",
    "modes",
    "linear_body.npz",
    "frames.npz",
    FILES,
    "peridyne.lock",
    CHECKPOINT,
];

/// What a run goes on from, and what waits in it until it has ended.
pub const CHECKPOINT: &str = "checkpoint";

/// How names of frames of films end that wait there.
pub const WAITING: &str = "frames";

/// What a script has written besides its results: a list of its files.
pub const FILES: &str = "files.json";

/// What names of fields over place and time begin with.
pub const SPACE_TIME: &str = "space_time_";

/// Is this the name of a file of the results that has its name whatever a deck or script says: the history, a frame, a
/// picture, …?
pub fn is_own(name: &Path) -> bool {
    let mut parts = name.components().filter(|c| *c != Component::CurDir);
    let Some(first) = parts.next().and_then(|c| c.as_os_str().to_str()) else {
        return false;
    };
    let frame = |kind: &str| {
        let number = first
            .strip_prefix(kind)
            .and_then(|n| n.strip_suffix(".vtu"));
        number.is_some_and(|n| n.bytes().all(|b| b.is_ascii_digit()))
    };
    let over_time = ["png", "svg", "npz"].iter().any(|end| {
        let stem = first.strip_suffix(end).and_then(|n| n.strip_suffix('.'));
        stem.is_some_and(|n| n.starts_with(SPACE_TIME))
    });
    // of those that are folders, all that is in them
    OWN.contains(&first)
        || parts.next().is_none() && (frame("points_") || frame("bonds_") || over_time)
}

/// A name without the parts that say nothing (`./`).
pub fn plain(name: &Path) -> PathBuf {
    let parts = name.components().filter(|c| *c != Component::CurDir);
    parts.collect()
}

/// Would one of two names take the place of the other, as a file or as a folder that it lies in?
pub fn collide(a: &Path, b: &Path) -> bool {
    let (a, b) = (plain(a), plain(b));
    a.starts_with(&b) || b.starts_with(&a)
}

/// Is `name`, taken from `dir`, a file inside `dir`? It [stays], and no link among the folders on the way leads out. (A
/// link in place of the file itself is replaced, not followed.)
pub fn is_inside(dir: &Path, name: &Path) -> bool {
    if !stays(name) {
        return false;
    }
    // what does not exist yet leads nowhere
    let Ok(home) = dir.canonicalize() else {
        return true;
    };
    let mut folder: PathBuf = home.clone();
    let parents = name.parent().into_iter().flat_map(Path::components);
    for part in parents {
        folder.push(part);
        match folder.canonicalize() {
            Ok(real) if real.starts_with(&home) => {}
            Ok(_) => return false,
            Err(_) => return true,
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_the_results_and_names_that_collide() {
        for name in [
            "history.csv",
            "./run.json",
            "points_00000012.vtu",
            "modes/a.png",
        ] {
            assert!(is_own(Path::new(name)), "{name}");
        }
        for name in ["points_a.vtu", "sub/history.csv", "frames/1.png", "a.dump"] {
            assert!(!is_own(Path::new(name)), "{name}");
        }
        let collide = |a: &str, b: &str| super::collide(Path::new(a), Path::new(b));
        assert!(collide("a", "./a") && collide("a/b", "a") && collide("a", "a/b/c"));
        assert!(!collide("a/b", "a/c") && !collide("ab", "a"));
    }

    #[test]
    fn a_folder_is_held_by_one_run_and_free_again_after_it() {
        let dir = tempfile::tempdir().unwrap();
        let out = dir.path().join("a/b");
        let held = Folder::claim(&out).unwrap();
        let text = Folder::claim(&out).unwrap_err().to_string();
        assert!(text.contains("another run writes there"), "{text}");
        assert!(text.contains("another folder"), "{text}");
        drop(held);
        Folder::claim(&out).unwrap();
        assert_eq!(fs::read_dir(&out).unwrap().count(), 0);
    }

    #[test]
    fn temporaries_of_killed_runs_are_swept_and_nothing_else() {
        let dir = tempfile::tempdir().unwrap();
        for name in [
            ".peridyne-aB3xY9",
            ".peridyne-notes.txt",
            "peridyne-abcdef",
            "history.csv",
        ] {
            fs::write(dir.path().join(name), "x").unwrap();
        }
        Folder::claim(dir.path()).unwrap();
        let mut left: Vec<_> = fs::read_dir(dir.path())
            .unwrap()
            .map(|e| e.unwrap().file_name().into_string().unwrap())
            .collect();
        left.sort();
        assert_eq!(
            left,
            [".peridyne-notes.txt", "history.csv", "peridyne-abcdef"]
        );
    }

    #[test]
    fn paths_that_lead_out_are_told() {
        let dir = tempfile::tempdir().unwrap();
        let out = dir.path().join("out");
        let inside = |name: &str| is_inside(&out, Path::new(name));
        let all = || {
            assert!(inside("a.data") && inside("./a.data") && inside("new/sub/a.data"));
            assert!(!inside("../a.data") && !inside("new/../../a.data") && !inside("/etc/a.data"));
        };
        all();
        fs::create_dir(&out).unwrap();
        all();
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(dir.path(), out.join("link")).unwrap();
            assert!(!inside("link/a.data") && !inside("link/sub/a.data"));
            assert!(inside("link"), "a link in place of the file is replaced");
        }
    }
}
