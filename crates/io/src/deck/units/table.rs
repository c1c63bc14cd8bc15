//! The units that are known.

use super::system::AVOGADRO;

use super::Dim;
use peridyne::quantity;

/// A unit: `scale · 10^ten` in SI. Powers of ten are kept apart so that "0.5 mm" is the number 0.0005 and not its
/// neighbour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    pub(super) scale: f64,
    ten: i32,
    pub dim: Dim,
}

impl Unit {
    pub(super) const fn new(scale: f64, ten: i32, dim: Dim) -> Unit {
        Unit { scale, ten, dim }
    }

    /// SI value of so many of it.
    pub fn si(self, value: f64) -> f64 {
        let text = format!("{value:e}");
        let shifted = text.split_once('e').and_then(|(digits, exponent)| {
            let exponent: i32 = exponent.parse().ok()?;
            format!("{digits}e{}", exponent + self.ten).parse().ok()
        });
        // infinities have no exponent
        shifted.unwrap_or(value) * self.scale
    }

    pub(super) fn power(self, power: i8) -> Option<Unit> {
        let dim = Dim::NUMBER.times(self.dim, power)?;
        Some(Unit {
            scale: quantity::power(self.scale, i32::from(power)),
            ten: self.ten * i32::from(power),
            dim,
        })
    }

    pub(super) fn times(self, other: Unit) -> Option<Unit> {
        Some(Unit {
            scale: self.scale * other.scale,
            ten: self.ten.checked_add(other.ten)?,
            dim: self.dim.times(other.dim, 1)?,
        })
    }
}

/// Units that take SI prefixes.
const PREFIXED: &[(&str, Unit)] = &[
    ("m", Unit::new(1.0, 0, Dim::LENGTH)),
    ("g", Unit::new(1.0, -3, Dim::MASS)),
    ("s", Unit::new(1.0, 0, Dim::TIME)),
    ("N", Unit::new(1.0, 0, Dim::FORCE)),
    ("Pa", Unit::new(1.0, 0, Dim::PRESSURE)),
    ("J", Unit::new(1.0, 0, Dim::ENERGY)),
    ("W", Unit::new(1.0, 0, Dim::POWER)),
    ("Hz", Unit::new(1.0, 0, Dim::FREQUENCY)),
    ("eV", Unit::new(1.602176634, -19, Dim::ENERGY)),
    ("K", Unit::new(1.0, 0, Dim::TEMPERATURE)),
    ("bar", Unit::new(1.0, 5, Dim::PRESSURE)),
    ("cal", Unit::new(4.184, 0, Dim::ENERGY)),
    ("rad", Unit::new(1.0, 0, Dim::NUMBER)),
    ("l", Unit::new(1.0, -3, Dim::VOLUME)),
];

/// Powers of ten; both signs for micro.
const PREFIXES: &[(&str, i32)] = &[
    ("f", -15),
    ("p", -12),
    ("n", -9),
    ("u", -6),
    ("\u{b5}", -6),
    ("\u{3bc}", -6),
    ("m", -3),
    ("c", -2),
    ("k", 3),
    ("M", 6),
    ("G", 9),
    ("T", 12),
];

/// Units without prefixes; both signs for ångström.
const OTHERS: &[(&str, Unit)] = &[
    ("\u{c5}", Unit::new(1.0, -10, Dim::LENGTH)),
    ("\u{212b}", Unit::new(1.0, -10, Dim::LENGTH)),
    ("angstrom", Unit::new(1.0, -10, Dim::LENGTH)),
    ("inch", Unit::new(2.54, -2, Dim::LENGTH)),
    ("min", Unit::new(6.0, 1, Dim::TIME)),
    ("h", Unit::new(3.6, 3, Dim::TIME)),
    ("t", Unit::new(1.0, 3, Dim::MASS)),
    ("u", Unit::new(1e-3 / AVOGADRO, 0, Dim::MASS)),
    ("mol", Unit::new(6.02214076, 23, Dim::NUMBER)),
    ("atm", Unit::new(1.01325, 5, Dim::PRESSURE)),
    ("psi", Unit::new(6894.757293168, 0, Dim::PRESSURE)),
    ("ksi", Unit::new(6.894757293168, 6, Dim::PRESSURE)),
    ("lbf", Unit::new(4.4482216152605, 0, Dim::FORCE)),
    ("in", Unit::new(2.54, -2, Dim::LENGTH)),
    ("ft", Unit::new(3.048, -1, Dim::LENGTH)),
    ("deg", Unit::new(DEGREE, 0, Dim::NUMBER)),
    ("\u{b0}", Unit::new(DEGREE, 0, Dim::NUMBER)),
    ("%", Unit::new(1.0, -2, Dim::NUMBER)),
];

const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// Degrees Celsius. As a factor of a unit (`W/m/degC`) one is a kelvin; alone it has another zero, which no factor says.
const CELSIUS: [&str; 3] = ["degC", "\u{b0}C", "\u{2103}"];

/// What has another zero than the kelvin, alone.
pub(super) fn is_celsius(name: &str) -> bool {
    CELSIUS.contains(&name)
}

/// Names that are no units here, and what is written instead.
const INSTEAD: [(&[&str], &str); 6] = [
    (
        &["degF", "\u{b0}F", "\u{2109}", "F"],
        "write kelvin: 68 \u{b0}F are (68 + 459.67)/1.8 K = 293.15 K",
    ),
    (
        &["C", "celsius", "Celsius"],
        "degrees Celsius are written degC",
    ),
    (
        &["rpm"],
        "write radians per time: 1 rpm is 0.1047197551 rad/s",
    ),
    (&["Hertz", "hertz"], "write Hz"),
    (
        &["lb", "lbs"],
        "write 0.45359237 kg for a mass, 1 lbf for a force",
    ),
    (&["kgf"], "write 9.80665 N"),
];

/// May this character stand in the name of a unit?
pub(super) fn in_name(c: char) -> bool {
    c.is_alphabetic() || ['%', '\u{b0}', '\u{2103}', '\u{2109}'].contains(&c)
}

pub(super) fn named(name: &str) -> Option<Unit> {
    if is_celsius(name) {
        return Some(Unit::new(1.0, 0, Dim::TEMPERATURE));
    }
    let exact = PREFIXED.iter().chain(OTHERS).find(|u| u.0 == name);
    exact.map(|u| u.1).or_else(|| {
        PREFIXES.iter().find_map(|(prefix, ten)| {
            let rest = name.strip_prefix(prefix)?;
            PREFIXED.iter().find(|u| u.0 == rest).map(|u| Unit {
                ten: u.1.ten + ten,
                ..u.1
            })
        })
    })
}

/// `N m` where the blank between both was forgotten: a force, pressure, energy or power, times a length or a time.
fn two(name: &str) -> Option<String> {
    let wide = [Dim::FORCE, Dim::PRESSURE, Dim::ENERGY, Dim::POWER];
    let narrow = [Dim::LENGTH, Dim::TIME];
    let each = name.char_indices().skip(1).find_map(|(i, _)| {
        let (left, right) = name.split_at(i);
        let fits = wide.contains(&named(left)?.dim) && narrow.contains(&named(right)?.dim);
        fits.then(|| format!("{left} {right}"))
    });
    each.filter(|_| name.len() < 8)
}

/// All units in a sentence.
pub fn known() -> String {
    let names = |all: &[(&'static str, Unit)]| {
        // of several ways to write the same the first
        let mut kept: Vec<&str> = vec![];
        for (n, (name, unit)) in all.iter().enumerate() {
            if all[..n].iter().all(|(_, other)| other != unit) {
                kept.push(name);
            }
        }
        kept.join(", ")
    };
    format!(
        "{} with prefixes f to T, and {}, degC",
        names(PREFIXED),
        names(OTHERS)
    )
}

/// What to say about a name that is no unit.
pub(super) fn unknown(name: &str) -> String {
    if let Some((_, help)) = INSTEAD.iter().find(|(names, _)| names.contains(&name)) {
        return format!("`{name}` is no unit here: {help}");
    }
    if let Some(two) = two(name) {
        return format!("unknown unit `{name}`: units are parted by a blank, `{two}`");
    }
    let prefixed = PREFIXES
        .iter()
        .flat_map(|(p, _)| PREFIXED.iter().map(move |u| format!("{p}{}", u.0)));
    let plain = PREFIXED.iter().chain(OTHERS).map(|u| u.0.to_string());
    let lower = name.to_lowercase();
    // a wrong case is the commonest slip: mpa, gpa, hz
    let same: Vec<String> = plain
        .chain(prefixed)
        .filter(|known| known.to_lowercase() == lower)
        .collect();
    // nobody means millipascals
    let near = same.iter().find(|known| *known == "MPa").or(same.first());
    match near {
        Some(near) => format!("unknown unit `{name}`, did you mean `{near}`?"),
        None => format!("unknown unit `{name}`; known are {}", known()),
    }
}
