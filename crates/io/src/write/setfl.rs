//! `eam/alloy` files (setfl) of tables: what LAMMPS and [`crate::read::eam`] read.

use std::io::{self, Write};
use std::path::Path;

use super::atomic::{WriteError, write_file};
use super::fields::invalid;
use crate::read::eam::EamFile;

/// Writes the tables, all or nothing; numbers read back to the same f64.
///
/// # Errors
/// The operating system's; `InvalidInput` when tables are missing, of unequal lengths or not finite.
pub fn write_setfl(path: &Path, file: &EamFile) -> Result<(), WriteError> {
    write_file(path, |w| setfl_to(w, file))
}

/// The same to any writer.
///
/// # Errors
/// Those of `w`, and those of [`write_setfl`].
pub fn setfl_to<W: Write>(w: &mut W, file: &EamFile) -> io::Result<()> {
    let (nrho, nr) = check(file)?;
    if !file.density_at.is_empty() {
        return Err(invalid(
            "densities that know both ends belong into an eam/fs file".into(),
        ));
    }
    // exactly three lines, or all that follows is misread
    let comments = file.comments.iter().flat_map(|c| c.lines());
    let rest = file.comments.iter().flat_map(|c| c.lines()).skip(2);
    for line in comments.take(2) {
        writeln!(w, "{line}")?;
    }
    let lines: usize = file.comments.iter().map(|c| c.lines().count()).sum();
    for _ in lines..2 {
        writeln!(w)?;
    }
    writeln!(w, "{}", rest.collect::<Vec<_>>().join(" | "))?;
    write!(w, "{}", file.elements.len())?;
    for element in &file.elements {
        write!(w, " {}", element.name)?;
    }
    writeln!(
        w,
        "\n{nrho} {:.16e} {nr} {:.16e} {:.16e}",
        file.drho, file.dr, file.cutoff
    )?;
    for (i, e) in file.elements.iter().enumerate() {
        let (number, mass, constant) = (e.number, e.mass, e.lattice_constant);
        writeln!(w, "{number} {mass:?} {constant:?} {}", e.lattice)?;
        table(w, &file.embedding[i])?;
        table(w, &file.density[i])?;
    }
    file.pair.iter().try_for_each(|values| table(w, values))
}

fn table<W: Write>(w: &mut W, values: &[f64]) -> io::Result<()> {
    for row in values.chunks(5) {
        for value in row {
            // 17 digits, exponents as C writes them
            let text = format!("{value:.16e}");
            let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
            let (sign, exponent) = match exponent.strip_prefix('-') {
                Some(e) => ('-', e),
                None => ('+', exponent),
            };
            write!(w, " {digits:>19}e{sign}{exponent:0>2}")?;
        }
        writeln!(w)?;
    }
    Ok(())
}

/// Lengths of the tables.
fn check(file: &EamFile) -> io::Result<(usize, usize)> {
    let n = file.elements.len();
    let [nrho, nr] = [&file.embedding, &file.density].map(|t| t.first().map_or(0, Vec::len));
    let counts = [
        ("embedding energies", &file.embedding, n, nrho),
        ("electron densities", &file.density, n, nr),
        ("pair energies", &file.pair, n * (n + 1) / 2, nr),
    ];
    for (what, tables, count, length) in counts {
        if tables.len() != count || n == 0 {
            let got = tables.len();
            return Err(invalid(format!(
                "{n} elements take {count} tables of {what}, there are {got}"
            )));
        }
        if let Some(t) = tables.iter().find(|t| t.len() != length || t.len() < 5) {
            let got = t.len();
            return Err(invalid(format!(
                "a table of {what} has {got} values instead of {length} (at least 5)"
            )));
        }
        if tables.iter().flatten().any(|v| !v.is_finite()) {
            return Err(invalid(format!("a value of the {what} is not finite")));
        }
    }
    if let Some(e) = file
        .elements
        .iter()
        .find(|e| e.name.is_empty() || e.name.contains(char::is_whitespace))
    {
        return Err(invalid(format!("`{}` is no name of an element", e.name)));
    }
    Ok((nrho, nr))
}
