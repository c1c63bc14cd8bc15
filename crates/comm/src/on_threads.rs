//! Threads of one process as ranks: what tests have, and what needs no MPI.

use crate::comm::{Comm, Kind};
use crate::threads::Thread;
use std::time::Duration;

/// Does `work` on so many threads, each a rank, and returns what they return, in their order.
///
/// # Panics
/// There are no ranks, or one of them panicked: others that wait for it have [`Failure::Ended`](crate::Failure::Ended).
pub fn on_threads<R: Send>(ranks: usize, work: impl Fn(Comm) -> R + Sync) -> Vec<R> {
    on_threads_apart(ranks, Duration::ZERO, work)
}

/// The same with messages that take so long at least, as between machines far from each other.
///
/// # Panics
/// As of [`on_threads`].
pub fn on_threads_apart<R: Send>(
    ranks: usize,
    delay: Duration,
    work: impl Fn(Comm) -> R + Sync,
) -> Vec<R> {
    assert!(ranks > 0, "no rank does nothing");
    let comm = |thread| Comm::new(Kind::Thread(thread));
    std::thread::scope(|scope| {
        let work = &work;
        let threads: Vec<_> = Thread::several(ranks, delay)
            .map(comm)
            .map(|comm| scope.spawn(move || work(comm)))
            .collect();
        let ended = threads.into_iter().map(|thread| thread.join());
        ended
            .map(|end| end.unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
            .collect()
    })
}
