//! Units: what `"14.9 GPa"` is in a unit system.

mod measure;
mod parse;
mod table;
mod write;

pub use measure::{Dimensions, Kind, Variables, factor_help};
pub use parse::{clock_time, split, unit};
pub use peridyne::quantity::rounded;
pub use write::counted;
pub(in crate::deck) use write::short;

use schemars::JsonSchema;
use serde::Deserialize;

/// What a number measures: the engine's word for it.
pub use peridyne::columns::Dimension as Dim;

/// How one would write a quantity of a kind.
const EXAMPLES: &[(Dim, &str)] = &[
    (Dim::NUMBER, "0.25"),
    (Dim::LENGTH, "0.5 mm"),
    (Dim::AREA, "2 mm^2"),
    (Dim::VOLUME, "1 mm^3"),
    (Dim::MASS, "2 kg"),
    (Dim::TIME, "20 us"),
    (Dim::TEMPERATURE, "300 K"),
    (Dim::VELOCITY, "100 m/s"),
    (Dim::ACCELERATION, "9.81 m/s^2"),
    (Dim::INVERSE_LENGTH, "1.4/mm"),
    (Dim::FREQUENCY, "1 kHz"),
    (Dim::DENSITY, "2200 kg/m^3"),
    (Dim::FORCE, "10 N"),
    (Dim::ENERGY, "1 J"),
    (Dim::POWER, "1 W"),
    (Dim::PRESSURE, "14.9 GPa"),
    (Dim::FRACTURE_ENERGY, "10 J/m^2"),
    (Dim::FORCE_DENSITY, "1e6 N/m^3"),
    (Dim::MICROMODULUS, "1.6e22 N/m^6"),
    (Dim::CONTACT_STIFFNESS, "1e26 N/m^7"),
    (Dim::INDENTER_STIFFNESS, "1e17 N/m^5"),
    (Dim::DAMPING, "1e6 kg/m^3/s"),
    (Dim::CONDUCTIVITY, "45 W/m/K"),
    (Dim::HEAT_CAPACITY, "460 J/kg/K"),
    (Dim::HEAT_FLUX, "1e4 W/m^2"),
    (Dim::HEAT_SOURCE, "1e6 W/m^3"),
    (Dim::HEAT_TRANSFER, "25 W/m^2/K"),
    (Dim::EXPANSION, "12e-6 K^-1"),
    (Dim::DIFFUSIVITY, "1e-9 m^2/s"),
    (Dim::CONCENTRATION, "100 mol/m^3"),
    (Dim::SPECIES_FLUX, "1e-3 mol/m^2/s"),
    (Dim::SPECIES_SOURCE, "1e-3 mol/m^3/s"),
];

/// How one would write a quantity of this dimension, if it is a usual one.
pub fn example(dim: Dim) -> Option<&'static str> {
    EXAMPLES.iter().find(|n| n.0 == dim).map(|n| n.1)
}

/// The dimension of this [name](Dim::name), if it is a usual one.
pub fn named(name: &str) -> Option<Dim> {
    usual().find(|dim| dim.name() == Some(name))
}

/// The usual dimensions.
pub fn usual() -> impl Iterator<Item = Dim> {
    EXAMPLES.iter().map(|(dim, _)| *dim)
}

/// How usual a dimension is: its place among those with examples.
fn place(dim: Dim) -> Option<usize> {
    EXAMPLES.iter().position(|n| n.0 == dim)
}

/// What plain numbers of a deck mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum UnitSystem {
    /// m, kg, s
    #[default]
    Si,
    /// Å, ps, eV; masses in g/mol, densities in g/cm³, pressures in bar. Computed in Å, ps, eV throughout.
    Metal(Constants),
    /// Reduced units; numbers carry none.
    Lj,
    /// Any consistent units; numbers carry none.
    None,
}

/// Physical constants with which g/mol, bar and kelvin become eV, Å and ps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Constants {
    /// Exact since 2019.
    #[default]
    Codata2018,
    /// The numbers of LAMMPS's `units metal` (CODATA 2006 and older): kinetic energies differ from the others by 6e-8,
    /// temperatures by 1e-6 of themselves.
    Lammps,
}

impl Constants {
    pub fn name(self) -> &'static str {
        match self {
            Constants::Codata2018 => "CODATA 2018",
            Constants::Lammps => "those of LAMMPS",
        }
    }

    /// Boltzmann's constant (eV/K).
    pub fn boltzmann(self) -> f64 {
        match self {
            Constants::Codata2018 => BOLTZMANN / EV,
            Constants::Lammps => 8.617343e-5,
        }
    }

    /// 1 g/mol in eV ps²/Å², 1 bar in eV/Å³ and 1 g/cm³ in eV ps²/Å⁵; `None` where units of SI say it.
    fn factor(self, dim: Dim) -> Option<f64> {
        const MASS: f64 = 1.0364269e-4;
        match (self, dim) {
            (Constants::Codata2018, _) => None,
            (Constants::Lammps, Dim::MASS) => Some(MASS),
            (Constants::Lammps, Dim::PRESSURE) => Some(1.0 / 1.6021765e6),
            (Constants::Lammps, Dim::DENSITY) => Some(0.602214129 * MASS),
            (Constants::Lammps, _) => None,
        }
    }
}

const EV: f64 = 1.602176634e-19;
const AVOGADRO: f64 = 6.02214076e23;
/// J/K
pub(in crate::deck) const BOLTZMANN: f64 = 1.380649e-23;

impl UnitSystem {
    pub fn name(self) -> &'static str {
        match self {
            UnitSystem::Si => "si",
            UnitSystem::Metal(_) => "metal",
            UnitSystem::Lj => "lj",
            UnitSystem::None => "none",
        }
    }

    /// Whether numbers may carry units.
    pub fn has_units(self) -> bool {
        matches!(self, UnitSystem::Si | UnitSystem::Metal(_))
    }

    /// SI value of the unit in which quantities of this dimension are computed.
    fn computed(self, dim: Dim) -> f64 {
        match self {
            // powers of one number each, so that an energy is one eV to the last digit
            UnitSystem::Metal(_) => {
                let [length, mass, time, _] = dim.0.map(i32::from);
                EV.powi(mass) * 1e-10f64.powi(length - 2 * mass) * 1e-12f64.powi(time + 2 * mass)
            }
            UnitSystem::Si | UnitSystem::Lj | UnitSystem::None => 1.0,
        }
    }

    /// SI value of the unit that a plain number of this dimension has.
    fn plain(self, dim: Dim) -> f64 {
        match (self, dim) {
            (UnitSystem::Metal(_), Dim::MASS) => 1e-3 / AVOGADRO,
            (UnitSystem::Metal(_), Dim::DENSITY) => 1e3,
            (UnitSystem::Metal(_), Dim::PRESSURE) => 1e5,
            _ => self.computed(dim),
        }
    }

    /// Factor from plain numbers to computed ones.
    pub fn plain_factor(self, dim: Dim) -> f64 {
        if let UnitSystem::Metal(constants) = self
            && let Some(factor) = constants.factor(dim)
        {
            return factor;
        }
        let (plain, computed) = (self.plain(dim), self.computed(dim));
        if plain == computed {
            1.0
        } else {
            plain / computed
        }
    }

    /// How many computed velocities one of ASE is: √(eV/(g/mol)) = Å/10.18 fs. Reduced units are their own.
    pub fn ase_velocity(self) -> f64 {
        match self {
            UnitSystem::Si | UnitSystem::Metal(_) => {
                (EV * 1e3 * AVOGADRO).sqrt() / self.computed(Dim::VELOCITY)
            }
            UnitSystem::Lj | UnitSystem::None => 1.0,
        }
    }

    /// SI value of a computed number.
    pub fn to_si(self, value: f64, dim: Dim) -> f64 {
        value * self.computed(dim)
    }

    /// Factor from SI to the unit that a plain number has.
    pub fn from_si(self, dim: Dim) -> f64 {
        1.0 / self.plain(dim)
    }
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
