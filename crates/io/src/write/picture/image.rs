//! An RGB image to draw on: rectangles, lines, text, and PNG.

use std::io::{self, Write};

use super::super::font::{self, Weight};

/// Red, green, blue; sRGB.
pub type Color = [u8; 3];

pub const WHITE: Color = [255; 3];
pub const INK: Color = [34, 38, 46];
pub const GREY: Color = [112, 118, 128];

/// Sizes of text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Font {
    Small,
    Normal,
    Title,
}

impl Font {
    /// Size (pixels) and weight.
    fn style(self) -> (f64, Weight) {
        match self {
            Font::Small => (19.0, Weight::Regular),
            Font::Normal => (22.0, Weight::Regular),
            Font::Title => (29.0, Weight::Bold),
        }
    }

    /// Width of a text (pixels).
    pub fn width(self, text: &str) -> f64 {
        let (size, weight) = self.style();
        font::width(text, size, weight)
    }
}

/// Where a text stands relative to its anchor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Align {
    Left,
    Center,
    Right,
}

/// Rows of pixels from the top; coordinates are in pixels, x to the right, y down.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image {
    pub width: usize,
    pub height: usize,
    pub pixels: Vec<Color>,
}

impl Image {
    /// A white image.
    pub fn new(width: usize, height: usize) -> Self {
        Image {
            width,
            height,
            pixels: vec![WHITE; width * height],
        }
    }

    /// Its pixels on a white sheet of this width and height.
    pub fn of_size(&self, (width, height): (usize, usize)) -> Vec<Color> {
        let mut pixels = vec![WHITE; width * height];
        let across = self.width.min(width);
        for row in 0..self.height.min(height) {
            let from = &self.pixels[row * self.width..][..across];
            pixels[row * width..][..across].copy_from_slice(from);
        }
        pixels
    }

    /// Lays `color` over a pixel with opacity 0…1; pixels outside are ignored.
    pub fn blend(&mut self, x: i64, y: i64, color: Color, opacity: f64) {
        if x < 0 || y < 0 || x >= self.width as i64 || y >= self.height as i64 {
            return;
        }
        let pixel = &mut self.pixels[y as usize * self.width + x as usize];
        if opacity == 1.0 {
            *pixel = color;
            return;
        }
        for (p, c) in pixel.iter_mut().zip(color) {
            *p = (f64::from(*p) + (f64::from(c) - f64::from(*p)) * opacity).round() as u8;
        }
    }

    pub fn rectangle(&mut self, x: f64, y: f64, width: f64, height: f64, color: Color) {
        for row in y.round() as i64..(y + height).round() as i64 {
            for column in x.round() as i64..(x + width).round() as i64 {
                self.blend(column, row, color, 1.0);
            }
        }
    }

    /// A straight line with round ends, smooth edges. A line that is not finite is not drawn.
    pub fn line(&mut self, from: [f64; 2], to: [f64; 2], width: f64, color: Color) {
        if !from.iter().chain(&to).all(|c| c.is_finite()) {
            return;
        }
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        let square = dx * dx + dy * dy;
        let reach = 0.5 * width + 1.0;
        let range = |a: f64, b: f64, end: usize| {
            let low = (a.min(b) - reach).floor().max(0.0);
            low as i64..=(a.max(b) + reach).ceil().min(end as f64) as i64
        };
        for y in range(from[1], to[1], self.height) {
            for x in range(from[0], to[0], self.width) {
                let (px, py) = (x as f64 + 0.5 - from[0], y as f64 + 0.5 - from[1]);
                let along = if square > 0.0 {
                    ((px * dx + py * dy) / square).clamp(0.0, 1.0)
                } else {
                    0.0
                };
                let distance = libm::hypot(px - along * dx, py - along * dy);
                self.blend(x, y, color, (0.5 * width + 0.5 - distance).clamp(0.0, 1.0));
            }
        }
    }

    /// One line of text, `y` its upper edge.
    pub fn text(&mut self, x: f64, y: f64, text: &str, font: Font, align: Align, color: Color) {
        let (size, weight) = font.style();
        // the base line lies an ascender below the upper edge
        self.write(
            [x, y + 0.93 * size],
            text,
            (size, weight),
            align,
            false,
            color,
        );
    }

    /// One line of text, `at` on its base line; upright: from below upwards.
    pub fn write(
        &mut self,
        at: [f64; 2],
        text: &str,
        (size, weight): (f64, Weight),
        align: Align,
        upright: bool,
        color: Color,
    ) {
        let start = match align {
            Align::Left => 0.0,
            Align::Center => -0.5 * font::width(text, size, weight),
            Align::Right => -font::width(text, size, weight),
        };
        let [x, y] = at.map(|c| c.round() as i64);
        let start = start.round() as i64;
        font::pixels(text, size, weight, |along, down, opacity| {
            let along = start + along;
            let (dx, dy) = match upright {
                true => (down, -along),
                false => (along, down),
            };
            self.blend(x + dx, y + dy, color, opacity);
        });
    }

    /// Writes the image as PNG (8-bit RGB).
    pub fn write_png<W: Write>(&self, w: W) -> io::Result<()> {
        let mut encoder = png::Encoder::new(w, self.width as u32, self.height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let mut writer = encoder.write_header().map_err(io_error)?;
        // row after row: no second copy of the pixels
        let mut rows = writer.stream_writer().map_err(io_error)?;
        rows.write_all(self.pixels.as_flattened())?;
        rows.finish().map_err(io_error)?;
        writer.finish().map_err(io_error)
    }
}

fn io_error(error: png::EncodingError) -> io::Error {
    match error {
        png::EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn png_decodes_to_the_same_pixels() {
        let mut image = Image::new(7, 5);
        image.rectangle(2.0, 1.0, 3.0, 2.0, [10, 20, 30]);
        let mut file = Vec::new();
        image.write_png(&mut file).unwrap();
        let mut reader = png::Decoder::new(io::Cursor::new(file))
            .read_info()
            .unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut bytes).unwrap();
        assert_eq!(
            (info.width, info.height, info.color_type),
            (7, 5, png::ColorType::Rgb)
        );
        let at = |x: usize, y: usize| &bytes[3 * (7 * y + x)..][..3];
        assert_eq!(at(2, 1), [10, 20, 30]);
        assert_eq!(at(4, 2), [10, 20, 30]);
        assert_eq!(at(5, 2), WHITE);
        assert_eq!(at(2, 3), WHITE);
    }

    #[test]
    fn a_line_covers_its_width_and_stays_in_the_image() {
        let mut image = Image::new(20, 11);
        image.line([-5.0, 5.5], [50.0, 5.5], 3.0, [0; 3]);
        let column: Vec<u8> = (0..11).map(|y| image.pixels[20 * y + 10][0]).collect();
        assert_eq!(column, [255, 255, 255, 255, 0, 0, 0, 255, 255, 255, 255]);
        let before = image.clone();
        image.line([f64::NAN, 0.0], [1.0, 1.0], 3.0, [0; 3]);
        assert_eq!(image, before);
    }

    #[test]
    fn text_stands_where_it_is_put() {
        let mut image = Image::new(200, 40);
        image.text(190.0, 5.0, "µ–Åσ", Font::Normal, Align::Right, [0; 3]);
        let inked = |x: usize| (0..40).any(|y| image.pixels[200 * y + x] != WHITE);
        let width = Font::Normal.width("µ–Åσ") as usize;
        assert!((190 - width..190).filter(|&x| inked(x)).count() > width / 2);
        assert!((0..188 - width).chain(191..200).all(|x| !inked(x)));
        // the ring of Å rises a pixel above the upper edge, and nothing is taller than the size
        let row = |y: usize| (0..200).any(|x| image.pixels[200 * y + x] != WHITE);
        assert!((0..4).chain(34..40).all(|y| !row(y)));
    }
}
