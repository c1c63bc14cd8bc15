//! Units of a deck, and what they are made of.

use peridyne::columns::Dimension as Dim;
use peridyne::quantity::power;
use schemars::JsonSchema;
use serde::Deserialize;

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

pub(super) const EV: f64 = 1.602176634e-19;
pub(super) const AVOGADRO: f64 = 6.02214076e23;
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
    pub(super) fn computed(self, dim: Dim) -> f64 {
        match self {
            // powers of one number each, so that an energy is one eV to the last digit
            UnitSystem::Metal(_) => {
                let [length, mass, time, _] = dim.0.map(i32::from);
                power(EV, mass) * power(1e-10, length - 2 * mass) * power(1e-12, time + 2 * mass)
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
