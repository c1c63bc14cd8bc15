//! Values as text.

use peridyne::quantity::{Message, rounded};

use super::system::{AVOGADRO, UnitSystem};

use super::Dim;

impl UnitSystem {
    /// A computed value as text with its unit.
    pub fn write(self, value: f64, dim: Dim) -> String {
        self.digits(value, dim, 6)
    }

    /// The same in the four digits that a reader looks at: `167.8 GPa`.
    pub fn show(self, value: f64, dim: Dim) -> String {
        self.digits(value, dim, 4)
    }

    /// What the engine says, its numbers with units.
    pub fn tell(self, message: &Message) -> String {
        message.with(|q| self.show(q.value, q.dimension))
    }

    fn digits(self, value: f64, dim: Dim, digits: usize) -> String {
        let si = value * self.computed(dim);
        // a reader likes 235.6 ns better, who writes a deck 0.1 m
        let least = if digits < 6 { 0.9995 } else { 0.0999 };
        let (scaled, unit): (f64, &str) = match (self, dim) {
            (UnitSystem::Lj | UnitSystem::None, _) | (_, Dim::NUMBER) => (value, ""),
            (UnitSystem::Metal(_), Dim::LENGTH) => (value, "Å"),
            (UnitSystem::Metal(_), Dim::TIME) => (value, "ps"),
            (UnitSystem::Metal(_), Dim::ENERGY) => (value, "eV"),
            (UnitSystem::Metal(_), Dim::VELOCITY) => (value, "Å/ps"),
            (UnitSystem::Metal(_), Dim::MASS) => (si * 1e3 * AVOGADRO, "g/mol"),
            (_, Dim::DENSITY) if matches!(self, UnitSystem::Metal(_)) => (si * 1e-3, "g/cm^3"),
            (_, Dim::LENGTH) => engineering(si, "m", least),
            (_, Dim::TIME) => engineering(si, "s", least),
            (_, Dim::PRESSURE) => engineering(si, "Pa", least),
            (_, Dim::AREA) => (si, "m^2"),
            (_, Dim::VOLUME) => (si, "m^3"),
            (_, Dim::MASS) => engineering(si, "kg", least),
            (_, Dim::VELOCITY) => (si, "m/s"),
            (_, Dim::DENSITY) => (si, "kg/m^3"),
            (_, Dim::FRACTURE_ENERGY) => (si, "J/m^2"),
            (_, Dim::MICROMODULUS) => (si, "N/m^6"),
            (_, Dim::CONTACT_STIFFNESS) => (si, "N/m^7"),
            (_, Dim::RIGID_BODY_STIFFNESS) => (si, "N/m^5"),
            _ => {
                let unit = self.unit(dim);
                return format!("{} {unit}", rounded(value, digits))
                    .trim_end()
                    .to_string();
            }
        };
        format!("{} {unit}", rounded(scaled, digits))
            .trim_end()
            .to_string()
    }
}

/// Units in which quantities of SI are written.
const SI: &[(Dim, &str)] = &[
    (Dim::NUMBER, ""),
    (Dim::VELOCITY, "m/s"),
    (Dim::ACCELERATION, "m/s^2"),
    (Dim::DENSITY, "kg/m^3"),
    (Dim::FORCE, "N"),
    (Dim::ENERGY, "J"),
    (Dim::POWER, "W"),
    (Dim::PRESSURE, "Pa"),
    (Dim::FRACTURE_ENERGY, "J/m^2"),
    (Dim::FORCE_DENSITY, "N/m^3"),
    (Dim::CONDUCTIVITY, "W/m/K"),
    (Dim::HEAT_CAPACITY, "J/kg/K"),
    (Dim::HEAT_FLUX, "W/m^2"),
    (Dim::HEAT_SOURCE, "W/m^3"),
    (Dim::HEAT_TRANSFER, "W/m^2/K"),
    (Dim::DIFFUSIVITY, "m^2/s"),
];

impl UnitSystem {
    /// The unit of a plain number of a deck; empty where numbers carry none.
    pub fn plain_unit(self, dim: Dim) -> String {
        match (self, dim) {
            (UnitSystem::Metal(_), Dim::MASS) => "g/mol".into(),
            (UnitSystem::Metal(_), Dim::DENSITY) => "g/cm^3".into(),
            (UnitSystem::Metal(_), Dim::PRESSURE) => "bar".into(),
            _ => self.unit(dim),
        }
    }

    /// The unit of a computed number of this dimension; empty where numbers carry none.
    pub fn unit(self, dim: Dim) -> String {
        self.unit_of(dim.0.map(f64::from))
    }

    /// The unit of a computed number whose square has this dimension.
    pub fn root_unit(self, dim: Dim) -> String {
        self.unit_of(dim.0.map(|e| 0.5 * f64::from(e)))
    }

    fn unit_of(self, [length, mass, time, temperature]: [f64; 4]) -> String {
        let product = |factors: &[(&str, f64)]| {
            let there = factors.iter().filter(|(_, e)| *e != 0.0);
            let power = |(name, e): &(&str, f64)| match *e == 1.0 {
                true => name.to_string(),
                false => format!("{name}^{e}"),
            };
            there.map(power).collect::<Vec<_>>().join(" ")
        };
        match self {
            UnitSystem::Lj | UnitSystem::None => String::new(),
            // one eV is Å² ps⁻² of a mass
            UnitSystem::Metal(_) => product(&[
                ("eV", mass),
                ("Å", length - 2.0 * mass),
                ("ps", time + 2.0 * mass),
                ("K", temperature),
            ]),
            UnitSystem::Si => {
                let exponents = [length, mass, time, temperature];
                let named = SI.iter().find(|(dim, _)| dim.0.map(f64::from) == exponents);
                match (named, mass, time, temperature) {
                    (Some((_, name)), _, _, _) => name.to_string(),
                    // what is left of a pressure: Pa m^0.5
                    (None, 1.0, -2.0, 0.0) => product(&[("Pa", 1.0), ("m", length + 1.0)]),
                    (None, _, _, _) => {
                        product(&[("kg", mass), ("m", length), ("s", time), ("K", temperature)])
                    }
                }
            }
        }
    }
}

/// A number in six digits, without trailing zeros.
pub(in crate::deck) fn short(value: f64) -> String {
    rounded(value, 6)
}

/// In the largest unit of which it is so much at least.
fn engineering(si: f64, unit: &'static str, least: f64) -> (f64, &'static str) {
    let table: &[(f64, &str)] = match unit {
        "m" => &[(1.0, "m"), (1e-3, "mm"), (1e-6, "µm"), (1e-9, "nm")],
        "s" => &[
            (1.0, "s"),
            (1e-3, "ms"),
            (1e-6, "µs"),
            (1e-9, "ns"),
            (1e-12, "ps"),
        ],
        "kg" => &[(1.0, "kg"), (1e-3, "g"), (1e-6, "mg"), (1e-9, "µg")],
        _ => &[(1e9, "GPa"), (1e6, "MPa"), (1e3, "kPa"), (1.0, "Pa")],
    };
    if si == 0.0 {
        return (0.0, unit);
    }
    let (scale, name) = *table
        .iter()
        .find(|(s, _)| si.abs() >= s * least)
        .unwrap_or(&table[table.len() - 1]);
    (si / scale, name)
}

/// Bonds, of which each is counted at both of its ends, each once.
#[must_use]
pub fn each_once(directed: u64) -> u64 {
    directed.div_ceil(2)
}

/// `1 point`, `2 points`.
pub fn counted(n: u64, one: &str) -> String {
    match n {
        1 => format!("1 {one}"),
        _ => format!("{n} {one}s"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deck::units::system::Constants;

    #[test]
    fn numbers_for_readers_have_units_and_four_digits() {
        let metal = UnitSystem::Metal(Constants::Codata2018);
        let si = UnitSystem::Si;
        assert_eq!(si.show(2.356137e-7, Dim::TIME), "235.6 ns");
        assert_eq!(si.write(2.356137e-7, Dim::TIME), "0.235614 µs");
        assert_eq!(si.show(1.678123e11, Dim::PRESSURE), "167.8 GPa");
        assert_eq!(si.show(0.003, Dim::LENGTH), "3 mm");
        assert_eq!(si.show(0.1, Dim::LENGTH), "100 mm");
        assert_eq!(si.show(3.6e-4, Dim::MASS), "360 mg");
        assert_eq!(si.show(-12345.6, Dim::ENERGY), "-12350 J");
        assert_eq!(si.show(8.790605e18, Dim::MICROMODULUS), "8.791e18 N/m^6");
        assert_eq!(metal.show(1.04757, Dim::PRESSURE), "167.8 GPa");
        assert_eq!(metal.show(1.0 / 9648.533, Dim::MASS), "1 g/mol");
        assert_eq!(UnitSystem::Lj.show(57.23456, Dim::PRESSURE), "57.23");
    }

    #[test]
    fn one_is_not_many() {
        let told = [0, 1, 2].map(|n| counted(n, "pre-crack"));
        assert_eq!(told, ["0 pre-cracks", "1 pre-crack", "2 pre-cracks"]);
    }

    #[test]
    fn units_of_columns() {
        let metal = UnitSystem::Metal(Constants::Codata2018);
        for (dim, si, other) in [
            (Dim::NUMBER, "", ""),
            (Dim::LENGTH, "m", "Å"),
            (Dim::FORCE, "N", "eV Å^-1"),
            (Dim::PRESSURE, "Pa", "eV Å^-3"),
            (Dim::FRACTURE_ENERGY, "J/m^2", "eV Å^-2"),
            (Dim::VELOCITY, "m/s", "Å ps^-1"),
            (Dim::TEMPERATURE, "K", "K"),
            (Dim::MASS, "kg", "eV Å^-2 ps^2"),
            (Dim::CONTACT_STIFFNESS, "Pa m^-5", "eV Å^-8"),
        ] {
            assert_eq!(UnitSystem::Si.unit(dim), si);
            assert_eq!(metal.unit(dim), other);
            assert_eq!(UnitSystem::None.unit(dim), "");
        }
        let squared = Dim::FRACTURE_ENERGY * Dim::PRESSURE;
        assert_eq!(UnitSystem::Si.root_unit(squared), "Pa m^0.5");
        assert_eq!(metal.root_unit(squared), "eV Å^-2.5");
    }
}
