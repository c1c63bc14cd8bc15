//! Files of a conservation law: `frames.npz` (`x`, `t`, `u[frame, point]`), pictures, `run.json`.

use super::atomic::{WriteError, write_file};
use super::npz::write_npz;
use super::picture::label;
use super::plot::{ColorMap, Map, Plot};
use super::run_json::{Setting, Status, digits};
use super::space_time::Drawing;
use crate::deck::Dim;
use crate::deck::conservation::LawDeck;
use peridyne::observe::StateHash;
use peridyne::state::{Archive, Owner};
use peridyne_transport::{Grid, measure, noll};
use serde::Serialize;
use std::io::Write as _;
use std::path::Path;

/// States at times.
#[derive(Debug)]
pub struct Frames {
    grid: Grid,
    times: Vec<f64>,
    values: Vec<f64>,
    /// Of the local law, where the run compares itself with it.
    exact: Vec<f64>,
    /// Through the faces, where it is asked for.
    flux: Vec<f64>,
}

impl Owner for Frames {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.list("times", &mut self.times);
        archive.list("values", &mut self.values);
        archive.list("exact", &mut self.exact);
        archive.list("flux", &mut self.flux);
    }
}

impl Frames {
    pub fn new(grid: &Grid) -> Frames {
        Frames {
            grid: *grid,
            times: vec![],
            values: vec![],
            exact: vec![],
            flux: vec![],
        }
    }

    /// A state of the deck's law, with `exact` where the run compares itself with it.
    pub fn push(&mut self, deck: &LawDeck, exact: Option<&[f64]>) {
        let e = &deck.evolution;
        self.times.push(e.time);
        self.values.extend_from_slice(&e.u);
        self.exact.extend_from_slice(exact.unwrap_or_default());
        if deck.flux {
            let flux = noll::through_faces(e.operator.law(), &e.u, e.time);
            self.flux.extend_from_slice(&flux);
        }
    }

    /// Is there one of this time?
    pub fn has(&self, time: f64) -> bool {
        self.times.last() == Some(&time)
    }

    fn frame(&self, n: usize) -> &[f64] {
        let points = self.grid.points();
        &self.values[n * points..][..points]
    }

    /// `x` (of a plane `x[point, 2]`), `t`, `u[frame, point]`; points along x run fastest. `exact[frame, point]`; `faces` and `flux[frame, face]`.
    ///
    /// # Errors
    /// The operating system's.
    pub fn write(&self, path: &Path) -> Result<(), WriteError> {
        let (n, d) = (self.grid.points(), self.grid.dimension);
        let x: Vec<f64> = (0..n)
            .flat_map(|k| self.grid.place(k).into_iter().take(d))
            .collect();
        let rows = self.times.len();
        let mut arrays: Vec<(&str, &[f64], Vec<usize>)> = vec![
            ("x", &x, [n, d][..if d == 1 { 1 } else { 2 }].to_vec()),
            ("t", &self.times, vec![rows]),
            ("u", &self.values, vec![rows, n]),
        ];
        if !self.exact.is_empty() {
            arrays.push(("exact", &self.exact, vec![rows, n]));
        }
        let Grid { low, spacing, .. } = self.grid;
        let faces: Vec<f64> = (0..=n).map(|k| low[0] + spacing * k as f64).collect();
        if !self.flux.is_empty() {
            arrays.push(("faces", &faces, vec![n + 1]));
            arrays.push(("flux", &self.flux, vec![rows, n + 1]));
        }
        write_npz(path, &arrays)
    }
}

/// Lines of the profiles.
const PROFILES: usize = 6;

/// `profiles` (in a plane along its middle row), and `space_time`, or in a plane the `last` frame; PNG and SVG.
///
/// # Errors
/// The operating system's.
pub fn write_pictures(dir: &Path, deck: &LawDeck, frames: &Frames) -> Result<(), WriteError> {
    let grid = &frames.grid;
    let [length, time, u] = [Dim::LENGTH, Dim::TIME, deck.dimension].map(|d| deck.units.unit(d));
    let [n, rows] = grid.cells;
    let ends = |a: usize| {
        [
            grid.low[a],
            grid.low[a] + grid.spacing * grid.cells[a] as f64,
        ]
    };
    let x: Vec<f64> = (0..n).map(|k| grid.place(k)[0]).collect();
    let count = frames.times.len();
    let middle = rows / 2 * n;
    let mut plot = Plot::new(&deck.title).x("x", &length).y("u", &u);
    let shown = PROFILES.min(count);
    for k in 0..shown {
        let f = if shown > 1 {
            k * (count - 1) / (shown - 1)
        } else {
            0
        };
        let label = format!("t = {:.4} {time}", frames.times[f]);
        plot = plot.line(label.trim_end(), &x, &frames.frame(f)[middle..][..n]);
        if let Some(exact) = frames.exact.get(f * n..(f + 1) * n) {
            let label = if k == 0 { "local law" } else { "" };
            plot = plot.dashed(label, &x, exact);
        }
    }
    plot.save(dir, "profiles")?;
    let plane = rows > 1;
    let last = frames.frame(count - 1);
    // a plane shows its last state alone
    let shown = if plane { last } else { &frames.values };
    let [low, high] = measure::extremes(shown);
    // a state that does not vary is shown too
    let spread = (high - low).max(1e-12 * high.abs()).max(1e-300);
    let title = match plane {
        true => format!(
            "{}, t = {}",
            deck.title,
            label::quantity(frames.times[count - 1], &time)
        ),
        false => deck.title.clone(),
    };
    let range = [low, low + spread];
    let colors = ColorMap::of(range);
    if plane {
        let map = Map::new(title)
            .x("x", &length, ends(0))
            .value("u", &u)
            .between(range[0], range[1])
            .colors(colors);
        let map = map.y("y", &length, ends(1)).equal().grid(n, last);
        map.save(dir, "last")?;
    } else if count > 1 {
        let drawing = Drawing {
            title: &title,
            x: ("x", &length, ends(0)),
            t: (&time, [frames.times[0], frames.times[count - 1]]),
            value: ("u", &u),
            range,
            colors,
        };
        drawing.map(n, &frames.values).save(dir, "space_time")?;
    }
    Ok(())
}

/// How far u is from the solution of the local law, over it: in the mean, the mean square and at most.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Compared {
    pub with: &'static str,
    pub time: f64,
    pub error_l1: f64,
    pub error_l2: f64,
    pub error_max: f64,
}

impl Compared {
    /// The state of now beside the solution `exact`.
    pub fn new(deck: &LawDeck, exact: &[f64]) -> Option<Compared> {
        let with = deck.reference.as_ref()?.solution().name();
        let [error_l1, error_l2, error_max] = measure::relative_distances(&deck.evolution.u, exact);
        Some(Compared {
            with,
            time: deck.evolution.time,
            error_l1,
            error_l2,
            error_max,
        })
    }

    pub fn errors(&self) -> [f64; 3] {
        [self.error_l1, self.error_l2, self.error_max]
    }
}

/// What `run.json` holds.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    pub version: String,
    pub kind: &'static str,
    pub deck: String,
    pub deck_hash: String,
    pub title: String,
    pub status: Status,
    /// The signal that ended the run early, where one did.
    pub ended_by: Option<String>,
    pub points: usize,
    /// Bonds of a point: transport, diffusion.
    pub bonds_of_a_point: [usize; 2],
    pub evaluation: &'static str,
    pub method: &'static str,
    pub time: f64,
    pub steps: u64,
    /// Wall time inside the steps alone (s).
    pub seconds_stepping: f64,
    pub ns_per_point_step: Option<f64>,
    pub peak_memory_bytes: Option<u64>,
    /// Of the time and the solution at the end.
    #[serde(flatten, serialize_with = "digits")]
    pub hash: StateHash,
    /// What steps have added to u at most until the end, estimated; none where it is not known.
    pub time_error: Option<f64>,
    /// What they may add.
    pub time_error_allowed: Option<f64>,
    /// How far u is from the solution of the local law at the end, where the run compares itself with it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub compared: Option<Compared>,
    /// What looked wrong in the deck, and in the run.
    pub warnings: Vec<String>,
    /// What reports tell besides.
    pub setting: Setting,
}

impl Report {
    /// How it ended.
    pub fn outcome(&self) -> String {
        match &self.ended_by {
            Some(signal) => format!("ended by {signal}"),
            None => self.status.to_string(),
        }
    }

    /// # Errors
    /// The operating system's.
    pub fn write(&self, path: &Path) -> Result<(), WriteError> {
        write_file(path, |w| {
            serde_json::to_writer_pretty(&mut *w, self)?;
            w.write_all(b"\n")
        })
    }
}
