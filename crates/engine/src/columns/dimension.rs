//! What a number measures. The engine counts in one consistent system of units; front ends turn dimensions into units.

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
    pub const VELOCITY: Dimension = Dimension([1, 0, -1, 0]);
    pub const DENSITY: Dimension = Dimension([-3, 1, 0, 0]);
    pub const FORCE: Dimension = Dimension([1, 1, -2, 0]);
    pub const ENERGY: Dimension = Dimension([2, 1, -2, 0]);
    /// Also energy per volume.
    pub const PRESSURE: Dimension = Dimension([-1, 1, -2, 0]);
    pub const FRACTURE_ENERGY: Dimension = Dimension([0, 1, -2, 0]);
    pub const FORCE_DENSITY: Dimension = Dimension([-2, 1, -2, 0]);
    pub const MICROMODULUS: Dimension = Dimension([-5, 1, -2, 0]);
    pub const CONTACT_STIFFNESS: Dimension = Dimension([-6, 1, -2, 0]);
    pub const INDENTER_STIFFNESS: Dimension = Dimension([-4, 1, -2, 0]);
    pub const DAMPING: Dimension = Dimension([-3, 1, -1, 0]);

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
        Dimension(std::array::from_fn(|n| self.0[n] + other.0[n]))
    }
}

impl Div for Dimension {
    type Output = Dimension;
    fn div(self, other: Dimension) -> Dimension {
        Dimension(std::array::from_fn(|n| self.0[n] - other.0[n]))
    }
}
