//! Numbers that know what they measure.

use super::dimension::Dimension;

/// A number with what it measures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quantity {
    pub value: f64,
    pub dimension: Dimension,
}

impl Dimension {
    pub const fn of(self, value: f64) -> Quantity {
        Quantity {
            value,
            dimension: self,
        }
    }
}

/// A number in so many digits, without trailing zeros.
pub fn rounded(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let rounded: f64 = format!("{value:.*e}", digits.max(1) - 1)
        .parse()
        .unwrap_or(value);
    if (1e-3..1e6).contains(&rounded.abs()) {
        format!("{rounded}")
    } else {
        format!("{rounded:e}")
    }
}
