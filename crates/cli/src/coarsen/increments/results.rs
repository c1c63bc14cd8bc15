//! What is told and written of increments, and how far they are from a run of all points.

use crate::failure::Failure;
use peridyne::observe::Snapshot;
use peridyne::run::Simulation;
use peridyne_io::deck::{Deck, Dim, UnitSystem, rounded};
use peridyne_io::write::atomic::write_file;
use peridyne_io::write::folder::Folder;
use peridyne_io::write::table::Table;
use peridyne_io::write::{Series, SeriesOptions, WriteError};
use peridyne_theory::coarsen::increments::{Increment, Increments, Model};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

const AXES: [&str; 3] = ["x", "y", "z"];

/// One increment.
pub struct Row {
    number: usize,
    t: f64,
    /// Of every support, along its axes (force).
    reactions: Vec<f64>,
    probes: Vec<f64>,
    /// Of the point that moved most (length).
    farthest: f64,
    energy: f64,
    work: f64,
    missing: [f64; 2],
    corrections: usize,
    tangents: usize,
    /// Whole bonds.
    broken: f64,
}

/// What is written of them. The folder is made with the first.
pub struct Written {
    out: PathBuf,
    files: Option<(Folder, Series)>,
    /// What is seen before the first increment.
    first: Snapshot,
    /// Sets, and axes.
    reactions: Vec<(String, &'static str)>,
    /// Names, and units.
    probes: Vec<(String, String)>,
    units: UnitSystem,
    rows: Vec<Row>,
}

impl Written {
    pub fn new<const D: usize>(
        deck: &Deck,
        body: &mut Model<D>,
        out: &Path,
        first: Snapshot,
    ) -> Written {
        let probes = body.simulation().probe_columns().into_iter().map(|c| {
            let unit = match c.rooted {
                true => deck.units.root_unit(c.dimension),
                false => deck.units.unit(c.dimension),
            };
            (c.name, unit)
        });
        Written {
            out: out.to_path_buf(),
            files: None,
            first,
            probes: probes.collect(),
            reactions: names(body),
            units: deck.units,
            rows: vec![],
        }
    }

    /// An increment that ended at t.
    pub fn row<const D: usize>(
        &mut self,
        body: &mut Model<D>,
        (number, t): (usize, f64),
        path: &Increments<D>,
        done: &Increment<D>,
    ) {
        let square = |u: &[f64; D]| u.iter().map(|u| u * u).sum::<f64>();
        let farthest = path.displacements().iter().map(square);
        let sums = body.reactions(path.retained(), &done.reaction);
        self.rows.push(Row {
            number,
            t,
            reactions: along(body, &sums),
            probes: body.simulation().measure(),
            farthest: farthest.fold(0.0, f64::max).sqrt(),
            energy: body.energy(),
            work: done.work,
            missing: [done.unbalanced, done.removed],
            corrections: done.corrections,
            tangents: done.tangents,
            broken: 0.5 * done.broken as f64,
        });
    }

    /// Rows up to here, and what is seen now.
    pub fn save(&mut self, frame: &Snapshot) -> Result<(), WriteError> {
        let (_, series) = match &mut self.files {
            Some(files) => files,
            none => {
                let folder = Folder::claim(&self.out)?;
                let options = SeriesOptions {
                    pictures: vec![],
                    units: self.units,
                    ..SeriesOptions::default()
                };
                let mut series = Series::new(&self.out, options)?;
                series.write(&self.first, &[])?;
                none.insert((folder, series))
            }
        };
        series.write(frame, &[])?;
        self.table().save(&self.out.join("increments.csv"))
    }

    /// The last increment in a line.
    pub fn told(&self) -> String {
        let Some(row) = self.rows.last() else {
            return String::new();
        };
        let pulls = self.reactions.iter().zip(&row.reactions);
        let pulls = pulls.map(|((set, axis), r)| {
            format!(
                ", reaction of {set} along {axis} {}",
                self.units.show(*r, Dim::FORCE)
            )
        });
        let broken = match row.broken {
            0.0 => String::new(),
            n => format!(
                "; {n} bonds broke, after each of which came an equilibrium of the same load"
            ),
        };
        format!(
            "increment {}: t {}{}; missing of the forces: {} on retained points, {} on removed ones{broken}",
            row.number,
            rounded(row.t, 4),
            pulls.collect::<String>(),
            rounded(row.missing[0], 2),
            rounded(row.missing[1], 2),
        )
    }

    fn table(&self) -> Table {
        let (rows, units) = (&self.rows, self.units);
        let of = |value: fn(&Row) -> f64| rows.iter().map(value).collect::<Vec<f64>>();
        let mut table = Table::new()
            .column("increment", "", of(|r| r.number as f64))
            .column("t", "", of(|r| r.t));
        for (k, (set, axis)) in self.reactions.iter().enumerate() {
            let values = rows.iter().map(|r| r.reactions[k]);
            table = table.column(
                &format!("reaction_{set}_{axis}"),
                &units.unit(Dim::FORCE),
                values,
            );
        }
        for (k, (name, unit)) in self.probes.iter().enumerate() {
            table = table.column(name, unit, rows.iter().map(|r| r.probes[k]));
        }
        table
            .column(
                "largest displacement",
                &units.unit(Dim::LENGTH),
                of(|r| r.farthest),
            )
            .column("strain energy", &units.unit(Dim::ENERGY), of(|r| r.energy))
            .column(
                "work of loads and supports",
                &units.unit(Dim::ENERGY),
                of(|r| r.work),
            )
            .column("missing on retained points", "", of(|r| r.missing[0]))
            .column("missing on removed points", "", of(|r| r.missing[1]))
            .column("corrections", "", of(|r| r.corrections as f64))
            .column("tangents", "", of(|r| r.tangents as f64))
            .column("broken bonds", "", of(|r| r.broken))
    }
}

/// Every support, along each axis that it holds.
fn names<const D: usize>(body: &Model<D>) -> Vec<(String, &'static str)> {
    let each = body.supports().iter().flat_map(|s| {
        (0..D)
            .filter(|a| s.held[*a])
            .map(|a| (s.set.clone(), AXES[a]))
    });
    each.collect()
}

/// Their values.
fn along<const D: usize>(body: &Model<D>, sums: &[[f64; 3]]) -> Vec<f64> {
    let each = body
        .supports()
        .iter()
        .zip(sums)
        .flat_map(|(s, sum)| (0..D).filter(|a| s.held[*a]).map(|a| sum[a]));
    each.collect()
}

/// A run of all points.
pub struct Truth<const D: usize> {
    pub sim: Box<dyn Simulation>,
    pub u: Vec<[f64; D]>,
    pub seconds: f64,
}

/// Runs a deck as it is.
pub fn run<const D: usize>(deck: &Deck, mut sim: Box<dyn Simulation>) -> Result<Truth<D>, Failure> {
    let began = Instant::now();
    sim.start(true);
    for _ in 0..deck.steps(sim.info().time_step) {
        let stepped = sim.step();
        stepped.map_err(|e| Failure::Run(format!("{}: {e}", deck.file())))?;
    }
    let seconds = began.elapsed().as_secs_f64();
    let u = { sim.displacements().into_iter() }
        .map(|u| std::array::from_fn(|a| u[a]))
        .collect();
    Ok(Truth { sim, u, seconds })
}

/// How far an answer is from that of all points.
pub struct Errors {
    /// Largest difference of displacements over the largest displacement: of retained points, of all.
    displacement: [f64; 2],
    /// Of the reactions of all supports together; not a number where there are none.
    reaction: f64,
}

impl Errors {
    pub fn of<const D: usize>(
        [u, truth]: [&[[f64; D]]; 2],
        kept: &[u32],
        [reactions, whole]: [&[[f64; 3]]; 2],
    ) -> Errors {
        let size = |x: &[f64; D]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let off = |i: usize| size(&std::array::from_fn(|a| u[i][a] - truth[i][a]));
        let most = truth.iter().map(size).fold(0.0, f64::max);
        let worst =
            |each: &mut dyn Iterator<Item = usize>| each.map(off).fold(0.0, f64::max) / most;
        let (mut difference, mut all) = (0.0, 0.0);
        for (r, w) in reactions.as_flattened().iter().zip(whole.as_flattened()) {
            difference += (r - w) * (r - w);
            all += w * w;
        }
        Errors {
            displacement: [
                worst(&mut kept.iter().map(|q| *q as usize)),
                worst(&mut (0..u.len())),
            ],
            reaction: f64::sqrt(difference / all),
        }
    }

    pub fn told(&self) -> String {
        let percent = |x: f64| match 100.0 * x {
            small if small < 1e-3 => rounded(small, 2),
            error => format!("{error:.3}"),
        };
        let reaction = match self.reaction.is_finite() {
            true => format!(", reactions {} %", percent(self.reaction)),
            false => String::new(),
        };
        format!(
            "displacement error {} % at most of retained points, {} % of all{reaction}",
            percent(self.displacement[0]),
            percent(self.displacement[1]),
        )
    }

    fn json(&self) -> serde_json::Value {
        serde_json::json!({
            "displacement_of_retained_points": self.displacement[0],
            "displacement_of_all_points": self.displacement[1],
            "reaction": self.reaction.is_finite().then_some(self.reaction),
        })
    }
}

/// `compared.json`: errors in increments and linear about the reference; seconds in increments and of all points.
pub fn compared(
    out: &Path,
    [increments, linear]: [&Errors; 2],
    seconds: [f64; 2],
) -> Result<(), WriteError> {
    let all = serde_json::json!({
        "increments": increments.json(),
        "linear": linear.json(),
        "seconds": { "increments": seconds[0], "all_points": seconds[1] },
    });
    write_file(&out.join("compared.json"), |w| writeln!(w, "{all:#}"))
}
