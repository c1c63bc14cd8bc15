//! A drawing as pixels.

use super::super::font::Weight;
use super::super::picture::image::{Color, Image};
use super::canvas::{Drawing, Outline, Shape};

pub fn draw(drawing: &Drawing, scale: f64) -> Image {
    let pixels = |length: f64| (length * scale).round() as usize;
    let mut image = Image::new(pixels(drawing.width), pixels(drawing.height));
    for shape in &drawing.shapes {
        match shape {
            Shape::Path {
                points,
                width,
                color,
                dash,
            } => {
                let points: Vec<[f64; 2]> = points.iter().map(|p| p.map(|c| c * scale)).collect();
                path(
                    &mut image,
                    &points,
                    width * scale,
                    *color,
                    dash.map(|d| d.map(|l| l * scale)),
                );
            }
            Shape::Rectangle { corner, size, fill } => {
                let [x, y] = corner.map(|c| c * scale);
                image.rectangle(x, y, size[0] * scale, size[1] * scale, *fill);
            }
            Shape::Marker {
                at,
                radius,
                outline,
                color,
            } => marker(
                &mut image,
                at.map(|c| c * scale),
                radius * scale,
                *outline,
                *color,
            ),
            Shape::Text {
                at,
                text,
                size,
                align,
                upright,
                color,
            } => {
                let at = at.map(|c| c * scale);
                let style = (size * scale, Weight::Regular);
                image.write(at, text, style, *align, *upright, *color);
            }
            Shape::Pixels {
                corner,
                size,
                image: source,
            } => stretch(
                &mut image,
                corner.map(|c| c * scale),
                size.map(|c| c * scale),
                source,
            ),
        }
    }
    image
}

/// Dashes go on around corners.
fn path(image: &mut Image, points: &[[f64; 2]], width: f64, color: Color, dash: Option<[f64; 2]>) {
    let mut phase = 0.0;
    for pair in points.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        let Some([ink, gap]) = dash else {
            image.line(from, to, width, color);
            continue;
        };
        let length = libm::hypot(to[0] - from[0], to[1] - from[1]);
        if !(length > 0.0 && length.is_finite()) {
            continue;
        }
        let at = |s: f64| -> [f64; 2] {
            std::array::from_fn(|a| from[a] + (to[a] - from[a]) * (s / length).clamp(0.0, 1.0))
        };
        let period = ink + gap;
        let mut start = -phase;
        while start < length {
            if start + ink > 0.0 {
                image.line(at(start), at(start + ink), width, color);
            }
            start += period;
        }
        phase = (phase + length) % period;
    }
}

fn marker(image: &mut Image, at: [f64; 2], radius: f64, outline: Outline, color: Color) {
    let points = outline.corners(at, radius);
    let reach = radius.ceil() as i64 + 1;
    let (cx, cy) = (at[0].round() as i64, at[1].round() as i64);
    for y in cy - reach..=cy + reach {
        for x in cx - reach..=cx + reach {
            // sixteen samples smooth the edge
            let inside = (0..16).filter(|k| {
                let p = [
                    x as f64 + (f64::from(k % 4) + 0.5) / 4.0,
                    y as f64 + (f64::from(k / 4) + 0.5) / 4.0,
                ];
                match outline {
                    Outline::Disc => libm::hypot(p[0] - at[0], p[1] - at[1]) <= radius,
                    Outline::Polygon { .. } => contains(&points, p),
                }
            });
            let opacity = inside.count() as f64 / 16.0;
            if opacity > 0.0 {
                image.blend(x, y, color, opacity);
            }
        }
    }
}

/// A convex polygon, clockwise on the screen.
fn contains(points: &[[f64; 2]], p: [f64; 2]) -> bool {
    (0..points.len()).all(|k| {
        let (a, b) = (points[k], points[(k + 1) % points.len()]);
        (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) >= 0.0
    })
}

fn stretch(image: &mut Image, corner: [f64; 2], size: [f64; 2], source: &Image) {
    let [left, top] = corner.map(|c| c.round() as i64);
    let right = (corner[0] + size[0]).round() as i64;
    let bottom = (corner[1] + size[1]).round() as i64;
    let (w, h) = ((right - left).max(1), (bottom - top).max(1));
    for y in 0..h {
        let row = (y as usize * source.height) / h as usize;
        for x in 0..w {
            let column = (x as usize * source.width) / w as usize;
            image.blend(
                left + x,
                top + y,
                source.pixels[row * source.width + column],
                1.0,
            );
        }
    }
}
