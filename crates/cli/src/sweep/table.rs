//! `sweep.csv`: a row per run; and a plot of each probe over each key of numbers.

use super::design::{Values, quantity};
use crate::study::Row;
use peridyne_io::write::WriteError;
use peridyne_io::write::plot::Plot;
use peridyne_io::write::report::history::{self, Column};
use peridyne_io::write::table::Table;
use std::path::{Path, PathBuf};

/// Numbers of `run.json` with their units.
const OF_RECORD: [(&str, &str); 5] = [
    ("steps", ""),
    ("particles", ""),
    ("broken_bonds", ""),
    ("fragments", ""),
    ("seconds_stepping", "s"),
];

/// The numbers of values of a key and their unit, where all are numbers in the same unit.
fn numbers<'a>(values: impl Iterator<Item = &'a String>) -> Option<(Vec<f64>, String)> {
    let each: Option<Vec<(f64, String)>> = values.map(|v| quantity(v)).collect();
    let each = each?;
    let unit = each.first()?.1.clone();
    let alike = each.iter().all(|(_, other)| *other == unit);
    alike.then(|| (each.into_iter().map(|(x, _)| x).collect(), unit))
}

/// Writes both, and says which files.
pub fn save(
    dir: &Path,
    vary: &[(String, Values)],
    rows: &[Row],
) -> Result<Vec<PathBuf>, WriteError> {
    let history = |row: &Row| {
        // of one that did not begin there is none
        let mut all = history::read(&row.dir.join("history.csv")).unwrap_or_default();
        all.retain(|c| c.name != "step");
        all
    };
    let histories: Vec<Vec<Column>> = rows.iter().map(history).collect();
    let name = |row: &Row| {
        row.dir
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned()
    };
    let mut table = Table::new().text("run", rows.iter().map(name));
    for (n, (key, _)) in vary.iter().enumerate() {
        let plain = |row: &Row| row.setting[n].1.trim_matches('"').to_string();
        table = table.text(key, rows.iter().map(plain));
    }
    table = table.text("status", rows.iter().map(|r| r.status.clone()));
    for (key, unit) in OF_RECORD {
        let of = |row: &Row| {
            let record = row.record.as_ref();
            record.and_then(|r| r[key].as_f64()).unwrap_or(f64::NAN)
        };
        table = table.column(key, unit, rows.iter().map(of));
    }
    let whole = histories.iter().max_by_key(|h| h.len());
    let all: Vec<&Column> = whole.into_iter().flatten().collect();
    let of = |n: usize, name: &str, pick: &dyn Fn(&[f64]) -> f64| {
        let column = histories[n].iter().find(|c| c.name == name);
        column.map_or(f64::NAN, |c| pick(&c.values))
    };
    let last = |v: &[f64]| v.last().copied().unwrap_or(f64::NAN);
    let least = |v: &[f64]| v.iter().copied().fold(f64::NAN, f64::min);
    let largest = |v: &[f64]| v.iter().copied().fold(f64::NAN, f64::max);
    let picks: [(&str, &dyn Fn(&[f64]) -> f64); 3] =
        [("last", &last), ("least", &least), ("largest", &largest)];
    for Column { name, unit, .. } in &all {
        for (which, pick) in picks {
            let each = (0..rows.len()).map(|n| of(n, name, pick));
            table = table.column(&format!("{name}, {which}"), unit, each);
        }
    }
    let whys = rows.iter().map(|r| r.why.clone().unwrap_or_default());
    table = table.text("why", whys);
    let path = dir.join("sweep.csv");
    table.save(&path)?;
    let mut files = vec![path];
    // one key of numbers alone tells how all else depends on it
    if let [(key, _)] = vary
        && let Some((x, of_x)) = numbers(rows.iter().map(|r| &r.setting[0].1))
    {
        for Column { name, unit, .. } in all.iter().filter(|c| c.is_of_a_probe()) {
            let mut points: Vec<[f64; 2]> = { x.iter().enumerate() }
                .map(|(n, x)| [*x, of(n, name, &largest)])
                .filter(|p| p[1].is_finite())
                .collect();
            points.sort_by(|a, b| a[0].total_cmp(&b[0]));
            if points.len() < 2 {
                continue;
            }
            let [x, y] = [0, 1].map(|a| points.iter().map(|p| p[a]).collect::<Vec<_>>());
            let short = key.rsplit('.').next().unwrap_or(key);
            let plot = Plot::new(format!("{name}, largest"))
                .x(short, &of_x)
                .y(name, unit)
                .line("", &x, &y)
                .points_of_it(&x, &y);
            let file: String = { name.chars() }
                .map(|c| if c.is_ascii_alphanumeric() { c } else { '_' })
                .collect();
            files.extend(plot.save(dir, &file)?);
        }
    }
    Ok(files)
}
