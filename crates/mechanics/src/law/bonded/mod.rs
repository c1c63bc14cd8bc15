//! Terms between particles that are bonded to each other, whatever moves: bonds, angles, dihedrals, impropers. A
//! [`Form`] is written once, as an
//! energy of the ξ = d²/2 of all pairs of its particles, over any [`Number`].

mod angle;
mod dihedral;
mod special;

pub use dihedral::{Wave, cosine_powers};
pub use special::special_pairs;

use super::number::Number;
use super::slopes::{Curved, Slopes};
use crate::spec::Form;

/// Pairs of the particles of a term, in the order of their ξ and of [`place`](super::blocks::place).
const PAIRS: [(usize, usize); 6] = [(0, 1), (0, 2), (1, 2), (0, 3), (1, 3), (2, 3)];

/// Parts of a potential that bonded terms belong to ([`Form::part`]).
pub const PARTS: [&str; 4] = ["bonds", "angles", "dihedrals", "impropers"];

/// Energy of a term with the slopes by the ξ of its pairs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pulls {
    pub energy: f64,
    /// `G_ab` (energy / length²), in the order of [`Form::pairs`].
    pub pulls: [f64; 6],
}

/// And with their slopes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tangents {
    pub first: Pulls,
    pub second: [[f64; 6]; 6],
}

impl Form {
    /// Number of its particles. Of an angle the second is the vertex; of a dihedral and an improper the second and third are the axis.
    pub fn particles(&self) -> usize {
        match self {
            Form::HarmonicBond { .. } => 2,
            Form::HarmonicAngle { .. }
            | Form::CosineAngle { .. }
            | Form::CosineSquaredAngle { .. } => 3,
            Form::Dihedral { .. } | Form::HarmonicImproper { .. } => 4,
        }
    }

    /// Which of [`PARTS`] it belongs to.
    pub fn part(&self) -> usize {
        match self {
            Form::HarmonicBond { .. } => 0,
            Form::HarmonicAngle { .. }
            | Form::CosineAngle { .. }
            | Form::CosineSquaredAngle { .. } => 1,
            Form::Dihedral { .. } => 2,
            Form::HarmonicImproper { .. } => 3,
        }
    }

    /// Pairs of its particles.
    pub fn pairs(&self) -> &'static [(usize, usize)] {
        let n = self.particles();
        &PAIRS[..n * (n - 1) / 2]
    }

    /// Energy (energy) by the ξ of its pairs.
    #[inline(always)]
    pub fn energy<N: Number>(&self, xi: &[N]) -> N {
        match self {
            Form::HarmonicBond { stiffness, length } => {
                let longer = xi[0].times(2.0).sqrt().plus(-length);
                (longer * longer).times(*stiffness)
            }
            Form::HarmonicAngle { stiffness, angle } => {
                let wider = angle::arc_cosine(angle::cosine(xi)).plus(-angle);
                (wider * wider).times(*stiffness)
            }
            Form::CosineAngle { stiffness } => angle::cosine(xi).plus(1.0).times(*stiffness),
            Form::CosineSquaredAngle { stiffness, cosine } => {
                let off = angle::cosine(xi).plus(-cosine);
                (off * off).times(*stiffness)
            }
            Form::Dihedral { powers } => dihedral::polynomial(powers, dihedral::cosine(xi)),
            Form::HarmonicImproper { stiffness, angle } => {
                let wider = angle::arc_cosine(dihedral::cosine(xi)).plus(-angle);
                (wider * wider).times(*stiffness)
            }
        }
    }

    /// Energy and slopes.
    pub fn pulls(&self, xi: &[f64]) -> Pulls {
        match xi.len() {
            1 => self.slopes::<1>(xi),
            3 => self.slopes::<3>(xi),
            _ => self.slopes::<6>(xi),
        }
    }

    fn slopes<const C: usize>(&self, xi: &[f64]) -> Pulls {
        let of: [Slopes<f64, C>; C] = crate::array::from_fn(|n| Slopes::nth(xi[n], n));
        let found = self.energy(&of);
        let mut pulls = [0.0; 6];
        pulls[..C].copy_from_slice(&found.slope);
        Pulls {
            energy: found.value,
            pulls,
        }
    }

    /// Energy, slopes and curvatures.
    pub fn tangents(&self, xi: &[f64]) -> Tangents {
        match xi.len() {
            1 => self.curved::<1>(xi),
            3 => self.curved::<3>(xi),
            _ => self.curved::<6>(xi),
        }
    }

    fn curved<const C: usize>(&self, xi: &[f64]) -> Tangents {
        let of: [Curved<C>; C] = crate::array::from_fn(|n| Curved::variable(xi[n], n));
        let found = self.energy(&of);
        let (mut pulls, mut second) = ([0.0; 6], [[0.0; 6]; 6]);
        pulls[..C].copy_from_slice(&found.slope);
        for (row, found) in second.iter_mut().zip(found.curvature) {
            row[..C].copy_from_slice(&found);
        }
        Tangents {
            first: Pulls {
                energy: found.value,
                pulls,
            },
            second,
        }
    }
}

#[cfg(test)]
mod tests;
