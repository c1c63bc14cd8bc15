//! Unit systems of LAMMPS: only what the `peri` output needs.

/// `units si | lj | metal | micro | nano | cgs`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Units {
    Lj,
    Si,
    Metal,
    Cgs,
    Micro,
    Nano,
}

impl Units {
    pub const ALL: [(&'static str, Units); 6] = [
        ("lj", Units::Lj),
        ("si", Units::Si),
        ("metal", Units::Metal),
        ("cgs", Units::Cgs),
        ("micro", Units::Micro),
        ("nano", Units::Nano),
    ];

    pub fn name(self) -> &'static str {
        Units::ALL
            .iter()
            .find(|(_, u)| *u == self)
            .map_or("lj", |(n, _)| n)
    }

    /// Boltzmann's constant.
    pub fn boltzmann(self) -> f64 {
        match self {
            Units::Lj => 1.0,
            Units::Si => 1.3806504e-23,
            Units::Metal => 8.617343e-5,
            Units::Cgs => 1.3806504e-16,
            Units::Micro => 1.3806504e-8,
            Units::Nano => 0.013806504,
        }
    }

    /// Converts mass · velocity² to energy.
    pub fn kinetic(self) -> f64 {
        if self == Units::Metal {
            1.0364269e-4
        } else {
            1.0
        }
    }

    /// Converts energy / volume to pressure.
    pub fn pressure(self) -> f64 {
        if self == Units::Metal {
            1.6021765e6
        } else {
            1.0
        }
    }

    /// Default `timestep`.
    pub fn time_step(self) -> f64 {
        match self {
            Units::Lj => 0.005,
            Units::Si | Units::Cgs => 1e-8,
            Units::Metal => 0.001,
            Units::Micro => 2.0,
            Units::Nano => 0.00045,
        }
    }

    /// Default skin.
    pub fn skin(self) -> f64 {
        match self {
            Units::Lj => 0.3,
            Units::Si => 0.001,
            Units::Metal => 2.0,
            Units::Cgs | Units::Micro | Units::Nano => 0.1,
        }
    }
}
