//! The text of pictures: DejaVu Sans (free licence of Bitstream Vera and Arev), embedded, so that every machine draws the same.

use std::sync::OnceLock;

use fontdue::{Font, FontSettings};

/// How thick the letters are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Weight {
    Regular,
    Bold,
}

/// The font; `None` only if the embedded file were damaged.
fn font(weight: Weight) -> Option<&'static Font> {
    static FONTS: [OnceLock<Option<Font>>; 2] = [OnceLock::new(), OnceLock::new()];
    let (place, file): (usize, fn() -> &'static [u8]) = match weight {
        Weight::Regular => (0, dejavu::sans::regular),
        Weight::Bold => (1, dejavu::sans::bold),
    };
    let load = || Font::from_bytes(file(), FontSettings::default()).ok();
    FONTS[place].get_or_init(load).as_ref()
}

/// Width of a text of this size (pixels).
pub fn width(text: &str, size: f64, weight: Weight) -> f64 {
    let Some(font) = font(weight) else { return 0.0 };
    text.chars()
        .map(|c| f64::from(font.metrics(c, size as f32).advance_width))
        .sum()
}

/// Gives every inked pixel of a line of text with its coverage, 0 to 1: along the text from its beginning, and below its base line.
pub fn pixels(text: &str, size: f64, weight: Weight, mut put: impl FnMut(i64, i64, f64)) {
    let Some(font) = font(weight) else { return };
    let mut pen = 0.0f64;
    for c in text.chars() {
        let (m, coverage) = font.rasterize(c, size as f32);
        let left = pen.round() as i64 + i64::from(m.xmin);
        // rows are from the top
        let top = -(m.height as i64) - i64::from(m.ymin);
        for (k, value) in coverage.iter().enumerate().filter(|(_, v)| **v > 0) {
            let (along, down) = ((k % m.width) as i64, (k / m.width) as i64);
            put(left + along, top + down, f64::from(*value) / 255.0);
        }
        pen += f64::from(m.advance_width);
    }
}
