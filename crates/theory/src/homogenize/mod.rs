//! Bodies that end: factors of bonds that make them as stiff at their ends as inside.

pub mod surface;
