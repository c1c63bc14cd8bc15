//! What can go wrong, with data; the front end adds file, line and span.

mod build;
mod run;
mod size;
mod solve;

pub use build::{BuildError, BuildErrorKind};
pub use run::RunError;
pub use size::size;
pub use solve::{Loose, SolveError};
