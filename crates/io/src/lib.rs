//! io

pub mod write;
