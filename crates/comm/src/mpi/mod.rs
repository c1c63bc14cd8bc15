//! Processes that an MPI launcher started.
//!
//! MPI 5.0 has a standard ABI (MPI Forum 2025, chapter 20): names, types and constants are the same in every library called `libmpi_abi`. So a
//! dozen functions of it are looked up when the program starts, and the program is the same file on a laptop and on a cluster.

mod abi;
mod find;

use crate::failure::Failure;
use crate::launcher::Launched;
use abi::{Abi, Request, Status};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Of messages; there is one kind.
const TAG: i32 = 0;

/// MPI, from its start to its end.
#[derive(Debug)]
pub struct Mpi {
    /// One thread at a time: that is what was asked for.
    abi: Mutex<Abi>,
    rank: usize,
    ranks: usize,
    library: String,
}

impl Mpi {
    /// Finds the library and starts MPI.
    ///
    /// # Errors
    /// There is none, or it is another one than the launcher's.
    pub(crate) fn start(launched: &Launched) -> Result<Mpi, Failure> {
        let (abi, path) = find::library().map_err(|tried| Failure::NoMpi {
            launched: launched.clone(),
            tried,
        })?;
        abi.init()?;
        let (rank, ranks) = (abi.rank()?, abi.ranks()?);
        let library = format!("{} ({path})", abi.version()?);
        if ranks != launched.ranks {
            abi.finalize();
            return Err(Failure::OtherLauncher {
                launched: launched.clone(),
                library,
                ranks,
            });
        }
        Ok(Mpi {
            abi: Mutex::new(abi),
            rank,
            ranks,
            library,
        })
    }

    pub(crate) fn rank(&self) -> usize {
        self.rank
    }

    pub(crate) fn ranks(&self) -> usize {
        self.ranks
    }

    /// Name, version and path of the library.
    pub fn library(&self) -> &str {
        &self.library
    }

    fn abi(&self) -> MutexGuard<'_, Abi> {
        self.abi.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(crate) fn exchange<R>(
        &self,
        send: &[(usize, &[u8])],
        receive: &mut [(usize, &mut [u8])],
        work: impl FnOnce() -> R,
    ) -> Result<R, Failure> {
        let mut open = Open {
            mpi: self,
            requests: Vec::with_capacity(send.len() + receive.len()),
            receives: vec![],
        };
        let abi = self.abi();
        for (from, into) in receive.iter_mut().filter(|(from, _)| *from != self.rank) {
            open.receives.push((*from, into.len()));
            // SAFETY: `into` is borrowed mutably until `open` is gone, which waits
            let request = unsafe { abi.receive(into.as_mut_ptr(), into.len(), *from, TAG) };
            open.requests.push(request?);
        }
        for (to, bytes) in send.iter().filter(|(to, _)| *to != self.rank) {
            // SAFETY: `bytes` is borrowed until `open` is gone, which waits
            let request = unsafe { abi.send(bytes.as_ptr(), bytes.len(), *to, TAG) };
            open.requests.push(request?);
        }
        drop(abi);
        let answer = work();
        open.wait()?;
        Ok(answer)
    }

    pub(crate) fn abort(&self, code: i32) {
        self.abi().abort(code);
    }
}

impl Drop for Mpi {
    fn drop(&mut self) {
        self.abi().finalize();
    }
}

/// Requests that hold addresses of somebody's slices: they end before this does.
struct Open<'a> {
    mpi: &'a Mpi,
    /// Receives first.
    requests: Vec<Request>,
    /// From whom, and how many bytes.
    receives: Vec<(usize, usize)>,
}

impl Open<'_> {
    fn wait(mut self) -> Result<(), Failure> {
        let mut statuses = vec![Status::default(); self.requests.len()];
        let abi = self.mpi.abi();
        abi.wait(&mut self.requests, &mut statuses)?;
        self.requests.clear();
        for (&(from, expected), status) in self.receives.iter().zip(&statuses) {
            let sent = abi.count(status)?;
            if sent != expected {
                return Err(Failure::Length {
                    from,
                    sent,
                    expected,
                });
            }
        }
        Ok(())
    }
}

impl Drop for Open<'_> {
    fn drop(&mut self) {
        if self.requests.is_empty() {
            return;
        }
        // an exchange broke off, and MPI may still write where the slices are: nothing of this process can be trusted from here on
        self.mpi.abi().abort(1);
        std::process::abort();
    }
}
