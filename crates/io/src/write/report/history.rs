//! `history.csv` as a report shows it.

use std::path::Path;

use serde_json::{Value, json};

use super::short;
use crate::read::ReadError;
use crate::write::history::{ledger_columns, today};

/// Rows of a report.
const ROWS: usize = 2000;
/// Columns that plots of probes leave out.
const OWN: [&str; 8] = [
    "step",
    "time",
    LOAD,
    "broken_bonds",
    "iterations",
    "solver_residual",
    "temperature",
    "pressure",
];
/// What the time of statics is called.
pub const LOAD: &str = "load factor";

/// A column: name, unit, a number for each row.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    pub name: String,
    pub unit: String,
    pub values: Vec<f64>,
}

impl Column {
    /// Or is it of every run?
    pub fn is_of_a_probe(&self) -> bool {
        let ledger = ledger_columns("");
        !OWN.contains(&&*self.name) && ledger.iter().all(|c| c.name != self.name)
    }
}

/// Columns of a table whose header is `name [unit]`.
///
/// # Errors
/// It cannot be read, or a row is not one of numbers.
pub fn read(path: &Path) -> Result<Vec<Column>, ReadError> {
    let (text, _) = crate::read::text_of(path)?;
    let mut lines = text.lines();
    let names = cells(lines.next().unwrap_or(""));
    let mut columns: Vec<Column> = names.iter().map(|c| column(c)).collect();
    for (n, line) in lines.enumerate() {
        let row: Option<Vec<f64>> = line.split(',').map(|c| c.parse().ok()).collect();
        match row.filter(|r| r.len() == columns.len()) {
            Some(row) => { columns.iter_mut().zip(row) }.for_each(|(c, v)| c.values.push(v)),
            None => {
                let message = format!("line {}: not {} numbers", n + 2, columns.len());
                return Err(ReadError::file(path, message));
            }
        }
    }
    Ok(columns)
}

/// The column that a cell of the first line names as `name [unit]`, empty yet.
pub(crate) fn column(cell: &str) -> Column {
    let (name, unit) = match cell.strip_suffix(']').and_then(|c| c.rsplit_once(" [")) {
        Some((name, unit)) => (name, unit),
        None => (cell, ""),
    };
    Column {
        name: today(name).into(),
        unit: unit.into(),
        values: vec![],
    }
}

/// Cells of a line (RFC 4180).
pub(crate) fn cells(line: &str) -> Vec<String> {
    let (mut all, mut cell, mut quoted) = (vec![], String::new(), false);
    let mut rest = line.chars().peekable();
    while let Some(c) = rest.next() {
        match c {
            '"' if quoted && rest.peek() == Some(&'"') => {
                rest.next();
                cell.push('"');
            }
            '"' => quoted = !quoted,
            ',' if !quoted => all.push(std::mem::take(&mut cell)),
            c => cell.push(c),
        }
    }
    all.push(cell);
    all
}

/// Steps and their times, where both are there and time is not load.
pub fn clock(columns: &[Column]) -> Vec<(u64, f64)> {
    let find = |name: &str| columns.iter().find(|c| c.name == name);
    let (Some(steps), Some(times)) = (find("step"), find("time")) else {
        return vec![];
    };
    let each = steps.values.iter().zip(&times.values);
    each.map(|(s, t)| (*s as u64, *t)).collect()
}

/// What the page needs of it, and what was left out.
pub fn shown(columns: &[Column]) -> (Value, Option<String>) {
    let rows = columns.first().map_or(0, |c| c.values.len());
    let every = rows.div_ceil(ROWS).max(1);
    let kept = |r: &usize| r.is_multiple_of(every) || r + 1 == rows;
    let named = |name: &str| columns.iter().find(|c| c.name == name);
    let over = ["time", LOAD, "t", "step"]
        .into_iter()
        .find(|n| named(n).is_some());
    let varies = |c: &&Column| c.values.iter().any(|v| *v != c.values[0]);
    let law = named("total_variation").is_some();
    let mut plots = vec![];
    let mut plot = |title: &str, names: &[&str], y: &str| {
        plots.push(json!({"title": title, "names": names, "y": y}));
    };
    if law {
        plot("Energy", &["energy"], "");
        plot("Mass", &["mass"], "");
        plot(
            "Rate of the energy",
            &["energy_rate", "energy_rate_exact"],
            "rate",
        );
        plot("Extremes", &["min", "max"], "u");
        plot("Total variation", &["total_variation"], "");
    } else {
        plot("Energy balance error", &["energy balance error"], "");
        plot("Broken bonds", &["broken_bonds"], "");
        plot("Temperature", &["temperature"], "");
        plot("Pressure", &["pressure"], "");
    }
    let ledger = ledger_columns("");
    let ledger: Vec<&str> = ledger.iter().map(|c| &*c.name).collect();
    let probes: Vec<&Column> = columns
        .iter()
        .filter(|c| !law && c.is_of_a_probe())
        .filter(varies)
        .collect();
    let mut units: Vec<&str> = vec![];
    for c in &probes {
        if !units.contains(&&*c.unit) {
            units.push(&c.unit);
        }
    }
    for unit in units {
        let names: Vec<&str> = { probes.iter().filter(|c| c.unit == unit) }
            .map(|c| &*c.name)
            .collect();
        for six in names.chunks(6) {
            let title = if six.len() == 1 {
                six[0].replace('_', " ")
            } else {
                "Probes".into()
            };
            plot(&title, six, "");
        }
    }
    // what pulls over what it is pulled by
    let of = |units: &'static [&'static str]| {
        let mut all = probes.iter().filter(move |c| units.contains(&&*c.unit));
        move || all.next()
    };
    let (mut lengths, mut forces) = (of(&["m", "Å"]), of(&["N", "eV Å^-1"]));
    let mut presets = vec![];
    if let Some(x) = lengths() {
        while let Some(y) = forces().filter(|_| presets.len() < 3) {
            presets.push(json!({"title": format!("{} over {}", y.name.replace('_', " "), x.name.replace('_', " ")), "x": x.name, "y": y.name}));
        }
    }
    for y in ["energy balance error", "kinetic energy"] {
        if let (Some(x), Some(c)) = (over, named(y)) {
            presets.extend(varies(&c).then(|| json!({"title": y, "x": x, "y": y})));
        }
    }
    let column = |c: &Column| {
        let values: Vec<Value> = (0..rows).filter(kept).map(|r| short(c.values[r])).collect();
        json!({"name": c.name, "unit": c.unit, "values": values})
    };
    // the last is what the balance misses
    let energies = &ledger[..ledger.len() - 1];
    let shown = json!({
        "over": over, "energies": if law { &[][..] } else { energies }, "plots": plots, "presets": presets,
        "columns": columns.iter().map(column).collect::<Vec<_>>(),
    });
    let note = (every > 1)
        .then(|| format!("Plots have every {every}th row of history.csv, which has {rows}."));
    (shown, note)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::write::history::{Column as Written, History};

    #[test]
    fn what_is_written_is_read() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("history.csv");
        let columns = [Written::new("a,b \"c\"", "m/s"), Written::new("x [1]", "")];
        let mut history = History::create(&path, &columns).unwrap();
        history.push(3, &[0.1 + 0.2, f64::NAN]).unwrap();
        history.push(4, &[-1e300, 2.0]).unwrap();
        let read = read(&path).unwrap();
        assert_eq!(read[0].values, [3.0, 4.0]);
        assert_eq!((&*read[1].name, &*read[1].unit), ("a,b \"c\"", "m/s"));
        assert_eq!(read[1].values, [0.1 + 0.2, -1e300]);
        assert!(read[2].values[0].is_nan());
    }

    #[test]
    fn a_torn_row_is_told() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("history.csv");
        std::fs::write(&path, "step,time [s]\n1,2\n3\n").unwrap();
        let text = read(&path).unwrap_err().to_string();
        assert!(text.contains("line 3: not 2 numbers"), "{text}");
    }

    #[test]
    fn loads_and_displacements_are_offered() {
        let column = |name: &str, unit: &str| Column {
            name: name.into(),
            unit: unit.into(),
            values: (0..5000).map(f64::from).collect(),
        };
        let columns = [
            column("step", ""),
            column("time", "s"),
            column("pull x", "N"),
            column("opening", "m"),
        ];
        let (shown, note) = shown(&columns);
        assert_eq!(shown["presets"][0]["x"], "opening");
        assert_eq!(shown["presets"][0]["y"], "pull x");
        let rows = shown["columns"][0]["values"].as_array().unwrap();
        assert_eq!((rows.len(), &rows[rows.len() - 1]), (1668, &json!(4999.0)));
        assert!(
            note.unwrap()
                .contains("every 3th row of history.csv, which has 5000")
        );
    }
}
