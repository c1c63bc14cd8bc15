//! A PNG of a field: a body from above and cut open, a plate, or a chain as curves; and films of them.
//!
//! Files: `shown` says which numbers, `body` lays out the views of 2-D and 3-D bodies, `view` draws one of them, its points as `cells`,
//! `rigid` is what rigid bodies look like and `solid` draws them, `marks` and `arrows` are drawn over it, `foot` below; `chain` plots 1-D;
//! `image` is what they draw on; `film` keeps frames.

pub mod animate;
pub mod arrows;
mod body;
mod camera;
mod cells;
mod chain;
pub mod colormap;
mod extent;
pub mod film;
mod foot;
pub mod image;
pub(super) mod label;
pub mod marks;
pub mod rigid;
pub mod shown;
mod sizes;
mod solid;
mod view;

use std::path::Path;

use peridyne::observe::Snapshot;

use self::animate::FilmFormat;
use self::arrows::Arrows;
use self::image::{Align, Font, GREY, INK, Image};
use self::marks::Marks;
use self::rigid::Placed;
use self::shown::{About, Shown};
use super::atomic::{WriteError, write_file};
use super::fields::{fields, invalid};
use crate::deck::UnitSystem;

/// Blank border (pixels).
const MARGIN: f64 = 56.0;
/// Height of title and subtitle (pixels).
const HEAD: f64 = 132.0;
/// Height of scale bar and colour bar (pixels).
const FOOT: f64 = 96.0;

/// What a picture shows, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct PictureOptions {
    pub title: String,
    /// Units of length and time; "m" and "s" get SI prefixes, "" is none.
    pub length_unit: String,
    pub time_unit: String,
    /// In which the numbers of fields are.
    pub units: UnitSystem,
    /// Width (pixels), 800 to 8192; the height follows from the body.
    pub width: usize,
    /// `None`: what the run is [about](About).
    pub field: Option<String>,
    /// `x`, `xy`, …; magnitudes by default.
    pub component: Option<String>,
    /// Displacements are drawn so many times as large; chosen by default.
    pub scale: Option<f64>,
    /// What the ends of the colours mean, in computed numbers; those of the values by default.
    pub range: Option<[f64; 2]>,
    /// A vector field that is drawn as arrows, too.
    pub arrows: Option<String>,
    /// All frames as a film, too.
    pub film: Option<FilmFormat>,
    /// Without step and time: an equilibrium has none.
    pub still: bool,
    pub marks: Marks,
}

impl Default for PictureOptions {
    fn default() -> Self {
        PictureOptions {
            title: String::new(),
            length_unit: String::new(),
            time_unit: String::new(),
            units: UnitSystem::None,
            width: 1600,
            field: None,
            component: None,
            scale: None,
            range: None,
            arrows: None,
            film: None,
            still: false,
            marks: Marks::default(),
        }
    }
}

/// The largest displacement is drawn as this part of the body, where displacements are magnified.
const SEEN: f64 = 0.05;

impl PictureOptions {
    /// The field that is shown.
    pub fn field(&self, about: About) -> &str {
        self.field.as_deref().unwrap_or(about.field())
    }

    /// `stress_yy`: the name of its files.
    pub fn stem(&self, about: About) -> String {
        match &self.component {
            None => self.field(about).to_string(),
            Some(part) => format!("{}_{part}", self.field(about)),
        }
    }

    /// For a mode of vibration: shapes have no size of their own.
    pub fn of_shape(&self, s: &Snapshot, title: String) -> PictureOptions {
        let seen = PictureOptions {
            title,
            field: Some("displacement".into()),
            component: None,
            scale: None,
            range: None,
            arrows: None,
            film: None,
            still: true,
            marks: Marks::default(),
            ..self.clone()
        };
        let scale = Some(seen.magnification(s));
        PictureOptions { scale, ..seen }
    }

    /// By how much displacements are seen well.
    fn magnification(&self, s: &Snapshot) -> f64 {
        let long = extent::longest(&extent::bounds(s));
        let finite = |x: &&[f64; 3]| x.iter().all(|c| c.is_finite());
        let all = s.displacement().iter().filter(finite).flatten();
        let most = all.fold(0.0, |m: f64, c| m.max(c.abs()));
        match most > 0.0 && long > 0.0 {
            true => label::round_down(SEEN * long / most),
            false => 1.0,
        }
    }

    /// How many times as large displacements are drawn.
    pub(super) fn scale_of(&self, s: &Snapshot, about: About) -> f64 {
        match (self.scale, about.magnified()) {
            (Some(scale), _) => scale,
            // what is large enough is drawn as it is
            (None, true) => self.magnification(s).max(1.0),
            (None, false) => 1.0,
        }
    }
}

/// Draws a field of a snapshot and the rigid bodies beside it; positions that are not finite are left out.
///
/// # Errors
/// `InvalidInput` for arrays of unequal lengths, or without the field.
pub fn picture(
    s: &Snapshot,
    bodies: &[Placed],
    options: &PictureOptions,
    about: About,
) -> std::io::Result<Image> {
    fields(s)?;
    let shown = Shown::of(s, options.field(about), options.component.as_deref())?;
    let shown = match options.range {
        Some(range) => shown.between(range),
        None => shown,
    };
    let arrows = options.arrows.as_deref();
    let arrows = arrows.map(|field| Arrows::of(s, field)).transpose()?;
    let scale = options.scale_of(s, about);
    let sight = Sight::of(s, bodies, &shown, scale);
    Ok(draw(s, bodies, (&shown, arrows.as_ref()), &sight, options))
}

/// What does not change from frame to frame.
pub(super) struct Sight {
    /// Displacements are drawn so many times as large.
    scale: f64,
    of: Seen,
}

enum Seen {
    Line(chain::Limits),
    Body(body::Sight),
}

impl Sight {
    /// Of one frame.
    fn of(s: &Snapshot, bodies: &[Placed], shown: &Shown, scale: f64) -> Sight {
        let of = match s.dimension {
            1 => Seen::Line(chain::Limits::of(s, shown)),
            _ => Seen::Body(body::Sight::of(s, bodies, scale)),
        };
        Sight { scale, of }
    }

    /// What shows both.
    fn with(self, other: &Sight) -> Sight {
        let of = match (self.of, &other.of) {
            (Seen::Line(own), Seen::Line(other)) => Seen::Line(own.with(other)),
            (Seen::Body(own), Seen::Body(other)) => Seen::Body(own.with(other)),
            (own, _) => own,
        };
        Sight { of, ..self }
    }
}

fn draw(
    s: &Snapshot,
    bodies: &[Placed],
    what: (&Shown, Option<&Arrows>),
    sight: &Sight,
    options: &PictureOptions,
) -> Image {
    // narrower than this, title and bars would overlap
    let options = PictureOptions {
        width: options.width.clamp(800, 8192),
        ..options.clone()
    };
    match &sight.of {
        Seen::Line(limits) => chain::draw(s, what.0, limits, &options),
        Seen::Body(seen) => body::draw(s, bodies, what, sight.scale, seen, &options),
    }
}

/// Draws and writes `path`, all or nothing.
///
/// # Errors
/// It cannot be drawn or written.
pub fn write(
    path: &Path,
    s: &Snapshot,
    bodies: &[Placed],
    options: &PictureOptions,
    about: About,
) -> Result<(), WriteError> {
    let image = picture(s, bodies, options, about).map_err(WriteError::at("draw", path))?;
    write_file(path, |w| image.write_png(w))
}

/// Title, and what and when this is.
fn head(image: &mut Image, s: &Snapshot, scale: f64, options: &PictureOptions) {
    let room = image.width as f64 - 2.0 * MARGIN;
    let mut title = options.title.clone();
    while Font::Title.width(&title) > room {
        title = title
            .chars()
            .take(title.chars().count().saturating_sub(2))
            .chain(['…'])
            .collect();
    }
    let mut y = 40.0;
    if !title.is_empty() {
        image.text(MARGIN, y, &title, Font::Title, Align::Left, INK);
        y += 42.0;
    }
    let time = label::quantity(s.time, &options.time_unit);
    let (step, points) = (label::count(s.step), label::count(s.reference.len() as u64));
    let when = match options.still {
        true => String::new(),
        false => format!("step {step}  ·  t = {time}  ·  "),
    };
    let magnified = match scale == 1.0 {
        true => String::new(),
        false => format!("  ·  displacements × {}", label::number(scale)),
    };
    let subtitle = format!("{when}{points} points{magnified}");
    image.text(MARGIN, y, &subtitle, Font::Small, Align::Left, GREY);
}

#[cfg(test)]
mod tests;
