//! Degrees Celsius, whose zero is another one than that of the kelvin.

use super::{Context, Result};
use crate::deck::units::{self, Dim};
use crate::deck::value::{Number, Written};
use std::cell::RefCell;
use std::ops::Range;

/// How the temperatures of a deck are written.
#[derive(Default)]
pub(super) struct Scales {
    /// The first in degrees Celsius.
    celsius: RefCell<Option<Range<usize>>>,
    /// Those without a unit, which are in kelvin.
    plain: RefCell<Vec<(Range<usize>, f64)>>,
}

impl Context<'_> {
    /// A temperature that is written in degrees Celsius, in kelvin as computed with.
    pub(super) fn celsius(&self, number: &Number, dim: Dim) -> Result<Option<f64>> {
        if dim != Dim::TEMPERATURE || !self.units.has_units() {
            return Ok(None);
        }
        let text = match &number.value {
            Written::Plain(value) => {
                if *value != 0.0 {
                    let plain = &self.scales.plain;
                    plain.borrow_mut().push((number.span.clone(), *value));
                }
                return Ok(None);
            }
            Written::Text(text) => text,
        };
        let Some(kelvin) = units::celsius(text) else {
            return Ok(None);
        };
        if kelvin < 0.0 {
            let message = format!("\"{text}\" lies below absolute zero, -273.15 degC");
            let help = "write a difference of temperatures in K";
            return Err(self.error_with(&number.span, message, help));
        }
        let first = &self.scales.celsius;
        first.borrow_mut().get_or_insert(number.span.clone());
        let factor = self.units.from_si(dim) * self.units.plain_factor(dim);
        Ok(Some(kelvin * factor))
    }

    /// Are temperatures of this deck in degrees Celsius, whose zero is not the default of any key?
    ///
    /// # Errors
    /// They are, and `table` leaves out the one that it measures from.
    pub fn has_reference(&self, table: &str) -> Result<()> {
        match &*self.scales.celsius.borrow() {
            None => Ok(()),
            Some(first) => Err(self.error_with(
                first,
                format!("{table}.reference is 0 K by default, and this temperature is in degrees Celsius"),
                format!("write reference = \"20 degC\" in [{table}]: where the body has its reference shape, and begins if nothing else is said"),
            )),
        }
    }

    /// What to say of temperatures without unit beside others in degrees Celsius.
    pub fn kelvins(&self) -> Vec<String> {
        if self.scales.celsius.borrow().is_none() {
            return vec![];
        }
        let plain = self.scales.plain.borrow();
        let told = |(span, value): &(Range<usize>, f64)| {
            let text = format!(
                "{value} is in kelvin, and other temperatures of this deck are in degrees Celsius: write its unit"
            );
            self.source.remark(span, &text)
        };
        let mut all: Vec<String> = plain.iter().map(told).collect();
        all.dedup();
        all
    }
}

/// What is written instead of `1 MPa*sqrt(m)`.
pub(super) fn of_roots(text: &str) -> Option<String> {
    let text: String = text.split_whitespace().collect();
    let roots = [
        "sqrt(m)", "sqrt(mm)", "sqrt(in)", "m^0.5", "m^.5", "m^(1/2)", "m^{1/2}", "√m",
    ];
    roots.iter().any(|root| text.contains(root)).then(|| {
        "no unit has half a power of a length: a fracture toughness K is given as an energy K²/E, for example energy = \
         \"(0.75 MPa)^2 * 1 m / 72 GPa\" (in plane strain times 1 - ν²)"
            .into()
    })
}
