//! Moments of a family on a lattice, `Σ w ξ^α`, exact by integers.

use crate::exact::{Field, Q};
use num_traits::Zero;
use peridyne::family::stencil::Stencil;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::Horizon;

/// Squared lengths, in units of `spacing²`, and vectors of a family.
#[derive(Debug, Clone, PartialEq)]
pub struct FamilyMoments {
    kind: LatticeKind,
    /// Quarters of the cell's edges, and the squared length in sixteenths.
    bonds: Vec<([i32; 3], i64)>,
}

impl FamilyMoments {
    /// The family of the first site, `m_ratio` spacings far, inclusive.
    pub fn new(kind: LatticeKind, m_ratio: u32) -> Self {
        let stencil = Stencil::new(kind, 1.0, Horizon::Ratio(m_ratio));
        FamilyMoments {
            kind,
            bonds: stencil.offsets()[0]
                .iter()
                .map(|o| (o.quarter, o.squared))
                .collect(),
        }
    }

    /// Number of bonds.
    pub fn bonds(&self) -> usize {
        self.bonds.len()
    }

    /// `Σ w(ξ²) ξ_x^{α_x} ξ_y^{α_y} ξ_z^{α_z}` in units of the spacing. Edges of length √3 enter with even powers only:
    /// the odd ones cancel in every family that mirrors itself.
    pub fn moment(&self, alpha: [u32; 3], weight: impl Fn(&Q) -> Q) -> Q {
        let edges = self.kind.edge_squared();
        let odd_root = (0..3).any(|a| edges[a] != 1 && alpha[a] % 2 == 1);
        if odd_root {
            return Q::zero();
        }
        let scale = (0..3).fold(Q::whole(1), |s, a| {
            s * Q::whole(edges[a]).to((alpha[a] / 2) as i32)
        });
        let sum = self.bonds.iter().fold(Q::zero(), |s, (quarter, squared)| {
            let power = (0..3).fold(Q::whole(1), |p, a| {
                p * Q::ratio(quarter[a] as i64, 4).to(alpha[a] as i32)
            });
            s + power * weight(&Q::ratio(*squared, 16))
        });
        scale * sum
    }

    /// All components of the tensor of rank `rank` that are not 0, by exponents.
    pub fn tensor(&self, rank: u32, weight: impl Fn(&Q) -> Q) -> Vec<([u32; 3], Q)> {
        let dimension = self.kind.dimension();
        let mut out = vec![];
        for x in (0..=rank).rev() {
            for y in (0..=rank - x).rev() {
                let alpha = [x, y, rank - x - y];
                if (dimension..3).any(|a| alpha[a] != 0) {
                    continue;
                }
                let value = self.moment(alpha, &weight);
                if !value.is_zero() {
                    out.push((alpha, value));
                }
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::q;

    #[test]
    fn chains_have_sums_of_powers() {
        let m = FamilyMoments::new(LatticeKind::Chain, 4);
        assert_eq!(m.moment([2, 0, 0], |_| q(1, 1)), q(60, 1));
        assert_eq!(m.moment([4, 0, 0], |s| q(1, 1) / s), q(60, 1));
        assert_eq!(m.tensor(3, |_| q(1, 1)), []);
    }

    #[test]
    fn second_moments_are_isotropic_and_fourth_ones_only_where_the_lattice_is() {
        let one = |_: &Q| q(1, 1);
        for (kind, m) in [
            (LatticeKind::Square, 3),
            (LatticeKind::Triangular, 3),
            (LatticeKind::Cubic, 2),
            (LatticeKind::Bcc, 2),
            (LatticeKind::Fcc, 2),
            (LatticeKind::Diamond, 1),
        ] {
            let f = FamilyMoments::new(kind, m);
            let second = f.tensor(2, one);
            assert_eq!(second.len(), kind.dimension(), "{kind:?}");
            assert!(second.iter().all(|(_, v)| *v == second[0].1));
            // Cauchy: M_xxxx = 3 M_xxyy
            let difference = f.moment([4, 0, 0], one) - q(3, 1) * f.moment([2, 2, 0], one);
            assert_eq!(
                difference.is_zero(),
                kind == LatticeKind::Triangular,
                "{kind:?}"
            );
        }
        // the square of three spacings: 28 bonds, Σ x² by hand: 6 + 16·… counted column by column
        let f = FamilyMoments::new(LatticeKind::Square, 3);
        assert_eq!(
            (f.bonds(), f.moment([2, 0, 0], one)),
            (28, q(2 * (5 + 4 * 5 + 9), 1))
        );
        // diamond has no inversion centre: Σ xyz of a site is not 0
        let f = FamilyMoments::new(LatticeKind::Diamond, 1);
        assert!(!f.moment([1, 1, 1], one).is_zero());
    }
}
