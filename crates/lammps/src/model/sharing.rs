//! Ranks that share the model of a script. The first one runs the script; the others read it up to its first `run`, and follow the model from there.

use crate::host::HostError;
use peridyne::spec::Spec;
use peridyne_comm::Comm;
use std::fmt::Write;
use std::hash::{DefaultHasher, Hasher};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Ranks that meet once: with the same model at the first `run`, or some of them at the end of the script.
#[derive(Debug, Clone)]
pub struct Sharing {
    pub(super) comm: Arc<Comm>,
    met: Arc<AtomicBool>,
}

/// What a rank says where they meet.
type Said = [u8; 9];
/// What that begins with: a model, the end of the script without one, a mistake before it.
const MODEL: u8 = 0;
const WELL: u8 = 1;
const BADLY: u8 = 2;

impl Sharing {
    pub fn new(comm: &Arc<Comm>) -> Sharing {
        Sharing {
            comm: comm.clone(),
            met: Arc::default(),
        }
    }

    fn say(&self, said: Said) -> Vec<Said> {
        let all = self.comm.all_as_long(&said);
        let all = all.unwrap_or_else(|failure| self.comm.end(failure));
        all.as_chunks().0.to_vec()
    }

    /// All ranks have this model?
    ///
    /// # Errors
    /// A rank has another one or none; there was one before.
    pub(super) fn meet(&self, spec: &Spec) -> Result<(), HostError> {
        if self.met.swap(true, Ordering::Relaxed) {
            return Err(HostError::new(
                "ranks do not share the models of a script after its first",
            )
            .help("run a script with `clear` in one process, or one script for each model"));
        }
        let mut sum = Sum(DefaultHasher::new());
        // a sum takes all that is written
        let _ = write!(sum, "{spec:?}");
        let mut own = [MODEL; 9];
        own[1..].copy_from_slice(&sum.0.finish().to_le_bytes());
        let all = self.say(own);
        if let Some(rank) = all.iter().position(|said| said[0] != MODEL) {
            return Err(HostError::new(format!(
                "rank {rank} has come to the end of the script without a `run`, or to a mistake before it"
            )));
        }
        match all.iter().position(|said| *said != own) {
            None => Ok(()),
            Some(rank) => Err(HostError::new(format!(
                "rank {rank} has read another model in this script than rank {} before its first `run`",
                self.comm.rank()
            ))
            .help("files that the script reads must be the same on all machines, and not made by it")),
        }
    }

    /// The script is over here, and ended well or not. Did it on the first rank? `None`: there was a model.
    pub fn leave(&self, well: bool) -> Option<bool> {
        if self.met.swap(true, Ordering::Relaxed) {
            return None;
        }
        let all = self.say([if well { WELL } else { BADLY }; 9]);
        Some(all[0][0] == WELL)
    }
}

/// A sum of what is written.
struct Sum(DefaultHasher);

impl Write for Sum {
    fn write_str(&mut self, text: &str) -> std::fmt::Result {
        self.0.write(text.as_bytes());
        Ok(())
    }
}
