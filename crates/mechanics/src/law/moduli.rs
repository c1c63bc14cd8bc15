//! Isotropic moduli of the three-dimensional solid, any two of which give the others.

use crate::spec::{Moduli, Plane};

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

    /// The λ with which an isotropic body of `dimension` dimensions has `W = ½ λ tr²ε + G ε:ε`: `E − 2G` of a bar,
    /// `2λG/(λ+2G)` of a sheet in plane stress, else that of the solid.
    pub fn lame_of(&self, dimension: usize, plane: Plane) -> f64 {
        let (l, g) = (self.lame(), self.shear());
        match (dimension, plane) {
            (1, _) => self.young - 2.0 * g,
            (2, Plane::Stress) => 2.0 * l * g / (l + 2.0 * g),
            (_, Plane::Stress | Plane::Strain) => l,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Textbooks: a sheet that is free to get thinner has `λ = E ν / (1 − ν²)`.
    #[test]
    fn a_sheet_in_plane_stress_gives_way() {
        let moduli = Moduli {
            young: 7.0,
            poisson: 0.3,
        };
        let of = |d, plane| moduli.lame_of(d, plane);
        assert!((of(2, Plane::Stress) - 7.0 * 0.3 / (1.0 - 0.09)).abs() < 1e-14);
        assert_eq!(of(2, Plane::Strain), moduli.lame());
        assert_eq!(of(3, Plane::Stress), moduli.lame());
        assert!((of(1, Plane::Stress) + 2.0 * moduli.shear() - 7.0).abs() < 1e-14);
    }
}
