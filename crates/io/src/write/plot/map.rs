//! A quantity over two axes as colours, with a colour bar: space–time images of the density, fields of plates.

use std::io;
use std::path::{Path, PathBuf};

use super::super::font::{self, Weight};
use super::super::picture::colormap;
use super::super::picture::image::{Align, Color, INK, Image};
use super::axis::Scale;
use super::canvas::{Drawing, Shape};
use super::frame::{Frame, LABEL, TICK, axes, beside};
use super::save::{SCALE, titled};
use super::{WriteError, invalid};

/// Where a value is missing.
const MISSING: Color = [214, 216, 220];

/// Colours of values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColorMap {
    /// From dark to light.
    Sequential,
    /// Blue, white, red: white is 0 where the range has both signs, as deep on either side, else its middle.
    Diverging,
}

impl ColorMap {
    /// The one for values from `low` to `high`: numbers of both signs diverge.
    pub fn of([low, high]: [f64; 2]) -> ColorMap {
        match colormap::Map::for_range([low, high]) {
            colormap::Map::Sequential => ColorMap::Sequential,
            colormap::Map::Diverging => ColorMap::Diverging,
        }
    }

    /// Of a value on a bar.
    fn tint(self, bar: Scale, value: f64) -> Color {
        let most = (-bar.low).max(bar.high);
        match self == ColorMap::Diverging && bar.low < 0.0 && bar.high > 0.0 {
            true => self.color(0.5 + 0.5 * value.clamp(bar.low, bar.high) / most),
            false => self.color(bar.part(value)),
        }
    }

    /// Of a part 0…1 of the map; grey for what is no number.
    pub(super) fn color(self, part: f64) -> Color {
        if part.is_nan() {
            return MISSING;
        }
        match self {
            ColorMap::Sequential => colormap::color(part),
            ColorMap::Diverging => {
                let part = part.clamp(0.0, 1.0);
                let ends: [[f64; 3]; 3] = [[33.0, 92.0, 175.0], [247.0; 3], [178.0, 24.0, 43.0]];
                let (k, t) = if part < 0.5 {
                    (0, 2.0 * part)
                } else {
                    (1, 2.0 * part - 1.0)
                };
                std::array::from_fn(|c| {
                    (ends[k][c] + t * (ends[k + 1][c] - ends[k][c])).round() as u8
                })
            }
        }
    }
}

#[derive(Debug, Clone)]
enum Data {
    None,
    /// Rows one after another, the first at the low end of y.
    Grid {
        columns: usize,
        values: Vec<f64>,
    },
    /// Squares of this width (in units of x) around points.
    Points {
        points: Vec<[f64; 2]>,
        values: Vec<f64>,
        width: f64,
    },
}

/// A map of colours; built step by step, then saved.
#[derive(Debug, Clone)]
pub struct Map {
    title: String,
    labels: [String; 2],
    value: String,
    range: [[f64; 2]; 2],
    data: Data,
    values: Option<[f64; 2]>,
    colors: ColorMap,
    down: bool,
    equal: bool,
}

impl Map {
    pub fn new(title: impl Into<String>) -> Map {
        Map {
            title: title.into(),
            labels: [String::new(), String::new()],
            value: String::new(),
            range: [[0.0, 1.0]; 2],
            data: Data::None,
            values: None,
            colors: ColorMap::Sequential,
            down: false,
            equal: false,
        }
    }

    /// What the x axis is, its unit, and from where to where the data goes (outer edges of the cells).
    #[must_use]
    pub fn x(mut self, name: &str, unit: &str, range: [f64; 2]) -> Map {
        self.labels[0] = titled(name, unit);
        self.range[0] = range;
        self
    }

    #[must_use]
    pub fn y(mut self, name: &str, unit: &str, range: [f64; 2]) -> Map {
        self.labels[1] = titled(name, unit);
        self.range[1] = range;
        self
    }

    /// What the colours are.
    #[must_use]
    pub fn value(mut self, name: &str, unit: &str) -> Map {
        self.value = titled(name, unit);
        self
    }

    /// Values of the ends of the colour bar; without it, those of the data.
    #[must_use]
    pub fn between(mut self, low: f64, high: f64) -> Map {
        self.values = Some([low, high]);
        self
    }

    #[must_use]
    pub fn colors(mut self, colors: ColorMap) -> Map {
        self.colors = colors;
        self
    }

    /// y grows downwards, as time in a space–time image.
    #[must_use]
    pub fn y_down(mut self) -> Map {
        self.down = true;
        self
    }

    /// One unit of x is as long as one of y.
    #[must_use]
    pub fn equal(mut self) -> Map {
        self.equal = true;
        self
    }

    /// Values in rows of `columns`, the first row at the low end of y. Where there are more values than pixels,
    /// a pixel is their mean.
    #[must_use]
    pub fn grid(mut self, columns: usize, values: &[f64]) -> Map {
        self.data = Data::Grid {
            columns,
            values: values.to_vec(),
        };
        self
    }

    /// Values at points, as squares of `width` (in units of x).
    #[must_use]
    pub fn points(mut self, points: &[[f64; 2]], values: &[f64], width: f64) -> Map {
        self.data = Data::Points {
            points: points.to_vec(),
            values: values.to_vec(),
            width,
        };
        self
    }

    /// Writes `name.png` and `name.svg` into `dir`, which is made if needed; gives their paths.
    ///
    /// # Errors
    /// The operating system's; `InvalidInput` for data that is no rectangle, empty or nowhere finite, or an empty range.
    pub fn save(&self, dir: &Path, name: &str) -> Result<[PathBuf; 2], WriteError> {
        super::save::save(dir, name, self.draw())
    }

    /// The picture itself.
    ///
    /// # Errors
    /// As [`Map::save`].
    pub fn image(&self) -> io::Result<Image> {
        Ok(super::raster::draw(&self.draw()?, super::save::SCALE))
    }

    fn check(&self) -> io::Result<&[f64]> {
        for [low, high] in self.range {
            if !(low < high && low.is_finite() && high.is_finite()) {
                return Err(invalid(format!(
                    "the range {low} to {high} cannot be an axis"
                )));
            }
        }
        match &self.data {
            Data::Grid { columns, values } => {
                if *columns == 0 || values.is_empty() || values.len() % columns != 0 {
                    return Err(invalid(format!(
                        "{} values do not fill rows of {columns}",
                        values.len()
                    )));
                }
                Ok(values)
            }
            Data::Points {
                points,
                values,
                width,
            } => {
                if points.len() != values.len()
                    || width.partial_cmp(&0.0) != Some(std::cmp::Ordering::Greater)
                {
                    return Err(invalid(format!(
                        "{} points of width {width} have {} values",
                        points.len(),
                        values.len()
                    )));
                }
                Ok(values)
            }
            Data::None => Err(invalid("the map has no data".to_string())),
        }
    }

    pub(super) fn draw(&self) -> io::Result<Drawing> {
        let values = self.check()?;
        let [xs, ys] = self.range.map(|[low, high]| Scale {
            low,
            high,
            log: false,
        });
        let bar = match self.values {
            Some([low, high]) if low < high => Scale {
                low,
                high,
                log: false,
            },
            Some([low, high]) => {
                return Err(invalid(format!(
                    "colours from {low} to {high} are no range"
                )));
            }
            None => Scale::around(values.iter().copied(), false, 0.0)?,
        };
        let marks = bar.ticks(8);
        let widest = marks
            .iter()
            .map(|t| font::width(&t.1, TICK, Weight::Regular))
            .fold(0.0, f64::max);
        let right = widest + 86.0;
        let mut drawing = Drawing::new(760.0, 520.0);
        if self.equal {
            // above and below is as much as `axes` takes
            let across = drawing.width - right - beside(&ys.ticks(8));
            let ratio = (ys.high - ys.low) / (xs.high - xs.low);
            drawing.height = (across * ratio).clamp(80.0, 1400.0) + 104.0;
        }
        let frame = axes(
            &mut drawing,
            &self.title,
            &self.labels,
            [xs, ys],
            [8, 8],
            self.down,
            right,
        );
        drawing.shapes.push(Shape::Pixels {
            corner: frame.corner,
            size: frame.size,
            image: self.pixels(&frame, bar),
        });
        drawing.frame(frame.corner, frame.size, 1.2, INK);
        self.bar(&mut drawing, &frame, bar, &marks);
        Ok(drawing)
    }

    fn bar(&self, drawing: &mut Drawing, frame: &Frame, bar: Scale, marks: &[(f64, String)]) {
        let corner = [frame.corner[0] + frame.size[0] + 18.0, frame.corner[1]];
        let size = [16.0, frame.size[1]];
        let mut image = Image::new(1, 256);
        for (k, pixel) in image.pixels.iter_mut().enumerate() {
            let part = 1.0 - k as f64 / 255.0;
            *pixel = self.colors.tint(bar, bar.low + part * (bar.high - bar.low));
        }
        drawing.shapes.push(Shape::Pixels {
            corner,
            size,
            image,
        });
        drawing.frame(corner, size, 1.0, INK);
        let edge = corner[0] + size[0];
        for (value, text) in marks {
            let y = corner[1] + (1.0 - bar.part(*value)) * size[1];
            drawing.segment([edge, y], [edge + 4.0, y], 1.0, INK);
            drawing.text([edge + 8.0, y + 4.2], text, TICK, Align::Left, INK);
        }
        let middle = corner[1] + 0.5 * size[1];
        drawing.upright([drawing.width - 14.0, middle], &self.value, LABEL, INK);
    }

    /// One pixel per value, or per pixel of the PNG where there are more values.
    fn pixels(&self, frame: &Frame, bar: Scale) -> Image {
        let most = frame.size.map(|s| (s * SCALE).round().max(1.0) as usize);
        match &self.data {
            Data::Grid { columns, values } => {
                let rows = values.len() / columns;
                let (w, h) = ((*columns).min(most[0]), rows.min(most[1]));
                let mut image = Image::new(w, h);
                for y in 0..h {
                    let row = if frame.down { y } else { h - 1 - y };
                    for x in 0..w {
                        let (mut sum, mut count) = (0.0, 0.0);
                        for j in row * rows / h..(row + 1) * rows / h {
                            for v in &values
                                [j * columns + x * columns / w..j * columns + (x + 1) * columns / w]
                            {
                                sum += v;
                                count += 1.0;
                            }
                        }
                        image.pixels[y * w + x] = self.colors.tint(bar, sum / count);
                    }
                }
                image
            }
            Data::Points {
                points,
                values,
                width,
            } => {
                let mut image = Image::new(most[0], most[1]);
                image.pixels.fill([255; 3]);
                let half = 0.5 * width;
                for (p, value) in points.iter().zip(values) {
                    let a = frame.place([p[0] - half, p[1] - half]);
                    let b = frame.place([p[0] + half, p[1] + half]);
                    let at = |q: [f64; 2], c: usize| (q[c] - frame.corner[c]) * SCALE;
                    let (x, y) = (at(a, 0), at(a, 1).min(at(b, 1)));
                    let (w, h) = (
                        (at(b, 0) - x).max(1.0),
                        (at(b, 1) - at(a, 1)).abs().max(1.0),
                    );
                    image.rectangle(x, y, w, h, self.colors.tint(bar, *value));
                }
                image
            }
            Data::None => Image::new(1, 1),
        }
    }
}
