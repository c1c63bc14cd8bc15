//! Lines and points over two axes.

use std::io;
use std::path::{Path, PathBuf};

use super::super::font::{self, Weight};
use super::super::picture::image::{Align, Color, GREY, INK, WHITE};
use super::axis::Scale;
use super::canvas::{Drawing, Outline, Shape};
use super::frame::{Frame, TICK, axes};
use super::save::titled;
use super::{WriteError, invalid};

/// Between a legend and what stands beside it.
const GAP: f64 = 10.0;
/// A legend may hide one of so many points.
const HIDDEN: usize = 200;

/// Colours that people with any colour vision tell apart (Okabe and Ito).
const COLORS: [Color; 7] = [
    [0, 114, 178],
    [213, 94, 0],
    [0, 158, 115],
    [204, 121, 167],
    [86, 180, 233],
    [230, 159, 0],
    [60, 60, 60],
];

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stroke {
    None,
    Solid,
    Dashed,
    Dotted,
}

impl Stroke {
    /// Lengths of ink and gap.
    fn dash(self) -> Option<[f64; 2]> {
        match self {
            Stroke::None | Stroke::Solid => None,
            Stroke::Dashed => Some([8.0, 5.0]),
            Stroke::Dotted => Some([1.0, 4.5]),
        }
    }
}

/// What is drawn at every point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mark {
    None,
    Disc,
    Square,
    Triangle,
    Diamond,
}

impl Mark {
    /// Outline and radius.
    fn shape(self) -> Option<(Outline, f64)> {
        let polygon = |corners, turn| Outline::Polygon { corners, turn };
        Some(match self {
            Mark::None => return None,
            Mark::Disc => (Outline::Disc, 3.0),
            Mark::Square => (polygon(4, std::f64::consts::FRAC_PI_4), 3.9),
            Mark::Triangle => (polygon(3, 0.0), 4.2),
            Mark::Diamond => (polygon(4, 0.0), 4.4),
        })
    }
}

#[derive(Debug, Clone)]
struct Series {
    label: String,
    points: Vec<[f64; 2]>,
    stroke: Stroke,
    mark: Mark,
    /// Unequal lengths, told when it is drawn.
    lengths: [usize; 2],
    /// Place in the colours.
    color: usize,
}

impl Series {
    fn color(&self) -> Color {
        COLORS[self.color % COLORS.len()]
    }
}

/// A plot of series; built step by step, then saved.
#[derive(Debug, Clone)]
pub struct Plot {
    title: String,
    labels: [String; 2],
    series: Vec<Series>,
    log: [bool; 2],
    range: [Option<[f64; 2]>; 2],
    /// Values of x with names.
    named: Vec<(f64, String)>,
    size: [f64; 2],
}

impl Plot {
    pub fn new(title: impl Into<String>) -> Plot {
        Plot {
            title: title.into(),
            labels: [String::new(), String::new()],
            series: Vec::new(),
            log: [false; 2],
            range: [None; 2],
            named: Vec::new(),
            size: [760.0, 480.0],
        }
    }

    /// What the x axis is, with its unit ("" for pure numbers).
    #[must_use]
    pub fn x(mut self, name: &str, unit: &str) -> Plot {
        self.labels[0] = titled(name, unit);
        self
    }

    #[must_use]
    pub fn y(mut self, name: &str, unit: &str) -> Plot {
        self.labels[1] = titled(name, unit);
        self
    }

    #[must_use]
    pub fn log_x(mut self) -> Plot {
        self.log[0] = true;
        self
    }

    #[must_use]
    pub fn log_y(mut self) -> Plot {
        self.log[1] = true;
        self
    }

    /// Shows this part only; without it, all points.
    #[must_use]
    pub fn x_range(mut self, low: f64, high: f64) -> Plot {
        self.range[0] = Some([low, high]);
        self
    }

    #[must_use]
    pub fn y_range(mut self, low: f64, high: f64) -> Plot {
        self.range[1] = Some([low, high]);
        self
    }

    /// A line from bottom to top at this x, with a name above.
    #[must_use]
    pub fn name_x(mut self, x: f64, name: &str) -> Plot {
        self.named.push((x, name.to_string()));
        self
    }

    /// A solid line; points that are not finite are gaps. An empty label keeps it out of the legend.
    #[must_use]
    pub fn line(self, label: &str, x: &[f64], y: &[f64]) -> Plot {
        self.series(label, x, y, Stroke::Solid, Mark::None)
    }

    #[must_use]
    pub fn dashed(self, label: &str, x: &[f64], y: &[f64]) -> Plot {
        self.series(label, x, y, Stroke::Dashed, Mark::None)
    }

    /// Discs without a line.
    #[must_use]
    pub fn points(self, label: &str, x: &[f64], y: &[f64]) -> Plot {
        self.series(label, x, y, Stroke::None, Mark::Disc)
    }

    /// Discs that belong to the last series: of its colour, without a place in the legend.
    #[must_use]
    pub fn points_of_it(self, x: &[f64], y: &[f64]) -> Plot {
        let mut plot = self.points("", x, y);
        let count = plot.series.len();
        if count > 1 {
            plot.series[count - 1].color = plot.series[count - 2].color;
        }
        plot
    }

    #[must_use]
    pub fn series(mut self, label: &str, x: &[f64], y: &[f64], stroke: Stroke, mark: Mark) -> Plot {
        let color = self.series.last().map_or(0, |s| s.color + 1);
        self.series.push(Series {
            color,
            label: label.to_string(),
            points: x.iter().zip(y).map(|(x, y)| [*x, *y]).collect(),
            stroke,
            mark,
            lengths: [x.len(), y.len()],
        });
        self
    }

    /// Writes `name.png` and `name.svg` into `dir`, which is made if needed; gives their paths.
    ///
    /// # Errors
    /// The operating system's; `InvalidInput` for x and y of unequal lengths, an empty range, and when nothing can be
    /// plotted.
    pub fn save(&self, dir: &Path, name: &str) -> Result<[PathBuf; 2], WriteError> {
        super::save::save(dir, name, self.draw())
    }

    fn scale(&self, axis: usize) -> io::Result<Scale> {
        if let Some([low, high]) = self.range[axis] {
            let log = self.log[axis];
            if low < high && low.is_finite() && high.is_finite() && (!log || low > 0.0) {
                return Ok(Scale { low, high, log });
            }
            return Err(invalid(format!(
                "the range {low} to {high} cannot be an axis"
            )));
        }
        let values = self
            .series
            .iter()
            .flat_map(|s| s.points.iter().map(|p| p[axis]));
        // lines run from edge to edge, but not along the upper and lower one
        Scale::around(values, self.log[axis], if axis == 0 { 0.0 } else { 0.06 })
    }

    pub(super) fn draw(&self) -> io::Result<Drawing> {
        for s in &self.series {
            let [x, y] = s.lengths;
            if x != y {
                return Err(invalid(format!(
                    "`{}` has {x} values of x and {y} of y",
                    s.label
                )));
            }
        }
        let scales = [self.scale(0)?, self.scale(1)?];
        let drawn = |beside: f64| {
            let mut drawing = Drawing::new(self.size[0] + beside, self.size[1]);
            let right = 24.0 + beside;
            let labels = &self.labels;
            let frame = axes(
                &mut drawing,
                &self.title,
                labels,
                scales,
                [10, 8],
                false,
                right,
            );
            (drawing, frame)
        };
        let (mut drawing, mut frame) = drawn(0.0);
        let size = self.legend_size();
        let mut corner = size.and_then(|size| self.legend_corner(&frame, size));
        // a legend that would hide what is plotted stands beside it
        if let (Some(size), None) = (size, corner) {
            (drawing, frame) = drawn(size[0] + GAP);
            corner = Some([frame.corner[0] + frame.size[0] + GAP, frame.corner[1]]);
        }
        for (x, name) in &self.named {
            let top = frame.place([*x, scales[1].high]);
            let bottom = frame.place([*x, scales[1].low]);
            if frame.holds(top) {
                drawing.segment(top, bottom, 1.0, GREY);
                drawing.text([top[0], top[1] - 5.0], name, TICK, Align::Center, INK);
            }
        }
        for s in &self.series {
            self.draw_series(&mut drawing, &frame, s, s.color());
        }
        drawing.frame(frame.corner, frame.size, 1.2, INK);
        if let (Some(size), Some(corner)) = (size, corner) {
            self.legend(&mut drawing, corner, size);
        }
        Ok(drawing)
    }

    fn draw_series(&self, drawing: &mut Drawing, frame: &Frame, s: &Series, color: Color) {
        let dash = s.stroke.dash();
        if s.stroke != Stroke::None {
            for points in frame.clipped(&s.points) {
                drawing.shapes.push(Shape::Path {
                    points,
                    width: 1.8,
                    color,
                    dash,
                });
            }
        }
        if let Some((outline, radius)) = s.mark.shape() {
            for p in s.points.iter().map(|p| frame.place(*p)) {
                if frame.holds(p) {
                    drawing.shapes.push(Shape::Marker {
                        at: p,
                        radius,
                        outline,
                        color,
                    });
                }
            }
        }
    }

    /// Series with a name.
    fn named_series(&self) -> impl Iterator<Item = &Series> {
        self.series.iter().filter(|s| !s.label.is_empty())
    }

    /// Of the box with the names; `None`: there are none.
    fn legend_size(&self) -> Option<[f64; 2]> {
        let widths = self
            .named_series()
            .map(|s| font::width(&s.label, TICK, Weight::Regular));
        let widest = widths.fold(0.0, f64::max);
        let rows = self.named_series().count();
        (rows > 0).then_some([widest + 56.0, 19.0 * rows as f64 + 10.0])
    }

    /// A corner of the frame in which the box covers next to nothing.
    fn legend_corner(&self, frame: &Frame, size: [f64; 2]) -> Option<[f64; 2]> {
        let [x0, y0] = frame.corner;
        let right = x0 + frame.size[0] - size[0] - GAP;
        let bottom = y0 + frame.size[1] - size[1] - GAP;
        let corners = [
            [right, y0 + GAP],
            [x0 + GAP, y0 + GAP],
            [right, bottom],
            [x0 + GAP, bottom],
        ];
        let near = |p: &[f64; 2], corner: &[f64; 2]| {
            (0..2).all(|a| p[a] > corner[a] - 4.0 && p[a] < corner[a] + size[a] + 4.0)
        };
        let covered = |corner: &[f64; 2]| {
            let marks = |s: &Series| {
                let places = s.points.iter().map(|p| frame.place(*p));
                s.mark
                    .shape()
                    .map_or(0, |_| places.filter(|p| near(p, corner)).count())
            };
            let lines = |s: &Series| {
                let pieces = frame.clipped(&s.points);
                pieces.iter().flatten().filter(|p| near(p, corner)).count()
            };
            self.series
                .iter()
                .map(|s| marks(s) + lines(s))
                .sum::<usize>()
        };
        let best = corners.into_iter().map(|c| (covered(&c), c));
        let (least, corner) = best.min_by_key(|(n, _)| *n)?;
        let all: usize = self.series.iter().map(|s| s.points.len()).sum();
        (least * HIDDEN <= all).then_some(corner)
    }

    fn legend(&self, drawing: &mut Drawing, corner: [f64; 2], size: [f64; 2]) {
        drawing.shapes.push(Shape::Rectangle {
            corner,
            size,
            fill: WHITE,
        });
        drawing.frame(corner, size, 0.8, [190, 194, 200]);
        for (row, s) in self.named_series().enumerate() {
            let y = corner[1] + 5.0 + 19.0 * row as f64 + 9.5;
            let color = s.color();
            let place = [corner[0] + 8.0, corner[0] + 40.0];
            let dash = s.stroke.dash();
            if s.stroke != Stroke::None {
                drawing.shapes.push(Shape::Path {
                    points: vec![[place[0], y], [place[1], y]],
                    width: 1.8,
                    color,
                    dash,
                });
            }
            if let Some((outline, radius)) = s.mark.shape() {
                drawing.shapes.push(Shape::Marker {
                    at: [0.5 * (place[0] + place[1]), y],
                    radius,
                    outline,
                    color,
                });
            }
            drawing.text(
                [corner[0] + 47.0, y + 4.3],
                &s.label,
                TICK,
                Align::Left,
                INK,
            );
        }
    }
}
