//! Numbers for people.

use peridyne_io::deck::rounded;

/// A number in about five digits.
pub fn digits(value: f64) -> String {
    let size = value.abs();
    if !value.is_finite() {
        "–".into()
    } else if value != 0.0 && !(1e-3..1e6).contains(&size) {
        rounded(value, 4)
    } else {
        let before = if size < 1.0 {
            1
        } else {
            libm::log10(size).floor() as usize + 1
        };
        format!("{value:.*}", 5usize.saturating_sub(before))
    }
}

/// A count in groups of three.
pub fn whole(n: u64) -> String {
    let text = n.to_string();
    let mut out = String::new();
    for (i, c) in text.chars().enumerate() {
        if i > 0 && (text.len() - i).is_multiple_of(3) {
            out.push(',');
        }
        out.push(c);
    }
    out
}

pub fn memory(bytes: f64) -> String {
    match bytes {
        b if b >= 1e9 => format!("{:.2} GB", b / 1e9),
        b if b >= 1e6 => format!("{:.1} MB", b / 1e6),
        b => format!("{:.1} kB", b / 1e3),
    }
}

pub fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 1.0 => format!("{:.0} ms", (1e3 * s).max(1.0)),
        s if s < 60.0 => format!("{s:.1} s"),
        s if s < 3600.0 => format!("{:.1} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_readable() {
        assert_eq!(whole(12_345_678), "12,345,678");
        assert_eq!(whole(12), "12");
        assert_eq!(digits(14.9), "14.900");
        assert_eq!(digits(0.25), "0.2500");
        assert_eq!(digits(123456.7), "123457");
        assert_eq!(digits(f64::NAN), "–");
        assert_eq!(duration(90.0), "1.5 min");
    }
}
