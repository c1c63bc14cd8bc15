//! Numbers with units, as text.

use super::Dim;
use super::table::{Unit, in_name, is_celsius, named, unknown};
use peridyne::expression::Misfit;
use std::ops::Range;
use std::time::Duration;

/// A text with powers as `^`.
fn plain(text: &str) -> String {
    let mut text = text.replace("**", "^").replace('·', "*");
    for (superscript, power) in [("¹", "1"), ("²", "2"), ("³", "3")] {
        text = text.replace(&format!("⁻{superscript}"), &format!("^-{power}"));
        text = text.replace(superscript, &format!("^{power}"));
    }
    text
}

/// A unit such as `kg/m^3`, `N/m²`, `J/m^2/s`, `W/(m K)`, `1/s`, `eV/Å^3`, `kg/m3`; each `/` divides by what follows it only.
///
/// # Errors
/// What is wrong in words. Degrees Celsius alone are none: they have another zero ([`celsius`]).
pub fn unit(text: &str) -> Result<Unit, String> {
    let text = plain(text);
    match is_celsius(text.trim().trim_end_matches("^1").trim_end()) {
        true => Err(format!(
            "`{}` is taken as the whole of a temperature, \"20 degC\" (293.15 K), not in expressions, constants and differences: write K \
             there, 20 K for a difference of 20 degrees",
            text.trim()
        )),
        false => product(&text),
    }
}

/// The temperature in kelvin that a text is in degrees Celsius, `20 degC`.
pub fn celsius(text: &str) -> Option<f64> {
    let (value, unit) = split(text)?;
    is_celsius(unit.trim_end()).then_some(value + 273.15)
}

/// Factors with their powers.
fn product(text: &str) -> Result<Unit, String> {
    const LARGE: &str = "the powers of the unit are too large";
    let (mut product, mut sign) = (Unit::new(1.0, 0, Dim::NUMBER), 1i8);
    let mut rest = text.trim();
    let below = rest.strip_prefix('1').map(str::trim_start);
    if let Some(below) = below.and_then(|b| b.strip_prefix('/')) {
        (sign, rest) = (-1, below.trim_start());
    }
    loop {
        let (factor, name);
        if let Some(inside) = rest.strip_prefix('(') {
            let closed = inside.split_once(')');
            let (inner, after) = closed.ok_or("a bracket of the unit is not closed")?;
            (factor, name) = (self::product(inner)?, format!("({inner})"));
            rest = after.trim_start();
        } else {
            let length = rest.find(|c: char| !in_name(c)).unwrap_or(rest.len());
            name = rest[..length].to_string();
            if name.is_empty() {
                return Err(if rest.is_empty() {
                    "a unit is missing".into()
                } else {
                    format!("`{rest}` is not a unit")
                });
            }
            factor = named(&name).ok_or_else(|| unknown(&name))?;
            rest = rest[length..].trim_start();
        }
        let explicit = rest.strip_prefix('^').map(str::trim_start);
        let digits = explicit.unwrap_or(rest);
        let end = digits
            .char_indices()
            .find(|(i, c)| !(c.is_ascii_digit() || *i == 0 && *c == '-' && explicit.is_some()))
            .map_or(digits.len(), |(i, _)| i);
        let power: i8 = match &digits[..end] {
            "" if explicit.is_none() => 1,
            digits => match digits.parse() {
                Ok(power) if (-9..=9).contains(&power) => power,
                _ => {
                    return Err(format!(
                        "`{name}^{digits}`: the power of a unit is a whole number from -9 to 9"
                    ));
                }
            },
        };
        product = factor
            .power(sign * power)
            .and_then(|f| product.times(f))
            .ok_or(LARGE)?;
        rest = digits[end..].trim_start();
        if rest.is_empty() {
            return Ok(product);
        }
        (sign, rest) = match rest.strip_prefix('/') {
            Some(after) => (-1, after.trim_start()),
            None => (1, rest.strip_prefix('*').unwrap_or(rest).trim_start()),
        };
    }
}

/// A time on the clock of the machine, `10 min`, `23 h 50 min`, `23:50:00`, in any system of units.
///
/// # Errors
/// It is none, or not above 0.
pub fn clock_time(text: &str) -> Result<Duration, String> {
    let none = || {
        format!(
            "`{text}` is no time, expected numbers with s, min or h, such as 23 h 50 min, or 23:50:00"
        )
    };
    let (mut rest, mut seconds) = (text.trim(), 0.0);
    if rest.is_empty() {
        return Err(none());
    }
    // as queues write it
    let parts: Vec<Option<f64>> = rest
        .split(':')
        .map(|n| n.parse::<u32>().ok().map(f64::from))
        .collect();
    if let [Some(hours), Some(minutes), Some(some)] = parts[..] {
        (rest, seconds) = ("", 3600.0 * hours + 60.0 * minutes + some);
    }
    while !rest.is_empty() {
        let begin = rest.find(|c: char| c.is_alphabetic() && c != 'e' && c != 'E');
        let (number, named) = rest.split_at(begin.unwrap_or(rest.len()));
        let end = named.find(|c: char| !c.is_alphabetic());
        let (name, next) = named.split_at(end.unwrap_or(named.len()));
        let number = number.trim().parse::<f64>().ok().filter(|n| *n >= 0.0);
        let unit = unit(name).ok().filter(|unit| unit.dim == Dim::TIME);
        seconds += unit.ok_or_else(none)?.si(number.ok_or_else(none)?);
        rest = next.trim_start();
    }
    let time = Duration::try_from_secs_f64(seconds).map_err(|_| none())?;
    match time.is_zero() {
        true => Err(format!("`{text}` is no time at all")),
        false => Ok(time),
    }
}

/// The unit that stands behind a number in an expression, and its length in bytes: `" MPa * t"` begins with MPa. `taken` are
/// names of variables and constants, which are no units here, and a name with a bracket is a function.
///
/// # Errors
/// Where the name stands that is no unit, or that is a unit and something else.
pub fn prefix(
    text: &str,
    taken: &dyn Fn(&str) -> bool,
) -> Result<Option<(usize, Unit)>, (Range<usize>, Misfit)> {
    let skip = |at: usize| at + text[at..].len() - text[at..].trim_start().len();
    // the name at a place as a unit has it (m of m2), and as an expression has it
    let names = |at: usize| {
        let end =
            |wanted: fn(char) -> bool| text[at..].find(|c| !wanted(c)).unwrap_or(text.len() - at);
        let unit = &text[at..at + end(in_name)];
        let whole = &text[at..at + end(|c| c.is_alphanumeric() || c == '_' || in_name(c))];
        let called = text[at + whole.len()..].trim_start().starts_with('(');
        (unit, whole, called)
    };
    let usable = |at: usize| {
        let (unit, whole, called) = names(at);
        !called && !taken(whole) && named(unit).is_some()
    };
    // the length of a bracket that holds units alone: W/(m K)
    let group = |at: usize| {
        let (inner, _) = text[at..].strip_prefix('(')?.split_once(')')?;
        let mut words = inner.split(|c: char| !(c.is_alphanumeric() || c == '_' || in_name(c)));
        (!words.any(taken) && product(&plain(inner)).is_ok()).then_some(inner.len() + 2)
    };
    let mut at = skip(0);
    let start = at;
    // 12e-6 1/K
    let one = text[at..].strip_prefix('1').map(|_| skip(at + 1));
    at = one
        .filter(|one| text[*one..].starts_with('/'))
        .unwrap_or(at);
    if text[at..].starts_with('/') {
        // 50/s
        let below = skip(at + 1);
        if !usable(below) && group(below).is_none() {
            return Ok(None);
        }
    } else {
        let (unit, whole, called) = names(at);
        if unit.is_empty() || called {
            return Ok(None);
        }
        if taken(whole) {
            if named(unit).is_none() {
                return Ok(None);
            }
            let help = format!("write `* {whole}` for the one, and another unit for the other");
            let message = format!("`{whole}` is a unit, and a name of this deck's expressions");
            let misfit = Misfit {
                message,
                help: Some(help),
            };
            return Err((at..at + whole.len(), misfit));
        }
        if named(unit).is_none() {
            let help = Some(
                "quantities are numbers with a unit, `5 mm`; multiplication is written with `*`"
                    .into(),
            );
            let message = unknown(unit);
            return Err((at..at + unit.len(), Misfit { message, help }));
        }
    }
    loop {
        // an operator, if any, and a name that can be used
        if let Some(operator) = text[at..].chars().next().filter(|c| "/*·".contains(*c)) {
            at = skip(at + operator.len_utf8());
        }
        at += group(at).unwrap_or(names(at).0.len());
        let explicit = skip(at);
        if text[explicit..].starts_with('^') {
            at = skip(explicit + 1);
            at += usize::from(text[at..].starts_with('-'));
        }
        at += text[at..]
            .find(|c: char| !(c.is_ascii_digit() || "⁻¹²³".contains(c)))
            .unwrap_or(text.len() - at);
        let next = skip(at);
        let (after, grouped) = match text[next..].chars().next() {
            Some(operator) if "/*·".contains(operator) => {
                let after = skip(next + operator.len_utf8());
                (after, group(after).is_some())
            }
            _ => (next, false),
        };
        if !usable(after) && !grouped {
            break;
        }
        at = next;
    }
    let written = match &text[start..at] {
        below if below.starts_with('/') => unit(&format!("1{below}")),
        written => unit(written),
    };
    written.map(|unit| Some((at, unit))).map_err(|message| {
        let help = None;
        (start..at, Misfit { message, help })
    })
}

/// Splits `"14.9 GPa"` into number and unit. `None` if it does not start with a number that a unit or nothing
/// follows; then it is an expression.
pub fn split(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    let length = (1..=text.len())
        .rev()
        .filter(|&n| text.is_char_boundary(n) && n <= 40)
        .find(|&n| text[..n].parse::<f64>().is_ok() && !text[..n].ends_with(char::is_whitespace))?;
    let value = text[..length].parse().ok()?;
    let rest = text[length..].trim_start();
    let below = rest.strip_prefix('1').unwrap_or(rest).trim_start();
    let unit_like =
        rest.is_empty() || rest.starts_with(in_name) || below.starts_with('/') && below != rest;
    unit_like.then_some((value, rest))
}
