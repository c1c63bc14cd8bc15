//! Images one after another, as an animated PNG or GIF.

use std::io::{self, Write};

use super::super::fields::invalid;
use super::image::Image;

/// What a film is written as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FilmFormat {
    /// An animated PNG: all colours; browsers play it.
    Png,
    /// Of at most 256 colours a frame; everything plays it.
    Gif,
}

impl FilmFormat {
    /// How names of its files end.
    pub fn ending(self) -> &'static str {
        match self {
            FilmFormat::Png => "png",
            FilmFormat::Gif => "gif",
        }
    }
}

/// Time of a frame (ms).
const DELAY: u16 = 80;

/// A film of so many images; all get the size of the first.
///
/// # Errors
/// The operating system's, those of the images; there is none.
pub fn animate<W: Write>(
    w: W,
    format: FilmFormat,
    count: usize,
    images: impl Iterator<Item = io::Result<Image>>,
) -> io::Result<()> {
    let mut images = images.peekable();
    let size = match images.peek() {
        Some(Ok(first)) => (first.width, first.height),
        // told below
        Some(Err(_)) => (1, 1),
        None => return Err(invalid("a film has frames".into())),
    };
    let frames = images.map(|image| Ok(image?.of_size(size).as_flattened().to_vec()));
    match format {
        FilmFormat::Png => animated_png(w, size, count, frames),
        FilmFormat::Gif => animated_gif(w, size, frames),
    }
}

/// Of 1, the best choice of colours, to 30, the quickest.
const PALETTE_SPEED: i32 = 10;

/// Frames as RGB.
fn animated_gif<W: Write>(
    w: W,
    (width, height): (usize, usize),
    frames: impl Iterator<Item = io::Result<Vec<u8>>>,
) -> io::Result<()> {
    let side = |n: usize| {
        u16::try_from(n).map_err(|_| invalid("a GIF has at most 65535 pixels a side".into()))
    };
    let (width, height) = (side(width)?, side(height)?);
    let mut writer = gif::Encoder::new(w, width, height, &[]).map_err(io::Error::other)?;
    writer
        .set_repeat(gif::Repeat::Infinite)
        .map_err(io::Error::other)?;
    for pixels in frames {
        let mut frame = gif::Frame::from_rgb_speed(width, height, &pixels?, PALETTE_SPEED);
        frame.delay = DELAY / 10;
        writer.write_frame(&frame).map_err(io::Error::other)?;
    }
    writer.into_inner().map_err(io::Error::other)?.flush()
}

/// Frames as RGB.
fn animated_png<W: Write>(
    w: W,
    (width, height): (usize, usize),
    count: usize,
    frames: impl Iterator<Item = io::Result<Vec<u8>>>,
) -> io::Result<()> {
    let mut encoder = png::Encoder::new(w, width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder
        .set_animated(count as u32, 0)
        .map_err(io::Error::other)?;
    encoder
        .set_frame_delay(DELAY, 1000)
        .map_err(io::Error::other)?;
    let mut writer = encoder.write_header().map_err(io::Error::other)?;
    for pixels in frames {
        writer
            .write_image_data(&pixels?)
            .map_err(io::Error::other)?;
    }
    writer.finish().map_err(io::Error::other)
}
