//! Units: what `"14.9 GPa"` is in a unit system.

mod dimension;
mod measure;
mod parse;
mod system;
mod table;
mod write;

pub use dimension::{example, named, usual};
pub use measure::{Dimensions, Kind, Variables, factor_help};
pub use parse::{celsius, clock_time, split, unit};
/// What a number measures: the engine's word for it.
pub use peridyne::columns::Dimension as Dim;
pub use peridyne::quantity::rounded;
pub(in crate::deck) use system::BOLTZMANN;
pub use system::{Constants, UnitSystem};
pub use table::known;
pub(in crate::deck) use write::short;
pub use write::{counted, each_once};

#[cfg(test)]
mod tests {
    use super::system::{AVOGADRO, EV};
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
        is("1e17 N/m^5", 1e17, Dim::RIGID_BODY_STIFFNESS);
        is("1e6 kg/m^3/s", 1e6, Dim::DAMPING);
        is("300 K", 300.0, Dim::TEMPERATURE);
        is("12e-6 K^-1", 12e-6, Dim([0, 0, 0, -1]));
    }

    /// As papers, data sheets and other programs write them.
    #[test]
    fn units_are_written_in_many_ways() {
        for text in ["12e-6 1/K", "12e-6 1/degC", "12e-6 K⁻¹", "12e-6 1/°C"] {
            is(text, 12e-6, Dim::EXPANSION);
        }
        is("50 1/s", 50.0, Dim::FREQUENCY);
        is("3 1/m", 3.0, Dim::INVERSE_LENGTH);
        is("2 N/mm", 2000.0, Dim::FRACTURE_ENERGY);
        is("2 kN/mm", 2e6, Dim::FRACTURE_ENERGY);
        is("30 N/mm^2", 30e6, Dim::PRESSURE);
        is("30 N/mm²", 30e6, Dim::PRESSURE);
        is("5 mm/s", 5e-3, Dim::VELOCITY);
        is("0.1 kJ/m^2", 100.0, Dim::FRACTURE_ENERGY);
        is("7 J/m^3", 7.0, Dim::PRESSURE);
        is("7.85 g/cm^3", 7850.0, Dim::DENSITY);
        for text in [
            "45 W/m/K",
            "45 W/(m K)",
            "45 W/(m*K)",
            "45 W/(m·°C)",
            "45 W m⁻¹ K⁻¹",
        ] {
            is(text, 45.0, Dim::CONDUCTIVITY);
        }
        is("460 J/(kg K)", 460.0, Dim::HEAT_CAPACITY);
        is("90 deg", std::f64::consts::FRAC_PI_2, Dim::NUMBER);
        is("90°", std::f64::consts::FRAC_PI_2, Dim::NUMBER);
        is("2 rad/s", 2.0, Dim::FREQUENCY);
        is("1 kcal/mol", 4184.0 / 6.02214076e23, Dim::ENERGY);
        is("10 ksi", 68.94757293168e6, Dim::PRESSURE);
        is("2 in", 0.0508, Dim::LENGTH);
        is("2 ft", 0.6096, Dim::LENGTH);
        is("1 lbf", 4.4482216152605, Dim::FORCE);
        is("3 ml", 3e-6, Dim::VOLUME);
        is("10 K/min", 10.0 / 60.0, Dim([0, 0, -1, 1]));
        is("10 degC/min", 10.0 / 60.0, Dim([0, 0, -1, 1]));
    }

    /// A temperature in degrees Celsius has another zero; a difference and a factor have none.
    #[test]
    fn degrees_celsius_alone_are_no_factor() {
        for text in ["20 degC", "20 °C", "20°C", "20 \u{2103}"] {
            assert_eq!(celsius(text), Some(293.15), "{text}");
        }
        assert_eq!(celsius("-273.15 degC"), Some(0.0));
        assert_eq!(celsius("20 degC/m"), None);
        assert_eq!(celsius("20 K"), None);
        for text in ["degC", "°C", " degC ^1"] {
            let why = unit(text).unwrap_err();
            assert!(why.contains("293.15 K"), "{text}: {why}");
        }
    }

    #[test]
    fn what_is_no_unit_says_so() {
        assert!(unit("gpa").unwrap_err().contains("did you mean `GPa`"));
        let unknown = unit("furlong").unwrap_err();
        assert!(
            unknown.contains("m, g, s, N") && unknown.contains("Å, inch, min"),
            "{unknown}"
        );
        for (text, says) in [
            ("degF", "(68 + 459.67)/1.8 K"),
            ("rpm", "1 rpm is 0.1047197551 rad/s"),
            ("C", "written degC"),
            ("Nm", "`N m`"),
            ("MPas", "`MPa s`"),
            ("W/(m K", "not closed"),
            ("m^0.5", "is not a unit"),
        ] {
            let why = unit(text).unwrap_err();
            assert!(why.contains(says), "{text}: {why}");
        }
        assert!(unit("m/").unwrap_err().contains("missing"));
        assert!(unit("m^x").unwrap_err().contains("whole number"));
        assert!(unit("m^99").unwrap_err().contains("-9 to 9"));
        assert!(split("2*x").is_none() && split("x").is_none() && split("-t").is_none());
        assert_eq!(split("1e-3"), Some((1e-3, "")));
    }

    #[test]
    fn metal_numbers_become_consistent() {
        let metal = UnitSystem::Metal(Constants::Codata2018);
        // 1 bar = 6.2415e-7 eV/Å³, 1 g/mol = 1.0364e-4 eV ps²/Å²
        assert!((metal.plain_factor(Dim::PRESSURE) - 6.241509074e-7).abs() < 1e-15);
        assert!((metal.plain_factor(Dim::MASS) - 1.036426966e-4).abs() < 1e-12);
        assert_eq!(metal.plain_factor(Dim::LENGTH), 1.0);
        assert_eq!(metal.plain_factor(Dim::ENERGY), 1.0);
        assert!((metal.from_si(Dim::ENERGY) * EV - 1.0).abs() < 1e-15);
        // ase.units.fs = 0.0982269: Å per fs in ASE's unit of time
        assert!((metal.ase_velocity() * 1e-3 * 0.09822694788 - 9.648533e-3).abs() < 1e-9);
        assert!((UnitSystem::Si.ase_velocity() - 9822.694).abs() < 1e-2);
    }

    /// Only masses, densities and pressures are made with measured constants.
    #[test]
    fn lammps_has_other_constants() {
        let [new, old] = [Constants::Codata2018, Constants::Lammps].map(UnitSystem::Metal);
        let off = |dim| old.plain_factor(dim) / new.plain_factor(dim) - 1.0;
        assert!((off(Dim::MASS) + 6.4e-8).abs() < 1e-9, "{}", off(Dim::MASS));
        assert!((off(Dim::PRESSURE) - 8.36e-8).abs() < 1e-9);
        assert!((off(Dim::DENSITY) - 4.1e-8).abs() < 2e-8);
        for dim in [Dim::LENGTH, Dim::ENERGY, Dim::TIME, Dim::VELOCITY] {
            assert_eq!(old.plain_factor(dim), 1.0);
        }
        assert!(
            (Constants::Lammps.boltzmann() / Constants::Codata2018.boltzmann() - 1.0).abs() < 2e-6
        );
    }

    #[test]
    fn values_are_written_with_their_units() {
        assert_eq!(UnitSystem::Si.write(14.9e9, Dim::PRESSURE), "14.9 GPa");
        assert_eq!(UnitSystem::Si.write(0.0005, Dim::LENGTH), "0.5 mm");
        assert_eq!(UnitSystem::Si.write(1e-7, Dim::TIME), "0.1 µs");
        assert_eq!(UnitSystem::Si.write(0.0, Dim::LENGTH), "0 m");
        assert_eq!(UnitSystem::Si.write(2e-9, Dim::VOLUME), "2e-9 m^3");
        assert_eq!(UnitSystem::None.write(0.25, Dim::LENGTH), "0.25");
    }
}
