//! Pictures of plates and solids: layout, frame, scale bar and colour bar.

use std::cell::OnceCell;

use peridyne::observe::Snapshot;
use peridyne::space::{AXES, Point};

use super::arrows::Arrows;
use super::camera::{Camera, Frame, cross};
use super::cells::{Cell, Cells};
use super::extent::{REACH, bounds, longest, moved, principal, strays};
use super::image::{Align, Font, GREY, Image};
use super::marks;
use super::rigid::Placed;
use super::shown::Shown;
use super::view::{Beside, draw as draw_view};
use super::{FOOT, HEAD, MARGIN, PictureOptions, foot, head};

/// Elevation of the viewer of the section (degrees): low enough to see the cut, high enough to see the top.
const ELEVATION: f64 = 30.0;
/// Cubes of magnified bodies are larger by this.
const MAGNIFIED: f64 = 1.25;
/// Room between and below the views (pixels).
const GAP: f64 = 48.0;
/// Height of the key of arrows (pixels).
const KEY: f64 = 44.0;
const CAPTION: f64 = 40.0;
/// A view is not drawn higher than this part of the picture's width.
const TALLEST: f64 = 0.75;
/// Views go below each other when that makes them larger by this factor.
const WORTH_STACKING: f64 = 1.6;

/// A rigid body hides so much of what it is in front of, seen from above.
const GLASS: f32 = 0.6;
/// Points in front of a cut by less than this part of a spacing lie in it: lattices may be perturbed.
const IN_CUT: f64 = 0.3;

/// Keeps the points whose reference coordinate along `axis` is at or behind `at` in the direction `sign` (±1).
#[derive(Debug, Clone, Copy)]
struct Cut {
    axis: usize,
    at: f64,
    sign: f64,
}

impl Cut {
    fn keeps(&self, reference: &Point, spacing: f64) -> bool {
        self.sign * (reference[self.axis] - self.at) >= -IN_CUT * spacing
    }

    /// Where a ray through a place of the screen meets it, towards the viewer (length).
    fn met(&self, camera: &Camera, right: f64, up: f64) -> f64 {
        let a = self.axis;
        (self.at - camera.right[a] * right - camera.up[a] * up) / camera.toward[a]
    }
}

/// One view: camera, what it shows, and its frame.
struct Panel {
    camera: Camera,
    frame: Frame,
    caption: String,
    cut: Option<Cut>,
}

/// What is seen of a body and how: the same for all frames of a film.
pub struct Sight {
    panels: Vec<Panel>,
    bounds: [[f64; 2]; 3],
    spacing: f64,
    /// Of a plate, where it is drawn.
    cells: OnceCell<Cells>,
}

/// Points and rigid bodies at a time.
struct Scene {
    moved: Vec<Point>,
    strays: Vec<bool>,
    bodies: Vec<Placed>,
}

impl Sight {
    /// Of one frame.
    pub fn of(s: &Snapshot, bodies: &[Placed], scale: f64) -> Sight {
        let bounds = bounds(s);
        let guesses = [s.spacing, longest(&bounds) / 100.0, 1.0];
        // where displacements are magnified, strains are, too, and points must not come apart
        let wide = if scale > 1.0 && s.dimension > 2 {
            MAGNIFIED
        } else {
            1.0
        };
        let spacing = wide * guesses.into_iter().find(|l| *l > 0.0).unwrap_or(1.0);
        let mut sight = Sight {
            cells: OnceCell::new(),
            panels: vec![],
            bounds,
            spacing,
        };
        let scene = sight.scene(s, bodies, scale);
        let framed = |(camera, caption, cut): (Camera, String, Option<Cut>)| {
            let all = scene.moved.iter().zip(&s.reference).zip(&scene.strays);
            let points = all.filter(|((x, reference), stray)| {
                !**stray && sight.near(x) && cut.is_none_or(|c| c.keeps(reference, spacing))
            });
            let ways = [camera.right, camera.up, camera.toward];
            let ends = scene.bodies.iter().flat_map(|b| b.ends(&ways));
            // as far as the picture reaches
            let ends = ends.map(|x| sight.reached(x));
            let points = points.map(|((x, _), _)| *x).chain(ends);
            let frame = Frame::around(&camera, points, spacing)?;
            Some(Panel {
                camera,
                frame,
                caption,
                cut,
            })
        };
        sight.panels = cameras(s, &bounds).into_iter().filter_map(framed).collect();
        sight
    }

    /// What shows both.
    pub fn with(mut self, other: &Sight) -> Sight {
        if self.panels.is_empty() {
            self.panels = { other.panels.iter() }
                .map(|p| Panel {
                    caption: p.caption.clone(),
                    ..*p
                })
                .collect();
        }
        for (own, other) in self.panels.iter_mut().zip(&other.panels) {
            own.frame = own.frame.with(&other.frame);
        }
        self
    }

    fn reach(&self) -> f64 {
        REACH * longest(&self.bounds)
    }

    fn near(&self, x: &Point) -> bool {
        let reach = self.reach() + self.spacing;
        (0..3).all(|a| x[a] >= self.bounds[a][0] - reach && x[a] <= self.bounds[a][1] + reach)
    }

    fn reached(&self, x: Point) -> Point {
        let reach = self.reach();
        std::array::from_fn(|a| x[a].clamp(self.bounds[a][0] - reach, self.bounds[a][1] + reach))
    }

    fn scene(&self, s: &Snapshot, bodies: &[Placed], scale: f64) -> Scene {
        let bodies = bodies.iter().map(|b| b.bounded(&self.bounds, s.dimension));
        Scene {
            moved: moved(s, scale).collect(),
            strays: strays(s),
            bodies: bodies.collect(),
        }
    }
}

pub fn draw(
    s: &Snapshot,
    bodies: &[Placed],
    (what, arrows): (&Shown, Option<&Arrows>),
    scale: f64,
    sight: &Sight,
    options: &PictureOptions,
) -> Image {
    let scene = sight.scene(s, bodies, scale);
    let spacing = sight.spacing;
    let cells = (s.dimension == 2).then(|| {
        let made = || Cells::of(&s.reference, s.spacing);
        sight.cells.get_or_init(made).at(&scene.moved)
    });
    let shown = |cut: Option<Cut>| {
        let all = scene.moved.iter().zip(&s.reference).zip(&what.values);
        let points = all.enumerate().filter(move |(_, ((x, reference), _))| {
            sight.near(x) && cut.is_none_or(|cut| cut.keeps(reference, spacing))
        });
        points.map(|(i, ((x, _), value))| {
            let cell = cells.as_ref().map_or(Cell::WHOLE, |c| c[i]);
            (*x, what.part(*value), cell)
        })
    };
    let panels = &sight.panels;
    let width = options.width as f64;
    let placed = place(panels, width - 2.0 * MARGIN, TALLEST * width);
    let key = if arrows.is_some() { KEY } else { 0.0 };
    let height = HEAD + placed.height + FOOT + key;
    let mut image = Image::new(options.width, height.ceil() as usize);
    head(&mut image, s, scale, options);
    let flat = s.dimension == 2;
    for ((panel, corner), caption) in panels.iter().zip(&placed.corners).zip(&placed.captions) {
        let corner = [MARGIN + corner[0], HEAD + corner[1]];
        let nearest = |right: f64, up: f64| match &panel.cut {
            Some(cut) => cut.met(&panel.camera, right, up),
            None => f64::INFINITY,
        };
        let beside = Beside {
            bodies: &scene.bodies,
            flat,
            opacity: if flat || panel.cut.is_some() {
                1.0
            } else {
                GLASS
            },
            nearest: &nearest,
        };
        draw_view(
            &mut image,
            (corner, placed.scale),
            (&panel.camera, &panel.frame),
            spacing,
            what.map,
            &beside,
            shown(panel.cut),
        );
        let view = marks::View {
            corner,
            step: spacing,
            scale: placed.scale,
            camera: &panel.camera,
            frame: &panel.frame,
            flat,
            open: panel.cut.is_some(),
        };
        if let Some(arrows) = arrows {
            let seen = scene.moved.iter().zip(&s.reference).enumerate();
            let seen = seen.filter(|(_, (x, reference))| {
                sight.near(x) && panel.cut.is_none_or(|cut| cut.keeps(reference, spacing))
            });
            arrows.draw(&mut image, &view, seen.map(|(i, (x, _))| (i, *x)));
        }
        let points = (&*s.reference, &*scene.moved);
        marks::draw(&mut image, &view, &options.marks, points);
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
    foot::draw(&mut image, (placed.scale, key), outside, what, options);
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
    let [thin, long, deep] = principal(bounds);
    let (right, top) = (unit(long), unit(thin));
    // the half behind the cut stays
    let cut = Some(Cut {
        axis: deep,
        at: 0.5 * (bounds[deep][0] + bounds[deep][1]),
        sign: cross(top, right)[deep],
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
