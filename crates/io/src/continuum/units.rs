//! Units of frames and of the fields made of them: everything is computed in the consistent units of the system (energy, length,
//! time), in which a mass has a factor of its own.

use crate::deck::{Constants, Dim, UnitSystem};
use peridyne::quantity::power;
use peridyne_fields::Quantity;

/// What numbers of a frame and a potential mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Units {
    Deck(UnitSystem),
    /// LAMMPS's `real`: Å, fs, kcal/mol, g/mol.
    Real,
}

/// Avogadro's constant times Boltzmann's (J/mol/K), and J in a thermochemical calorie.
const GAS: f64 = 8.314462618;
const CALORIE: f64 = 4.184;

impl Units {
    pub const NAMES: &'static str = "metal, real, lj, si or none";

    /// By their name.
    pub fn named(name: &str) -> Option<Units> {
        Some(match name {
            "metal" => Units::Deck(UnitSystem::Metal(Constants::default())),
            "si" => Units::Deck(UnitSystem::Si),
            "lj" => Units::Deck(UnitSystem::Lj),
            "none" => Units::Deck(UnitSystem::None),
            "real" => Units::Real,
            _ => return None,
        })
    }

    pub fn name(self) -> &'static str {
        match self {
            Units::Deck(system) => system.name(),
            Units::Real => "real",
        }
    }

    /// In which a potential's numbers are read.
    pub fn deck(self) -> UnitSystem {
        match self {
            Units::Deck(system) => system,
            // consistent in themselves
            Units::Real => UnitSystem::None,
        }
    }

    /// Computed masses (energy · time² / length²) that one of the user's is.
    pub fn mass(self) -> f64 {
        match self {
            Units::Deck(system) => system.plain_factor(Dim::MASS),
            // (g/mol) Å²/fs² in kcal/mol
            Units::Real => 1e4 / CALORIE,
        }
    }

    /// k_B (energy / temperature).
    pub fn boltzmann(self) -> f64 {
        match self {
            Units::Deck(UnitSystem::Metal(constants)) => constants.boltzmann(),
            Units::Deck(UnitSystem::Si) => 1.380649e-23,
            Units::Deck(UnitSystem::Lj | UnitSystem::None) => 1.0,
            Units::Real => 1e-3 * GAS / CALORIE,
        }
    }

    /// The user's mass of an atom of so many g/mol; `None` in units that know no atoms.
    pub fn molar(self, mass: f64) -> Option<f64> {
        match self {
            Units::Deck(UnitSystem::Metal(_)) | Units::Real => Some(mass),
            Units::Deck(UnitSystem::Si) => Some(mass * 1e-3 / 6.02214076e23),
            Units::Deck(UnitSystem::Lj | UnitSystem::None) => None,
        }
    }

    /// How many of the user's velocities one of ASE's momenta over masses is.
    pub fn ase_velocity(self) -> f64 {
        match self {
            Units::Deck(system) => system.ase_velocity(),
            Units::Real => 1e-3 * UnitSystem::Metal(Constants::default()).ase_velocity(),
        }
    }

    /// Names of mass, energy, length, time, temperature; empty where numbers carry none.
    fn words(self) -> [&'static str; 5] {
        match self {
            Units::Deck(UnitSystem::Metal(_)) => ["g/mol", "eV", "Å", "ps", "K"],
            Units::Deck(UnitSystem::Si) => ["kg", "J", "m", "s", "K"],
            Units::Deck(UnitSystem::Lj | UnitSystem::None) => ["", "", "", "", ""],
            Units::Real => ["g/mol", "kcal/mol", "Å", "fs", "K"],
        }
    }

    pub fn length(self) -> &'static str {
        self.words()[2]
    }

    pub fn time(self) -> &'static str {
        self.words()[3]
    }

    /// Unit of a quantity; "reduced" where numbers carry none.
    pub fn unit(self, quantity: Quantity) -> String {
        let p = quantity.powers();
        let powers = [p.mass, p.energy, p.length, p.time, p.temperature];
        let words = self.words();
        if words[0].is_empty() {
            return "reduced".into();
        }
        if words[1] == "J" && quantity.is_stress() {
            return "Pa".into();
        }
        let part = |word: &str, power: i32| match power {
            1 => word.to_string(),
            n => format!("{word}^{n}"),
        };
        let over: Vec<String> = (0..5)
            .filter(|k| powers[*k] > 0)
            .map(|k| part(words[k], powers[k]))
            .collect();
        let under: Vec<String> = (0..5)
            .filter(|k| powers[*k] < 0)
            .map(|k| part(words[k], -powers[k]))
            .collect();
        match (over.join(" "), under.len()) {
            (over, 0) => over,
            (over, 1) => format!("{over}/{}", under[0]),
            (over, _) => format!("{over}/({})", under.join(" ")),
        }
    }

    /// Factor from computed values to the user's.
    pub fn factor(self, quantity: Quantity) -> f64 {
        power(self.mass(), -quantity.powers().mass)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Half a gram per mole at one ångström per femtosecond is 1195 kcal/mol, and k_B is LAMMPS's.
    #[test]
    fn real_units_are_consistent() {
        assert!((0.5 * Units::Real.mass() - 1_195.028_680_688_336).abs() < 1e-9);
        assert!((Units::Real.boltzmann() - 0.001_987_204_3).abs() < 1e-9);
        let metal = Units::named("metal").unwrap();
        // the same kinetic energy in eV: 1 Å/fs = 1000 Å/ps, 1 eV = 23.0605 kcal/mol
        let ratio = Units::Real.mass() / (metal.mass() * 1e6);
        assert!((ratio - 23.060_547_8).abs() < 1e-6, "{ratio}");
    }

    #[test]
    fn units_have_names() {
        let si = Units::named("si").unwrap();
        assert_eq!(si.unit(Quantity::Stress), "Pa");
        assert_eq!(si.unit(Quantity::Energy), "J/m^3");
        let metal = Units::named("metal").unwrap();
        assert_eq!(metal.unit(Quantity::Density), "g/mol/Å^3");
        assert_eq!(metal.unit(Quantity::Stress), "eV/Å^3");
        assert_eq!(metal.unit(Quantity::HeatKinetic), "eV/(Å^2 ps)");
        assert_eq!(metal.unit(Quantity::Velocity), "Å/ps");
        assert_eq!(metal.unit(Quantity::Temperature), "K");
        assert_eq!(
            Units::named("lj").unwrap().unit(Quantity::Stress),
            "reduced"
        );
        assert!(Units::named("imperial").is_none());
    }
}
