//! Families: which points talk to which. Each kind enumerates its bonds in one place.

pub mod horizon;
pub(crate) mod links;
pub(crate) mod neighbours;
pub mod nodes;
pub(crate) mod offsets;
pub mod stencil;

pub use neighbours::periods;

/// Fraction of a partner's volume that lies inside the horizon, linear over one cell:
/// `½ + (δ − r0)/h` where `|r0 − δ| ≤ h/2`, else 1 (LAMMPS's observed ν; Parks et al. 2008 (3.0.13)).
pub fn volume_fraction(r0: f64, horizon: f64, spacing: f64) -> f64 {
    (0.5 + (horizon - r0) / spacing).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Parks et al. 2008, (3.0.13) and their figure 3.1: 1 up to half a spacing before the horizon, a straight line from there, ½ at the horizon.
    #[test]
    fn volumes_count_in_full_until_their_cells_reach_over_the_horizon() {
        let (horizon, h) = (3.0, 0.5);
        for (r, part) in [
            (0.1, 1.0),
            (2.5, 1.0),
            (2.75, 1.0),
            (2.875, 0.75),
            (3.0, 0.5),
        ] {
            assert_eq!(volume_fraction(r, horizon, h), part, "{r}");
        }
    }
}
