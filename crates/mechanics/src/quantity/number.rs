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

/// `xⁿ` by squaring: these products, in this order. [`f64::powi`] of two numbers that the compiler knows is folded by another function, so its last digits
/// depend on what was inlined where.
pub fn power(x: f64, n: i32) -> f64 {
    let (mut square, mut left, mut out) = (x, n.unsigned_abs(), 1.0);
    loop {
        if left % 2 == 1 {
            out *= square;
        }
        left /= 2;
        if left == 0 {
            break;
        }
        square *= square;
    }
    if n < 0 { 1.0 / out } else { out }
}

#[cfg(test)]
mod tests {
    use super::power;

    /// Products as they are written, rounded one by one.
    #[test]
    fn powers_are_products_in_a_known_order() {
        let x = 1.602176634e-19f64;
        let (two, four) = (x * x, (x * x) * (x * x));
        let exact = [1.0, x, two, x * two, four, x * four, two * four];
        for (n, wanted) in (0..).zip(exact) {
            assert_eq!(power(x, n), wanted, "{n}");
            assert_eq!(power(x, -n), 1.0 / wanted, "{n}");
        }
    }
}
