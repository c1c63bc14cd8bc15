//! What goes wrong between ranks.

use crate::launcher::Launched;
use thiserror::Error;

/// Why ranks cannot go on together.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum Failure {
    #[error(
        "{launched}, but no MPI with the standard ABI (libmpi_abi: MPICH 5, Intel MPI, Open MPI 6) was found: {}. \
         Write PERIDYNE_MPI=PATH with its path, or `pip install mpich` and start with that mpiexec", tried.join("; ")
    )]
    NoMpi {
        launched: Launched,
        /// What was looked for, and why it was not it.
        tried: Vec<String>,
    },
    #[error(
        "{launched}, but {library} knows of {ranks}: the launcher is of another MPI. \
         Start with the mpiexec beside that library, or write PERIDYNE_MPI=PATH with the library of this launcher"
    )]
    OtherLauncher {
        launched: Launched,
        library: String,
        ranks: usize,
    },
    #[error("rank {rank} has ended, and others wait for what it would have sent")]
    Ended { rank: usize },
    #[error("rank {from} sent {sent} bytes where {expected} are expected")]
    Length {
        from: usize,
        sent: usize,
        expected: usize,
    },
    #[error("there is no rank {rank}: there are {ranks}, from 0")]
    NoRank { rank: usize, ranks: usize },
    #[error("MPI: {0}")]
    Mpi(String),
}
