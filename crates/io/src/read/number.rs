//! Numbers as other programs write them.

/// `1.5e-3`, `1.5D-3`, and `1.5-103`, as Fortran prints exponents of three digits.
pub fn number(word: &str) -> Option<f64> {
    if let Ok(x) = word.parse() {
        return Some(x);
    }
    let word = word.replace(['D', 'd'], "e");
    if let Ok(x) = word.parse() {
        return Some(x);
    }
    let sign = word.rfind(['+', '-']).filter(|at| *at > 0)?;
    if word.contains(['e', 'E']) || !word[..sign].contains('.') {
        return None;
    }
    format!("{}e{}", &word[..sign], &word[sign..]).parse().ok()
}

/// What to add to a message about a word that is no number: is its comma that of a decimal?
pub fn comma(word: &str) -> &'static str {
    match number(&word.replacen(',', ".", 1)) {
        Some(_) if word.contains(',') => {
            "; is that a decimal comma? Numbers have a point: 1.5, not 1,5"
        }
        _ => "",
    }
}

/// Has a line of numbers decimal commas? Where commas separate numbers they stand between all of them.
pub fn decimal_commas(line: &str) -> bool {
    let parts = line.split(|c: char| c.is_whitespace() || c == ';');
    let parts: Vec<&str> = parts.filter(|p| !p.is_empty()).collect();
    let inside = |p: &&str| !p.starts_with(',') && !p.ends_with(',') && !comma(p).is_empty();
    // what stands between two parts is a blank or semicolon alone
    let apart = |w: &[&str]| !w[0].ends_with(',') && !w[1].starts_with(',');
    parts.iter().any(inside) && parts.windows(2).any(apart)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponents_as_fortran_writes_them() {
        for (text, value) in [
            ("1.5D-3", 1.5e-3),
            ("-0.25d+02", -25.0),
            (".5", 0.5),
            ("0.", 0.0),
            ("1.5-103", 1.5e-103),
            ("-2.0+100", -2e100),
        ] {
            assert_eq!(number(text), Some(value), "{text}");
        }
        for text in ["FCC", "1.5e", "--1", "1e5-3", "", "-", "1-2", "1,5"] {
            assert_eq!(number(text), None, "{text}");
        }
    }

    #[test]
    fn commas_of_decimals_are_told_from_those_between_numbers() {
        for line in ["0,5 0,5 0 1", "0,5;1,5;0;1", "1,5e-3\t2,5", "0 0,5"] {
            assert!(decimal_commas(line), "{line}");
        }
        for line in [
            "0,5,0,1",
            "0.5, 1, 2, 3",
            "0 1 2 3",
            "1;2;3",
            "1 , 2 , 3",
            "1, 2,3",
            "",
        ] {
            assert!(!decimal_commas(line), "{line}");
        }
        assert!(comma("-1,5D-3").contains("decimal comma"));
        assert_eq!((comma("a,b"), comma("1.5"), comma("1,5,2")), ("", "", ""));
    }
}
