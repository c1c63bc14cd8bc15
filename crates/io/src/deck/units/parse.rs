//! Numbers with units, as text.

use super::Dim;
use super::table::{Unit, named, unknown};

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
