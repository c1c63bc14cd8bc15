//! Arrows of a vector field: of the points that are seen one here and there, the longest of the run as long as two of their distances.

use std::io;

use peridyne::columns::{Dimension, Shape};
use peridyne::observe::{Snapshot, Values};

use super::super::fields::invalid;
use super::image::{Align, Font, INK, Image, WHITE};
use super::label;
use super::marks::View;
use crate::deck::UnitSystem;

/// Distance of arrows, and length of the longest (pixels).
const APART: f64 = 34.0;
const LONGEST: f64 = 58.0;
/// Shorter ones say nothing (pixels).
const SHORTEST: f64 = 2.5;

/// A vector for each point.
#[derive(Debug, Clone, PartialEq)]
pub struct Arrows {
    pub name: String,
    pub dimension: Dimension,
    pub vectors: Vec<[f64; 3]>,
    /// What is drawn as long as an arrow may be.
    pub longest: f64,
}

fn length(v: &[f64; 3]) -> f64 {
    v.iter().map(|c| c * c).sum::<f64>().sqrt()
}

/// The longest finite vector.
pub fn longest(vectors: &[[f64; 3]]) -> f64 {
    let all = vectors.iter().map(length).filter(|l| l.is_finite());
    all.fold(0.0, f64::max)
}

impl Arrows {
    /// Of a column of vectors.
    ///
    /// # Errors
    /// `InvalidInput`: there is no such column, or it is of something else.
    pub fn of(s: &Snapshot, field: &str) -> io::Result<Arrows> {
        let column = s.column(field);
        let column = column.ok_or_else(|| invalid(format!("the snapshot carries no {field}")))?;
        let (Values::Vectors(vectors), Shape::Vector) = (&column.values, column.declaration.shape)
        else {
            return Err(invalid(format!(
                "{field} has no direction: it is no vector"
            )));
        };
        Ok(Arrows {
            name: field.replace('_', " "),
            dimension: column.declaration.dimension,
            longest: longest(vectors),
            vectors: vectors.clone(),
        })
    }

    /// Draws over a view those of the points at these places, of several in one direction of sight that of the nearest.
    pub fn draw(
        &self,
        image: &mut Image,
        view: &View,
        points: impl Iterator<Item = (usize, [f64; 3])>,
    ) {
        if !(self.longest > 0.0) {
            return;
        }
        let cells = view
            .frame
            .size()
            .map(|s| (s * view.scale / APART).ceil().max(1.0) as usize);
        // which point stands for a cell, and how near it is to the viewer and to the middle of the cell
        let mut chosen: Vec<Option<(f64, f64, usize, [f64; 2])>> = vec![None; cells[0] * cells[1]];
        for (i, x) in points {
            let at = view.place(x);
            let part = [0, 1].map(|a| (at[a] - view.corner[a]) / APART);
            if !part.iter().all(|p| p.is_finite() && *p >= 0.0) {
                continue;
            }
            let [column, row] = part.map(|p| p as usize);
            if column >= cells[0] || row >= cells[1] {
                continue;
            }
            let depth = (view.camera.project(x)[2] / view.step).round();
            let off = part.map(|p| p.fract() - 0.5);
            let off = off[0] * off[0] + off[1] * off[1];
            let place = &mut chosen[row * cells[0] + column];
            let better =
                |(d, o, ..): &(f64, f64, usize, [f64; 2])| depth > *d || (depth == *d && off < *o);
            if place.as_ref().is_none_or(better) {
                *place = Some((depth, off, i, at));
            }
        }
        for (_, _, i, at) in chosen.into_iter().flatten() {
            let toward = view.camera.project(self.vectors[i]);
            let d = [toward[0], -toward[1]].map(|c| c / self.longest * LONGEST);
            arrow(image, at, d);
        }
    }

    /// How long the longest round number is, at this place of the foot.
    pub fn key(&self, image: &mut Image, [x, y]: [f64; 2], units: UnitSystem) {
        if !(self.longest > 0.0) {
            return;
        }
        let round = label::round_down(self.longest);
        let pixels = round / self.longest * LONGEST;
        arrow(image, [x, y], [pixels, 0.0]);
        let text = format!("{}  {}", units.show(round, self.dimension), self.name);
        image.text(
            x + pixels + 14.0,
            y - 13.0,
            &text,
            Font::Normal,
            Align::Left,
            INK,
        );
    }
}

fn arrow(image: &mut Image, from: [f64; 2], d: [f64; 2]) {
    let long = libm::hypot(d[0], d[1]);
    if !(long >= SHORTEST && long.is_finite()) {
        return;
    }
    let unit = d.map(|c| c / long);
    let tip = [from[0] + d[0], from[1] + d[1]];
    let head = (0.4 * long).min(9.0);
    let barb = |side: f64| {
        [
            tip[0] - head * unit[0] + side * 0.55 * head * unit[1],
            tip[1] - head * unit[1] - side * 0.55 * head * unit[0],
        ]
    };
    for (width, color) in [(4.2, WHITE), (1.8, INK)] {
        image.line(from, tip, width, color);
        image.line(tip, barb(1.0), width, color);
        image.line(tip, barb(-1.0), width, color);
    }
}
