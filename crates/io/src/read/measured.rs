//! Columns of a table of what was measured: CSV, whose first line names them and their units, `pull [kN]`.

use super::error::ReadError;
use super::lines::Lines;
use super::number::{comma, number};
use crate::deck::{Dim, unit};
use crate::write::report::history::{Column, cells, column};
use std::path::Path;

/// A column of what was measured.
pub struct Measured {
    pub name: String,
    /// Of the values; the file may have another one.
    pub unit: String,
    /// The file names no unit.
    pub plain: bool,
    pub values: Vec<f64>,
}

/// The columns of these names, each in this unit, and the lines that their numbers are from. A column without a unit is in it already.
/// Other columns may say anything; blank lines and those that begin with # are passed over.
///
/// # Errors
/// The file cannot be read, lacks one of the columns or has it twice, has a unit of another kind, no rows, or something else than a
/// number in a cell.
pub fn columns(
    path: &Path,
    wanted: &[(&str, &str)],
) -> Result<(Vec<Measured>, Vec<usize>), ReadError> {
    let (text, name) = super::text_of(path)?;
    let mut lines = Lines::new(&text, &name);
    let titles =
        line_of(&mut lines).ok_or_else(|| ReadError::file(path, format!("it is empty; {HOW}")))?;
    let named: Vec<Column> = { cells(titles).into_iter() }
        .map(|cell| {
            let spaced = cell.trim().replace('[', " [");
            let column = column(&spaced);
            Column {
                name: column.name.trim().into(),
                ..column
            }
        })
        .collect();
    let mut found = vec![];
    for (name, to) in wanted {
        let mut places = (0..named.len()).filter(|n| named[*n].name == *name);
        let (Some(place), None) = (places.next(), places.next()) else {
            let all: Vec<&str> = named.iter().map(|c| &*c.name).collect();
            return Err(lines.error(format!(
                "one column `{name}` is looked for, here are {}; {HOW}",
                all.join(", ")
            )));
        };
        let from = named[place].unit.trim();
        let factor = factor(from, to)
            .map_err(|why| lines.error(format!("the column `{name} [{from}]`: {why}")))?;
        let column = Measured {
            name: (*name).into(),
            unit: (*to).into(),
            plain: from.is_empty(),
            values: vec![],
        };
        found.push((place, factor, column));
    }
    let mut rows = vec![];
    while let Some(line) = line_of(&mut lines) {
        let row = cells(line);
        if row.len() != named.len() {
            return Err(lines.error(format!(
                "{} cells, the first line names {} columns{}",
                row.len(),
                named.len(),
                comma(line)
            )));
        }
        for (place, factor, column) in &mut found {
            let cell = row[*place].trim();
            let value = number(cell).map(&*factor).filter(|x| x.is_finite());
            let value = value.ok_or_else(|| {
                let what = match cell {
                    "" => "nothing",
                    cell => cell,
                };
                let (name, help) = (&column.name, comma(cell));
                lines.error(format!(
                    "expected a number in the column `{name}`, found {what}{help}"
                ))
            })?;
            column.values.push(value);
        }
        rows.push(lines.number);
    }
    if rows.is_empty() {
        return Err(lines.error(format!("no rows under the first line; {HOW}")));
    }
    Ok((found.into_iter().map(|(.., column)| column).collect(), rows))
}

const HOW: &str = "the first line names the columns, `opening [mm],pull [kN]`, and a row of numbers follows for each point";

fn line_of<'a>(lines: &mut Lines<'a>) -> Option<&'a str> {
    loop {
        let line = lines.next()?;
        if !line.starts_with('#') {
            return Some(line);
        }
    }
}

/// From one unit into another of the same kind.
fn factor(from: &str, to: &str) -> Result<Box<dyn Fn(f64) -> f64>, String> {
    if from.is_empty() || from == to {
        return Ok(Box::new(|x| x));
    }
    let from = unit(from)?;
    let (dim, one) = match to {
        "" => (Dim::NUMBER, 1.0),
        to => unit(to).map(|u| (u.dim, u.si(1.0)))?,
    };
    if from.dim != dim {
        let to = if to.is_empty() {
            "a number without one"
        } else {
            to
        };
        return Err(format!(
            "it is {}, and what is computed is in {to}: {dim}",
            from.dim
        ));
    }
    Ok(Box::new(move |x| from.si(x) / one))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str, wanted: &[(&str, &str)]) -> Result<Vec<Measured>, String> {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("curve.csv");
        std::fs::write(&path, text).unwrap();
        let read = columns(&path, wanted).map_err(|e| e.to_string());
        read.map(|(columns, _)| columns)
            .map_err(|e| e.replace(&path.display().to_string(), "curve.csv"))
    }

    #[test]
    fn columns_come_in_the_units_that_are_asked_for() {
        let text = "# a test of 1999\n\nspecimen, pull[kN] ,opening [mm],pull_y\na,0.5,1e-1,1\n# pause\nb, 1 ,2D-1,2\n";
        let wanted = [("opening", "m"), ("pull", "N"), ("pull_y", "N")];
        let all = read(text, &wanted).unwrap();
        assert_eq!(all[0].values, [1e-4, 2e-4]);
        assert_eq!(all[1].values, [500.0, 1000.0]);
        assert_eq!(all[2].values, [1.0, 2.0]);
        let metal = read("f [eV/Å]\n2\n", &[("f", "eV Å^-1")]).unwrap();
        assert_eq!(metal[0].values, [2.0]);
        let part = read("s [%]\n2\n", &[("s", "")]).unwrap();
        assert_eq!(part[0].values, [0.02]);
    }

    #[test]
    fn mistakes_have_their_line() {
        for (text, why) in [
            ("", "curve.csv: it is empty"),
            ("x [mm],y [N]\n", "curve.csv:1: no rows"),
            (
                "x [mm],z [N]\n1,2\n",
                "curve.csv:1: one column `y` is looked for, here are x, z",
            ),
            ("x [mm],y [N],y [N]\n1,2,3\n", "curve.csv:1: one column `y`"),
            ("x [mm],y [kn]\n1,2\n", "did you mean `kN`?"),
            (
                "x [mm],y [mm]\n1,2\n",
                "curve.csv:1: the column `y [mm]`: it is a length",
            ),
            (
                "x [mm],y [N]\n1,2\n\n3,NaN\n",
                "curve.csv:4: expected a number in the column `y`, found NaN",
            ),
            (
                "x [mm],y [N]\n1,2\n3,\n",
                "curve.csv:3: expected a number in the column `y`, found nothing",
            ),
            ("x [mm],y [N]\n1,inf\n", "curve.csv:2: expected a number"),
            (
                "x [mm],y [N]\n1,2,3\n",
                "curve.csv:2: 3 cells, the first line names 2 columns",
            ),
        ] {
            let told = read(text, &[("x", "m"), ("y", "N")]).err().unwrap();
            assert!(told.contains(why), "{text:?}: {told}");
        }
    }
}
