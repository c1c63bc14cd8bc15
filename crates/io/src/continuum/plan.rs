//! What fields a deck asks for.

use crate::write::picture::animate::FilmFormat;
use peridyne_fields::{PairForce, Partition, Quantity, Shape};

/// A picture of a slice in a film (bytes).
const PICTURE: f64 = 100e3;

/// Fields of the running model.
#[derive(Debug, Clone)]
pub struct FieldsSpec {
    /// Folder inside that of the results.
    pub name: String,
    pub shape: Shape,
    /// S (length).
    pub width: f64,
    /// Axes that are averaged over; those beyond the dimension among them.
    pub averaged: [bool; 3],
    pub place: Place,
    /// Of peridynamic bodies `None`: those of their force states.
    pub choice: Option<Choice>,
    /// Steps between frames; `None`: the last state.
    pub every: Option<u64>,
    /// Frames to pass over first.
    pub skip: u64,
    /// Write each frame.
    pub each: bool,
    /// Films of the slice.
    pub film: Option<FilmFormat>,
    /// Write the pressure, too.
    pub pressure: bool,
    /// Make y, its flux and the angular momentum, too.
    pub coordinate: bool,
    /// Points at which residuals are measured.
    pub residuals: usize,
}

/// Where fields are wanted.
#[derive(Debug, Clone, PartialEq)]
pub enum Place {
    Grid {
        counts: [usize; 3],
        /// Lower and upper; `None`: of the body.
        corners: Option<[[f64; 3]; 2]>,
    },
    Points(Vec<[f64; 3]>),
}

/// What is a choice with atoms.
#[derive(Debug, Clone, Default)]
pub struct Choice {
    pub partition: Partition,
    pub pair_force: PairForce,
    /// Keep parts of the potential apart.
    pub parts: bool,
}

impl Place {
    /// Number of points.
    pub fn points(&self) -> u64 {
        match self {
            Place::Grid { counts, .. } => counts
                .iter()
                .fold(1, |all: u64, n| all.saturating_mul(*n as u64)),
            Place::Points(points) => points.len() as u64,
        }
    }
}

impl FieldsSpec {
    /// Frames that are taken in a run of so many steps.
    pub fn frames(&self, steps: u64) -> u64 {
        let met = self.every.map_or(0, |every| steps / every.max(1) + 1);
        met.saturating_sub(self.skip).max(1)
    }

    /// What is written at most, without packing: a text and an array of every number of the means, of their errors, and of each frame if
    /// these are wanted (bytes).
    pub fn bytes(&self, steps: u64) -> f64 {
        let frames = if self.each { self.frames(steps) } else { 0 };
        // slices of stress and temperature
        let films = if self.film.is_some() {
            2 * self.frames(steps)
        } else {
            0
        };
        PICTURE * films as f64 + bytes(self.place.points(), frames, self.coordinate)
    }
}

/// What tables of so many points take at most, with y and what goes with it or without: of means, of their errors, and of so many frames (bytes).
pub fn bytes(points: u64, frames: u64, coordinate: bool) -> f64 {
    let numbers = Quantity::numbers(coordinate);
    // 8 in an array, about 24 as text
    32.0 * numbers as f64 * points as f64 * (2.0 + frames as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_and_bytes_are_those_of_the_steps() {
        let asked = FieldsSpec {
            name: "fields".into(),
            shape: Shape::Gaussian,
            width: 1.0,
            averaged: [false; 3],
            place: Place::Grid {
                counts: [4, 5, 1],
                corners: None,
            },
            choice: None,
            every: Some(10),
            skip: 3,
            each: false,
            film: None,
            pressure: false,
            coordinate: false,
            residuals: 0,
        };
        assert_eq!(asked.place.points(), 20);
        // steps 0, 10, …, 100, less three
        assert_eq!(asked.frames(100), 8);
        // a run that ends before has its end
        assert_eq!(asked.frames(5), 1);
        let each = FieldsSpec {
            each: true,
            ..asked.clone()
        };
        assert_eq!(each.bytes(100) / asked.bytes(100), 5.0);
        let last = FieldsSpec {
            every: None,
            ..asked
        };
        assert_eq!(last.frames(100), 1);
    }
}
