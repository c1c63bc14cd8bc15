//! `eam/alloy` files: three comment lines; `N name…`; `Nrho drho Nr dr cutoff`; per element a line
//! `number mass lattice_constant lattice` with its tables F and ρ; then r φ of every pair, lower triangle. `eam/fs` files have a
//! table ρ at an atom of each element instead of one (Finnis & Sinclair 1984).

use super::super::error::ReadError;
use super::file::{EamElement, EamFile, failure};
use super::titled;
use super::values::Values;
use std::path::Path;

/// Reads an `eam/alloy` file.
///
/// # Errors
/// File and line: it is truncated, has something else than a finite number in a table, counts that do not fit,
/// steps that are not positive, or a cutoff beyond its tables.
pub fn setfl(path: &Path) -> Result<EamFile, ReadError> {
    let (text, name) = titled(path, 3)?;
    parse_setfl(&text, &name)
}

/// Reads an `eam/fs` file.
///
/// # Errors
/// As [`setfl`].
pub fn fs(path: &Path) -> Result<EamFile, ReadError> {
    let (text, name) = titled(path, 3)?;
    parse_fs(&text, &name)
}

/// The same from a text; `name` is for messages.
pub fn parse_setfl(text: &str, name: &str) -> Result<EamFile, ReadError> {
    parse(text, name, false)
}

/// An `eam/fs` file from a text; `name` is for messages.
pub fn parse_fs(text: &str, name: &str) -> Result<EamFile, ReadError> {
    parse(text, name, true)
}

fn parse(text: &str, name: &str, both_ends: bool) -> Result<EamFile, ReadError> {
    let kind = if both_ends { "eam/fs" } else { "eam/alloy" };
    let mut values = Values::new(text, name);
    let mut comments = Vec::new();
    for _ in 0..3 {
        let line = values.lines.next_raw();
        let line = line.ok_or_else(|| {
            failure(
                name,
                None,
                format!("the file ends within its three comment lines: this is not an {kind} file"),
            )
        })?;
        comments.push(line.trim_end().to_string());
    }
    let names = names(&mut values)?;
    // many files put the cutoff one step beyond the last knot, where the last value stays
    let grid = Grid::read(&mut values, 1.5)?;
    let mut file = EamFile {
        source: name.to_string(),
        comments,
        elements: Vec::new(),
        drho: grid.drho,
        dr: grid.dr,
        cutoff: grid.cutoff,
        embedding: Vec::new(),
        density: Vec::new(),
        density_at: Vec::new(),
        pair: Vec::new(),
    };
    for element in &names {
        let what = format!("`number mass lattice_constant lattice` of {element}");
        let words = values.header(&what)?;
        file.elements.push(described(&values, &words, element)?);
        let what = format!("the embedding energy F of {element}");
        file.embedding.push(values.table(&what, grid.nrho)?);
        if both_ends {
            let mut each = vec![];
            for at in &names {
                let what = format!("the electron density of {element} at {at}");
                each.push(values.table(&what, grid.nr)?);
            }
            file.density.push(each[file.density.len()].clone());
            file.density_at.push(each);
        } else {
            let what = format!("the electron density of {element}");
            file.density.push(values.table(&what, grid.nr)?);
        }
    }
    for (i, first) in names.iter().enumerate() {
        for second in &names[..=i] {
            let what = format!("r φ of the pair {first}-{second}");
            file.pair.push(values.table(&what, grid.nr)?);
        }
    }
    values.end(match both_ends {
        true => "",
        false => "; this reads eam/alloy: files of eam/fs, which have a density for every pair, are named .fs",
    })?;
    Ok(file)
}

fn names(values: &mut Values) -> Result<Vec<String>, ReadError> {
    let words = values.header("`N` and the names of N elements")?;
    let count = values.count(words.first(), "the number of elements", 1)?;
    let names: Vec<String> = words[1..].iter().map(|w| w.to_string()).collect();
    if names.len() != count {
        return Err(values.lines.error(format!(
            "{count} elements are announced and {} named: write `{} {}`",
            names.len(),
            names.len(),
            names.join(" ")
        )));
    }
    if let Some(i) = (1..count).find(|i| names[..*i].contains(&names[*i])) {
        return Err(values
            .lines
            .error(format!("the element {} is named twice", names[i])));
    }
    Ok(names)
}

/// `number mass lattice_constant lattice`.
pub(super) fn described(
    values: &Values,
    words: &[&str],
    name: &str,
) -> Result<EamElement, ReadError> {
    Ok(EamElement {
        name: name.to_string(),
        number: values
            .lines
            .parse(words.first().copied(), "an atomic number")?,
        mass: values.positive(words.get(1), "the mass")?,
        lattice_constant: match words.get(2) {
            Some(word) => values.number(word, || "the lattice constant".into())?,
            None => 0.0,
        },
        lattice: words.get(3).unwrap_or(&"").to_string(),
    })
}

/// The line of counts and steps.
#[derive(Debug, Clone, Copy)]
pub(super) struct Grid {
    pub nrho: usize,
    pub drho: f64,
    pub nr: usize,
    pub dr: f64,
    pub cutoff: f64,
}

impl Grid {
    /// The cutoff may lie `spare` steps beyond the last knot.
    pub fn read(values: &mut Values, spare: f64) -> Result<Grid, ReadError> {
        let what = "Nrho drho Nr dr cutoff";
        let words = values.header(&format!("`{what}`"))?;
        if words.len() != 5 {
            return Err(values.lines.error(format!(
                "expected the five numbers `{what}`, found {}",
                words.len()
            )));
        }
        // slopes at the knots take five values
        let grid = Grid {
            nrho: values.count(words.first(), "Nrho", 5)?,
            drho: values.positive(words.get(1), "drho")?,
            nr: values.count(words.get(2), "Nr", 5)?,
            dr: values.positive(words.get(3), "dr")?,
            cutoff: values.positive(words.get(4), "the cutoff")?,
        };
        let end = (grid.nr - 1) as f64 * grid.dr;
        if grid.cutoff > (end + spare * grid.dr) * (1.0 + 1e-6) {
            return Err(values.lines.error(format!(
                "the cutoff {} lies beyond the tables, which end at (Nr - 1) dr = {end}: write a smaller cutoff or longer tables",
                grid.cutoff
            )));
        }
        Ok(grid)
    }
}
