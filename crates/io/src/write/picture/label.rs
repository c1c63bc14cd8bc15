//! Numbers for people: round lengths, SI prefixes, thousands.

/// The largest of 1, 2, 5 × 10ⁿ that is not above `value` (positive, finite).
pub fn round_down(value: f64) -> f64 {
    let power = libm::pow(10f64, libm::log10(value).floor());
    let digit = [5.0, 2.0, 1.0]
        .into_iter()
        .find(|d| d * power <= value * (1.0 + 1e-9));
    digit.unwrap_or(1.0) * power
}

/// A number with at most four digits that matter, and no zeros that do not.
pub fn number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || !size.is_finite() {
        return if size == 0.0 {
            "0".into()
        } else {
            value.to_string()
        };
    }
    if !(1e-3..1e5).contains(&size) {
        let text = format!("{value:.3e}");
        let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        return format!("{}e{exponent}", trimmed(digits));
    }
    let decimals = (3 - libm::log10(size).floor() as i32).clamp(0, 9) as usize;
    trimmed(&format!("{value:.decimals$}")).to_string()
}

fn trimmed(digits: &str) -> &str {
    if digits.contains('.') {
        digits.trim_end_matches('0').trim_end_matches('.')
    } else {
        digits
    }
}

/// A number with its unit; metres and seconds get SI prefixes, other units are kept as they are.
pub fn quantity(value: f64, unit: &str) -> String {
    let (factor, prefix) = prefix(value, unit);
    let text = format!("{} {prefix}{unit}", number(value / factor));
    text.trim_end().to_string()
}

/// Factor and SI prefix that bring a value near 1…1000; none for other units than metres and seconds.
pub fn prefix(value: f64, unit: &str) -> (f64, &'static str) {
    let size = value.abs() * (1.0 + 1e-9);
    if !matches!(unit, "m" | "s") || size == 0.0 || !size.is_finite() {
        return (1.0, "");
    }
    let prefixes = [
        (1.0, ""),
        (1e-3, "m"),
        (1e-6, "µ"),
        (1e-9, "n"),
        (1e-12, "p"),
    ];
    let fits = |(factor, _): &(f64, &str)| size >= *factor;
    prefixes.into_iter().find(fits).unwrap_or((1e-15, "f"))
}

/// A count with commas between thousands.
pub fn count(n: u64) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (i, c) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(c);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_round() {
        for (value, round) in [
            (1.0, 1.0),
            (1.99, 1.0),
            (2.0, 2.0),
            (0.0499, 0.02),
            (7e8, 5e8),
        ] {
            assert!((round_down(value) / round - 1.0).abs() < 1e-12, "{value}");
        }
    }

    #[test]
    fn numbers_are_short() {
        let cases = [
            (0.0, "0"),
            (1.0, "1"),
            (-0.25, "-0.25"),
            (1.0 / 3.0, "0.3333"),
            (12345.6, "12346"),
            (2e-7, "2e-7"),
            (-1.25e9, "-1.25e9"),
            (100.0, "100"),
            (f64::NAN, "NaN"),
        ];
        for (value, text) in cases {
            assert_eq!(number(value), text);
        }
    }

    #[test]
    fn metres_and_seconds_get_prefixes() {
        assert_eq!(quantity(0.02, "m"), "20 mm");
        assert_eq!(quantity(2e-4, "s"), "200 µs");
        assert_eq!(quantity(0.001, "m"), "1 mm");
        assert_eq!(quantity(3.0, "m"), "3 m");
        assert_eq!(quantity(0.02, "Å"), "0.02 Å");
        assert_eq!(quantity(0.0, "s"), "0 s");
        assert_eq!(quantity(0.5, ""), "0.5");
    }

    #[test]
    fn thousands_have_commas() {
        assert_eq!(count(7), "7");
        assert_eq!(count(103_110), "103,110");
        assert_eq!(count(8_000_000), "8,000,000");
    }
}
