//! What was understood, in words.

mod acting;
mod deck;
mod family;
mod material;
mod probe;
mod schedule;
mod shape;
mod words;

pub use deck::{describe, sources};
