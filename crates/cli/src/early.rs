//! Runs that end before their last step, and what they go on with.

use crate::Input;
use crate::deck::{STDIN, is_piped};
use crate::failure::Failure;
use peridyne_io::deck::clock_time;
use peridyne_io::read::source;
use peridyne_io::write::checkpoint::Asked;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Where a run ends before its last step, as if a signal had come: `peridyne resume` goes on from there.
#[derive(clap::Args, Debug, Clone, Default)]
pub struct Early {
    /// End after this step; a LAMMPS script at the first place from then on from which it can go on.
    #[arg(long, value_name = "STEP")]
    pub stop_after: Option<u64>,
    /// End when so much time has gone by, such as "47 h": what a queue gives a job, less what writing takes.
    #[arg(long = "for", value_name = "TIME", value_parser = time)]
    pub time: Option<(Duration, String)>,
}

fn time(text: &str) -> Result<(Duration, String), String> {
    clock_time(text).map(|time| (time, text.to_string()))
}

impl Early {
    /// What ends a run that began then, after so many steps; `None`: nothing does yet.
    pub fn reached(&self, steps: u64, begun: Instant) -> Option<String> {
        let step = self.stop_after.filter(|n| steps >= *n);
        let late = |of: &&(Duration, String)| begun.elapsed() >= of.0;
        let time = self.time.as_ref().filter(late);
        let step = step.map(|n| format!("--stop-after {n}"));
        step.or_else(|| time.map(|(_, text)| format!("--for {text}")))
    }
}

/// What a state says of how its run was asked for: command, name of the deck and its text.
pub fn asked(input: &Input, records: [String; 3]) -> Asked {
    asked_by(&input.file, input.set.clone(), records, source::sums())
}

/// The same of a deck's file, what overrides it, and the files that were read for it.
pub fn asked_by(
    file: &Path,
    set: Vec<(String, String)>,
    [command, name, text]: [String; 3],
    mut files: Vec<(PathBuf, u32)>,
) -> Asked {
    let deck = match is_piped(file) || file == Path::new(STDIN) {
        true => PathBuf::from("-"),
        false => file.canonicalize().unwrap_or_else(|_| file.to_path_buf()),
    };
    files.retain(|(path, _)| *path != deck);
    Asked {
        version: env!("CARGO_PKG_VERSION").to_string(),
        command,
        name,
        deck,
        text,
        set,
        files,
        ..Asked::default()
    }
}

/// Were the files that the deck names read as they were when the run began?
///
/// # Errors
/// The first that was not.
pub fn same_files(then: &[(PathBuf, u32)], now: &[(PathBuf, u32)]) -> Result<(), Failure> {
    match then.iter().find(|file| !now.contains(file)) {
        Some((path, _)) => Err(Failure::input(format!(
            "{}: this is not the file that the run began with; put it back, or begin anew",
            path.display()
        ))),
        None => Ok(()),
    }
}
