//! A field of a body on a line over place and time, as colours with t downwards: x is that of the reference. The style of seleson2009 Figs. 4.3 and 5.1
//! and seleson2014 Fig. 1, where the field is the density (y′)⁻¹.

use super::atomic::WriteError;
use super::npz::write_npz;
use super::picture::shown;
use super::plot::{ColorMap, Map};
use peridyne::space::Point;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Reference over current distance of the two points beside a point.
pub const DENSITY: &str = "density";

/// Columns of a picture at most: of more points each is a mean.
pub const COLUMNS: usize = 1000;
/// Rows at most.
pub const ROWS: u64 = 750;

/// The drawing of a field over place and time.
pub struct Drawing<'a> {
    pub title: &'a str,
    /// Name, unit and outer edges of the axis of places.
    pub x: (&'a str, &'a str, [f64; 2]),
    /// Unit, first and last time.
    pub t: (&'a str, [f64; 2]),
    /// Name and unit of the field.
    pub value: (&'a str, &'a str),
    /// Ends of the colours.
    pub range: [f64; 2],
    pub colors: ColorMap,
}

impl Drawing<'_> {
    /// Values in rows of `columns`, the first row above.
    pub fn map(&self, columns: usize, values: &[f64]) -> Map {
        Map::new(self.title)
            .x(self.x.0, self.x.1, self.x.2)
            .y("t", self.t.0, self.t.1)
            .y_down()
            .value(self.value.0, self.value.1)
            .colors(self.colors)
            .between(self.range[0], self.range[1])
            .grid(columns, values)
    }
}

/// The part of space and time that is shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// From where to where in the reference (length).
    pub x: [f64; 2],
    /// From when to when (time).
    pub t: [f64; 2],
}

impl Default for Window {
    fn default() -> Self {
        let all = [f64::NEG_INFINITY, f64::INFINITY];
        Window { x: all, t: all }
    }
}

fn inside(value: f64, [low, high]: [f64; 2], round_off: f64) -> bool {
    low - round_off <= value && value <= high + round_off
}

impl Window {
    /// Is a row due after `step` of `steps` steps of `time_step`? Rows lie as evenly as whole steps allow, the first and the last step among them.
    pub fn is_row(&self, step: u64, steps: u64, time_step: f64) -> bool {
        let near = 1e-9 * time_step;
        let time = |n: u64| n as f64 * time_step;
        let first = (self.t[0] / time_step - 1e-9).ceil().max(0.0) as u64;
        if !inside(time(step), self.t, near) || step > steps {
            return false;
        }
        let last = match self.t[1] < time(steps) {
            true => (self.t[1] / time_step + 1e-9).floor() as u64,
            false => steps,
        };
        let (n, count) = (step - first.min(step), last - first.min(last));
        let rows = count.min(ROWS);
        // the row nearest to this step, and the step nearest to that row
        let row = (n * rows + count / 2).checked_div(count).unwrap_or(0);
        (row * count + rows / 2).checked_div(rows).unwrap_or(0) == n
    }
}

/// Points of a body on a line, from left to right.
#[derive(Debug, Clone)]
pub struct Line {
    /// Numbers of the points.
    points: Vec<usize>,
    /// Where they are in the reference.
    x: Vec<f64>,
    /// Which body they are of.
    body: Vec<u64>,
    /// Length after which all repeats.
    period: Option<f64>,
}

impl Line {
    /// Of reference positions, of several bodies with the number of each point's.
    pub fn new(reference: &[Point], body: Option<&[f64]>, period: Option<f64>) -> Line {
        let mut points: Vec<usize> = (0..reference.len()).collect();
        points.sort_by(|a, b| reference[*a][0].total_cmp(&reference[*b][0]));
        Line {
            x: points.iter().map(|i| reference[*i][0]).collect(),
            body: points
                .iter()
                .map(|i| body.map_or(0, |b| b[*i] as u64))
                .collect(),
            points,
            period,
        }
    }

    /// Values of points by number in the order of the line.
    pub fn along(&self, values: &[f64]) -> Vec<f64> {
        self.points.iter().map(|i| values[*i]).collect()
    }

    /// The neighbour `by` places to the right, and by how much of the period it lies further; `None`: there is none, or it is of another body.
    fn neighbour(&self, i: usize, by: isize) -> Option<(usize, f64)> {
        let n = self.x.len() as isize;
        let j = i as isize + by;
        let (j, shift) = match self.period {
            Some(period) if j < 0 => (j + n, -period),
            Some(period) if j >= n => (j - n, period),
            _ => (j, 0.0),
        };
        let j = usize::try_from(j).ok().filter(|j| *j < self.x.len())?;
        (self.body[j] == self.body[i]).then_some((j, shift))
    }

    /// `(x_{j+1} − x_{j−1})/(y_{j+1} − y_{j−1})` from displacements in the order of the line; not a number at ends.
    pub fn density(&self, u: &[f64]) -> Vec<f64> {
        let of = |i: usize| {
            let (left, right) = (self.neighbour(i, -1)?, self.neighbour(i, 1)?);
            let apart = self.x[right.0] + right.1 - self.x[left.0] - left.1;
            Some(apart / (apart + u[right.0] - u[left.0]))
        };
        (0..u.len()).map(|i| of(i).unwrap_or(f64::NAN)).collect()
    }
}

/// A field over place and time, as it is recorded.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SpaceTime {
    /// Outer edges of the columns in the reference.
    pub x: [f64; 2],
    pub columns: usize,
    /// Time of every row.
    pub times: Vec<f64>,
    /// Rows one after another, each value the mean of the points in its column; not a number where there is none.
    pub values: Vec<f32>,
    /// Places on the line of each column's points, the second is the first beyond them.
    #[serde(skip)]
    places: Vec<(usize, usize)>,
}

impl SpaceTime {
    /// Of a field of the points of a line in a window; `ends`: have both ends of the line a value? `None`: no point is there.
    pub fn new(line: &Line, window: &Window, ends: bool) -> Option<SpaceTime> {
        let n = line.x.len();
        let spread = line.x.last()? - line.x.first()?;
        let shown = |i: &usize| {
            let has = ends || (line.neighbour(*i, -1).is_some() && line.neighbour(*i, 1).is_some());
            has && inside(line.x[*i], window.x, 1e-9 * spread)
        };
        let first = (0..n).find(shown)?;
        let last = (0..n).rev().find(shown)?;
        // a cell around every point
        let half = |a: usize, b: usize| 0.5 * (line.x[b] - line.x[a]);
        let (before, after) = match (first.checked_sub(1), last + 1 < n) {
            _ if n < 2 => return None,
            (Some(left), right) => {
                let before = half(left, first);
                (
                    before,
                    if right {
                        half(last, last + 1)
                    } else {
                        half(last - 1, last)
                    },
                )
            }
            (None, true) => (half(0, 1), half(last, last + 1)),
            (None, false) => (half(0, 1), half(n - 2, n - 1)),
        };
        let x = [line.x[first] - before, line.x[last] + after];
        let columns = (last + 1 - first).min(COLUMNS);
        let width = (x[1] - x[0]) / columns as f64;
        let column = |i: usize| (((line.x[i] - x[0]) / width) as usize).min(columns - 1);
        let mut places = vec![(0, 0); columns];
        for i in (first..=last).rev() {
            let place = &mut places[column(i)];
            *place = (i, if place.1 == 0 { i + 1 } else { place.1 });
        }
        // a column without a point shows the nearest
        for (c, place) in places.iter_mut().enumerate().filter(|(_, p)| p.1 == 0) {
            let middle = x[0] + (c as f64 + 0.5) * width;
            let right = line.x[first..=last].partition_point(|x| *x < middle) + first;
            let left = right.saturating_sub(1).max(first);
            let right = right.min(last);
            let near = match middle - line.x[left] <= line.x[right] - middle {
                true => left,
                false => right,
            };
            *place = (near, near + 1);
        }
        Some(SpaceTime {
            x,
            columns,
            times: vec![],
            values: vec![],
            places,
        })
    }

    /// Adds a row of values in the order of the line.
    pub fn record(&mut self, time: f64, values: &[f64]) {
        self.times.push(time);
        for (first, end) in &self.places {
            let known = || values[*first..*end].iter().filter(|v| v.is_finite());
            let mean = known().sum::<f64>() / known().count() as f64;
            self.values.push(mean as f32);
        }
    }

    /// Ends of the colours for a field: as far from 1 on either side for the density.
    pub fn range(&self, field: &str) -> [f64; 2] {
        let finite = || {
            self.values
                .iter()
                .map(|v| f64::from(*v))
                .filter(|v| v.is_finite())
        };
        if field == DENSITY {
            let most = finite().map(|v| (v - 1.0).abs()).fold(0.0, f64::max);
            let most = if most > 0.0 { most } else { 1.0 };
            return [1.0 - most, 1.0 + most];
        }
        let low = finite().fold(f64::INFINITY, f64::min);
        let high = finite().fold(f64::NEG_INFINITY, f64::max);
        shown::range(field, low, high)
    }

    /// The picture; white where the density is that of the body at rest. `units`: of length, time and the field.
    pub fn map(&self, title: &str, field: &str, units: [&str; 3], range: [f64; 2]) -> Map {
        let values: Vec<f64> = self.values.iter().map(|v| f64::from(*v)).collect();
        let time = |t: Option<&f64>| t.copied().unwrap_or(0.0);
        Drawing {
            title,
            x: ("x (reference)", units[0], self.x),
            t: (
                units[1],
                [time(self.times.first()), time(self.times.last())],
            ),
            value: (field, units[2]),
            range,
            colors: match field {
                DENSITY => ColorMap::Diverging,
                _ => ColorMap::of(range),
            },
        }
        .map(self.columns, &values)
    }

    /// `x[columns]`, their middles; `t[rows]`; the field `[rows, columns]` by its name.
    ///
    /// # Errors
    /// The operating system's.
    pub fn save(&self, path: &Path, field: &str) -> Result<PathBuf, WriteError> {
        let width = (self.x[1] - self.x[0]) / self.columns as f64;
        let middle = |c: usize| self.x[0] + (c as f64 + 0.5) * width;
        let x: Vec<f64> = (0..self.columns).map(middle).collect();
        let values: Vec<f64> = self.values.iter().map(|v| f64::from(*v)).collect();
        let rows = self.times.len();
        write_npz(
            path,
            &[
                ("x", &x, vec![self.columns]),
                ("t", &self.times, vec![rows]),
                (field, &values, vec![rows, self.columns]),
            ],
        )?;
        Ok(path.to_path_buf())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: &[f64]) -> Vec<Point> {
        x.iter().map(|x| [*x, 0.0, 0.0]).collect()
    }

    #[test]
    fn the_density_of_a_stretched_chain() {
        let x: Vec<f64> = (0..6).map(|j| 0.5 * f64::from(j)).collect();
        let u: Vec<f64> = (0..6).map(|j| 0.25 * f64::from(j)).collect();
        let line = Line::new(&at(&x), None, None);
        let mut image = SpaceTime::new(&line, &Window::default(), false).unwrap();
        image.record(0.0, &line.density(&u));
        // spacing 0.5 becomes 0.75; the two ends have none
        assert_eq!((image.columns, image.x), (4, [0.25, 2.25]));
        assert_eq!(image.values, [2.0 / 3.0; 4].map(|v: f64| v as f32));
        assert_eq!(image.times, [0.0]);
        // a ring of period 3 has no ends; the neighbours of its first point meet
        let ring = Line::new(&at(&x), None, Some(3.0));
        let image = SpaceTime::new(&ring, &Window::default(), false).unwrap();
        assert_eq!((image.columns, image.x), (6, [-0.25, 2.75]));
        let density = ring.density(&u);
        assert!(density[0].is_infinite());
        assert_eq!(density[2], 2.0 / 3.0);
    }

    #[test]
    fn columns_are_means_of_what_lies_in_them_wherever_points_lie() {
        // 2000 points given from right to left, two to a column
        let x: Vec<f64> = (0..2000).rev().map(f64::from).collect();
        let line = Line::new(&at(&x), None, None);
        let mut image = SpaceTime::new(&line, &Window::default(), true).unwrap();
        image.record(1.5, &line.along(&x));
        assert_eq!(image.columns, COLUMNS);
        let exact: Vec<f32> = (0..1000).map(|c| 2.0 * c as f32 + 0.5).collect();
        assert_eq!(image.values, exact);
        // two bodies: the ends that face each other have no density
        let x = [0.0, 1.0, 2.0, 2.5, 3.5, 4.5];
        let body = [0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
        let line = Line::new(&at(&x), Some(&body), None);
        let density = line.density(&[0.0; 6]);
        let known: Vec<usize> = (0..6).filter(|i| density[*i] == 1.0).collect();
        assert_eq!(known, [1, 4]);
        // a column for each point from the first that has a density to the last
        let window = Window {
            x: [0.5, 4.0],
            ..Window::default()
        };
        let image = SpaceTime::new(&line, &window, false).unwrap();
        assert_eq!((image.columns, image.x), (4, [0.5, 4.0]));
    }

    #[test]
    fn rows_are_even_and_hold_both_ends() {
        let all = Window::default();
        let rows = |window: &Window, steps: u64, dt: f64| -> Vec<u64> {
            (0..=steps)
                .filter(|n| window.is_row(*n, steps, dt))
                .collect()
        };
        assert_eq!(rows(&all, 5, 0.1), [0, 1, 2, 3, 4, 5]);
        let many = rows(&all, 4619, 0.06);
        assert_eq!((many.len() as u64, many[0], many[750]), (ROWS + 1, 0, 4619));
        assert!(many.windows(2).all(|w| (6..=7).contains(&(w[1] - w[0]))));
        // 2 to 3 with steps of 0.1: both belong to it in spite of round-off
        let part = Window {
            t: [2.0, 3.0],
            ..all
        };
        assert_eq!(rows(&part, 50, 0.1), (20..=30).collect::<Vec<_>>());
        assert_eq!(rows(&part, 25, 0.1), (20..=25).collect::<Vec<_>>());
    }
}
