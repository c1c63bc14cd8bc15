//! Files that are either whole or not there.
//!
//! A file is written to a temporary beside it and renamed over the old one when it is complete and on the
//! disk; a killed run, a full disk or an error on the way leaves the old file untouched and no rubbish. A file that was
//! read is never replaced ([`crate::read::source`]).

use std::ffi::OsStr;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::read::source;

/// What the writers of formats are given: a buffered temporary file.
pub type Sink<'a> = BufWriter<&'a mut NamedTempFile>;

/// A file that could not be written, with what the operating system said.
#[derive(Debug, thiserror::Error)]
#[error("cannot {action} `{}`: {source}{}", path.display(), advice(path, source))]
pub struct WriteError {
    pub path: PathBuf,
    /// What was being done: "write", "create the directory", …
    pub action: &'static str,
    pub source: io::Error,
}

impl WriteError {
    /// For `map_err`: `WriteError::at("write", path)`.
    pub fn at(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> WriteError {
        let path = path.to_path_buf();
        move |source| WriteError {
            path,
            action,
            source,
        }
    }
}

/// What the user can do about it.
fn advice(path: &Path, error: &io::Error) -> String {
    let parent = directory(path).display();
    match error.kind() {
        io::ErrorKind::StorageFull => {
            format!("; free space on the disk of `{parent}` or write to another directory")
        }
        io::ErrorKind::PermissionDenied => {
            format!("; make `{parent}` writable or write to another directory")
        }
        io::ErrorKind::ResourceBusy => {
            "; wait until it has ended, or give another folder with --out".into()
        }
        io::ErrorKind::NotFound => format!("; create the directory `{parent}` first"),
        _ => String::new(),
    }
}

/// The directory a file lies in; a bare name lies in the current one.
fn directory(path: &Path) -> &Path {
    path.parent()
        .filter(|p| !p.as_os_str().is_empty())
        .unwrap_or(Path::new("."))
}

/// Writes `path` with `fill`, all or nothing.
///
/// # Errors
/// The operating system's, of any step, as [`WriteError`]; then `path` is as it was before.
pub fn write_file(
    path: &Path,
    fill: impl FnOnce(&mut Sink) -> io::Result<()>,
) -> Result<(), WriteError> {
    replace(path, fill).map_err(WriteError::at("write", path))
}

fn replace(path: &Path, fill: impl FnOnce(&mut Sink) -> io::Result<()>) -> io::Result<()> {
    source::replaceable(path)?;
    let mut file = temporary_in(directory(path))?;
    let mut sink = BufWriter::with_capacity(1 << 18, &mut file);
    fill(&mut sink)?;
    sink.flush()?;
    drop(sink);
    // the name must not reach the disk before the contents; late errors of the disk show here
    file.as_file().sync_all()?;
    let file = file.persist(path).map_err(|e| e.error)?;
    source::made(&file);
    Ok(())
}

/// What names of temporaries begin with, before [`RANDOM`] letters and digits.
const PREFIX: &str = ".peridyne-";
const RANDOM: usize = 6;

/// Does a temporary of ours have this name?
pub(super) fn is_temporary(name: &OsStr) -> bool {
    let random = name.to_str().and_then(|n| n.strip_prefix(PREFIX));
    random.is_some_and(|r| r.len() == RANDOM && r.bytes().all(|b| b.is_ascii_alphanumeric()))
}

/// A temporary file with the rights that any other new file gets (tempfile's own are private), and with errors
/// free of its name: the user knows the path that was asked for.
pub(super) fn temporary_in(directory: &Path) -> io::Result<NamedTempFile> {
    let mut code = None;
    let made = tempfile::Builder::new()
        .prefix(PREFIX)
        .rand_bytes(RANDOM)
        .make_in(directory, |path| {
            let mut options = File::options();
            let file = options.read(true).write(true).create_new(true).open(path);
            file.inspect_err(|e| code = e.raw_os_error())
        });
    made.map_err(|e| code.map_or(e, io::Error::from_raw_os_error))
}

/// Creates a directory and its parents.
pub fn create_directory(path: &Path) -> Result<(), WriteError> {
    std::fs::create_dir_all(path).map_err(WriteError::at("create the directory", path))
}

/// Opens an existing file to append whole records to it.
pub(super) fn open_to_append(path: &Path) -> Result<File, WriteError> {
    File::options()
        .append(true)
        .open(path)
        .map_err(WriteError::at("append to", path))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(dir: &Path) -> Vec<String> {
        let entries = std::fs::read_dir(dir).unwrap();
        entries
            .map(|e| e.unwrap().file_name().into_string().unwrap())
            .collect()
    }

    #[test]
    fn a_failed_write_leaves_the_old_file_and_nothing_else() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.txt");
        write_file(&path, |w| w.write_all(b"old")).unwrap();
        let error = write_file(&path, |w| {
            w.write_all(&[b'x'; 1 << 20])?;
            Err(io::ErrorKind::StorageFull.into())
        })
        .unwrap_err();
        assert_eq!(std::fs::read(&path).unwrap(), b"old");
        assert_eq!(names(dir.path()), ["a.txt"]);
        assert!(error.to_string().contains("a.txt"), "{error}");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_is_told_with_path_and_reason() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("big.vtu");
        let error = write_file(&path, |_| {
            File::options()
                .write(true)
                .open("/dev/full")?
                .write_all(b"does not fit")
        })
        .unwrap_err();
        let text = error.to_string();
        assert!(
            text.contains("big.vtu") && text.contains("No space left on device"),
            "{text}"
        );
        assert!(text.contains("free space"), "{text}");
        assert!(names(dir.path()).is_empty());
    }

    #[test]
    fn a_missing_directory_is_named() {
        let dir = tempfile::tempdir().unwrap();
        let text = write_file(&dir.path().join("nowhere/a.txt"), |_| Ok(()))
            .unwrap_err()
            .to_string();
        assert!(
            text.contains("nowhere/a.txt`: No such file or directory"),
            "{text}"
        );
        assert!(text.contains("create the directory"), "{text}");
        assert!(!text.contains(".peridyne-"), "{text}");
    }

    #[test]
    fn a_directory_that_cannot_be_made_is_named() {
        let dir = tempfile::tempdir().unwrap();
        std::fs::write(dir.path().join("file"), "").unwrap();
        let text = create_directory(&dir.path().join("file/out"))
            .unwrap_err()
            .to_string();
        assert!(
            text.contains("cannot create the directory") && text.contains("file/out"),
            "{text}"
        );
    }

    #[test]
    fn permission_denied_says_what_to_do() {
        let error = WriteError::at("write", Path::new("/results/a.vtu"))(
            io::ErrorKind::PermissionDenied.into(),
        );
        assert!(
            error
                .to_string()
                .ends_with("make `/results` writable or write to another directory")
        );
    }

    #[cfg(unix)]
    #[test]
    fn results_get_the_rights_of_ordinary_files() {
        use std::os::unix::fs::PermissionsExt;
        let dir = tempfile::tempdir().unwrap();
        let (ours, plain) = (dir.path().join("ours"), dir.path().join("plain"));
        write_file(&ours, |_| Ok(())).unwrap();
        File::create(&plain).unwrap();
        let mode = |p: &Path| std::fs::metadata(p).unwrap().permissions().mode();
        assert_eq!(mode(&ours), mode(&plain));
    }
}
