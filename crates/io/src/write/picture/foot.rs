//! What stands below a picture: how long a length is, and what the colours mean.

use super::colormap::Map;
use super::image::{Align, Font, GREY, INK, Image};
use super::shown::Shown;
use super::{MARGIN, PictureOptions, label};

/// Length of the colour bar, and room beside it (pixels).
const BAR: f64 = 320.0;
const GAP: f64 = 48.0;

/// Scale bar to the left, colour bar to the right, what is missing between them.
pub fn draw(
    image: &mut Image,
    (scale, below): (f64, f64),
    outside: usize,
    what: &Shown,
    options: &PictureOptions,
) {
    let right = image.width as f64 - MARGIN;
    let y = image.height as f64 - below - 52.0;
    let length = label::round_down(0.16 * image.width as f64 / scale);
    let pixels = length * scale;
    for (dx, dy, w, h) in [
        (0.0, 6.0, pixels, 3.0),
        (0.0, 0.0, 3.0, 15.0),
        (pixels - 3.0, 0.0, 3.0, 15.0),
    ] {
        image.rectangle(MARGIN + dx, y + dy, w, h, INK);
    }
    let text = label::quantity(length, &options.length_unit);
    image.text(
        MARGIN + pixels + 14.0,
        y - 5.0,
        &text,
        Font::Normal,
        Align::Left,
        INK,
    );

    let [low, high] = what.range.map(|v| options.units.show(v, what.dimension));
    let bar = BAR;
    let start = right - bar - Font::Normal.width(&high) - 14.0;
    // a long name stands above its bar
    let beside = format!("{}  {low}", what.name);
    let left = MARGIN + pixels + 14.0 + Font::Normal.width(&text) + GAP;
    let fits = start - 14.0 - Font::Normal.width(&beside) > left;
    if !fits {
        image.text(
            start + 0.5 * bar,
            y - 32.0,
            &what.name,
            Font::Normal,
            Align::Center,
            INK,
        );
    }
    for i in 0..bar as usize {
        let [low, high] = what.range;
        let value = low + (high - low) * (i as f64 + 0.5) / bar;
        let tint = what.map.color(what.part(value));
        image.rectangle(start + i as f64, y - 2.0, 1.0, 18.0, tint);
    }
    if what.map == Map::Diverging {
        let [low, high] = what.range;
        let zero = start + bar * -low / (high - low);
        image.rectangle(zero - 1.0, y - 2.0, 2.0, 23.0, INK);
        image.text(zero, y + 22.0, "0", Font::Small, Align::Center, INK);
    }
    image.text(
        start - 14.0,
        y - 5.0,
        if fits { &beside } else { &low },
        Font::Normal,
        Align::Right,
        INK,
    );
    image.text(right, y - 5.0, &high, Font::Normal, Align::Right, INK);
    if outside > 0 {
        let noun = if outside == 1 { "point" } else { "points" };
        let text = format!("{} {noun} outside", label::count(outside as u64));
        image.text(
            MARGIN + pixels + 14.0,
            y + 22.0,
            &text,
            Font::Small,
            Align::Left,
            GREY,
        );
    }
}
