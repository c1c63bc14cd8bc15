//! What a number measures. The engine counts in one consistent system of units; front ends turn dimensions into units.

use std::fmt;
use std::ops::{Div, Mul};

/// Exponents of length, mass, time and temperature.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Dimension(pub [i8; 4]);

impl Dimension {
    pub const NUMBER: Dimension = Dimension([0, 0, 0, 0]);
    pub const LENGTH: Dimension = Dimension([1, 0, 0, 0]);
    pub const AREA: Dimension = Dimension([2, 0, 0, 0]);
    pub const VOLUME: Dimension = Dimension([3, 0, 0, 0]);
    pub const MASS: Dimension = Dimension([0, 1, 0, 0]);
    pub const TIME: Dimension = Dimension([0, 0, 1, 0]);
    pub const TEMPERATURE: Dimension = Dimension([0, 0, 0, 1]);
    pub const INVERSE_LENGTH: Dimension = Dimension([-1, 0, 0, 0]);
    pub const FREQUENCY: Dimension = Dimension([0, 0, -1, 0]);
    pub const ACCELERATION: Dimension = Dimension([1, 0, -2, 0]);
    pub const VELOCITY: Dimension = Dimension([1, 0, -1, 0]);
    pub const DENSITY: Dimension = Dimension([-3, 1, 0, 0]);
    pub const FORCE: Dimension = Dimension([1, 1, -2, 0]);
    pub const ENERGY: Dimension = Dimension([2, 1, -2, 0]);
    pub const POWER: Dimension = Dimension([2, 1, -3, 0]);
    /// Also energy per volume.
    pub const PRESSURE: Dimension = Dimension([-1, 1, -2, 0]);
    pub const FRACTURE_ENERGY: Dimension = Dimension([0, 1, -2, 0]);
    pub const FORCE_DENSITY: Dimension = Dimension([-2, 1, -2, 0]);
    pub const MICROMODULUS: Dimension = Dimension([-5, 1, -2, 0]);
    pub const CONTACT_STIFFNESS: Dimension = Dimension([-6, 1, -2, 0]);
    pub const RIGID_BODY_STIFFNESS: Dimension = Dimension([-4, 1, -2, 0]);
    pub const DAMPING: Dimension = Dimension([-3, 1, -1, 0]);
    pub const CONDUCTIVITY: Dimension = Dimension([1, 1, -3, -1]);
    /// Per mass.
    pub const HEAT_CAPACITY: Dimension = Dimension([2, 0, -2, -1]);
    pub const HEAT_FLUX: Dimension = Dimension([0, 1, -3, 0]);
    pub const HEAT_SOURCE: Dimension = Dimension([-1, 1, -3, 0]);
    pub const HEAT_TRANSFER: Dimension = Dimension([0, 1, -3, -1]);
    pub const EXPANSION: Dimension = Dimension([0, 0, 0, -1]);
    pub const DIFFUSIVITY: Dimension = Dimension([2, 0, -1, 0]);
    /// Amount per volume.
    pub const CONCENTRATION: Dimension = Dimension([-3, 0, 0, 0]);
    pub const SPECIES_FLUX: Dimension = Dimension([-2, 0, -1, 0]);
    pub const SPECIES_SOURCE: Dimension = Dimension([-3, 0, -1, 0]);

    /// What the usual ones are called.
    const NAMES: &[(Dimension, &'static str)] = &[
        (Dimension::NUMBER, "a plain number"),
        (Dimension::LENGTH, "a length"),
        (Dimension::AREA, "an area"),
        (Dimension::VOLUME, "a volume"),
        (Dimension::MASS, "a mass"),
        (Dimension::TIME, "a time"),
        (Dimension::TEMPERATURE, "a temperature"),
        (Dimension::VELOCITY, "a velocity"),
        (Dimension::ACCELERATION, "an acceleration"),
        (Dimension::INVERSE_LENGTH, "an inverse length"),
        (Dimension::FREQUENCY, "a frequency"),
        (Dimension::DENSITY, "a density"),
        (Dimension::FORCE, "a force"),
        (Dimension::ENERGY, "an energy"),
        (Dimension::POWER, "a power"),
        (Dimension::PRESSURE, "a pressure"),
        (Dimension::FRACTURE_ENERGY, "an energy per area"),
        (Dimension::FORCE_DENSITY, "a force per volume"),
        (
            Dimension::MICROMODULUS,
            "a micromodulus (force per volume squared)",
        ),
        (
            Dimension::CONTACT_STIFFNESS,
            "a contact stiffness (force per volume squared and length)",
        ),
        (
            Dimension::RIGID_BODY_STIFFNESS,
            "a contact stiffness of a rigid body (force per volume and area)",
        ),
        (Dimension::DAMPING, "a damping (mass per volume and time)"),
        (Dimension::CONDUCTIVITY, "a thermal conductivity"),
        (Dimension::HEAT_CAPACITY, "a heat capacity per mass"),
        (Dimension::HEAT_FLUX, "a heat flux (power per area)"),
        (Dimension::HEAT_SOURCE, "a power per volume"),
        (Dimension::HEAT_TRANSFER, "a heat transfer coefficient"),
        (Dimension::EXPANSION, "an inverse temperature"),
        (Dimension::DIFFUSIVITY, "a diffusivity"),
        (
            Dimension::CONCENTRATION,
            "a concentration (amount per volume)",
        ),
        (
            Dimension::SPECIES_FLUX,
            "a flux of a species (amount per area and time)",
        ),
        (
            Dimension::SPECIES_SOURCE,
            "a source of a species (amount per volume and time)",
        ),
    ];

    /// What it is called, if it is a usual one.
    pub fn name(self) -> Option<&'static str> {
        let named = Dimension::NAMES.iter().find(|n| n.0 == self);
        named.map(|n| n.1)
    }

    /// `self · other^times`; `None`: the exponents run over.
    pub fn times(self, other: Dimension, times: i8) -> Option<Dimension> {
        let mut sum = self.0;
        for (s, o) in sum.iter_mut().zip(other.0) {
            *s = s.checked_add(o.checked_mul(times)?)?;
        }
        Some(Dimension(sum))
    }
}

impl Mul for Dimension {
    type Output = Dimension;
    fn mul(self, other: Dimension) -> Dimension {
        Dimension(crate::array::from_fn(|n| self.0[n] + other.0[n]))
    }
}

impl Div for Dimension {
    type Output = Dimension;
    fn div(self, other: Dimension) -> Dimension {
        Dimension(crate::array::from_fn(|n| self.0[n] - other.0[n]))
    }
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(name) = self.name() {
            return f.write_str(name);
        }
        let near = [
            (Dimension::TIME, 1),
            (Dimension::TIME, -1),
            (Dimension::LENGTH, 1),
            (Dimension::LENGTH, -1),
        ];
        // a pressure times a time, a mass per length
        let named = near.into_iter().find_map(|(part, power)| {
            let rest = self.times(part, -power)?;
            let name = rest.name().filter(|_| rest != Dimension::NUMBER)?;
            Some((name, if power > 0 { "times" } else { "over" }, part))
        });
        let [length, mass, time, temperature] = self.0;
        match named {
            Some((name, how, part)) => write!(f, "{name} {how} {part}"),
            None if temperature == 0 => write!(f, "a quantity in m^{length} kg^{mass} s^{time}"),
            None => write!(
                f,
                "a quantity in m^{length} kg^{mass} s^{time} K^{temperature}"
            ),
        }
    }
}
