//! What can go wrong, with data; the front end adds file, line and span.

mod build;
mod run;
mod solve;

pub use build::{BuildError, BuildErrorKind};
pub use run::RunError;
pub use solve::{Loose, SolveError};

/// Bytes for readers.
pub fn size(bytes: f64) -> String {
    match bytes {
        b if b >= 1e12 => format!("{:.3} TB", b / 1e12),
        b if b >= 1e9 => format!("{:.1} GB", b / 1e9),
        b => format!("{:.0} MB", b / 1e6),
    }
}
