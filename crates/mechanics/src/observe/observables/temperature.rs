//! `temperature`

use super::{Needs, Observable};
use super::{by_id, square};
use crate::columns::{Declaration, Dimension, Shape};
use crate::observe::{State, Values};

pub static OBSERVABLE: Observable = Observable {
    declaration: Declaration::of_points(
        "temperature",
        Shape::Scalar,
        Dimension::TEMPERATURE,
        "Kinetic temperature of an atom; its mean is that of the body times (N − 1)/N, whose centre of mass takes D degrees of freedom.",
    ).derived(),
    equation: "T = m v·v / (D k_B)",
    source: "",
    needs: Needs::Atoms,
    of,
};

/// Temperature of a body of `points` atoms whose centre of mass is at rest: `2 E_kin / ((D N − D) k_B)`; of one atom with its D degrees
/// of freedom.
pub fn temperature_of(kinetic: f64, dimension: usize, points: u64, boltzmann: f64) -> f64 {
    let free = dimension as u64 * points.saturating_sub(1).max(1);
    2.0 * kinetic / (free as f64 * boltzmann)
}

fn of(state: &mut dyn State) -> Option<Values> {
    let per = state.dimension() as f64 * state.boltzmann();
    Some(Values::Scalars(by_id(state, |s, i| {
        s.density(i) * s.volume(i) * square(s.velocity(i)) / per
    })))
}
