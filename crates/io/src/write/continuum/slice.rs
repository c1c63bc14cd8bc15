//! Pictures of the slice through the middle of a grid: the mean of the normal stresses, and the kinetic temperature where there is one;
//! of one table, or of all frames as a film.

use super::columns::{Column, Table};
use crate::continuum::Units;
use crate::write::atomic::{WriteError, write_file};
use crate::write::picture::animate::{FilmFormat, animate};
use crate::write::picture::film::{HURRY, stride};
use crate::write::picture::label;
use crate::write::plot::{ColorMap, Map};
use peridyne::state::{Archive, Owner};
use peridyne_fields::Quantity;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// A slice across the shortest axis of a grid.
#[derive(Debug, Clone, Default)]
struct Slice {
    /// Names of its files, and what it shows.
    name: &'static str,
    title: &'static str,
    /// Axis across it, axes along it, and where these begin and end.
    across: usize,
    along: [usize; 2],
    range: [[f64; 2]; 2],
    columns: usize,
    values: Vec<f64>,
    unit: String,
    /// Is it of both signs?
    signed: bool,
}

/// Nothing for points that are no grid, or a grid that is no more than a line.
fn slices(table: &Table) -> Vec<Slice> {
    let Some((n, cell)) = &table.grid else {
        return vec![];
    };
    let across = (0..3).min_by_key(|a| n[*a]).unwrap_or(2);
    let along = match across {
        0 => [1, 2],
        1 => [0, 2],
        _ => [0, 1],
    };
    let [a, b] = along;
    if n[a] < 2 || n[b] < 2 {
        return vec![];
    }
    let middle = n[across] / 2;
    let place = |i: usize, j: usize| {
        let mut at = [middle; 3];
        (at[a], at[b]) = (i, j);
        at[0] + n[0] * (at[1] + n[1] * at[2])
    };
    let length = |axis: usize| {
        let e = cell.edges[axis];
        (e[0] * e[0] + e[1] * e[1] + e[2] * e[2]).sqrt()
    };
    let find = |quantity: Quantity| {
        let own = table.columns.iter().find(|c| c.quantity == quantity)?;
        own.values.as_ref().ok().map(|v| (own, v))
    };
    let stress = find(Quantity::Stress).or_else(|| find(Quantity::StressPotential));
    let temperature = find(Quantity::Temperature);
    let all = [(KINDS[0], stress, true), (KINDS[1], temperature, false)];
    let of = |((name, title), found, trace): (_, Option<(&Column, &Vec<f64>)>, bool)| {
        let (column, all) = found?;
        let value = |p: usize| match trace {
            true => (all[9 * p] + all[9 * p + 4] + all[9 * p + 8]) / 3.0,
            false => all[p],
        };
        let rows = (0..n[b]).flat_map(|j| (0..n[a]).map(move |i| (i, j)));
        let values: Vec<f64> = rows.map(|(i, j)| value(place(i, j))).collect();
        values.iter().any(|v| v.is_finite()).then(|| Slice {
            name,
            title,
            across,
            along,
            range: along.map(|axis| [cell.origin[axis], cell.origin[axis] + length(axis)]),
            columns: n[a],
            values,
            unit: column.unit.clone(),
            signed: trace,
        })
    };
    all.into_iter().filter_map(of).collect()
}

/// Lowest and highest finite value; of numbers of both signs those that are not all 0.
fn ends(values: impl Iterator<Item = f64>, signed: bool) -> Option<[f64; 2]> {
    let finite = values.filter(|v| v.is_finite());
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
        (l.min(v), h.max(v))
    });
    let most = low.abs().max(high.abs());
    match signed {
        true => (low < high && most > 0.0 && most.is_finite()).then_some([low, high]),
        false => (low < high).then_some([low, high]),
    }
}

impl Slice {
    /// Its picture with the colours between these values; `when` follows the title.
    fn map(&self, between: Option<[f64; 2]>, when: &str, units: Units) -> Map {
        let axes = ["x", "y", "z"];
        let [a, b] = self.along;
        let map = Map::new(format!(
            "{}, slice across {}{when}",
            self.title, axes[self.across]
        ))
        .x(axes[a], units.length(), self.range[0])
        .y(axes[b], units.length(), self.range[1])
        .value(self.title, &self.unit)
        .equal()
        .grid(self.columns, &self.values);
        match (between, self.signed) {
            (Some(ends), true) => map.colors(ColorMap::of(ends)).between(ends[0], ends[1]),
            (Some([low, high]), false) => map.between(low, high),
            (None, _) => map,
        }
    }
}

/// Writes pictures of the slice across the shortest axis of the grid; gives their paths. Nothing for points that are no grid, or a grid
/// that is no more than a line.
///
/// # Errors
/// The operating system's.
pub fn write_slice(dir: &Path, table: &Table, units: Units) -> Result<Vec<PathBuf>, WriteError> {
    let mut made = vec![];
    for slice in slices(table) {
        let own = slice
            .signed
            .then(|| ends(slice.values.iter().copied(), true));
        made.extend(slice.map(own.flatten(), "", units).save(dir, slice.name)?);
    }
    Ok(made)
}

/// Which kinds of slices there are: names and titles.
const KINDS: [(&str, &str); 2] = [
    ("stress", "mean normal stress"),
    ("temperature", "kinetic temperature"),
];

impl Owner for Slice {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        let mut kind = KINDS.iter().position(|k| k.0 == self.name).unwrap_or(0);
        archive.one("kind", &mut kind);
        match KINDS.get(kind) {
            Some((name, title)) => (self.name, self.title) = (name, title),
            None => archive.refuse("kind"),
        }
        archive.one("across", &mut self.across);
        archive.one("along", &mut self.along);
        archive.one("range", &mut self.range);
        archive.one("columns", &mut self.columns);
        archive.list("values", &mut self.values);
        archive.text("unit", &mut self.unit);
        archive.one("signed", &mut self.signed);
        let axes = self.across < 3 && self.along.iter().all(|a| *a < 3);
        if archive.loads() && !axes {
            archive.refuse("across");
        }
    }
}

impl Owner for SliceFilm {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        let none = || (None, Slice::default());
        archive.items(
            "frames",
            &mut self.frames,
            none,
            |(time, slice), archive| {
                archive.one("time", time);
                slice.archive(archive);
            },
        );
    }
}

/// Slices of frames, kept until the ends of the colours are known.
#[derive(Debug, Clone, Default)]
pub struct SliceFilm {
    frames: Vec<(Option<f64>, Slice)>,
    /// It is drawn short.
    hurried: bool,
}

impl SliceFilm {
    /// Takes the slices of a frame, of this time.
    pub fn push(&mut self, table: &Table, time: Option<f64>) {
        self.frames
            .extend(slices(table).into_iter().map(|s| (time, s)));
    }

    /// Who waits for it does not wait long.
    pub fn hurry(&mut self) {
        self.hurried = true;
    }

    /// Writes `NAME_film.png` or `.gif` of each kind of slice; gives their paths.
    ///
    /// # Errors
    /// The operating system's.
    pub fn finish(
        self,
        dir: &Path,
        units: Units,
        format: FilmFormat,
    ) -> Result<Vec<PathBuf>, WriteError> {
        let mut made = vec![];
        for (name, _) in KINDS {
            let own: Vec<&(Option<f64>, Slice)> =
                self.frames.iter().filter(|(_, s)| s.name == name).collect();
            let Some((_, first)) = own.first() else {
                continue;
            };
            let all = own.iter().flat_map(|(_, s)| s.values.iter().copied());
            let between = ends(all, first.signed);
            let image = |(time, slice): &&(Option<f64>, Slice)| {
                let when = time.map_or(String::new(), |t| {
                    format!(", t = {}", label::quantity(t, units.time()))
                });
                slice.map(between, &when, units).image()
            };
            let path = dir.join(format!("{name}_film.{}", format.ending()));
            let most = self.hurried.then(|| {
                let begun = Instant::now();
                let drawn = own.first().map(image);
                let each = begun.elapsed().max(Duration::from_millis(1));
                drop(drawn);
                // there are two of them
                (HURRY.as_secs_f64() / 2.0 / each.as_secs_f64()) as usize
            });
            let some = own.iter().step_by(stride(own.len(), most));
            let count = some.len();
            write_file(&path, |w| animate(w, format, count, some.map(image)))?;
            made.push(path);
        }
        Ok(made)
    }
}
