//! Rigid bodies as a camera sees them: depth and light for each pixel of a part of a view, lit, with dark edges against what is behind.

use super::camera::{Camera, Frame};
use super::image::Color;
use super::rigid::{Form, Placed};

/// What they are made of; no field has this colour.
pub const STEEL: Color = [168, 176, 188];
/// Towards the light (right, up, to the viewer), and what light there is without it.
const LIGHT: [f64; 3] = [-0.352_4, 0.553_8, 0.755_1];
const AMBIENT: f64 = 0.42;
/// Light on a cut, and on an edge against what is behind.
const SECTION: f32 = 1.12;
const EDGE: f32 = 0.5;
/// Bevel of a flat body: change of light on sides towards the light and away from it.
const BEVEL: [f32; 2] = [0.35, -0.28];

/// A body in pixels of a view; depths in lengths of its own.
enum Solid {
    Ball {
        at: [f64; 3],
        radius: f64,
    },
    Mesh {
        corner: Vec<[f64; 3]>,
        face: Vec<[u32; 3]>,
    },
}

/// All that is to be drawn into a view.
pub struct Solids {
    all: Vec<Solid>,
    /// Depths for a pixel.
    deep: f64,
    /// Do they lie flat over a plate?
    flat: bool,
}

/// How a view measures: pixels of a length, and depths of one.
pub struct Measure<'a> {
    pub camera: &'a Camera,
    pub frame: &'a Frame,
    pub fine: f64,
    pub deep: f64,
}

/// A part of a view: rows and columns, the first of them.
#[derive(Clone, Copy)]
pub struct Part {
    pub width: usize,
    pub height: usize,
    pub first: [usize; 2],
}

/// What is seen of rigid bodies in a part.
pub struct Layer {
    part: Part,
    /// Towards the viewer; −∞ where there is nothing.
    pub depth: Vec<f32>,
    pub light: Vec<f32>,
}

fn lit(n: [f64; 3]) -> f32 {
    let toward = (0..3).map(|a| n[a] * LIGHT[a]).sum::<f64>().max(0.0);
    (AMBIENT + (1.0 - AMBIENT) * (toward / LIGHT[2]).min(1.2)) as f32
}

impl Solids {
    pub fn of(bodies: &[Placed], measure: &Measure, flat: bool) -> Solids {
        let place = |x: [f64; 3]| {
            let p = measure.camera.project(x);
            [
                (p[0] - measure.frame.low[0]) * measure.fine,
                (measure.frame.high[1] - p[1]) * measure.fine,
                (p[2] - measure.frame.low[2]) * measure.deep,
            ]
        };
        let made = |body: &Placed| match &body.form {
            Form::Ball(radius) => Some(Solid::Ball {
                at: place(body.center),
                radius: radius * measure.fine,
            }),
            Form::Surface(surface) => Some(Solid::Mesh {
                corner: { surface.corner.iter() }
                    .map(|x| place(body.in_space(x)))
                    .collect(),
                face: surface.face.clone(),
            }),
            Form::Plane(_) => None,
        };
        Solids {
            all: bodies.iter().filter_map(made).collect(),
            deep: measure.deep / measure.fine,
            flat,
        }
    }

    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// Pixels around that edges of a part depend on.
    pub const MARGIN: usize = 12;

    /// What is seen in a part; `most`: how near it may be at a pixel, where something is cut open.
    pub fn seen(&self, part: Part, most: impl Fn(f64, f64) -> f64) -> Layer {
        let size = part.width * part.height;
        let mut layer = Layer {
            part,
            depth: vec![f32::NEG_INFINITY; size],
            light: vec![0.0; size],
        };
        for solid in &self.all {
            let mut own = vec![(f64::NEG_INFINITY, 0f32); size];
            match solid {
                Solid::Ball { at, radius } => self.ball(&mut own, part, (at, *radius), &most),
                Solid::Mesh { corner, face } => self.mesh(&mut own, part, (corner, face), &most),
            }
            for (at, (depth, light)) in own.into_iter().enumerate() {
                if depth as f32 > layer.depth[at] {
                    (layer.depth[at], layer.light[at]) = (depth as f32, light);
                }
            }
        }
        layer.edges(self.flat);
        layer
    }

    fn ball(
        &self,
        own: &mut [(f64, f32)],
        part: Part,
        (at, r): (&[f64; 3], f64),
        most: &impl Fn(f64, f64) -> f64,
    ) {
        let (rows, columns) = part.span([at[0] - r, at[0] + r], [at[1] - r, at[1] + r]);
        for row in rows {
            for column in columns.clone() {
                let [x, y] = [column as f64 + 0.5, row as f64 + 0.5];
                let (dx, dy) = (x - at[0], y - at[1]);
                let rest = r * r - dx * dx - dy * dy;
                if rest < 0.0 {
                    continue;
                }
                let z = rest.sqrt();
                let [near, far] = [1.0, -1.0].map(|way| at[2] + way * z * self.deep);
                let limit = most(x, y);
                let normal = match self.flat {
                    true => [0.0, 0.0, 1.0],
                    false => [dx / r, -dy / r, z / r],
                };
                own[part.at(row, column)] = match () {
                    () if near <= limit => (near, lit(normal)),
                    () if far < limit => (limit, SECTION),
                    () => continue,
                };
            }
        }
    }

    fn mesh(
        &self,
        own: &mut [(f64, f32)],
        part: Part,
        (corner, face): (&[[f64; 3]], &[[u32; 3]]),
        most: &impl Fn(f64, f64) -> f64,
    ) {
        for f in face {
            let [a, b, c] = f.map(|n| corner[n as usize]);
            let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            if area == 0.0 || !area.is_finite() {
                continue;
            }
            let least = |k: usize| a[k].min(b[k]).min(c[k]);
            let largest = |k: usize| a[k].max(b[k]).max(c[k]);
            let (rows, columns) = part.span([least(0), largest(0)], [least(1), largest(1)]);
            // rows grow downwards: what turns right faces the viewer
            let front = area < 0.0 || self.flat;
            let light = match (self.flat, front) {
                (true, _) => 1.0,
                (_, true) => lit(self.normal([a, b, c])),
                // the viewer looks into it: it is cut here
                (_, false) => SECTION,
            };
            for row in rows {
                for column in columns.clone() {
                    let [x, y] = [column as f64 + 0.5, row as f64 + 0.5];
                    let v = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / area;
                    let w = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / area;
                    if v < 0.0 || w < 0.0 || v + w > 1.0 {
                        continue;
                    }
                    let depth = a[2] + v * (b[2] - a[2]) + w * (c[2] - a[2]);
                    let limit = most(x, y);
                    let place = &mut own[part.at(row, column)];
                    if depth <= limit && depth > place.0 {
                        *place = (depth, light);
                    }
                }
            }
        }
        // what is seen from inside ends at the cut
        for (n, place) in own.iter_mut().enumerate() {
            if place.1 == SECTION && place.0.is_finite() {
                let [row, column] = [n / part.width, n % part.width];
                let limit = most(
                    (part.first[1] + column) as f64 + 0.5,
                    (part.first[0] + row) as f64 + 0.5,
                );
                place.0 = if limit.is_finite() { limit } else { place.0 };
            }
        }
    }

    /// Unit normal of a face towards right, up and the viewer.
    fn normal(&self, [a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
        let way = |p: [f64; 3]| [p[0] - a[0], a[1] - p[1], (p[2] - a[2]) / self.deep];
        let (u, v) = (way(b), way(c));
        let n = super::camera::cross(u, v);
        let size = n.iter().map(|c| c * c).sum::<f64>().sqrt();
        n.map(|c| c / size)
    }
}

impl Part {
    /// Rows and columns whose middles are between these pixels.
    fn span(&self, x: [f64; 2], y: [f64; 2]) -> (std::ops::Range<usize>, std::ops::Range<usize>) {
        let of = |[low, high]: [f64; 2], first: usize, count: usize| {
            let (least, end) = (first as f64, (first + count) as f64);
            let low = (low - 0.5).ceil().clamp(least, end) as usize;
            low..((high + 0.5).floor().clamp(least, end) as usize).max(low)
        };
        (
            of(y, self.first[0], self.height),
            of(x, self.first[1], self.width),
        )
    }

    fn at(&self, row: usize, column: usize) -> usize {
        (row - self.first[0]) * self.width + column - self.first[1]
    }
}

impl Layer {
    /// Nothing here.
    pub fn hide(&mut self, at: usize) {
        self.depth[at] = f32::NEG_INFINITY;
    }

    /// Light on a pixel, where a body is seen.
    pub fn light(&self, at: usize) -> Option<f32> {
        self.depth[at].is_finite().then(|| self.light[at])
    }

    /// Outlines, and the bevel of flat bodies.
    fn edges(&mut self, flat: bool) {
        let (w, h) = (self.part.width as i64, self.part.height as i64);
        let solid: Vec<bool> = self.depth.iter().map(|d| d.is_finite()).collect();
        // outside the part it goes on as it is at its border
        let there = |row: i64, column: i64| {
            solid[(row.clamp(0, h - 1) * w + column.clamp(0, w - 1)) as usize]
        };
        let far = Solids::MARGIN as i64 - 2;
        for row in 0..h {
            for column in 0..w {
                let at = (row * w + column) as usize;
                if !solid[at] {
                    continue;
                }
                let beside = |d: i64| {
                    let ways = [[d, 0], [-d, 0], [0, d], [0, -d]];
                    ways.iter().any(|[r, c]| !there(row + r, column + c))
                };
                if beside(3) {
                    self.light[at] = EDGE;
                } else if flat {
                    let [up, down] = [-far, far].map(|d| !there(row + d, column + d));
                    let change = f32::from(up) * BEVEL[0] + f32::from(down) * BEVEL[1];
                    self.light[at] += change;
                }
            }
        }
    }
}
