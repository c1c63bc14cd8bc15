//! Families: which points talk to which. Each kind enumerates its bonds in one place.

pub(crate) mod cells;
pub mod horizon;
pub(crate) mod links;
pub(crate) mod neighbours;
pub(crate) mod offsets;
pub mod stencil;

/// Fraction of a partner's volume that lies inside the horizon, linear over one cell:
/// `½ + (δ − r0)/h` where `|r0 − δ| ≤ h/2`, else 1 (LAMMPS's observed ν; Parks et al. 2008 (3.0.13)).
pub fn volume_fraction(r0: f64, horizon: f64, spacing: f64) -> f64 {
    (0.5 + (horizon - r0) / spacing).min(1.0)
}
