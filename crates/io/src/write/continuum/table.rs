//! `points.csv`: one row for each point. A quantity that the frame does not allow, or that is not defined at a point, is an empty field;
//! where one is missing altogether, a last column without values says why.

use super::columns::{Column, Table, components};
use crate::write::atomic::WriteError;
use crate::write::grown::{Seal, write_sealed};
use std::io::{self, Write};
use std::path::Path;

/// Writes the table, and says what is in it; of means also `errors` beside it, with the standard errors.
///
/// # Errors
/// The operating system's.
pub fn write_table(path: &Path, table: &Table) -> Result<Seal, WriteError> {
    let seal = write_sealed(path, |w| rows(w, table, |c| c.values.as_deref().ok()))?;
    if table.columns.iter().any(|c| c.errors.is_some()) {
        let errors = path.with_file_name("errors.csv");
        write_sealed(&errors, |w| rows(w, table, |c| c.errors.as_deref()))?;
    }
    Ok(seal)
}

fn rows<W: Write>(
    w: &mut W,
    table: &Table,
    of: impl Fn(&Column) -> Option<&[f64]>,
) -> io::Result<()> {
    write!(w, "x,y,z")?;
    let mut missing: Vec<(&str, Vec<&str>)> = vec![];
    for column in &table.columns {
        for name in components(&column.name, column.quantity) {
            write!(w, ",{name}")?;
        }
        if let Err(why) = column.values {
            match missing.iter_mut().find(|m| m.0 == why) {
                Some((_, names)) => names.push(&column.name),
                None => missing.push((why, vec![&column.name])),
            }
        }
    }
    for (why, names) in &missing {
        write!(w, ",no {}: {why}", names.join(" "))?;
    }
    writeln!(w)?;
    for (p, x) in table.points.iter().enumerate() {
        write!(w, "{:?},{:?},{:?}", x[0], x[1], x[2])?;
        for column in &table.columns {
            let n = column.quantity.components();
            for c in 0..n {
                match of(column).map(|all| all[n * p + c]) {
                    Some(value) if value.is_finite() => write!(w, ",{value:?}")?,
                    Some(_) | None => write!(w, ",")?,
                }
            }
        }
        writeln!(w, "{}", ",".repeat(missing.len()))?;
    }
    Ok(())
}
