//! The text of a PNG: DejaVu Sans (free licence of Bitstream Vera and Arev), embedded, so that every machine draws the same.

use std::sync::OnceLock;

use fontdue::{Font, FontSettings};

use super::super::picture::image::{Align, Color, Image};

/// The font; `None` only if the embedded file were damaged.
fn font() -> Option<&'static Font> {
    static FONT: OnceLock<Option<Font>> = OnceLock::new();
    let load = || Font::from_bytes(dejavu::sans::regular(), FontSettings::default()).ok();
    FONT.get_or_init(load).as_ref()
}

/// Width of a text of this size.
pub fn width(text: &str, size: f64) -> f64 {
    let Some(font) = font() else { return 0.0 };
    text.chars()
        .map(|c| f64::from(font.metrics(c, size as f32).advance_width))
        .sum()
}

/// Draws a line of text, `at` (pixels) on its base line.
pub fn draw(
    image: &mut Image,
    at: [f64; 2],
    text: &str,
    size: f64,
    align: Align,
    upright: bool,
    color: Color,
) {
    let Some(font) = font() else { return };
    let mut pen = match align {
        Align::Left => 0.0,
        Align::Center => -0.5 * width(text, size),
        Align::Right => -width(text, size),
    };
    for c in text.chars() {
        let (m, coverage) = font.rasterize(c, size as f32);
        let left = pen.round() as i64 + i64::from(m.xmin);
        // rows are from the top, y grows down
        let top = -(m.height as i64) - i64::from(m.ymin);
        for (k, value) in coverage.iter().enumerate() {
            let along = left + (k % m.width) as i64;
            let down = top + (k / m.width) as i64;
            let (dx, dy) = if upright {
                (down, -along)
            } else {
                (along, down)
            };
            let x = at[0].round() as i64 + dx;
            let y = at[1].round() as i64 + dy;
            image.blend(x, y, color, f64::from(*value) / 255.0);
        }
        pen += f64::from(m.advance_width);
    }
}
