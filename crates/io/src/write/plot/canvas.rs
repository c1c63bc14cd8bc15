//! What a plot is made of, in units of which the PNG has two pixels and the SVG one.

use super::super::picture::image::{Align, Color, Image};

/// One thing drawn; later ones lie over earlier ones.
#[derive(Debug, Clone)]
pub enum Shape {
    /// Straight pieces through the points; `dash`: lengths of ink and gap.
    Path {
        points: Vec<[f64; 2]>,
        width: f64,
        color: Color,
        dash: Option<[f64; 2]>,
    },
    Rectangle {
        corner: [f64; 2],
        size: [f64; 2],
        fill: Color,
    },
    /// A filled polygon or disc of a marker.
    Marker {
        at: [f64; 2],
        radius: f64,
        outline: Outline,
        color: Color,
    },
    /// A line of text, `at` on its base line.
    Text {
        at: [f64; 2],
        text: String,
        size: f64,
        align: Align,
        /// Read from bottom to top.
        upright: bool,
        color: Color,
    },
    /// Pixels stretched over a rectangle, without smoothing.
    Pixels {
        corner: [f64; 2],
        size: [f64; 2],
        image: Image,
    },
}

/// A page of shapes.
#[derive(Debug, Clone)]
pub struct Drawing {
    pub width: f64,
    pub height: f64,
    pub shapes: Vec<Shape>,
}

impl Drawing {
    pub fn new(width: f64, height: f64) -> Self {
        Drawing {
            width,
            height,
            shapes: Vec::new(),
        }
    }

    pub fn segment(&mut self, from: [f64; 2], to: [f64; 2], width: f64, color: Color) {
        self.shapes.push(Shape::Path {
            points: vec![from, to],
            width,
            color,
            dash: None,
        });
    }

    pub fn text(&mut self, at: [f64; 2], text: &str, size: f64, align: Align, color: Color) {
        self.shapes.push(Shape::Text {
            at,
            text: text.to_string(),
            size,
            align,
            upright: false,
            color,
        });
    }

    /// Text that reads from bottom to top, centred at `at`.
    pub fn upright(&mut self, at: [f64; 2], text: &str, size: f64, color: Color) {
        self.shapes.push(Shape::Text {
            at,
            text: text.to_string(),
            size,
            align: Align::Center,
            upright: true,
            color,
        });
    }

    /// The border of a rectangle.
    pub fn frame(&mut self, corner: [f64; 2], size: [f64; 2], width: f64, color: Color) {
        let [x, y] = corner;
        let [w, h] = size;
        self.shapes.push(Shape::Path {
            points: vec![[x, y], [x + w, y], [x + w, y + h], [x, y + h], [x, y]],
            width,
            color,
            dash: None,
        });
    }
}

/// Outline of a marker.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Outline {
    Disc,
    /// Corners on the circle of the radius; the first is up, turned by this angle.
    Polygon {
        corners: usize,
        turn: f64,
    },
}

impl Outline {
    /// Corners of a polygon, clockwise; none for a disc.
    pub fn corners(self, at: [f64; 2], radius: f64) -> Vec<[f64; 2]> {
        let Outline::Polygon { corners, turn } = self else {
            return Vec::new();
        };
        let corner = |k: usize| {
            let angle = turn + std::f64::consts::TAU * k as f64 / corners as f64;
            [
                at[0] + radius * libm::sin(angle),
                at[1] - radius * libm::cos(angle),
            ]
        };
        (0..corners).map(corner).collect()
    }
}
