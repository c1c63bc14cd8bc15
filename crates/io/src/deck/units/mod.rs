//! Units: what `"14.9 GPa"` is in a unit system.

mod dimension;
mod measure;
mod parse;
mod system;
mod table;
mod write;

pub use dimension::{example, named, usual};
pub use measure::{Dimensions, Kind, Variables, factor_help};
pub use parse::{clock_time, split, unit};
/// What a number measures: the engine's word for it.
pub use peridyne::columns::Dimension as Dim;
pub use peridyne::quantity::rounded;
pub(in crate::deck) use system::BOLTZMANN;
pub use system::{Constants, UnitSystem};
pub use write::counted;
pub(in crate::deck) use write::short;

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
        is("1e17 N/m^5", 1e17, Dim::INDENTER_STIFFNESS);
        is("1e6 kg/m^3/s", 1e6, Dim::DAMPING);
        is("300 K", 300.0, Dim::TEMPERATURE);
        is("12e-6 K^-1", 12e-6, Dim([0, 0, 0, -1]));
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
