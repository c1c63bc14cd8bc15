//! States of a run from which it goes on: when they are written, what is in them, and which of them is taken.
//!
//! A checkpoint is one file in the folder `checkpoint` of the results: what the run was asked for, the state of the model and that of
//! whatever writes ([`Archive`]), in blocks with a checksum each. It is written beside the one before and takes its name when it is on
//! the disk, so a run that is killed at any moment leaves a whole one.

use std::fs::{self, File};
use std::io::{self, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use peridyne::state::{Archive, Owner, StateError};
use peridyne_comm::Work;
use serde_json::json;

use super::atomic::{WriteError, create_directory, write_file};
use super::folder::{CHECKPOINT, WAITING};

/// What files begin with; the number is that of the format.
const MAGIC: &[u8; 24] = b"peridyne checkpoint 011\n";
/// Bytes of a block.
const BLOCK: usize = 1 << 20;
/// Beside the states: what ranks had to do, for whoever shares the body out again. No result.
const WORK: &str = "work.json";
/// What names of states begin and end with.
const NAME: [&str; 2] = ["step_", ".state"];

/// How often states are written, and how many stay.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CheckpointSchedule {
    /// Wall-clock time between two.
    pub every: Duration,
    pub keep: usize,
}

impl Default for CheckpointSchedule {
    /// Runs that are shorter write none.
    fn default() -> Self {
        CheckpointSchedule {
            every: Duration::from_secs(600),
            keep: 2,
        }
    }
}

/// What a run was asked for.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Asked {
    /// Of the program that wrote it.
    pub version: String,
    /// The command, and what the deck is called in the records of the run.
    pub command: String,
    pub name: String,
    /// The deck, where it lies, and what overrode its keys.
    pub deck: PathBuf,
    pub text: String,
    pub set: Vec<(String, String)>,
    /// Other files that were read, with their checksums.
    pub files: Vec<(PathBuf, u32)>,
    /// What the program that led the run gave it beside the deck, in words: no state has it, and who goes on gives it again.
    pub given: Vec<String>,
    /// Steps done, and of how many.
    pub step: u64,
    pub steps: u64,
}

impl Owner for Asked {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.text("version", &mut self.version);
        archive.text("command", &mut self.command);
        archive.text("name", &mut self.name);
        let mut path = self.deck.to_string_lossy().into_owned();
        archive.text("deck", &mut path);
        self.deck = path.into();
        archive.text("text", &mut self.text);
        let none = || (String::new(), String::new());
        archive.items("set", &mut self.set, none, |(key, value), archive| {
            archive.text("key", key);
            archive.text("value", value);
        });
        let none = || (PathBuf::new(), 0);
        archive.items("files", &mut self.files, none, |(path, sum), archive| {
            let mut name = path.to_string_lossy().into_owned();
            archive.text("name", &mut name);
            *path = name.into();
            archive.one("checksum", sum);
        });
        let given = &mut self.given;
        archive.items("given", given, String::new, |text, archive| {
            archive.text("what", text);
        });
        archive.one("step", &mut self.step);
        archive.one("steps", &mut self.steps);
    }
}

/// Why a run cannot go on.
#[derive(Debug, thiserror::Error)]
pub enum ResumeError {
    #[error("{}: there is no state to go on from{}", dir.display(), why_none(dir))]
    None { dir: PathBuf },
    #[error("{}: this is no state of a run of peridyne", path.display())]
    Foreign { path: PathBuf },
    #[error("{}: the state was written by {found}, this is peridyne {}; go on with the program that began", path.display(), env!("CARGO_PKG_VERSION"))]
    Version { path: PathBuf, found: String },
    #[error("{}: block {block} is damaged", path.display())]
    Damaged { path: PathBuf, block: u64 },
    /// A file of the results is not as it was.
    #[error(transparent)]
    Files(WriteError),
    #[error("{}: {error}", path.display())]
    State { path: PathBuf, error: StateError },
}

fn why_none(dir: &Path) -> &'static str {
    let record = std::fs::read(dir.join("run.json")).ok();
    let record = record.map(|text| serde_json::from_slice::<serde_json::Value>(&text));
    match record {
        Some(Ok(run)) if run["status"] == "done" => ": the run is done",
        Some(_) => ": the run was too short to write one (output.checkpoint says how often)",
        None => {
            ": give the folder of the results of a run that was ended early, or that wrote states (output.checkpoint)"
        }
    }
}

/// Writes blocks: length, checksum, bytes; an empty one at the end.
struct Blocks<W> {
    to: W,
    room: Vec<u8>,
}

impl<W: Write> Blocks<W> {
    fn block(&mut self) -> io::Result<()> {
        let sum = crc32fast::hash(&self.room);
        self.to.write_all(&(self.room.len() as u32).to_le_bytes())?;
        self.to.write_all(&sum.to_le_bytes())?;
        self.to.write_all(&self.room)?;
        self.room.clear();
        Ok(())
    }

    fn end(mut self) -> io::Result<()> {
        if !self.room.is_empty() {
            self.block()?;
        }
        self.block()
    }
}

impl<W: Write> Write for Blocks<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let count = bytes.len().min(BLOCK - self.room.len());
        self.room.extend_from_slice(&bytes[..count]);
        if self.room.len() == BLOCK {
            self.block()?;
        }
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Reads them back; no byte of a block is given before all of it was looked at.
struct Unblocked<R> {
    from: R,
    room: Vec<u8>,
    at: usize,
    blocks: u64,
    damaged: bool,
}

impl<R: Read> Unblocked<R> {
    fn next(&mut self) -> io::Result<()> {
        let mut head = [0; 8];
        self.from.read_exact(&mut head)?;
        let [a, b, c, d, sum @ ..] = head;
        let length = u32::from_le_bytes([a, b, c, d]) as usize;
        self.blocks += 1;
        self.damaged = length > BLOCK;
        if !self.damaged {
            self.room.resize(length, 0);
            self.from.read_exact(&mut self.room)?;
            self.damaged = crc32fast::hash(&self.room) != u32::from_le_bytes(sum);
        }
        self.at = 0;
        match self.damaged {
            true => Err(io::ErrorKind::InvalidData.into()),
            false => Ok(()),
        }
    }
}

impl<R: Read> Read for Unblocked<R> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        if self.at == self.room.len() && !to.is_empty() {
            self.next()?;
        }
        let count = to.len().min(self.room.len() - self.at);
        to[..count].copy_from_slice(&self.room[self.at..self.at + count]);
        self.at += count;
        Ok(count)
    }
}

/// A state that is read.
pub struct Checkpoint {
    path: PathBuf,
    from: Unblocked<BufReader<File>>,
    pub asked: Asked,
    /// States that are newer and cannot be read, and why.
    pub passed_over: Vec<String>,
}

impl Checkpoint {
    /// Has a folder of results a state, whole or not?
    pub fn any(dir: &Path) -> bool {
        !states(dir).is_empty()
    }

    /// The newest whole state of a folder of results; every block of it was looked at.
    ///
    /// # Errors
    /// There is none, or what is wrong with the newest where no other is whole.
    pub fn newest(dir: &Path) -> Result<Checkpoint, ResumeError> {
        let mut first = None;
        let mut passed_over = vec![];
        for path in states(dir).into_iter().rev() {
            match Checkpoint::look(&path).and_then(|()| Checkpoint::open(&path)) {
                Ok(found) => {
                    return Ok(Checkpoint {
                        passed_over,
                        ..found
                    });
                }
                Err(error) => {
                    passed_over.push(error.to_string());
                    first.get_or_insert(error);
                }
            }
        }
        let dir = dir.to_path_buf();
        Err(first.unwrap_or(ResumeError::None { dir }))
    }

    fn begun(path: &Path) -> Result<Unblocked<BufReader<File>>, ResumeError> {
        let failed = |error| ResumeError::State {
            path: path.to_path_buf(),
            error: StateError::Stream(error),
        };
        let file = File::open(path).map_err(failed)?;
        let mut from = BufReader::with_capacity(1 << 18, file);
        let mut magic = [0; MAGIC.len()];
        let read = from.read_exact(&mut magic);
        let path = path.to_path_buf();
        if read.is_err() || !magic.starts_with(b"peridyne checkpoint ") {
            return Err(ResumeError::Foreign { path });
        }
        if magic != *MAGIC {
            let found = "another version".to_string();
            return Err(ResumeError::Version { path, found });
        }
        Ok(Unblocked {
            from,
            room: vec![],
            at: 0,
            blocks: 0,
            damaged: false,
        })
    }

    /// Is every block as it was written, to the last?
    fn look(path: &Path) -> Result<(), ResumeError> {
        let mut from = Checkpoint::begun(path)?;
        loop {
            if let Err(error) = from.next() {
                return Err(told(path, &from, StateError::Stream(error)));
            }
            if from.room.is_empty() {
                return Ok(());
            }
        }
    }

    fn open(path: &Path) -> Result<Checkpoint, ResumeError> {
        let mut from = Checkpoint::begun(path)?;
        let mut asked = Asked::default();
        let mut archive = Archive::load(&mut from);
        archive.part("asked", &mut asked);
        let read = archive.done();
        read.map_err(|error| told(path, &from, error))?;
        let path = path.to_path_buf();
        if asked.version != env!("CARGO_PKG_VERSION") {
            let found = format!("peridyne {}", asked.version);
            return Err(ResumeError::Version { path, found });
        }
        Ok(Checkpoint {
            path,
            from,
            asked,
            passed_over: vec![],
        })
    }

    /// Passes all the rest through an archive.
    ///
    /// # Errors
    /// The state is of another model; what was read so far is in this one.
    pub fn load(&mut self, pass: impl FnOnce(&mut Archive<'_>)) -> Result<(), ResumeError> {
        let mut archive = Archive::load(&mut self.from);
        pass(&mut archive);
        let read = archive.done();
        read.map_err(|error| told(&self.path, &self.from, error))
    }
}

fn told<R>(path: &Path, from: &Unblocked<R>, error: StateError) -> ResumeError {
    let path = path.to_path_buf();
    match from.damaged {
        true => ResumeError::Damaged {
            path,
            block: from.blocks,
        },
        false => ResumeError::State { path, error },
    }
}

/// States of a folder of results, the oldest first.
fn states(dir: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(dir.join(CHECKPOINT)).into_iter().flatten();
    let mut all: Vec<(u64, PathBuf)> = entries
        .filter_map(|entry| {
            let path = entry.ok()?.path();
            let name = path.file_name()?.to_str()?;
            let step = name.strip_prefix(NAME[0])?.strip_suffix(NAME[1])?;
            Some((step.parse().ok()?, path))
        })
        .collect();
    all.sort();
    all.into_iter().map(|(_, path)| path).collect()
}

/// States of a run that is going on.
pub struct Checkpoints {
    dir: PathBuf,
    schedule: Option<CheckpointSchedule>,
    last: Instant,
}

impl Checkpoints {
    /// None of an earlier run is left, unless this one goes on with it. `None`: only who asks gets one.
    ///
    /// # Errors
    /// The operating system's.
    pub fn new(
        dir: &Path,
        schedule: Option<CheckpointSchedule>,
        goes_on: bool,
    ) -> Result<Checkpoints, WriteError> {
        if !goes_on {
            clear(dir)?;
        }
        Ok(Checkpoints {
            dir: dir.to_path_buf(),
            schedule,
            last: Instant::now(),
        })
    }

    /// Has it been long enough since the last?
    pub fn is_due(&self) -> bool {
        self.schedule
            .is_some_and(|s| self.last.elapsed() >= s.every)
    }

    /// Writes a state; older ones beyond those that are kept go.
    ///
    /// # Errors
    /// The operating system's; the states of before stay.
    pub fn write(
        &mut self,
        asked: &mut Asked,
        pass: impl FnOnce(&mut Archive<'_>),
    ) -> Result<(), WriteError> {
        // where it fails, it is not tried again at every step
        self.last = Instant::now();
        let folder = self.dir.join(CHECKPOINT);
        create_directory(&folder)?;
        let name = format!("{}{:010}{}", NAME[0], asked.step, NAME[1]);
        write_file(&folder.join(name), |w| {
            w.write_all(MAGIC)?;
            let mut blocks = Blocks {
                to: w,
                room: Vec::with_capacity(BLOCK),
            };
            let mut archive = Archive::save(&mut blocks);
            archive.part("asked", asked);
            pass(&mut archive);
            archive.done().map_err(|error| match error {
                StateError::Stream(error) => error,
                other => io::Error::other(other.to_string()),
            })?;
            blocks.end()
        })?;
        let all = states(&self.dir);
        let keep = self.schedule.unwrap_or_default().keep.max(1);
        for old in &all[..all.len().saturating_sub(keep)] {
            fs::remove_file(old).map_err(WriteError::at("remove the older", old))?;
        }
        self.last = Instant::now();
        Ok(())
    }

    /// Writes what ranks had to do, beside the states.
    ///
    /// # Errors
    /// The operating system's.
    pub fn write_work(&self, work: &[Work]) -> Result<(), WriteError> {
        if work.is_empty() {
            return Ok(());
        }
        let ranks: Vec<_> = { work.iter() }
            .map(|of| json!({"points": of.points, "seconds_per_step": of.seconds}))
            .collect();
        write_file(&self.dir.join(CHECKPOINT).join(WORK), |w| {
            serde_json::to_writer_pretty(w, &json!({ "ranks": ranks })).map_err(io::Error::from)
        })
    }

    /// The run is done: nobody goes on with it.
    ///
    /// # Errors
    /// The operating system's.
    pub fn done(self) -> Result<(), WriteError> {
        clear(&self.dir)
    }

    /// The run has ended otherwise: what waits for nobody goes.
    ///
    /// # Errors
    /// The operating system's.
    pub fn ended(self) -> Result<(), WriteError> {
        match states(&self.dir).is_empty() {
            true => clear(&self.dir),
            false => Ok(()),
        }
    }
}

/// What ranks had to do in the run that wrote states into a folder of results; nothing where nobody knows.
pub fn work_before(dir: &Path) -> Vec<Work> {
    let read = || {
        let text = fs::read(dir.join(CHECKPOINT).join(WORK)).ok()?;
        let all: serde_json::Value = serde_json::from_slice(&text).ok()?;
        let each = all["ranks"].as_array()?.iter().map(|of| {
            Some(Work {
                points: of["points"].as_u64()? as usize,
                seconds: of["seconds_per_step"].as_f64()?,
            })
        });
        each.collect::<Option<Vec<_>>>()
    };
    read().unwrap_or_default()
}

/// Takes away all states and the frames of films that wait beside them; what else is there stays.
fn clear(dir: &Path) -> Result<(), WriteError> {
    let folder = dir.join(CHECKPOINT);
    let entries = fs::read_dir(&folder).into_iter().flatten().flatten();
    let waits =
        |path: &Path| path.extension().is_some_and(|e| e == WAITING) || path.ends_with(WORK);
    let beside = entries.map(|e| e.path()).filter(|p| waits(p));
    for path in beside.chain(states(dir)) {
        fs::remove_file(&path).map_err(WriteError::at("remove", &path))?;
    }
    // of somebody else's files none is taken away
    let _ = fs::remove_dir(&folder);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A run of three states, each with so many numbers.
    fn three(dir: &Path, numbers: usize) -> Vec<PathBuf> {
        let schedule = CheckpointSchedule {
            keep: 3,
            ..CheckpointSchedule::default()
        };
        let mut all = Checkpoints::new(dir, Some(schedule), false).unwrap();
        for step in [5, 10, 15] {
            let mut asked = Asked {
                version: env!("CARGO_PKG_VERSION").into(),
                set: vec![("run.steps".into(), "20".into())],
                step,
                ..Asked::default()
            };
            let mut values = vec![step as f64; numbers];
            all.write(&mut asked, |a| a.list("values", &mut values))
                .unwrap();
        }
        states(dir)
    }

    fn read(dir: &Path) -> Result<(Checkpoint, Vec<f64>), ResumeError> {
        let mut found = Checkpoint::newest(dir)?;
        let mut values = vec![];
        found.load(|a| a.list("values", &mut values))?;
        Ok((found, values))
    }

    #[test]
    fn the_newest_state_comes_back_and_a_damaged_one_is_passed_over() {
        let dir = tempfile::tempdir().unwrap();
        // three blocks and a part
        let all = three(dir.path(), 400_000);
        assert_eq!(all.len(), 3);
        let (found, values) = read(dir.path()).unwrap();
        assert_eq!((found.asked.step, found.passed_over.len()), (15, 0));
        assert_eq!(found.asked.set[0].1, "20");
        assert_eq!(values, vec![15.0; 400_000]);
        let whole = fs::read(&all[2]).unwrap();
        // wherever a bit turns
        for at in [0, 20, 24, 30, 33, 1 << 20, whole.len() - 9, whole.len() - 1] {
            let mut bytes = whole.clone();
            bytes[at] ^= 1;
            fs::write(&all[2], &bytes).unwrap();
            let (found, values) = read(dir.path()).unwrap();
            assert_eq!((found.asked.step, values[0]), (10, 10.0), "{at}");
            assert_eq!(found.passed_over.len(), 1);
        }
        for end in [0, 10, 24, 40, 1 << 20, whole.len() - 8, whole.len() - 1] {
            fs::write(&all[2], &whole[..end]).unwrap();
            assert_eq!(read(dir.path()).unwrap().0.asked.step, 10, "{end}");
        }
        for path in &all {
            fs::write(path, b"peridyne checkpoint 000\n").unwrap();
        }
        let error = read(dir.path()).err().unwrap().to_string();
        assert!(error.contains("was written by another version"), "{error}");
    }

    #[test]
    fn two_states_stay_and_none_of_a_run_that_is_done() {
        let dir = tempfile::tempdir().unwrap();
        let mut all = Checkpoints::new(dir.path(), None, false).unwrap();
        assert!(!all.is_due());
        for step in 0..5 {
            let mut asked = Asked {
                step,
                ..Asked::default()
            };
            all.write(&mut asked, |_| {}).unwrap();
        }
        assert_eq!(states(dir.path()).len(), 2);
        let other = dir.path().join(CHECKPOINT).join("mine.txt");
        fs::write(&other, "x").unwrap();
        all.done().unwrap();
        assert!(states(dir.path()).is_empty() && other.is_file());
        let error = Checkpoint::newest(dir.path()).err().unwrap().to_string();
        assert!(error.contains("there is no state to go on from"), "{error}");
    }
}
