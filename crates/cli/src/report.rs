//! `peridyne report`.

use crate::failure::{Failure, say};
use peridyne::observe::StateHash;
use peridyne_io::write::folder::Folder;
use peridyne_io::write::report::{self, NAME, ReportError};
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub struct ReportArguments {
    /// Folder of the results of a run (it has a run.json).
    pub dir: PathBuf,
}

pub fn report(arguments: &ReportArguments) -> Result<(), Failure> {
    let dir = &arguments.dir;
    if !dir.join("run.json").is_file() {
        return Err(Failure::input(ReportError::NoRun(dir.clone()).to_string()));
    }
    let failed = |e: String| Failure::Run(e);
    let _held = Folder::claim(dir).map_err(|e| failed(e.to_string()))?;
    let made = report::write(dir).map_err(|e| failed(e.to_string()))?;
    say(&line(dir));
    say(&format!("size      {:.2} MB", made.bytes as f64 / 1e6));
    made.notes.iter().for_each(|n| say(&format!("note: {n}")));
    Ok(())
}

/// Where the report of a run is, or how to make it.
pub fn told(dir: &Path) -> String {
    match dir.join(NAME).is_file() {
        true => line(dir),
        false => format!(
            "report: left out, for the run was ended and its files are large; `peridyne report {}` makes it",
            dir.display()
        ),
    }
}

/// What a run ended as.
pub fn state(hash: StateHash) -> String {
    format!("state     {hash}")
}

/// Where the report of a folder is.
pub fn line(dir: &Path) -> String {
    format!("report: {}", dir.join(NAME).display())
}
