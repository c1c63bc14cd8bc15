//! Writers: each turns snapshots or numbers into one format, atomically, and does nothing else.

pub mod atomic;
pub mod dump;
pub mod fields;
pub mod history;
pub mod pvd;
pub mod run_json;
pub mod vtu;
