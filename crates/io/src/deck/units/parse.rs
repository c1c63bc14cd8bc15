//! Numbers with units, as text.

use super::Dim;
use super::table::{Unit, named, unknown};
use peridyne::expression::Misfit;
use std::ops::Range;
use std::time::Duration;

/// A unit such as `kg/m^3`, `N/m²`, `J/m^2/s`, `eV/Å^3`, `kg/m3`; each `/` divides by what follows it only.
pub fn unit(text: &str) -> Result<Unit, String> {
    const LARGE: &str = "the powers of the unit are too large";
    let text = text
        .replace('²', "^2")
        .replace('³', "^3")
        .replace("**", "^")
        .replace('·', "*");
    let (mut product, mut sign) = (Unit::new(1.0, 0, Dim::NUMBER), 1i8);
    let mut rest = text.trim();
    loop {
        let length = rest
            .find(|c: char| !(c.is_alphabetic() || c == '%'))
            .unwrap_or(rest.len());
        let name = &rest[..length];
        if name.is_empty() {
            return Err(if rest.is_empty() {
                "a unit is missing".into()
            } else {
                format!("`{rest}` is not a unit")
            });
        }
        let factor = named(name).ok_or_else(|| unknown(name))?;
        rest = rest[length..].trim_start();
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

/// A time on the clock of the machine, `10 min`, `47 h`, `90 s`, in any system of units.
///
/// # Errors
/// It is none, or not above 0.
pub fn clock_time(text: &str) -> Result<Duration, String> {
    let end = text.find(|c: char| c.is_alphabetic() && c != 'e' && c != 'E');
    let (number, name) = text.split_at(end.unwrap_or(text.len()));
    let none = || format!("`{text}` is no time, expected a number and s, min or h");
    let number: f64 = number.trim().parse().map_err(|_| none())?;
    let unit = unit(name).map_err(|_| none())?;
    if unit.dim != Dim::TIME {
        return Err(none());
    }
    let time = Duration::try_from_secs_f64(unit.si(number)).map_err(|_| none())?;
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
        let unit = &text[at..at + end(|c| c.is_alphabetic() || c == '%')];
        let whole = &text[at..at + end(|c| c.is_alphanumeric() || c == '_' || c == '%')];
        let called = text[at + whole.len()..].trim_start().starts_with('(');
        (unit, whole, called)
    };
    let usable = |at: usize| {
        let (unit, whole, called) = names(at);
        !called && !taken(whole) && named(unit).is_some()
    };
    let mut at = skip(0);
    let start = at;
    if text[at..].starts_with('/') {
        // 50/s
        if !usable(skip(at + 1)) {
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
        at += names(at).0.len();
        let explicit = skip(at);
        if text[explicit..].starts_with('^') {
            at = skip(explicit + 1);
            at += usize::from(text[at..].starts_with('-'));
        }
        at += text[at..]
            .find(|c: char| !(c.is_ascii_digit() || c == '²' || c == '³'))
            .unwrap_or(text.len() - at);
        let next = skip(at);
        let after = match text[next..].chars().next() {
            Some(operator) if "/*·".contains(operator) => skip(next + operator.len_utf8()),
            _ => next,
        };
        if !usable(after) {
            break;
        }
        at = next;
    }
    let written = match text[start..at].strip_prefix('/') {
        Some(below) => unit(below).map(|u| u.power(-1)),
        None => unit(&text[start..at]).map(Some),
    };
    match written {
        Ok(Some(unit)) => Ok(Some((at, unit))),
        Ok(None) => Ok(None),
        Err(message) => Err((
            start..at,
            Misfit {
                message,
                help: None,
            },
        )),
    }
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
    let unit_like = rest.is_empty() || rest.starts_with(|c: char| c.is_alphabetic() || c == '%');
    unit_like.then_some((value, rest))
}
