//! Pictures of 1-D bodies: displacement, and what is shown, along x.

use peridyne::observe::Snapshot;

use super::image::{Align, Color, Font, GREY, INK, Image};
use super::shown::Shown;
use super::{HEAD, MARGIN, PictureOptions, head, label};

/// Height of one plot, of its name above it, of the room between and below them, and width of the numbers at the left (pixels).
const PLOT: f64 = 300.0;
const NAME: f64 = 34.0;
const BETWEEN: f64 = 64.0;
const BELOW: f64 = 96.0;
const NUMBERS: f64 = 110.0;
const GRID: Color = [228, 230, 234];
const CURVE: Color = [42, 92, 150];

/// Where a plot stands, and what its edges mean.
struct Axes {
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
    x: [f64; 2],
    y: [f64; 2],
}

impl Axes {
    fn place(&self, x: f64, y: f64) -> [f64; 2] {
        let part = |v: f64, [low, high]: [f64; 2]| (v - low) / (high - low);
        [
            self.left + part(x, self.x) * (self.right - self.left),
            self.bottom - part(y, self.y) * (self.bottom - self.top),
        ]
    }
}

/// Where the curves of a line are: reference positions, displacements and values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits([[f64; 2]; 3]);

impl Limits {
    /// Of one frame.
    pub fn of(s: &Snapshot, what: &Shown) -> Limits {
        let Curves { x, u, values } = Curves::of(s, what);
        Limits([&x, &u, &values].map(|all| ends(all)))
    }

    /// Around both.
    pub fn with(self, other: &Limits) -> Limits {
        Limits(std::array::from_fn(|k| {
            let ([a, b], [c, d]) = (self.0[k], other.0[k]);
            [a.min(c), b.max(d)]
        }))
    }
}

/// What is drawn, in the order along the line.
struct Curves {
    x: Vec<f64>,
    u: Vec<f64>,
    values: Vec<f64>,
}

impl Curves {
    fn of(s: &Snapshot, what: &Shown) -> Curves {
        let mut order: Vec<usize> = (0..s.reference.len())
            .filter(|&i| s.reference[i][0].is_finite() && s.displacement()[i][0].is_finite())
            .collect();
        order.sort_by(|&a, &b| s.reference[a][0].total_cmp(&s.reference[b][0]));
        Curves {
            x: order.iter().map(|&i| s.reference[i][0]).collect(),
            u: order.iter().map(|&i| s.displacement()[i][0]).collect(),
            values: order.iter().map(|&i| what.values[i]).collect(),
        }
    }
}

pub fn draw(s: &Snapshot, what: &Shown, limits: &Limits, options: &PictureOptions) -> Image {
    // displacements are shown anyhow
    let plots = if what.name.starts_with("displacement") {
        1
    } else {
        2
    };
    let room = plots as f64 * PLOT + (plots - 1) as f64 * BETWEEN;
    let mut image = Image::new(options.width, (HEAD + NAME + room + BELOW) as usize);
    head(&mut image, s, 1.0, options);
    let Curves { x, u, values } = Curves::of(s, what);
    let tints: Vec<Color> = { values.iter() }
        .map(|v| what.map.color(what.part(*v)))
        .collect();

    let unit = options.length_unit.as_str();
    let [across, moved, shown] = limits.0.map(range);
    let at = |top: f64, y: [f64; 2]| Axes {
        left: MARGIN + NUMBERS,
        right: image.width as f64 - MARGIN,
        top,
        bottom: top + PLOT,
        x: across,
        y,
    };
    let upper = at(HEAD + NAME, moved);
    let lower = match what.name.as_str() {
        "damage" => at(HEAD + NAME + PLOT + BETWEEN, [-0.04, 1.04]),
        _ => at(HEAD + NAME + PLOT + BETWEEN, shown),
    };
    grid(&mut image, &upper, "displacement", unit);
    if plots == 1 {
        numbers_below(&mut image, &upper, unit);
        curve(&mut image, &upper, &x, &u, &tints, s.spacing);
        return image;
    }
    grid(
        &mut image,
        &lower,
        &what.name,
        &options.units.unit(what.dimension),
    );
    numbers_below(&mut image, &lower, unit);
    curve(&mut image, &upper, &x, &u, &tints, s.spacing);
    curve(&mut image, &lower, &x, &values, &tints, s.spacing);
    image
}

/// Lowest and highest finite one.
fn ends(values: &[f64]) -> [f64; 2] {
    let finite = values.iter().copied().filter(|v| v.is_finite());
    finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| {
        [low.min(v), high.max(v)]
    })
}

/// An interval with a little room; of some width even if all values are equal.
fn range([low, high]: [f64; 2]) -> [f64; 2] {
    if low > high {
        return [0.0, 1.0];
    }
    // a difference below round-off of the values is none
    let width = high - low;
    let room = if width > 1e-12 * low.abs().max(high.abs()) {
        0.04 * width
    } else {
        low.abs().max(1e-300)
    };
    [low - room, high + room]
}

/// Four to nine round numbers inside an interval.
fn ticks([low, high]: [f64; 2]) -> Vec<f64> {
    let step = label::round_down((high - low) / 4.0);
    let first = (low / step).ceil() as i64;
    (first..)
        .map(|i| i as f64 * step)
        .take_while(|t| *t <= high)
        .take(12)
        .collect()
}

/// Horizontal grid lines with numbers at the left and the name of the curve above.
fn grid(image: &mut Image, axes: &Axes, name: &str, unit: &str) {
    let marks = ticks(axes.y);
    let (factor, prefix) = label::prefix(axes.y[0].abs().max(axes.y[1].abs()), unit);
    for y in marks {
        let at = axes.place(axes.x[0], y)[1];
        image.line([axes.left, at], [axes.right, at], 1.5, GRID);
        let text = label::number(y / factor);
        image.text(
            axes.left - 14.0,
            at - 10.0,
            &text,
            Font::Small,
            Align::Right,
            GREY,
        );
    }
    let name = if unit.is_empty() {
        name.to_string()
    } else {
        format!("{name} ({prefix}{unit})")
    };
    image.text(
        axes.left,
        axes.top - NAME,
        &name,
        Font::Normal,
        Align::Left,
        INK,
    );
}

fn numbers_below(image: &mut Image, axes: &Axes, unit: &str) {
    let (factor, prefix) = label::prefix(axes.x[0].abs().max(axes.x[1].abs()), unit);
    image.line(
        [axes.left, axes.bottom],
        [axes.right, axes.bottom],
        2.0,
        INK,
    );
    for x in ticks(axes.x) {
        let at = axes.place(x, axes.y[0])[0];
        image.line([at, axes.bottom], [at, axes.bottom + 8.0], 2.0, INK);
        let text = label::number(x / factor);
        image.text(
            at,
            axes.bottom + 14.0,
            &text,
            Font::Small,
            Align::Center,
            GREY,
        );
    }
    let name = if unit.is_empty() {
        "x".to_string()
    } else {
        format!("x ({prefix}{unit})")
    };
    let middle = 0.5 * (axes.left + axes.right);
    image.text(
        middle,
        axes.bottom + 44.0,
        &name,
        Font::Normal,
        Align::Center,
        INK,
    );
}

/// A curve, interrupted where neighbours are farther apart than points are; points in their colours
/// where there is room for them.
fn curve(image: &mut Image, axes: &Axes, x: &[f64], y: &[f64], tints: &[Color], spacing: f64) {
    for (x, y) in x.windows(2).zip(y.windows(2)) {
        if spacing <= 0.0 || x[1] - x[0] < 3.0 * spacing {
            image.line(axes.place(x[0], y[0]), axes.place(x[1], y[1]), 2.5, CURVE);
        }
    }
    let room = (axes.right - axes.left) / x.len().max(1) as f64;
    if room >= 5.0 {
        for ((x, y), tint) in x.iter().zip(y).zip(tints) {
            let at = axes.place(*x, *y);
            image.line(at, at, room.min(9.0), *tint);
        }
    }
}
