//! A body seen by an orthographic camera: every point a small cube, the nearest to the viewer wins.
//!
//! Everything is drawn at [`FINE`] times the final resolution and averaged down. Relief is shown by the light on the
//! slope of the surface and by darkening what lies deeper than its surroundings ("unsharp masking the depth
//! buffer", Luft, Colditz and Deussen 2006).

use std::ops::Range;

use super::camera::{Camera, Frame};
use super::cells::Cell;
use super::colormap::Map;
use super::image::{Color, Image};
use super::solid::{Layer, Measure, Part, STEEL, Solids};

/// Pixels drawn per final pixel and axis.
const FINE: usize = 2;
/// Fine rows and columns that are drawn at a time, so that a picture takes little memory.
const PART: usize = 384;
/// Cubes are a little larger than the spacing, so that a stretched but unbroken body shows no gaps.
const OVERLAP: f64 = 1.08;
/// Light on the faces of a body seen obliquely: below 1 darkens towards black, above 1 lightens towards white.
const SIDE_LIGHT: f32 = 0.88;
const TOP_LIGHT: f32 = 1.10;

/// Change of light per slope (rise over run) of the surface, and the most that a hollow takes away.
const SLOPE_LIGHT: f32 = 0.45;
const HOLLOW_SHADE: f32 = 0.45;

/// Rigid bodies in a view.
pub struct Beside<'a> {
    pub bodies: &'a [super::rigid::Placed],
    /// Do they lie flat over a plate?
    pub flat: bool,
    /// How much of what is behind them they hide, 0 to 1.
    pub opacity: f32,
    /// How near to the viewer something may be on the ray through a place of the camera's screen (lengths), where the body is cut open.
    pub nearest: &'a dyn Fn(f64, f64) -> f64,
}

/// A colour channel (0…255) in a light: darkened towards black below 1, lightened towards white above.
fn lit(channel: f32, light: f32) -> f32 {
    if light <= 1.0 {
        channel * light
    } else {
        channel + (255.0 - channel) * (light - 1.0).min(1.0)
    }
}

/// A colour in a light.
fn in_light([r, g, b]: Color, light: f32) -> [f32; 3] {
    [
        lit(f32::from(r), light),
        lit(f32::from(g), light),
        lit(f32::from(b), light),
    ]
}

/// Depth, place among the colours and face per fine pixel of a part of a view, a byte or four each: parts reach far around where cubes
/// are large.
struct Buffer {
    width: usize,
    height: usize,
    /// Row and column of the view that are the first here.
    first: [usize; 2],
    /// Towards the viewer, in edges of a cube, and then the height above the ground of the body; −∞ where there is nothing.
    depth: Vec<f32>,
    /// Place in the table of colours.
    part: Vec<u8>,
    /// Place in [`FACES`].
    face: Vec<u8>,
    /// Edge of a cube in fine pixels.
    edge: f64,
}

/// A pixel of a [`Buffer`].
struct Pixel<'a> {
    depth: &'a mut f32,
    part: &'a mut u8,
    face: &'a mut u8,
}

impl Pixel<'_> {
    /// Keeps what is nearest to the viewer.
    fn keep_nearer(self, depth: f32, part: u8, face: u8) {
        if depth > *self.depth {
            *self.depth = depth;
            *self.part = part;
            *self.face = face;
        }
    }
}

/// Light of a cell seen from straight above, and of the top and the front of a cube seen obliquely.
const FACES: [f32; 3] = [1.0, TOP_LIGHT, SIDE_LIGHT];

/// Rows and columns of a buffer that come into the image, with the light of each pixel.
struct Core {
    rows: Range<usize>,
    columns: Range<usize>,
    light: Vec<f32>,
}

impl Core {
    /// The light of each pixel, with its place in a buffer of this width.
    fn each(&mut self, width: usize, mut of: impl FnMut(usize, &mut f32)) {
        let lights = self.light.chunks_exact_mut(self.columns.len());
        for (row, lights) in self.rows.clone().zip(lights) {
            for (column, light) in self.columns.clone().zip(lights) {
                of(row * width + column, light);
            }
        }
    }
}

/// A point as it is drawn: where, its place among the colours from 0 to 1, and its cell.
pub type Seen = ([f64; 3], f64, Cell);

/// Cells overlap: a place shows the point that is nearest, in edges of each. By this part of an edge only, which is no relief.
const NEARER: f64 = 1e-4;

/// Draws points with the upper left corner of the frame at `corner` (pixels), `scale` pixels per
/// length.
pub fn draw(
    image: &mut Image,
    (corner, scale): ([f64; 2], f64),
    (camera, frame): (&Camera, &Frame),
    spacing: f64,
    map: Map,
    beside: &Beside,
    points: impl Iterator<Item = Seen> + Clone,
) {
    let fine = scale * FINE as f64;
    let [w, h] = frame.size().map(|s| (s * fine).ceil() as usize + FINE);
    let edge = (spacing * OVERLAP * fine).max(1.0);
    // light and shade of a row depend on the rows within the widest blur
    let deep = 1.0 / (spacing * OVERLAP);
    let measure = Measure {
        camera,
        frame,
        fine,
        deep,
    };
    let solids = Solids::of(beside.bodies, &measure, beside.flat);
    let margin = hollow_radius(edge)
        .max(slope_radius(edge) + 1)
        .max(if solids.is_empty() { 0 } else { Solids::MARGIN })
        .div_ceil(FINE)
        * FINE;
    // parts are as large as what they need around them is wide
    let side = PART.max(margin).next_multiple_of(FINE);
    let around = |from: usize, size: usize, end: usize| {
        let core = from..(from + size).min(end);
        let first = from.saturating_sub(margin);
        let length = (core.end + margin).min(end) - first;
        (core.start - first..core.end - first, first, length)
    };
    let table: Vec<Color> = (0..=255).map(|i| map.color(f64::from(i) / 255.0)).collect();
    for top in (0..h).step_by(side) {
        for left in (0..w).step_by(side) {
            let (rows, row, height) = around(top, side, h);
            let (columns, column, width) = around(left, side, w);
            let mut buffer = Buffer {
                width,
                height,
                first: [row, column],
                depth: vec![f32::NEG_INFINITY; width * height],
                part: vec![0; width * height],
                face: vec![0; width * height],
                edge,
            };
            for (x, part, cell) in points.clone() {
                let p = camera.project(x);
                let screen = [(p[0] - frame.low[0]) * fine, (frame.high[1] - p[1]) * fine];
                let depth = (p[2] - frame.low[2]) * deep;
                let place = ((part as f32).clamp(0.0, 1.0) * 255.0).round() as u8;
                match camera.cosine == 0.0 {
                    true => buffer.cell(screen, (depth as f32, place), &cell),
                    false => buffer.cube(screen, (depth as f32, place), camera),
                }
            }
            let steel = (!solids.is_empty()).then(|| {
                let part = Part {
                    width,
                    height,
                    first: [row, column],
                };
                let most = |x: f64, y: f64| {
                    let [right, up] = [frame.low[0] + x / fine, frame.high[1] - y / fine];
                    ((beside.nearest)(right, up) - frame.low[2]) * deep
                };
                let mut layer = solids.seen(part, most);
                for (at, depth) in buffer.depth.iter().enumerate() {
                    if !beside.flat && *depth > layer.depth[at] {
                        layer.hide(at);
                    }
                }
                layer
            });
            let mut core = Core {
                light: vec![1.0; rows.len() * columns.len()],
                rows,
                columns,
            };
            // of much of a view there is nothing to light
            if buffer.depth.iter().any(|depth| depth.is_finite()) {
                buffer.raise(camera);
                core.each(width, |at, light| {
                    *light = FACES[usize::from(buffer.face[at])]
                });
                if camera.cosine == 0.0 {
                    buffer.light_slopes(&mut core);
                }
                buffer.darken_hollows(&mut core);
            }
            let steel = steel.as_ref().map(|layer| (layer, beside.opacity));
            buffer.average_onto(image, corner, &core, &table, steel);
        }
    }
}

/// Radii of the blurs (fine pixels) for cubes of this edge.
fn slope_radius(edge: f64) -> usize {
    (edge.round() as usize).max(2)
}

fn hollow_radius(edge: f64) -> usize {
    ((2.0 * edge).round() as usize).max(3)
}

impl Buffer {
    /// A cube seen from `elevation`: its top face above its front face, each a rectangle.
    fn cube(&mut self, [x, y]: [f64; 2], (depth, part): (f32, u8), camera: &Camera) {
        let (e, s, c) = (self.edge, camera.sine, camera.cosine);
        let top = y - 0.5 * e * (s + c);
        // the front upper edge of the cube is the part nearest to the viewer
        let ridge = top + e * s;
        let nearest = depth + (0.5 * (s + c)) as f32;
        let [rows, columns] = self.span([x - 0.5 * e, x + 0.5 * e], [top, top + e * (s + c)]);
        for row in rows {
            let v = row as f64 + 0.5 - ridge;
            let (fall, face) = match v < 0.0 {
                true => (-v * c / s / e, 1),
                false => (v * s / c / e, 2),
            };
            let depth = nearest - fall as f32;
            for (_, old) in self.row(row, columns.clone()) {
                old.keep_nearer(depth, part, face);
            }
        }
    }

    /// A cell seen from straight above.
    fn cell(&mut self, [x, y]: [f64; 2], (depth, part): (f32, u8), cell: &Cell) {
        // rows grow downwards
        let e = self.edge;
        let [a, b] = cell.edges.map(|v| [e * v[0], -e * v[1]]);
        let area = a[0] * b[1] - a[1] * b[0];
        // parts of the edges per pixel across and down
        let along = [b[1] / area, -b[0] / area];
        let across = [-a[1] / area, a[0] / area];
        let [w, h] = [0, 1].map(|k| 0.5 * (a[k].abs() + b[k].abs()));
        let [rows, columns] = self.span([x - w, x + w], [y - h, y + h]);
        let nearest = depth + 0.5;
        for row in rows {
            let down = row as f64 + 0.5 - y;
            let so_far = [down * along[1], down * across[1]];
            for (column, old) in self.row(row, columns.clone()) {
                // most of a solid lies behind something
                if nearest <= *old.depth {
                    continue;
                }
                let right = column as f64 + 0.5 - x;
                let along = right * along[0] + so_far[0];
                let across = right * across[0] + so_far[1];
                if along.abs() > 0.5 || across.abs() > 0.5 {
                    continue;
                }
                let away = NEARER * (along * along + across * across);
                old.keep_nearer(depth + (0.5 - away) as f32, part, 0);
            }
        }
    }

    /// Rows and columns of the view that are here and whose middles are between these pixels.
    fn span(&self, x: [f64; 2], y: [f64; 2]) -> [Range<usize>; 2] {
        let whole = |[from, to]: [f64; 2], first: usize, count: usize| {
            let [low, end] = [from, to]
                .map(|x| ((x - 0.5).ceil().max(0.0) as usize).clamp(first, first + count));
            low..end
        };
        let [first_row, first_column] = self.first;
        [
            whole(y, first_row, self.height),
            whole(x, first_column, self.width),
        ]
    }

    /// Pixels of a row of the view, with their columns.
    fn row(
        &mut self,
        row: usize,
        columns: Range<usize>,
    ) -> impl Iterator<Item = (usize, Pixel<'_>)> {
        let first = (row - self.first[0]) * self.width + columns.start - self.first[1];
        let at = first..first + columns.len();
        let pixels = { self.depth[at.clone()].iter_mut() }
            .zip(&mut self.part[at.clone()])
            .zip(&mut self.face[at]);
        let pixels = pixels.map(|((depth, part), face)| Pixel { depth, part, face });
        columns.zip(pixels)
    }

    /// From depths to heights of the surface above the ground of the body (edges of a cube). Seen from above this is the depth; seen
    /// obliquely, unlike the depth, it is constant on a level surface.
    fn raise(&mut self, camera: &Camera) {
        let row_height = camera.cosine / self.edge;
        for (at, depth) in self.depth.iter_mut().enumerate() {
            let row = (self.first[0] + at / self.width) as f64;
            *depth = *depth * camera.sine as f32 - (row * row_height) as f32;
        }
    }

    /// Mean of the heights within ±`radius` pixels along both axes; 0 where there is nothing.
    fn blurred(&self, radius: usize) -> impl Fn(usize) -> f32 + use<> {
        let (w, h) = (self.width, self.height);
        // sums of heights and of how many there are, along the rows
        let mut along = vec![[0f32; 2]; w * h];
        for (row, sums) in along.chunks_exact_mut(w).enumerate() {
            let depth = &self.depth[row * w..][..w];
            let mut running = [0f64; 2];
            for i in 0..w + radius {
                if i < w && depth[i].is_finite() {
                    running[0] += f64::from(depth[i]);
                    running[1] += 1.0;
                }
                if i > 2 * radius && depth[i - 2 * radius - 1].is_finite() {
                    running[0] -= f64::from(depth[i - 2 * radius - 1]);
                    running[1] -= 1.0;
                }
                if i >= radius {
                    sums[i - radius] = [running[0] as f32, running[1] as f32];
                }
            }
        }
        // and of these down the columns, all of them row by row: neighbours in memory. A row of sums waits until nobody asks for what it replaces
        let mut sums = along;
        let mut running = vec![[0f64; 2]; w];
        let mut waiting = vec![[0f32; 2]; w * (radius + 1)];
        for i in 0..h + 2 * radius + 1 {
            if i < h {
                for (r, new) in running.iter_mut().zip(&sums[i * w..][..w]) {
                    r[0] += f64::from(new[0]);
                    r[1] += f64::from(new[1]);
                }
            }
            let slot = (i + 1) % (radius + 1) * w;
            if i > 2 * radius {
                let old = &mut sums[(i - 2 * radius - 1) * w..][..w];
                for (r, old) in running.iter_mut().zip(old.iter()) {
                    r[0] -= f64::from(old[0]);
                    r[1] -= f64::from(old[1]);
                }
                old.copy_from_slice(&waiting[slot..][..w]);
            }
            if (radius..h + radius).contains(&i) {
                for (r, sum) in running.iter().zip(&mut waiting[slot..][..w]) {
                    *sum = [r[0] as f32, r[1] as f32];
                }
            }
        }
        move |at| {
            let [s, n] = sums[at];
            if n > 0.5 { s / n } else { 0.0 }
        }
    }

    /// Light from the upper left on the slopes of the smoothed surface.
    fn light_slopes(&self, core: &mut Core) {
        let smooth = self.blurred(slope_radius(self.edge));
        let solid = |at: usize| self.depth[at].is_finite();
        core.each(self.width, |at, light| {
            let (row, column) = (at / self.width, at % self.width);
            let inside = (1..self.height.saturating_sub(1)).contains(&row)
                && (1..self.width.saturating_sub(1)).contains(&column);
            if !inside || !solid(at) {
                return;
            }
            let [left, right] = [at - 1, at + 1];
            let [above, below] = [at - self.width, at + self.width];
            if !(solid(left) && solid(right) && solid(above) && solid(below)) {
                return;
            }
            // heights are in edges, so slopes are rise over run
            let run = 2.0 / self.edge as f32;
            let to_the_right = (smooth(right) - smooth(left)) / run;
            let down = (smooth(below) - smooth(above)) / run;
            *light *= 1.0 + (SLOPE_LIGHT * (to_the_right + down)).clamp(-0.35, 0.25);
        });
    }

    /// Darkens what lies deeper than its surroundings: cracks, and debris behind.
    fn darken_hollows(&self, core: &mut Core) {
        let smooth = self.blurred(hollow_radius(self.edge));
        core.each(self.width, |at, light| {
            let height = self.depth[at];
            if height.is_finite() {
                *light *= 1.0 - HOLLOW_SHADE * ((smooth(at) - height) / 4.0).clamp(0.0, 1.0);
            }
        });
    }

    /// Averages fine pixels down to the image.
    fn average_onto(
        &self,
        image: &mut Image,
        corner: [f64; 2],
        core: &Core,
        table: &[Color],
        steel: Option<(&Layer, f32)>,
    ) {
        let (down, across) = (core.rows.len(), core.columns.len());
        for row in 0..down.div_ceil(FINE) {
            for column in 0..across.div_ceil(FINE) {
                let mut sum = [0f32; 3];
                let mut covered = 0.0;
                for y in row * FINE..(row * FINE + FINE).min(down) {
                    for x in column * FINE..(column * FINE + FINE).min(across) {
                        let at = (core.rows.start + y) * self.width + core.columns.start + x;
                        let body = self.depth[at].is_finite().then(|| {
                            let light = core.light[y * across + x];
                            in_light(table[usize::from(self.part[at])], light)
                        });
                        let front = steel.and_then(|(layer, opacity)| {
                            let light = layer.light(at)?;
                            Some((in_light(STEEL, light), opacity))
                        });
                        let seen = match (body, front) {
                            (None, None) => continue,
                            (Some(body), None) => body,
                            (body, Some((front, opacity))) => {
                                let mut seen = body.unwrap_or([255.0; 3]);
                                for c in 0..3 {
                                    seen[c] += (front[c] - seen[c]) * opacity;
                                }
                                seen
                            }
                        };
                        for c in 0..3 {
                            sum[c] += seen[c];
                        }
                        covered += 1.0;
                    }
                }
                if covered > 0.0 {
                    let [r, g, b] = sum;
                    let mean = |s: f32| (s / covered).round() as u8;
                    let mean = [mean(r), mean(g), mean(b)];
                    let opacity = f64::from(covered) / (FINE * FINE) as f64;
                    let first = [core.columns.start, core.rows.start];
                    let x = (self.first[1] + first[0]) / FINE + column;
                    let y = (self.first[0] + first[1]) / FINE + row;
                    let [left, top] = corner.map(|c| c.round() as i64);
                    image.blend(left + x as i64, top + y as i64, mean, opacity);
                }
            }
        }
    }
}
