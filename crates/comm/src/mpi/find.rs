//! Which library is the MPI of this process?

use super::abi::Abi;
use crate::launcher::ASKED;
use std::path::{Path, PathBuf};

/// What a launcher is called that lies in a folder of `PATH`.
const LAUNCHERS: [&str; 2] = ["mpiexec", "mpirun"];

#[cfg(target_os = "macos")]
const NAME: &str = "libmpi_abi.1.dylib";
#[cfg(not(target_os = "macos"))]
const NAME: &str = "libmpi_abi.so.1";

/// The first library that has the ABI, and its path; or what was tried and why it was not taken.
pub(super) fn library() -> Result<(Abi, String), Vec<String>> {
    let mut tried = vec![];
    for path in candidates() {
        match Abi::load(&path).and_then(|abi| abi.known().map(|()| abi)) {
            Ok(abi) => return Ok((abi, path)),
            Err(why) => tried.push(match why.contains(&path) {
                true => why,
                false => format!("{path}: {why}"),
            }),
        }
    }
    Err(tried)
}

/// Paths in the order in which they are tried: the one that was asked for; beside the program that started this one, whose MPI it is;
/// where the loader looks (`LD_LIBRARY_PATH`, the system's); beside the launchers in `PATH`.
fn candidates() -> Vec<String> {
    if let Ok(asked) = std::env::var(ASKED) {
        return vec![asked];
    }
    let mut found: Vec<PathBuf> = vec![];
    found.extend(parent().iter().flat_map(|program| beside(program)));
    found.push(NAME.into());
    let path = std::env::var_os("PATH").unwrap_or_default();
    for folder in std::env::split_paths(&path) {
        let launchers = LAUNCHERS.map(|name| folder.join(name));
        let there = launchers.iter().filter_map(|file| file.canonicalize().ok());
        found.extend(there.flat_map(|program| beside(&program)));
    }
    let mut paths: Vec<String> = vec![];
    for path in found {
        let path = path.to_string_lossy().into_owned();
        if !paths.contains(&path) {
            paths.push(path);
        }
    }
    paths
}

/// The library of an installation whose `bin` a program is in, if it is there.
fn beside(program: &Path) -> Vec<PathBuf> {
    let Some(top) = program.parent().and_then(Path::parent) else {
        return vec![];
    };
    let libraries = ["lib", "lib64"].map(|folder| top.join(folder).join(NAME));
    libraries
        .into_iter()
        .filter(|file| file.is_file())
        .collect()
}

/// The program that started this one, where the system tells (Linux).
fn parent() -> Option<PathBuf> {
    let id = std::os::unix::process::parent_id();
    std::fs::read_link(format!("/proc/{id}/exe")).ok()
}
