//! Pictures of plates and solids: layout, frame, scale bar and colour bar.

use peridyne::observe::Snapshot;
use peridyne::space::AXES;

use super::arrows::Arrows;
use super::extent::{REACH, bounds, longest, moved, strays};
use super::image::{Align, Font, GREY, INK, Image};
use super::marks;
use super::shown::Shown;
use super::sizes;
use super::view::{Camera, Frame, cross, draw as draw_view};
use super::{FOOT, HEAD, MARGIN, PictureOptions, head, label};

/// Elevation of the viewer of the section (degrees): low enough to see the cut, high enough to see the top.
const ELEVATION: f64 = 30.0;
/// Cubes of magnified bodies are larger by this.
const MAGNIFIED: f64 = 1.25;
/// Room between and below the views (pixels).
const GAP: f64 = 48.0;
/// Height of the key of arrows, length of the colour bar (pixels).
const KEY: f64 = 44.0;
const BAR: f64 = 320.0;
const CAPTION: f64 = 40.0;
/// A view is not drawn higher than this part of the picture's width.
const TALLEST: f64 = 0.75;
/// Views go below each other when that makes them larger by this factor.
const WORTH_STACKING: f64 = 1.6;

/// Keeps the points whose reference coordinate along `axis` is at or behind `at` in the direction `sign` (±1).
#[derive(Debug, Clone, Copy)]
struct Cut {
    axis: usize,
    at: f64,
    sign: f64,
}

impl Cut {
    fn keeps(&self, reference: &[f64; 3]) -> bool {
        self.sign * reference[self.axis] >= self.sign * self.at
    }
}

/// One view: camera, what it shows, and its frame.
struct Panel {
    camera: Camera,
    frame: Frame,
    caption: String,
    cut: Option<Cut>,
}

pub fn draw(
    s: &Snapshot,
    (what, arrows): (&Shown, Option<&Arrows>),
    scale: f64,
    options: &PictureOptions,
) -> Image {
    let bounds = bounds(s);
    let guesses = [s.spacing, longest(&bounds) / 100.0, 1.0];
    // where displacements are magnified, strains are, too, and points must not come apart
    let wide = if scale > 1.0 { MAGNIFIED } else { 1.0 };
    let spacing = wide * guesses.into_iter().find(|l| *l > 0.0).unwrap_or(1.0);
    let near = |x: &[f64; 3]| {
        let reach = REACH * longest(&bounds) + spacing;
        (0..3).all(|a| x[a] >= bounds[a][0] - reach && x[a] <= bounds[a][1] + reach)
    };
    // cubes in space hide what is behind gaps anyway, and overlap badly
    let edges = match s.dimension {
        2 => sizes::edges(&s.reference, s.spacing),
        _ => None,
    };
    let size = |i: usize| edges.as_ref().map_or(1.0, |e| e[i] / s.spacing);
    let shown = |cut: Option<Cut>| {
        let all = moved(s, scale).zip(&s.reference).zip(&what.values);
        let points = all.enumerate().filter(move |(_, ((x, reference), _))| {
            near(x) && cut.is_none_or(|cut| cut.keeps(reference))
        });
        points.map(|(i, ((x, _), value))| (x, what.part(*value), size(i)))
    };
    // bodies beside a plate belong into its picture, as far as it reaches
    let beside: Vec<[f64; 3]> = match s.dimension {
        2 => (options.marks.rigid_places(s.time).into_iter())
            .map(|x| {
                let reach = REACH * longest(&bounds);
                std::array::from_fn(|a| x[a].clamp(bounds[a][0] - reach, bounds[a][1] + reach))
            })
            .collect(),
        _ => vec![],
    };
    let strays = strays(s);
    let panels: Vec<Panel> = cameras(s, &bounds)
        .into_iter()
        .filter_map(|(camera, caption, cut)| {
            let all = moved(s, scale).zip(&s.reference).zip(&strays);
            let points = all.filter(|((x, reference), stray)| {
                !**stray && near(x) && cut.is_none_or(|cut| cut.keeps(reference))
            });
            let points = points.map(|((x, _), _)| x);
            let frame = Frame::around(&camera, points.chain(beside.iter().copied()), spacing)?;
            Some(Panel {
                camera,
                frame,
                caption,
                cut,
            })
        })
        .collect();

    let width = options.width as f64;
    let placed = place(&panels, width - 2.0 * MARGIN, TALLEST * width);
    let key = if arrows.is_some() { KEY } else { 0.0 };
    let height = HEAD + placed.height + FOOT + key;
    let mut image = Image::new(options.width, height.ceil() as usize);
    head(&mut image, s, scale, options);
    for ((panel, corner), caption) in panels.iter().zip(&placed.corners).zip(&placed.captions) {
        let corner = [MARGIN + corner[0], HEAD + corner[1]];
        draw_view(
            &mut image,
            (corner, placed.scale),
            &panel.camera,
            &panel.frame,
            spacing,
            what.map,
            shown(panel.cut),
        );
        let view = marks::View {
            corner,
            step: spacing,
            scale: placed.scale,
            camera: &panel.camera,
            frame: &panel.frame,
            flat: s.dimension == 2,
        };
        if let Some(arrows) = arrows {
            let seen = moved(s, scale).zip(&s.reference).enumerate();
            let seen = seen.filter(|(_, (x, reference))| {
                near(x) && panel.cut.is_none_or(|cut| cut.keeps(reference))
            });
            arrows.draw(&mut image, &view, seen.map(|(i, (x, _))| (i, x)));
        }
        marks::draw(&mut image, &view, &options.marks, s.time);
        let middle = corner[0] + 0.5 * panel.frame.size()[0] * placed.scale;
        image.text(
            middle,
            HEAD + caption,
            &panel.caption,
            Font::Small,
            Align::Center,
            GREY,
        );
    }
    let outside = s.reference.len() - shown(None).count();
    foot(&mut image, (placed.scale, key), outside, what, options);
    if let Some(arrows) = arrows {
        let at = [MARGIN, image.height as f64 - 0.62 * KEY];
        arrows.key(&mut image, at, options.units);
    }
    image
}

/// The cameras of a body with captions and cuts: a plate as it lies; a solid from above, along its thinnest
/// axis, and cut open through the middle along its longest and thinnest axes.
fn cameras(s: &Snapshot, bounds: &[[f64; 2]; 3]) -> Vec<(Camera, String, Option<Cut>)> {
    let unit = |axis: usize| std::array::from_fn(|a| f64::from(u8::from(a == axis)));
    let straight = std::f64::consts::FRAC_PI_2;
    if s.dimension == 2 {
        return vec![(Camera::new(unit(0), unit(2), straight), String::new(), None)];
    }
    let extent = bounds.map(|[low, high]| high - low);
    // equal extents differ by round-off and half cells: prefer z up and x to the right
    let tie = 1.02;
    let thin = [2, 1, 0].into_iter().reduce(|best, a| {
        if extent[a] * tie < extent[best] {
            a
        } else {
            best
        }
    });
    let thin = thin.unwrap_or(2);
    let long = (0..3).filter(|&a| a != thin);
    let long = long
        .reduce(|best, a| {
            if extent[a] > tie * extent[best] {
                a
            } else {
                best
            }
        })
        .unwrap_or(0);
    let deep = 3 - thin - long;
    let (right, top) = (unit(long), unit(thin));
    // the half behind the cut stays
    let sign = cross(top, right)[deep];
    let middle = 0.5 * (bounds[deep][0] + bounds[deep][1]);
    // a plane of points in the middle belongs to the half, whatever the round-off
    let cut = Some(Cut {
        axis: deep,
        at: middle - sign * 1e-6 * extent[deep],
        sign,
    });
    let [t, l] = [thin, long].map(|a| AXES[a]);
    vec![
        (
            Camera::new(right, top, straight),
            format!("from above, along -{t}"),
            None,
        ),
        (
            Camera::new(right, top, ELEVATION.to_radians()),
            format!("cut open along {l} and {t}"),
            cut,
        ),
    ]
}

/// Scale (pixels per length), upper left corners of the views and upper edges of their captions, and height of
/// them all (pixels).
struct Placement {
    scale: f64,
    corners: Vec<[f64; 2]>,
    captions: Vec<f64>,
    height: f64,
}

/// Places views side by side, or below each other where that shows them much larger, all at one scale.
fn place(panels: &[Panel], width: f64, tallest: f64) -> Placement {
    let sizes: Vec<[f64; 2]> = panels.iter().map(|p| p.frame.size()).collect();
    let caption = if panels.iter().all(|p| p.caption.is_empty()) {
        0.0
    } else {
        CAPTION
    };
    let count = sizes.len() as f64;
    let gaps = GAP * (count - 1.0);
    let total = |axis: usize| sizes.iter().map(|s| s[axis]).sum::<f64>();
    let largest = |axis: usize| sizes.iter().map(|s| s[axis]).fold(0.0, f64::max);
    if sizes.is_empty() {
        return Placement {
            scale: 1.0,
            corners: Vec::new(),
            captions: Vec::new(),
            height: 0.0,
        };
    }
    let beside = ((width - gaps) / total(0)).min(tallest / largest(1));
    let below = (width / largest(0)).min((tallest - gaps - count * caption) / total(1));
    let (mut corners, mut captions) = (Vec::new(), Vec::new());
    let mut at = 0.0;
    if beside * WORTH_STACKING >= below {
        let left = 0.5 * (width - gaps - total(0) * beside);
        let height = largest(1) * beside;
        for size in &sizes {
            corners.push([left + at, 0.5 * (height - size[1] * beside)]);
            captions.push(height + 0.4 * caption);
            at += size[0] * beside + GAP;
        }
        return Placement {
            scale: beside,
            corners,
            captions,
            height: height + caption,
        };
    }
    for size in &sizes {
        corners.push([0.5 * (width - size[0] * below), at]);
        at += size[1] * below;
        captions.push(at + 0.4 * caption);
        at += caption + GAP;
    }
    Placement {
        scale: below,
        corners,
        captions,
        height: at - GAP,
    }
}

/// Scale bar to the left, colour bar to the right, what is missing between them.
fn foot(
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
        let tint = what.map.color((i as f64 + 0.5) / bar);
        image.rectangle(start + i as f64, y - 2.0, 1.0, 18.0, tint);
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
