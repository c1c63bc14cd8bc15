//! Isotropic moduli of the three-dimensional solid, any two of which give the others.

use crate::spec::Moduli;

impl Moduli {
    /// From bulk and shear modulus of the three-dimensional solid.
    pub fn from_bulk_shear(bulk: f64, shear: f64) -> Self {
        Moduli {
            young: 9.0 * bulk * shear / (3.0 * bulk + shear),
            poisson: (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear)),
        }
    }
    pub fn bulk(&self) -> f64 {
        self.young / (3.0 * (1.0 - 2.0 * self.poisson))
    }
    pub fn shear(&self) -> f64 {
        self.young / (2.0 * (1.0 + self.poisson))
    }
    /// First Lamé constant λ of the three-dimensional solid.
    pub fn lame(&self) -> f64 {
        self.bulk() - 2.0 / 3.0 * self.shear()
    }
}
