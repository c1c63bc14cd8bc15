//! Units: what `"14.9 GPa"` is in a unit system.

use schemars::JsonSchema;
use serde::Deserialize;
use std::fmt;

/// Exponents of length, mass and time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dim(pub [i8; 3]);

impl Dim {
    pub const NUMBER: Dim = Dim([0, 0, 0]);
    pub const LENGTH: Dim = Dim([1, 0, 0]);
    pub const AREA: Dim = Dim([2, 0, 0]);
    pub const VOLUME: Dim = Dim([3, 0, 0]);
    pub const MASS: Dim = Dim([0, 1, 0]);
    pub const TIME: Dim = Dim([0, 0, 1]);
    pub const VELOCITY: Dim = Dim([1, 0, -1]);
    pub const DENSITY: Dim = Dim([-3, 1, 0]);
    pub const FORCE: Dim = Dim([1, 1, -2]);
    pub const ENERGY: Dim = Dim([2, 1, -2]);
    pub const PRESSURE: Dim = Dim([-1, 1, -2]);
    pub const FRACTURE_ENERGY: Dim = Dim([0, 1, -2]);
    pub const FORCE_DENSITY: Dim = Dim([-2, 1, -2]);
    pub const MICROMODULUS: Dim = Dim([-5, 1, -2]);
    pub const CONTACT_STIFFNESS: Dim = Dim([-6, 1, -2]);
    pub const INDENTER_STIFFNESS: Dim = Dim([-4, 1, -2]);
    pub const DAMPING: Dim = Dim([-3, 1, -1]);

    /// What it is called and how one would write it.
    const NAMES: &[(Dim, &str, &str)] = &[
        (Dim::NUMBER, "a plain number", "0.25"),
        (Dim::LENGTH, "a length", "0.5 mm"),
        (Dim::AREA, "an area", "2 mm^2"),
        (Dim::VOLUME, "a volume", "1 mm^3"),
        (Dim::MASS, "a mass", "2 kg"),
        (Dim::TIME, "a time", "20 us"),
        (Dim::VELOCITY, "a velocity", "100 m/s"),
        (Dim([1, 0, -2]), "an acceleration", "9.81 m/s^2"),
        (Dim([0, 0, -1]), "a frequency", "1 kHz"),
        (Dim::DENSITY, "a density", "2200 kg/m^3"),
        (Dim::FORCE, "a force", "10 N"),
        (Dim::ENERGY, "an energy", "1 J"),
        (Dim([2, 1, -3]), "a power", "1 W"),
        (Dim::PRESSURE, "a pressure", "14.9 GPa"),
        (Dim::FRACTURE_ENERGY, "an energy per area", "10 J/m^2"),
        (Dim::FORCE_DENSITY, "a force per volume", "1e6 N/m^3"),
        (
            Dim::MICROMODULUS,
            "a micromodulus (force per volume squared)",
            "1.6e22 N/m^6",
        ),
        (
            Dim::CONTACT_STIFFNESS,
            "a contact stiffness (force per volume squared and length)",
            "1e26 N/m^7",
        ),
        (
            Dim::INDENTER_STIFFNESS,
            "an indenter stiffness (force per volume and area)",
            "1e17 N/m^5",
        ),
        (
            Dim::DAMPING,
            "a damping (mass per volume and time)",
            "1e6 kg/m^3/s",
        ),
    ];

    pub fn example(self) -> Option<&'static str> {
        Dim::NAMES.iter().find(|n| n.0 == self).map(|n| n.2)
    }

    fn plus(self, other: Dim, times: i8) -> Option<Dim> {
        let mut sum = self.0;
        for (s, o) in sum.iter_mut().zip(other.0) {
            *s = s.checked_add(o.checked_mul(times)?)?;
        }
        Some(Dim(sum))
    }
}

impl fmt::Display for Dim {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match Dim::NAMES.iter().find(|n| n.0 == *self) {
            Some((_, name, _)) => f.write_str(name),
            None => write!(
                f,
                "a quantity in m^{} kg^{} s^{}",
                self.0[0], self.0[1], self.0[2]
            ),
        }
    }
}

/// What plain numbers of a deck mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum UnitSystem {
    /// m, kg, s
    #[default]
    Si,
    /// Å, ps, eV; masses in g/mol, densities in g/cm³, pressures in bar. Computed in Å, ps, eV throughout.
    Metal,
    /// Reduced units; numbers carry none.
    Lj,
    /// Any consistent units; numbers carry none.
    None,
}

const EV: f64 = 1.602176634e-19;
const AVOGADRO: f64 = 6.02214076e23;

impl UnitSystem {
    pub fn name(self) -> &'static str {
        match self {
            UnitSystem::Si => "si",
            UnitSystem::Metal => "metal",
            UnitSystem::Lj => "lj",
            UnitSystem::None => "none",
        }
    }

    /// Whether numbers may carry units.
    pub fn has_units(self) -> bool {
        matches!(self, UnitSystem::Si | UnitSystem::Metal)
    }

    /// SI value of the unit in which quantities of this dimension are computed.
    fn computed(self, dim: Dim) -> f64 {
        match self {
            // powers of one number each, so that an energy is one eV to the last digit
            UnitSystem::Metal => {
                let [length, mass, time] = dim.0.map(i32::from);
                EV.powi(mass) * 1e-10f64.powi(length - 2 * mass) * 1e-12f64.powi(time + 2 * mass)
            }
            _ => 1.0,
        }
    }

    /// SI value of the unit that a plain number of this dimension has.
    fn plain(self, dim: Dim) -> f64 {
        match (self, dim) {
            (UnitSystem::Metal, Dim::MASS) => 1e-3 / AVOGADRO,
            (UnitSystem::Metal, Dim::DENSITY) => 1e3,
            (UnitSystem::Metal, Dim::PRESSURE) => 1e5,
            _ => self.computed(dim),
        }
    }

    /// Factor from plain numbers to computed ones.
    pub fn plain_factor(self, dim: Dim) -> f64 {
        let (plain, computed) = (self.plain(dim), self.computed(dim));
        if plain == computed {
            1.0
        } else {
            plain / computed
        }
    }

    /// Factor from SI to the unit that a plain number has.
    pub fn from_si(self, dim: Dim) -> f64 {
        1.0 / self.plain(dim)
    }

    /// A computed value as text with its unit.
    pub fn write(self, value: f64, dim: Dim) -> String {
        let si = value * self.computed(dim);
        let (scaled, unit): (f64, &str) = match (self, dim) {
            (UnitSystem::Lj | UnitSystem::None, _) | (_, Dim::NUMBER) => (value, ""),
            (UnitSystem::Metal, Dim::LENGTH) => (value, "Å"),
            (UnitSystem::Metal, Dim::TIME) => (value, "ps"),
            (UnitSystem::Metal, Dim::ENERGY) => (value, "eV"),
            (UnitSystem::Metal, Dim::VELOCITY) => (value, "Å/ps"),
            (_, Dim::DENSITY) if self == UnitSystem::Metal => (si * 1e-3, "g/cm^3"),
            (_, Dim::LENGTH) => engineering(si, "m"),
            (_, Dim::TIME) => engineering(si, "s"),
            (_, Dim::PRESSURE) => engineering(si, "Pa"),
            (_, Dim::AREA) => (si, "m^2"),
            (_, Dim::MASS) => (si, "kg"),
            (_, Dim::VELOCITY) => (si, "m/s"),
            (_, Dim::DENSITY) => (si, "kg/m^3"),
            (_, Dim::FRACTURE_ENERGY) => (si, "J/m^2"),
            (_, Dim::MICROMODULUS) => (si, "N/m^6"),
            (_, Dim::CONTACT_STIFFNESS) => (si, "N/m^7"),
            (_, Dim::INDENTER_STIFFNESS) => (si, "N/m^5"),
            _ => (si, "SI"),
        };
        let number = short(scaled);
        if unit.is_empty() {
            number
        } else {
            format!("{number} {unit}")
        }
    }
}

/// A number in six digits, without trailing zeros.
pub(super) fn short(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    if (1e-3..1e6).contains(&rounded.abs()) {
        format!("{rounded}")
    } else {
        format!("{rounded:e}")
    }
}

fn engineering(si: f64, unit: &'static str) -> (f64, &'static str) {
    let table: &[(f64, &str)] = match unit {
        "m" => &[(1.0, "m"), (1e-3, "mm"), (1e-6, "µm"), (1e-9, "nm")],
        "s" => &[
            (1.0, "s"),
            (1e-3, "ms"),
            (1e-6, "µs"),
            (1e-9, "ns"),
            (1e-12, "ps"),
        ],
        _ => &[(1e9, "GPa"), (1e6, "MPa"), (1e3, "kPa"), (1.0, "Pa")],
    };
    let (scale, name) = *table
        .iter()
        .find(|(s, _)| si.abs() >= s * 0.0999)
        .unwrap_or(&table[table.len() - 1]);
    (si / scale, name)
}

/// A unit: `scale · 10^ten` in SI. Powers of ten are kept apart so that "0.5 mm" is the number 0.0005 and not its
/// neighbour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    scale: f64,
    ten: i32,
    pub dim: Dim,
}

impl Unit {
    const fn new(scale: f64, ten: i32, dim: Dim) -> Unit {
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

    fn power(self, power: i8) -> Option<Unit> {
        let dim = Dim::NUMBER.plus(self.dim, power)?;
        Some(Unit {
            scale: self.scale.powi(i32::from(power)),
            ten: self.ten * i32::from(power),
            dim,
        })
    }

    fn times(self, other: Unit) -> Option<Unit> {
        Some(Unit {
            scale: self.scale * other.scale,
            ten: self.ten.checked_add(other.ten)?,
            dim: self.dim.plus(other.dim, 1)?,
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
    ("W", Unit::new(1.0, 0, Dim([2, 1, -3]))),
    ("Hz", Unit::new(1.0, 0, Dim([0, 0, -1]))),
    ("eV", Unit::new(1.602176634, -19, Dim::ENERGY)),
    ("bar", Unit::new(1.0, 5, Dim::PRESSURE)),
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
    ("l", Unit::new(1.0, -3, Dim::VOLUME)),
    ("atm", Unit::new(1.01325, 5, Dim::PRESSURE)),
    ("psi", Unit::new(6894.757293168, 0, Dim::PRESSURE)),
    ("%", Unit::new(1.0, -2, Dim::NUMBER)),
];

fn named(name: &str) -> Option<Unit> {
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

fn unknown(name: &str) -> String {
    let prefixed = PREFIXES
        .iter()
        .flat_map(|(p, _)| PREFIXED.iter().map(move |u| format!("{p}{}", u.0)));
    let plain = PREFIXED.iter().chain(OTHERS).map(|u| u.0.to_string());
    let lower = name.to_lowercase();
    // a wrong case is the commonest slip: mpa, gpa, hz
    let near = plain
        .chain(prefixed)
        .find(|known| known.to_lowercase() == lower);
    match near {
        Some(near) => format!("unknown unit `{name}`, did you mean `{near}`?"),
        None => format!(
            "unknown unit `{name}`; known are m, g, s, N, Pa, J, W, Hz, eV, bar with prefixes f to T, and Å, inch, min, h, t, u, mol, l, atm, psi, %"
        ),
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

#[cfg(test)]
mod tests {
    use super::*;

    fn is(text: &str, value: f64, dim: Dim) {
        let (number, unit_text) = split(text).unwrap_or_else(|| panic!("{text}"));
        let unit = unit(unit_text).unwrap_or_else(|e| panic!("{text}: {e}"));
        assert_eq!(unit.dim, dim, "{text}");
        // decimal shifts are exact
        let bound = if unit.scale == 1.0 {
            0.0
        } else {
            1e-14 * value.abs()
        };
        assert!(
            (unit.si(number) - value).abs() <= bound,
            "{text}: {}",
            unit.si(number)
        );
    }

    #[test]
    fn units_are_what_they_say() {
        is("14.9 GPa", 14.9e9, Dim::PRESSURE);
        is("0.5mm", 0.5e-3, Dim::LENGTH);
        is("100 m/s", 100.0, Dim::VELOCITY);
        is("2200 kg/m^3", 2200.0, Dim::DENSITY);
        is("2.2 g/cm³", 2200.0, Dim::DENSITY);
        is("2.2 g/cm3", 2200.0, Dim::DENSITY);
        is("5 N/m^2", 5.0, Dim::PRESSURE);
        is("5 N m^-2", 5.0, Dim::PRESSURE);
        is("10 J/m^2", 10.0, Dim::FRACTURE_ENERGY);
        is("10 kN/m", 1e4, Dim::FRACTURE_ENERGY);
        is("100 ns", 1e-7, Dim::TIME);
        is("-3 µs", -3e-6, Dim::TIME);
        is("58.69 g/mol", 58.69e-3 / AVOGADRO, Dim::MASS);
        is("1 eV/Å^3", EV / 1e-30, Dim::PRESSURE);
        is("5 %", 0.05, Dim::NUMBER);
        is("1e17 N/m^5", 1e17, Dim::INDENTER_STIFFNESS);
        is("1e6 kg/m^3/s", 1e6, Dim::DAMPING);
    }

    #[test]
    fn what_is_no_unit_says_so() {
        assert!(unit("gpa").unwrap_err().contains("did you mean `GPa`"));
        assert!(unit("furlong").unwrap_err().contains("unknown unit"));
        assert!(unit("m/").unwrap_err().contains("missing"));
        assert!(unit("m^x").unwrap_err().contains("whole number"));
        assert!(unit("m^99").unwrap_err().contains("-9 to 9"));
        assert!(split("2*x").is_none() && split("x").is_none() && split("-t").is_none());
        assert_eq!(split("1e-3"), Some((1e-3, "")));
    }

    #[test]
    fn metal_numbers_become_consistent() {
        let metal = UnitSystem::Metal;
        // 1 bar = 6.2415e-7 eV/Å³, 1 g/mol = 1.0364e-4 eV ps²/Å²
        assert!((metal.plain_factor(Dim::PRESSURE) - 6.241509074e-7).abs() < 1e-15);
        assert!((metal.plain_factor(Dim::MASS) - 1.036426966e-4).abs() < 1e-12);
        assert_eq!(metal.plain_factor(Dim::LENGTH), 1.0);
        assert_eq!(metal.plain_factor(Dim::ENERGY), 1.0);
        assert!((metal.from_si(Dim::ENERGY) * EV - 1.0).abs() < 1e-15);
    }

    #[test]
    fn values_are_written_with_their_units() {
        assert_eq!(UnitSystem::Si.write(14.9e9, Dim::PRESSURE), "14.9 GPa");
        assert_eq!(UnitSystem::Si.write(0.0005, Dim::LENGTH), "0.5 mm");
        assert_eq!(UnitSystem::Si.write(1e-7, Dim::TIME), "0.1 µs");
        assert_eq!(UnitSystem::None.write(0.25, Dim::LENGTH), "0.25");
    }
}
