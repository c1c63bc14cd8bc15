//! This rank among the others, whatever carries the messages.

use crate::failure::Failure;
use crate::launcher;
#[cfg(unix)]
use crate::mpi;
use crate::threads;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

/// This rank among the others.
#[derive(Debug)]
pub struct Comm {
    pub(crate) kind: Kind,
    counted: Counted,
    earlier: OnceLock<Vec<Work>>,
}

/// What a rank had to do in a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Work {
    /// Points that it had.
    pub points: usize,
    /// How long a step took it, without waits (time of the clock).
    pub seconds: f64,
}

/// What this rank has sent so far.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Traffic {
    /// Messages to single ranks, and their bytes; those of what all hear are not among them.
    pub messages: u64,
    pub bytes: u64,
    /// How often all heard what each had ([`Comm::all`]).
    pub rounds: u64,
    /// Nanoseconds that it worked while messages were on their way.
    pub worked: u64,
    /// And those that it did nothing else.
    pub waited: u64,
}

#[derive(Debug, Default)]
struct Counted {
    messages: AtomicU64,
    bytes: AtomicU64,
    rounds: AtomicU64,
    worked: AtomicU64,
    waited: AtomicU64,
}

#[derive(Debug)]
pub(crate) enum Kind {
    Alone,
    Thread(threads::Thread),
    #[cfg(unix)]
    Mpi(mpi::Mpi),
}

impl Comm {
    /// A process of its own.
    pub fn alone() -> Comm {
        Comm::new(Kind::Alone)
    }

    /// One of the processes that a launcher (`mpiexec`, `srun`) started; alone where there is none, or one process, or `PERIDYNE_MPI` is `off`.
    ///
    /// # Errors
    /// There is no MPI that can be used, or it knows nothing of the other processes: each would do the whole work, and none would know.
    pub fn of_launcher() -> Result<Comm, Failure> {
        if std::env::var_os(launcher::ASKED).is_some_and(|asked| asked == launcher::OFF) {
            return Ok(Comm::alone());
        }
        match launcher::launched() {
            None => Ok(Comm::alone()),
            Some(launched) if launched.ranks == 1 => Ok(Comm::alone()),
            #[cfg(unix)]
            Some(launched) => Ok(Comm::new(Kind::Mpi(mpi::Mpi::start(&launched)?))),
            #[cfg(not(unix))]
            Some(launched) => Err(Failure::NoMpi {
                launched,
                tried: vec!["MPI is looked for on Unix alone".into()],
            }),
        }
    }

    pub(crate) fn new(kind: Kind) -> Comm {
        Comm {
            kind,
            counted: Counted::default(),
            earlier: OnceLock::new(),
        }
    }

    /// What this rank has sent so far.
    pub fn traffic(&self) -> Traffic {
        let counted = &self.counted;
        let [messages, bytes, rounds, worked, waited] = [
            &counted.messages,
            &counted.bytes,
            &counted.rounds,
            &counted.worked,
            &counted.waited,
        ]
        .map(|n| n.load(Ordering::Relaxed));
        Traffic {
            messages,
            bytes,
            rounds,
            worked,
            waited,
        }
    }

    /// What ranks had to do in an earlier run, in their order: bodies are shared out by it. All ranks are told the same, before they make one; only once.
    pub fn share_by(&self, earlier: Vec<Work>) {
        // a body stays where it is
        let _ = self.earlier.set(earlier);
    }

    /// What ranks had to do in an earlier run, if anybody knows.
    pub fn earlier(&self) -> &[Work] {
        self.earlier.get().map_or(&[], |all| all)
    }

    /// One more round of all.
    pub(crate) fn count_round(&self) {
        self.counted.rounds.fetch_add(1, Ordering::Relaxed);
    }

    /// This one's number, from 0.
    pub fn rank(&self) -> usize {
        match &self.kind {
            Kind::Alone => 0,
            Kind::Thread(thread) => thread.rank(),
            #[cfg(unix)]
            Kind::Mpi(mpi) => mpi.rank(),
        }
    }

    /// How many there are.
    pub fn ranks(&self) -> usize {
        match &self.kind {
            Kind::Alone => 1,
            Kind::Thread(thread) => thread.ranks(),
            #[cfg(unix)]
            Kind::Mpi(mpi) => mpi.ranks(),
        }
    }

    /// What carries the messages, in words.
    pub fn carrier(&self) -> String {
        match &self.kind {
            Kind::Alone => "one process".into(),
            Kind::Thread(_) => "threads of one process".into(),
            #[cfg(unix)]
            Kind::Mpi(mpi) => mpi.library().into(),
        }
    }

    /// Sends the bytes of `send` to their ranks, does `work`, and returns when all of `receive` is there and `send` may be changed.
    ///
    /// Messages between two ranks arrive in the order of the lists of both, and to oneself, too; a receive has the length of what was sent. All ranks
    /// that are named by one another take part; others need not.
    ///
    /// # Errors
    /// Another rank has ended, a message has another length, a rank does not exist, or what MPI said. What was received then means nothing.
    pub fn exchange<R>(
        &self,
        send: &[(usize, &[u8])],
        receive: &mut [(usize, &mut [u8])],
        work: impl FnOnce() -> R,
    ) -> Result<R, Failure> {
        for (_, bytes) in send.iter().filter(|(to, _)| *to != self.rank()) {
            self.counted.messages.fetch_add(1, Ordering::Relaxed);
            self.counted
                .bytes
                .fetch_add(bytes.len() as u64, Ordering::Relaxed);
        }
        let mut worked = 0;
        let answer = self.trade(send, receive, || {
            let begun = Instant::now();
            let answer = work();
            worked = begun.elapsed().as_nanos() as u64;
            answer
        });
        self.counted.worked.fetch_add(worked, Ordering::Relaxed);
        self.counted.waited.fetch_sub(worked, Ordering::Relaxed);
        answer
    }

    /// [`Comm::exchange`], of which nobody keeps count.
    pub(crate) fn trade<R>(
        &self,
        send: &[(usize, &[u8])],
        receive: &mut [(usize, &mut [u8])],
        work: impl FnOnce() -> R,
    ) -> Result<R, Failure> {
        let ranks = self.ranks();
        let partners =
            { send.iter().map(|(to, _)| *to) }.chain(receive.iter().map(|(from, _)| *from));
        if let Some(rank) = partners.into_iter().find(|rank| *rank >= ranks) {
            return Err(Failure::NoRank { rank, ranks });
        }
        let own = self.rank();
        self.to_oneself(send, receive)?;
        let begun = Instant::now();
        let answer = match &self.kind {
            Kind::Alone => Ok(work()),
            Kind::Thread(thread) => {
                thread.send(send.iter().filter(|(to, _)| *to != own));
                let answer = work();
                let received = thread.receive(receive.iter_mut().filter(|(from, _)| *from != own));
                received.map(|()| answer)
            }
            #[cfg(unix)]
            Kind::Mpi(mpi) => mpi.exchange(send, receive, work),
        };
        let waited = begun.elapsed().as_nanos() as u64;
        self.counted.waited.fetch_add(waited, Ordering::Relaxed);
        answer
    }

    /// What a rank sends to itself is copied.
    fn to_oneself(
        &self,
        send: &[(usize, &[u8])],
        receive: &mut [(usize, &mut [u8])],
    ) -> Result<(), Failure> {
        let own = self.rank();
        let mut sent = send.iter().filter(|(to, _)| *to == own);
        let mut received = receive.iter_mut().filter(|(from, _)| *from == own);
        loop {
            match (sent.next(), received.next()) {
                (None, None) => return Ok(()),
                (Some((_, bytes)), Some((_, into))) if bytes.len() == into.len() => {
                    into.copy_from_slice(bytes)
                }
                (sent, received) => {
                    return Err(Failure::Length {
                        from: own,
                        sent: sent.map_or(0, |(_, bytes)| bytes.len()),
                        expected: received.map_or(0, |(_, into)| into.len()),
                    });
                }
            }
        }
    }

    /// Ends this rank, and so all, where what others have to say does not come: processes with the message and exit code 1, threads by a panic.
    pub fn end(&self, failure: Failure) -> ! {
        match &self.kind {
            Kind::Thread(_) => panic!("{failure}"),
            #[cfg(unix)]
            Kind::Mpi(_) => {}
            Kind::Alone => {}
        }
        eprintln!("error: rank {}: {failure}", self.rank());
        self.abort(1)
    }

    /// Ends all ranks at once with this exit code, as where one cannot go on and the others wait for it. Threads end by their own errors
    /// ([`Failure::Ended`]); a process alone just ends.
    pub fn abort(&self, code: i32) -> ! {
        #[cfg(unix)]
        if let Kind::Mpi(mpi) = &self.kind {
            mpi.abort(code);
        }
        std::process::exit(code)
    }
}
