//! Unit systems of LAMMPS, with the numbers that LAMMPS computes with: those of CODATA 2006 and older, which its own
//! answers depend on from the sixth digit on.

use peridyne_io::deck::UnitSystem;

/// `units lj | real | metal | si | cgs | electron | micro | nano`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Units {
    Lj,
    Real,
    Metal,
    Si,
    Cgs,
    Electron,
    Micro,
    Nano,
}

/// kcal/mol per g/mol (Å/fs)² is the square of this.
const REAL: f64 = 48.88821291;

impl Units {
    pub const ALL: [(&'static str, Units); 8] = [
        ("lj", Units::Lj),
        ("real", Units::Real),
        ("metal", Units::Metal),
        ("si", Units::Si),
        ("cgs", Units::Cgs),
        ("electron", Units::Electron),
        ("micro", Units::Micro),
        ("nano", Units::Nano),
    ];

    pub fn name(self) -> &'static str {
        Units::ALL
            .iter()
            .find(|(_, u)| *u == self)
            .map_or("lj", |(n, _)| n)
    }

    /// Names of the units of length and time, for pictures; lj has none.
    pub fn labels(self) -> (&'static str, &'static str) {
        match self {
            Units::Lj => ("", ""),
            Units::Real => ("Å", "fs"),
            Units::Electron => ("Bohr", "fs"),
            Units::Si => ("m", "s"),
            Units::Metal => ("Å", "ps"),
            Units::Cgs => ("cm", "s"),
            Units::Micro => ("µm", "µs"),
            Units::Nano => ("nm", "ns"),
        }
    }

    /// Units in which decks have the same numbers; of the others numbers carry none.
    pub fn system(self) -> UnitSystem {
        match self {
            Units::Si => UnitSystem::Si,
            Units::Lj => UnitSystem::Lj,
            Units::Real
            | Units::Metal
            | Units::Cgs
            | Units::Electron
            | Units::Micro
            | Units::Nano => UnitSystem::None,
        }
    }

    /// Boltzmann's constant (energy / temperature).
    pub fn boltzmann(self) -> f64 {
        match self {
            Units::Lj => 1.0,
            Units::Real => 0.0019872067,
            Units::Metal => 8.617343e-5,
            Units::Si => 1.3806504e-23,
            Units::Cgs => 1.3806504e-16,
            Units::Electron => 3.16681534e-6,
            Units::Micro => 1.3806504e-8,
            Units::Nano => 0.013806504,
        }
    }

    /// Energy of mass · velocity² (LAMMPS's `mvv2e`).
    pub fn kinetic(self) -> f64 {
        match self {
            Units::Real => REAL * REAL,
            Units::Metal => 1.0364269e-4,
            Units::Electron => 1.06657236,
            Units::Lj | Units::Si | Units::Cgs | Units::Micro | Units::Nano => 1.0,
        }
    }

    /// Acceleration of force / mass (LAMMPS's `ftm2v`).
    pub fn acceleration(self) -> f64 {
        match self {
            Units::Real => 1.0 / REAL / REAL,
            Units::Metal => 1.0 / 1.0364269e-4,
            // rounded by itself, not from the number above
            Units::Electron => 0.937582899,
            Units::Lj | Units::Si | Units::Cgs | Units::Micro | Units::Nano => 1.0,
        }
    }

    /// Pressure of energy / volume (LAMMPS's `nktv2p`).
    pub fn pressure(self) -> f64 {
        match self {
            Units::Real => 68568.415,
            Units::Metal => 1.6021765e6,
            Units::Electron => 2.94210108e13,
            Units::Lj | Units::Si | Units::Cgs | Units::Micro | Units::Nano => 1.0,
        }
    }

    /// Default `timestep`.
    pub fn time_step(self) -> f64 {
        match self {
            Units::Lj => 0.005,
            Units::Real => 1.0,
            Units::Si | Units::Cgs => 1e-8,
            Units::Metal | Units::Electron => 0.001,
            Units::Micro => 2.0,
            Units::Nano => 0.00045,
        }
    }

    /// Default skin.
    pub fn skin(self) -> f64 {
        match self {
            Units::Lj => 0.3,
            Units::Si => 0.001,
            Units::Real | Units::Metal | Units::Electron => 2.0,
            Units::Cgs | Units::Micro | Units::Nano => 0.1,
        }
    }
}
