//! A row of the table.

use std::fmt::Write;

pub(super) const AXES: [&str; 3] = ["x", "y", "z"];

/// Width of the names of rows.
pub(super) const NAME: usize = 18;

pub(super) fn row(out: &mut String, name: &str, value: impl std::fmt::Display) {
    // writing to a String cannot fail
    let _ = writeln!(out, "  {name:NAME$}{value}");
}
