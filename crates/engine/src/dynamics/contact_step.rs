//! What contact adds to the stability limit: the stiffness of points that touch, by their materials.
//!
//! A pair in contact is a spring of force density `K V_j` along its direction. Points that are free, with z neighbours
//! in range on all sides, meet `(z/D) K V` along any direction, and twice that where neighbours move against each other:
//! `λ = (z/D) K (V_b/ρ_a + V_a/ρ_b)` (exact for springs of a square or cubic lattice). A point at the surface of a body
//! has half a family besides: `λ = ½ λ_bonds + (z/D) K V_b/ρ_a`. With friction, springs along the faces count with theirs:
//! z/D becomes `z (1 + (D − 1) κ/K)/D`. Cohesion adds what it resists with, `V`-weighted over its partners, over both densities.

use crate::interaction::Repulsion;

/// Points of one material: the largest volume and the least density.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grain {
    /// Length^D times the section.
    pub volume: f64,
    /// Mass / length³.
    pub density: f64,
}

/// The pair of materials that asks for the shortest step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactLimit {
    /// Largest eigenvalue of `M⁻¹K` (1 / time²).
    pub lambda: f64,
    pub materials: [usize; 2],
}

/// The largest eigenvalue over all pairs of materials. `per_axis` is z/D, with friction more, `bonds` the largest eigenvalue of the bonds,
/// `cohesion` what a pair of materials resists with besides (force density / length).
pub fn contact_limit(
    repulsion: &Repulsion,
    grains: &[Grain],
    per_axis: f64,
    bonds: f64,
    cohesion: impl Fn(usize, usize) -> f64,
) -> Option<ContactLimit> {
    let mut most: Option<ContactLimit> = None;
    for (a, own) in grains.iter().enumerate() {
        for (b, other) in grains.iter().enumerate() {
            let stiffness = per_axis * repulsion.of([a, b]);
            let push = stiffness * other.volume / own.density;
            let free = push + stiffness * own.volume / other.density;
            let sticks = cohesion(a, b) * (1.0 / own.density + 1.0 / other.density);
            let lambda = free.max(0.5 * bonds + push) + sticks;
            if push > 0.0 && most.is_none_or(|m| lambda > m.lambda) {
                most = Some(ContactLimit {
                    lambda,
                    materials: [a.min(b), a.max(b)],
                });
            }
        }
    }
    most
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_masses_on_a_chain_are_the_closed_form() {
        // springs k between m and M by turns: ω² = 2 k (1/m + 1/M) at most
        let repulsion = Repulsion::uniform(3.0, 0.9, 1.35);
        let of = |volume, density| Grain { volume, density };
        let found = contact_limit(
            &repulsion,
            &[of(2.0, 1.0), of(2.0, 5.0)],
            2.0,
            0.0,
            |_, _| 0.0,
        )
        .unwrap();
        // the lighter material alone is stiffest: k = K V², m = ρ V
        assert_eq!(found.materials, [0, 0]);
        assert!((found.lambda - 4.0 * 3.0 * 2.0 / 1.0).abs() < 1e-12);
        let apart = |a: usize, b: usize| if a == b { 0.0 } else { 3.0 };
        let across = Repulsion {
            stiffness: crate::interaction::PairTable::new(2, apart),
            ..repulsion
        };
        let found =
            contact_limit(&across, &[of(2.0, 1.0), of(2.0, 5.0)], 2.0, 0.0, |_, _| 0.0).unwrap();
        let (k, m) = (3.0 * 4.0, [2.0, 10.0]);
        assert_eq!(found.materials, [0, 1]);
        assert!((found.lambda - 2.0 * k * (1.0 / m[0] + 1.0 / m[1])).abs() < 1e-12);
        assert!(
            contact_limit(
                &Repulsion::uniform(0.0, 0.9, 1.0),
                &[of(1.0, 1.0)],
                2.0,
                5.0,
                |_, _| 0.0
            )
            .is_none()
        );
    }
}
