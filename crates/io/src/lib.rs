//! io
pub mod deck;
pub mod read;
