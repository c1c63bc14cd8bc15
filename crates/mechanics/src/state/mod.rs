//! What a model cannot find again: everything that a step reads and an earlier step wrote, and that does not follow to the last bit
//! from other such numbers.
//!
//! Whoever owns such numbers passes them through an [`Archive`], which writes them down or reads them back in place: one text for
//! both, so that what is saved is what is loaded. Numbers keep their kind (bits of bonds stay bits), those of points and bonds are in the order of ids:
//! how they lie in memory, and on which rank, does not show. What was read is followed by what follows from it: an owner looks again at whatever it derives.

mod archive;
mod ranks;
mod shared;
mod words;

pub use archive::{Archive, Owner, StateError};
pub use shared::{Bonds, Whose};
pub use words::{Word, words};
