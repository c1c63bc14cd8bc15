//! Writers: each turns snapshots or numbers into one format, atomically, and does nothing else.

pub mod atomic;
pub mod card;
pub mod checkpoint;
pub mod conservation;
pub mod continuum;
pub mod data;
pub mod dump;
pub mod earlier;
pub mod exodus;
pub mod extxyz;
pub mod fields;
pub mod folder;
mod font;
pub mod fragments;
mod grown;
pub mod history;
pub mod linear;
pub mod npz;
pub mod picture;
pub mod plot;
pub mod pvd;
pub mod report;
pub mod run_json;
pub mod series;
pub mod setfl;
pub mod shares;
pub mod space;
pub mod space_time;
pub mod table;
pub mod trajectory;
pub mod vtkhdf;
pub mod vtu;

pub use atomic::WriteError;
pub use grown::{Grown, Seal, Summed};
pub use series::{Series, SeriesOptions};
