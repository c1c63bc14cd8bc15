//! Words of choices and lengths.

use crate::deck::units::{Dim, UnitSystem};
use crate::excerpt::one_line;
use peridyne::spec::{Horizon, Influence};

/// The name of a choice as a deck has it, in words: `cubic spline`.
pub(super) fn words(choice: &impl std::fmt::Debug) -> String {
    let mut out = String::new();
    for (n, c) in format!("{choice:?}").chars().enumerate() {
        if n > 0 && c.is_uppercase() {
            out.push(' ');
        }
        out.extend(c.to_lowercase());
    }
    out
}

pub(super) fn influence(chosen: Influence) -> String {
    match chosen {
        Influence::Formula(formula) => one_line(formula.source()).into_owned(),
        word => words(&word),
    }
}

/// A horizon as it is written.
pub(super) fn length(horizon: Horizon, units: UnitSystem) -> String {
    match horizon {
        Horizon::Ratio(m) => format!("{m} spacings"),
        Horizon::Length(length) => units.write(length, Dim::LENGTH),
    }
}
