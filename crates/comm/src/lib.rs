//! Ranks: processes or threads that share one computation and tell each other what the others need.
//!
//! [`Comm`] is one of three things: a process alone, threads of one process ([`on_threads`], which tests and laptops have), or processes that an MPI
//! launcher started ([`Comm::of_launcher`]). Nothing here is compiled against an MPI: the library is found when the program starts ([`mpi`]), unless the
//! feature `ferrompi` is on.
//!
//! All that there is is made of one operation, [`Comm::exchange`]: messages to and from other ranks, with work meanwhile. The others
//! ([`Comm::all`], [`Comm::barrier`]) are made of it once for all three. No number is ever added up on the way: who needs a sum
//! gathers what is summed and adds in an order of its own, so that it does not depend on how many ranks there are.

mod collect;
mod comm;
mod failure;
pub mod launcher;
#[cfg(all(unix, feature = "ferrompi"))]
#[path = "mpi/linked.rs"]
pub mod mpi;
#[cfg(all(unix, not(feature = "ferrompi")))]
pub mod mpi;
mod on_threads;
mod threads;

pub use comm::{Comm, Traffic, Work};
pub use failure::Failure;
pub use on_threads::{on_threads, on_threads_apart};
