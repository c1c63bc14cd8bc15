//! `volume`

use super::by_id;
use super::{Needs, Observable};
use crate::columns::{Declaration, Dimension, Shape};
use crate::observe::{State, Values};

pub static OBSERVABLE: Observable = Observable {
    declaration: Declaration::of_points(
        "volume",
        Shape::Scalar,
        Dimension::VOLUME,
        "Volume of the point.",
    ),
    equation: "V",
    source: "",
    needs: Needs::Nothing,
    of,
};

fn of(state: &mut dyn State) -> Option<Values> {
    Some(Values::Scalars(by_id(state, |s, i| s.volume(i))))
}
