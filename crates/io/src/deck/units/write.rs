//! Values as text.

use super::{Dim, UnitSystem};

impl UnitSystem {
    /// A computed value as text with its unit.
    pub fn write(self, value: f64, dim: Dim) -> String {
        let si = value * self.computed(dim);
        let (scaled, unit): (f64, &str) = match (self, dim) {
            (UnitSystem::Lj | UnitSystem::None, _) | (_, Dim::NUMBER) => (value, ""),
            (UnitSystem::Metal(_), Dim::LENGTH) => (value, "Å"),
            (UnitSystem::Metal(_), Dim::TIME) => (value, "ps"),
            (UnitSystem::Metal(_), Dim::ENERGY) => (value, "eV"),
            (UnitSystem::Metal(_), Dim::VELOCITY) => (value, "Å/ps"),
            (_, Dim::DENSITY) if matches!(self, UnitSystem::Metal(_)) => (si * 1e-3, "g/cm^3"),
            (_, Dim::LENGTH) => engineering(si, "m"),
            (_, Dim::TIME) => engineering(si, "s"),
            (_, Dim::PRESSURE) => engineering(si, "Pa"),
            (_, Dim::AREA) => (si, "m^2"),
            (_, Dim::VOLUME) => (si, "m^3"),
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
pub(in crate::deck) fn short(value: f64) -> String {
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
    if si == 0.0 {
        return (0.0, unit);
    }
    let (scale, name) = *table
        .iter()
        .find(|(s, _)| si.abs() >= s * 0.0999)
        .unwrap_or(&table[table.len() - 1]);
    (si / scale, name)
}
