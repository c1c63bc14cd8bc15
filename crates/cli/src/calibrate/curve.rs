//! A measured curve, and how far those of runs are from it.

use crate::failure::Failure;
use peridyne_io::deck::rounded;
use peridyne_io::read::measured;
use peridyne_io::write::history::{Column, today};
use peridyne_io::write::report::history;
use std::path::{Path, PathBuf};

/// Ends that differ by less than this part of the curve are one.
const SAME: f64 = 1e-9;

#[derive(clap::Args)]
pub struct CurveArguments {
    /// What was measured: CSV, whose first line names columns and their units, `opening [mm],pull [kN]`.
    #[arg(long, value_name = "FILE")]
    pub measured: PathBuf,
    /// Column of the measured file, and of `history.csv`, along which curves are compared.
    #[arg(long, value_name = "COLUMN")]
    pub x: String,
    /// Column of both that is fitted.
    #[arg(long, value_name = "COLUMN")]
    pub y: String,
    /// Column of the measured file with the standard deviation of each y: residuals are divided by it.
    #[arg(long, value_name = "COLUMN")]
    pub sigma: Option<String>,
}

pub struct Curve {
    /// Columns of runs, with their units.
    pub of: [Column; 2],
    pub x: Vec<f64>,
    pub y: Vec<f64>,
    /// Standard deviations, if they were given.
    pub sigma: Option<Vec<f64>>,
    /// The file, and the line of each point.
    lines: (String, Vec<usize>),
    pub notes: Vec<String>,
}

impl Curve {
    /// What was measured, in the units of runs, whose `history.csv` has these columns.
    pub fn read(arguments: &CurveArguments, columns: &[Column]) -> Result<Curve, Failure> {
        let path = &arguments.measured;
        let step = Column::new("step", "");
        let [x, y] = [("--x", &arguments.x), ("--y", &arguments.y)].map(|(flag, name)| {
            let mut all = columns.iter().chain([&step]);
            all.find(|c| c.name == today(name)).ok_or_else(|| {
                let all: Vec<&str> = columns.iter().map(|c| c.name.as_str()).collect();
                Failure::input(format!(
                    "{flag} {name}: history.csv of this deck has no such column; it has {}",
                    all.join(", ")
                ))
            })
        });
        let (x, y) = (x?, y?);
        if x.name == y.name {
            return Err(Failure::input(format!("--x and --y are both {}", x.name)));
        }
        let mut wanted = vec![(&*x.name, &*x.unit), (&*y.name, &*y.unit)];
        wanted.extend(arguments.sigma.iter().map(|name| (&**name, &*y.unit)));
        let read = measured::columns(path, &wanted);
        let (found, lines) = read.map_err(|e| Failure::input(e.to_string()))?;
        let notes = { found.iter().filter(|c| c.plain) }
            .zip(&wanted)
            .filter(|(c, _)| !c.unit.is_empty())
            .map(|(c, _)| {
                let (name, unit) = (&c.name, &c.unit);
                format!(
                    "the column {name} of {} names no unit and is taken in {unit}",
                    path.display()
                )
            })
            .collect();
        let mut values = found.into_iter().map(|c| c.values);
        let mut next = || values.next().unwrap_or_default();
        let curve = Curve {
            of: [x.clone(), y.clone()],
            x: next(),
            y: next(),
            sigma: arguments.sigma.as_ref().map(|_| next()),
            lines: (path.display().to_string(), lines),
            notes,
        };
        let wrong = curve.sigma.iter().flatten().position(|s| !(*s > 0.0));
        match wrong {
            None => Ok(curve),
            Some(n) => Err(Failure::input(format!(
                "{}: a standard deviation is above 0",
                curve.place(n)
            ))),
        }
    }

    /// File and line of a point.
    fn place(&self, point: usize) -> String {
        format!("{}:{}", self.lines.0, self.lines.1[point])
    }

    /// x and y of a run in this folder.
    ///
    /// # Errors
    /// Why there is no curve of one value for each x.
    pub fn of_run(&self, dir: &Path) -> Result<[Vec<f64>; 2], String> {
        let path = dir.join("history.csv");
        let all = history::read(&path).map_err(|e| e.to_string())?;
        let [x, y] = [0, 1].map(|n| {
            let name = &self.of[n].name;
            let column = all.iter().find(|c| c.name == *name);
            column
                .map(|c| c.values.clone())
                .ok_or_else(|| format!("{} has no column {name}", path.display()))
        });
        let (x, y) = (x?, y?);
        let rising = x.last() > x.first();
        let (mut along, mut curve) = (vec![], vec![]);
        for (n, (x, y)) in x.iter().zip(&y).enumerate() {
            let (last, before) = (along.last().copied(), curve.last().copied());
            if !x.is_finite() || !y.is_finite() {
                return Err(format!("{} is no number in row {}", self.of[1].name, n + 1));
            }
            let on = last.is_none_or(|last| if rising { *x > last } else { *x < last });
            if on {
                along.push(*x);
                curve.push(*y);
            } else if (last, before) != (Some(*x), Some(*y)) {
                return Err(format!(
                    "{} goes back or stands still in row {} of history.csv, at {}: curves are compared along one that only rises or only falls",
                    self.of[0].name,
                    n + 1,
                    rounded(*x, 6)
                ));
            }
        }
        if !rising {
            along.reverse();
            curve.reverse();
        }
        Ok([along, curve])
    }

    /// Computed less measured at each measured x, on the line between the rows about it, over the standard deviation if there are any.
    ///
    /// # Errors
    /// The run does not reach every x that was measured.
    pub fn residuals(&self, dir: &Path) -> Result<Vec<f64>, String> {
        let [x, y] = self.of_run(dir)?;
        let (Some(first), Some(last)) = (x.first(), x.last()) else {
            return Err("history.csv has no rows".into());
        };
        let slack = SAME * (last - first);
        let mut all = vec![];
        for (n, at) in self.x.iter().enumerate() {
            if x.len() < 2 || *at < first - slack || *at > last + slack {
                let [name, from, to] = [&self.of[0].name, &rounded(*first, 6), &rounded(*last, 6)];
                return Err(format!(
                    "{name} of the run goes from {from} to {to}, and {} is at {}: nothing is continued beyond a curve; run further, or leave these points out",
                    self.place(n),
                    rounded(*at, 6)
                ));
            }
            let after = x.partition_point(|x| x < at).clamp(1, x.len() - 1);
            let part = ((at - x[after - 1]) / (x[after] - x[after - 1])).clamp(0.0, 1.0);
            let found = y[after - 1] + (y[after] - y[after - 1]) * part;
            let sigma = self.sigma.as_ref().map_or(1.0, |s| s[n]);
            all.push((found - self.y[n]) / sigma);
        }
        Ok(all)
    }
}
