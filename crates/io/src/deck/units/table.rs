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

pub(super) fn named(name: &str) -> Option<Unit> {
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

/// What to say about a name that is no unit.
pub(super) fn unknown(name: &str) -> String {
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
        None => format!(
            "unknown unit `{name}`; known are m, g, s, N, Pa, J, W, Hz, eV, K, bar with prefixes f to T, and Å, inch, min, h, t, u, mol, l, atm, psi, %"
        ),
    }
}
