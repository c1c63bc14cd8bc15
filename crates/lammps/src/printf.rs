//! The conversions of C's `printf` for one number: what LAMMPS's `format` options and `$(x:%g)` use.

/// One conversion with the text around it, e.g. `"%-12.4e |"`.
#[derive(Debug, Clone, PartialEq)]
pub struct Format {
    before: String,
    after: String,
    left: bool,
    plus: bool,
    space: bool,
    alternate: bool,
    zero: bool,
    width: usize,
    precision: Option<usize>,
    conversion: char,
}

/// A number or a word to print.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value<'a> {
    Integer(i64),
    Float(f64),
    Text(&'a str),
}

const LONGEST: usize = 400;

impl Format {
    /// Parses a format with exactly one conversion out of d i u x o, e f g (and capitals), s.
    ///
    /// # Errors
    /// A sentence that says what is wrong.
    pub fn parse(text: &str) -> Result<Format, String> {
        let mut all = Format::parse_line(text)?;
        match all.len() {
            1 => Ok(all.remove(0)),
            n => Err(format!(
                "expected one conversion like %g in `{text}`, found {n}"
            )),
        }
    }

    /// Parses a format with any number of conversions; text after a conversion belongs to it.
    pub fn parse_line(text: &str) -> Result<Vec<Format>, String> {
        let mut found: Vec<Format> = Vec::new();
        let mut before = String::new();
        let mut chars = text.chars().peekable();
        while let Some(c) = chars.next() {
            if c != '%' {
                match found.last_mut() {
                    Some(f) => f.after.push(c),
                    None => before.push(c),
                }
                continue;
            }
            if chars.peek() == Some(&'%') {
                chars.next();
                match found.last_mut() {
                    Some(f) => f.after.push('%'),
                    None => before.push('%'),
                }
                continue;
            }
            let mut f = Format {
                before: std::mem::take(&mut before),
                after: String::new(),
                left: false,
                plus: false,
                space: false,
                alternate: false,
                zero: false,
                width: 0,
                precision: None,
                conversion: 'g',
            };
            while let Some(&c) = chars.peek() {
                match c {
                    '-' => f.left = true,
                    '+' => f.plus = true,
                    ' ' => f.space = true,
                    '#' => f.alternate = true,
                    '0' => f.zero = true,
                    _ => break,
                }
                chars.next();
            }
            f.width = number(&mut chars, text)?.unwrap_or(0);
            if chars.peek() == Some(&'.') {
                chars.next();
                f.precision = Some(number(&mut chars, text)?.unwrap_or(0));
            }
            while chars.peek().is_some_and(|c| "lhjztqL".contains(*c)) {
                chars.next();
            }
            f.conversion = match chars.next() {
                Some(c) if "diuxXoeEfFgGs".contains(c) => c,
                Some(c) => {
                    return Err(format!(
                        "`%{c}` in `{text}` is not a conversion: use d, e, f, g or s"
                    ));
                }
                None => {
                    return Err(format!(
                        "`{text}` ends within a conversion: use d, e, f, g or s"
                    ));
                }
            };
            found.push(f);
        }
        Ok(found)
    }

    /// Takes off the one blank after the conversion: lines are joined with blanks.
    #[must_use]
    pub fn without_following_blank(mut self) -> Self {
        if self.after.ends_with(' ') {
            self.after.pop();
        }
        self
    }

    pub fn is_integer(&self) -> bool {
        "diuxXo".contains(self.conversion)
    }

    pub fn is_float(&self) -> bool {
        "eEfFgG".contains(self.conversion)
    }

    pub fn is_text(&self) -> bool {
        self.conversion == 's'
    }

    /// Formats a value; numbers are converted to what the conversion wants.
    pub fn print(&self, value: Value) -> String {
        let (negative, digits) = match value {
            _ if self.is_text() => {
                let text = match value {
                    Value::Text(t) => t.to_string(),
                    Value::Integer(i) => i.to_string(),
                    Value::Float(x) => general(x, 6, false),
                };
                let cut = self.precision.unwrap_or(usize::MAX);
                return self.pad("", &text.chars().take(cut).collect::<String>(), false);
            }
            Value::Text(t) => return self.pad("", t, false),
            Value::Integer(i) if self.is_float() => self.float(i as f64),
            Value::Integer(i) => self.integer(i),
            Value::Float(x) if self.is_float() => self.float(x),
            Value::Float(x) => self.integer(x as i64),
        };
        let sign = if negative {
            "-"
        } else if self.plus {
            "+"
        } else if self.space {
            " "
        } else {
            ""
        };
        let numeric = digits.starts_with(|c: char| c.is_ascii_digit());
        self.pad(
            sign,
            &digits,
            self.zero && numeric && !(self.is_integer() && self.precision.is_some()),
        )
    }

    fn integer(&self, i: i64) -> (bool, String) {
        let digits = match self.conversion {
            'x' => format!("{i:x}"),
            'X' => format!("{i:X}"),
            'o' => format!("{i:o}"),
            _ => i.unsigned_abs().to_string(),
        };
        (
            i < 0 && "di".contains(self.conversion),
            format!("{digits:0>w$}", w = self.precision.unwrap_or(1)),
        )
    }

    fn float(&self, x: f64) -> (bool, String) {
        let digits = if x.is_nan() {
            "nan".to_string()
        } else if x.is_infinite() {
            "inf".to_string()
        } else {
            let p = self.precision.unwrap_or(6);
            match self.conversion.to_ascii_lowercase() {
                'e' => exponential(x.abs(), p),
                'f' => format!("{:.p$}", x.abs()),
                _ => general(x.abs(), p, self.alternate),
            }
        };
        let upper = self.conversion.is_ascii_uppercase();
        (
            x.is_sign_negative() && !x.is_nan(),
            if upper { digits.to_uppercase() } else { digits },
        )
    }

    fn pad(&self, sign: &str, digits: &str, zero: bool) -> String {
        let fill = self
            .width
            .saturating_sub(sign.chars().count() + digits.chars().count());
        let mut out = self.before.clone();
        if !self.left && !zero {
            out.extend(std::iter::repeat_n(' ', fill));
        }
        out.push_str(sign);
        if !self.left && zero {
            out.extend(std::iter::repeat_n('0', fill));
        }
        out.push_str(digits);
        if self.left {
            out.extend(std::iter::repeat_n(' ', fill));
        }
        out.push_str(&self.after);
        out
    }
}

fn number(
    chars: &mut std::iter::Peekable<std::str::Chars>,
    text: &str,
) -> Result<Option<usize>, String> {
    let mut value = None;
    while let Some(d) = chars.peek().and_then(|c| c.to_digit(10)) {
        chars.next();
        let next = value.unwrap_or(0) * 10 + d as usize;
        if next > LONGEST {
            return Err(format!("width or precision in `{text}` is above {LONGEST}"));
        }
        value = Some(next);
    }
    Ok(value)
}

/// `%.{p}e` of a finite number.
fn exponential(x: f64, p: usize) -> String {
    let text = format!("{x:.p$e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let (sign, digits) = match exponent.strip_prefix('-') {
        Some(d) => ('-', d),
        None => ('+', exponent),
    };
    format!("{mantissa}e{sign}{digits:0>2}")
}

/// `%.{p}g` of a finite number.
pub fn general(x: f64, p: usize, alternate: bool) -> String {
    let p = p.max(1);
    let text = format!("{x:.w$e}", w = p - 1);
    let exponent: i32 = text
        .split_once('e')
        .and_then(|(_, e)| e.parse().ok())
        .unwrap_or(0);
    let plain = exponent >= -4 && i64::from(exponent) < p as i64;
    let shown = if plain {
        format!(
            "{x:.w$}",
            w = (p as i64 - 1 - i64::from(exponent)).max(0) as usize
        )
    } else {
        exponential(x, p - 1)
    };
    if alternate || !shown.contains('.') {
        return shown;
    }
    let (mantissa, tail) = match shown.find('e') {
        Some(e) => shown.split_at(e),
        None => (shown.as_str(), ""),
    };
    format!(
        "{}{tail}",
        mantissa.trim_end_matches('0').trim_end_matches('.')
    )
}

/// The number that its text with 15 digits stands for; nothing is allocated.
pub fn round_to_fifteen(x: f64) -> f64 {
    /// Room for `-1.23456789012345e-308`.
    #[derive(Default)]
    struct Short {
        bytes: [u8; 32],
        len: usize,
    }
    impl std::fmt::Write for Short {
        fn write_str(&mut self, s: &str) -> std::fmt::Result {
            let end = self.len + s.len();
            let room = self.bytes.get_mut(self.len..end).ok_or(std::fmt::Error)?;
            room.copy_from_slice(s.as_bytes());
            self.len = end;
            Ok(())
        }
    }
    let mut text = Short::default();
    if std::fmt::Write::write_fmt(&mut text, format_args!("{x:.14e}")).is_err() {
        return x;
    }
    let text = std::str::from_utf8(&text.bytes[..text.len]).ok();
    text.and_then(|t| t.parse().ok()).unwrap_or(x)
}

/// `%.15g`: how LAMMPS turns the value of a variable into text, also inside other formulas.
pub fn fifteen(x: f64) -> String {
    if x.is_finite() {
        general(x, 15, false)
    } else {
        Format::parse("%g")
            .map(|f| f.print(Value::Float(x)))
            .unwrap_or_default()
    }
}

/// Shortest decimal that reads back as `x`, laid out as LAMMPS's `write_data` does.
pub fn shortest(x: f64) -> String {
    if !x.is_finite() {
        return fifteen(x);
    }
    let text = format!("{x:e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let e: i32 = exponent.parse().unwrap_or(0);
    if (-4..16).contains(&e) {
        format!("{x}")
    } else {
        let sign = if e < 0 { '-' } else { '+' };
        format!("{mantissa}e{sign}{:0>2}", e.abs())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn p(format: &str, x: f64) -> String {
        Format::parse(format).unwrap().print(Value::Float(x))
    }

    /// Expected texts are glibc's.
    #[test]
    fn prints_as_c_does() {
        for (format, x, text) in [
            ("%g", 0.0, "0"),
            ("%g", -0.001, "-0.001"),
            ("%g", 0.0001, "0.0001"),
            ("%g", 0.00001, "1e-05"),
            ("%g", 123456.0, "123456"),
            ("%g", 1234567.0, "1.23457e+06"),
            ("%g", 999999.5, "1e+06"),
            ("%g", 100000.0, "100000"),
            ("%#g", 1.0, "1.00000"),
            ("%.0g", 15.0, "2e+01"),
            ("%.17g", 0.1, "0.10000000000000001"),
            ("%.20g", 0.1 + 0.2, "0.30000000000000004441"),
            ("%-10.5f|", 2.5, "2.50000   |"),
            ("%10.3e", -12345.678, "-1.235e+04"),
            ("%+d", 3.0, "+3"),
            ("%05d", -42.0, "-0042"),
            ("%5.3d", 7.0, "  007"),
            ("% -14.8g", 28119739e19, " 2.8119739e+26"),
            ("% -14.8g", 0.0, " 0            "),
            ("%08.3f", -1.5, "-001.500"),
            ("%E", 1.0, "1.000000E+00"),
            ("%g", f64::INFINITY, "inf"),
            ("%08g", f64::NEG_INFINITY, "    -inf"),
            ("%g", f64::NAN, "nan"),
            ("%x", 255.0, "ff"),
            ("a%%b%.1fc%%", 1.25, "a%b1.2c%"),
            ("%.3f", -0.000499, "-0.000"),
            ("%e", 1e-320, "9.999889e-321"),
            ("%20.15e", 2200.0, "2.200000000000000e+03"),
        ] {
            assert_eq!(p(format, x), text, "{format} of {x}");
        }
    }

    #[test]
    fn refuses_other_formats() {
        for bad in ["%", "%5", "%q", "%n", "", "plain", "%g %g", "%999999g"] {
            assert!(Format::parse(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn shortest_reads_back() {
        for (x, text) in [
            (1.25e-10, "1.25e-10"),
            (2200.0, "2200"),
            (-0.0009991999999999994, "-0.0009991999999999994"),
            (1e-6, "1e-06"),
            (0.0, "0"),
            (1e16, "1e+16"),
            (1e15, "1000000000000000"),
        ] {
            assert_eq!(shortest(x), text);
        }
    }
}
