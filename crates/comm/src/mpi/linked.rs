//! Processes that an MPI launcher started, with an MPI of before the standard ABI: the one that this program was compiled with (feature `ferrompi`).

use crate::failure::Failure;
use crate::launcher::Launched;
use ferrompi::{Communicator, ThreadLevel, scope};
use std::cell::RefCell;
use std::sync::{Mutex, PoisonError};

/// Of messages; there is one kind.
const TAG: i32 = 0;

/// MPI, from its start to its end.
pub struct Mpi {
    /// One thread at a time: that is what was asked for.
    world: Mutex<Communicator>,
    rank: usize,
    ranks: usize,
    library: String,
}

thread_local! {
    /// What ends MPI, on the thread that started it.
    static STARTED: RefCell<Option<ferrompi::Mpi>> = const { RefCell::new(None) };
}

impl std::fmt::Debug for Mpi {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "rank {} of {}: {}", self.rank, self.ranks, self.library)
    }
}

fn said(error: ferrompi::Error) -> Failure {
    Failure::Mpi(error.to_string())
}

impl Mpi {
    /// Starts MPI.
    ///
    /// # Errors
    /// It does not start, or is another one than the launcher's.
    pub(crate) fn start(launched: &Launched) -> Result<Mpi, Failure> {
        let mpi = ferrompi::Mpi::init_thread(ThreadLevel::Serialized).map_err(said)?;
        let world = mpi.world();
        let [rank, ranks] = [world.rank(), world.size()].map(|n| n as usize);
        let library = ferrompi::Mpi::library_version().map_err(said)?;
        let library = library.lines().next().unwrap_or_default().to_string();
        if ranks != launched.ranks {
            return Err(Failure::OtherLauncher {
                launched: launched.clone(),
                library,
                ranks,
            });
        }
        STARTED.set(Some(mpi));
        Ok(Mpi {
            world: Mutex::new(world),
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

    /// Name and version of the library.
    pub fn library(&self) -> &str {
        &self.library
    }

    pub(crate) fn exchange<R>(
        &self,
        send: &[(usize, &[u8])],
        receive: &mut [(usize, &mut [u8])],
        work: impl FnOnce() -> R,
    ) -> Result<R, Failure> {
        let world = self.world.lock().unwrap_or_else(PoisonError::into_inner);
        let expected: Vec<(usize, usize)> = { receive.iter() }
            .filter(|(from, _)| *from != self.rank)
            .map(|(from, into)| (*from, into.len()))
            .collect();
        let done = scope(|s| {
            let others = receive.iter_mut().filter(|(from, _)| *from != self.rank);
            let open = others.map(|(from, into)| world.irecv(s, into, *from as i32, TAG));
            let open = open.collect::<ferrompi::Result<Vec<_>>>()?;
            for (to, bytes) in send.iter().filter(|(to, _)| *to != self.rank) {
                world.isend(s, bytes, *to as i32, TAG)?;
            }
            let answer = work();
            let arrived = open
                .into_iter()
                .map(|request| ferrompi::Result::Ok(request.wait()?.count));
            let arrived = arrived.collect::<ferrompi::Result<Vec<_>>>()?;
            Ok((answer, arrived))
        });
        let (answer, arrived) = done.map_err(said)?;
        for ((from, expected), sent) in expected.into_iter().zip(arrived) {
            let sent = sent.unwrap_or_default();
            if sent != expected {
                return Err(Failure::Length {
                    from,
                    sent,
                    expected,
                });
            }
        }
        Ok(answer)
    }

    pub(crate) fn abort(&self, code: i32) {
        let world = self.world.lock().unwrap_or_else(PoisonError::into_inner);
        world.abort(code);
    }
}

impl Drop for Mpi {
    fn drop(&mut self) {
        drop(STARTED.take());
    }
}
