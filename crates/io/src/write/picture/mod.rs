//! A PNG of the damage: a body from above and cut open, a plate, or a chain as curves.
//!
//! Files: `body` lays out the views of 2-D and 3-D bodies, `view` draws one of them, `chain` plots 1-D; `image` is
//! what they draw on.

mod body;
mod chain;
pub mod colormap;
pub mod image;
pub(super) mod label;
mod view;

use std::path::Path;

use peridyne::observe::Snapshot;

use self::image::{Align, Font, GREY, INK, Image};
use super::atomic::{WriteError, write_file};
use super::fields::fields;

/// Blank border (pixels).
const MARGIN: f64 = 56.0;
/// Height of title and subtitle (pixels).
const HEAD: f64 = 132.0;
/// Height of scale bar and colour bar (pixels).
const FOOT: f64 = 96.0;

/// What a picture says beside the damage.
#[derive(Debug, Clone, PartialEq)]
pub struct PictureOptions {
    pub title: String,
    /// Units of length and time; "m" and "s" get SI prefixes, "" is none.
    pub length_unit: String,
    pub time_unit: String,
    /// Width (pixels), 800 to 8192; the height follows from the body.
    pub width: usize,
}

impl Default for PictureOptions {
    fn default() -> Self {
        PictureOptions {
            title: String::new(),
            length_unit: String::new(),
            time_unit: String::new(),
            width: 1600,
        }
    }
}

/// Draws the damage of a snapshot; positions that are not finite are left out.
///
/// # Errors
/// `InvalidInput` for arrays of unequal lengths, or without damage.
pub fn damage(s: &Snapshot, options: &PictureOptions) -> std::io::Result<Image> {
    fields(s)?;
    if s.damage().len() != s.reference.len() {
        return Err(super::fields::invalid(
            "the snapshot carries no damage".to_string(),
        ));
    }
    // narrower than this, title and bars would overlap
    let options = PictureOptions {
        width: options.width.clamp(800, 8192),
        ..options.clone()
    };
    Ok(if s.dimension == 1 {
        chain::draw(s, &options)
    } else {
        body::draw(s, &options)
    })
}

/// Draws and writes `path`, all or nothing.
pub fn write(path: &Path, s: &Snapshot, options: &PictureOptions) -> Result<(), WriteError> {
    let image = damage(s, options).map_err(WriteError::at("draw", path))?;
    write_file(path, |w| image.write_png(w))
}

/// Title, and what and when this is.
fn head(image: &mut Image, s: &Snapshot, options: &PictureOptions) {
    let room = ((image.width as f64 - 2.0 * MARGIN) / Font::Title.width("x")) as usize;
    let mut title = options.title.clone();
    if title.chars().count() > room {
        title = title
            .chars()
            .take(room.saturating_sub(3))
            .chain("...".chars())
            .collect();
    }
    let mut y = 40.0;
    if !title.is_empty() {
        image.text(MARGIN, y, &title, Font::Title, Align::Left, INK);
        y += 42.0;
    }
    let time = label::quantity(s.time, &options.time_unit);
    let (step, points) = (label::count(s.step), label::count(s.reference.len() as u64));
    let subtitle = format!("step {step}  ·  t = {time}  ·  {points} points");
    image.text(MARGIN, y, &subtitle, Font::Small, Align::Left, GREY);
}

#[cfg(test)]
mod tests;
