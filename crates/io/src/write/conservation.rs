//! Files of a conservation law: `frames.npz` (`x`, `t`, `u[frame, point]`), pictures, `run.json`.

use super::atomic::{WriteError, write_file};
use super::picture::label;
use super::plot::{ColorMap, Map, Plot};
use super::run_json::{Setting, Status};
use crate::deck::Dim;
use crate::deck::conservation::LawDeck;
use ndarray::{ArrayViewD, IxDyn};
use ndarray_npy::NpzWriter;
use peridyne_transport::{Grid, measure};
use serde::Serialize;
use std::io::{Cursor, Error, Write as _};
use std::path::Path;

/// States at times.
#[derive(Debug)]
pub struct Frames {
    grid: Grid,
    times: Vec<f64>,
    values: Vec<f64>,
}

impl Frames {
    pub fn new(grid: &Grid) -> Frames {
        Frames {
            grid: *grid,
            times: vec![],
            values: vec![],
        }
    }

    pub fn push(&mut self, time: f64, u: &[f64]) {
        self.times.push(time);
        self.values.extend_from_slice(u);
    }

    /// The last state, unless it is there.
    pub fn push_last(&mut self, time: f64, u: &[f64]) {
        if self.times.last() != Some(&time) {
            self.push(time, u);
        }
    }

    fn frame(&self, n: usize) -> &[f64] {
        let points = self.grid.points();
        &self.values[n * points..][..points]
    }

    /// `x` (of a plane `x[point, 2]`), `t`, `u[frame, point]`; points along x run fastest.
    ///
    /// # Errors
    /// The operating system's.
    pub fn write(&self, path: &Path) -> Result<(), WriteError> {
        let bytes = self.archive().map_err(WriteError::at("write", path))?;
        write_file(path, |w| w.write_all(&bytes))
    }

    fn archive(&self) -> Result<Vec<u8>, Error> {
        let mut file = NpzWriter::new_compressed(Cursor::new(vec![]));
        let mut add = |name: &str, values: &[f64], shape: &[usize]| -> Result<(), Error> {
            let array = ArrayViewD::from_shape(IxDyn(shape), values).map_err(Error::other)?;
            file.add_array(name, &array).map_err(Error::other)
        };
        let (n, d) = (self.grid.points(), self.grid.dimension);
        let x: Vec<f64> = (0..n)
            .flat_map(|k| self.grid.place(k).into_iter().take(d))
            .collect();
        add("x", &x, &[n, d][..if d == 1 { 1 } else { 2 }])?;
        add("t", &self.times, &[self.times.len()])?;
        add("u", &self.values, &[self.times.len(), n])?;
        Ok(file.finish().map_err(Error::other)?.into_inner())
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
    let map = Map::new(title)
        .x("x", &length, ends(0))
        .value("u", &u)
        .between(low, low + spread)
        .colors(ColorMap::of([low, low + spread]));
    if plane {
        let map = map.y("y", &length, ends(1)).equal().grid(n, last);
        map.save(dir, "last")?;
    } else if count > 1 {
        let map = map.y("t", &time, [frames.times[0], frames.times[count - 1]]);
        map.grid(n, &frames.values).save(dir, "space_time")?;
    }
    Ok(())
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
    /// What steps have added to u at most until the end, estimated; none where it is not known.
    pub time_error: Option<f64>,
    /// What they may add.
    pub time_error_allowed: Option<f64>,
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
