//! The space that a body is in.

/// Dimensions, section and periods of the space; the default: three dimensions without a period.
#[derive(Debug, Clone)]
pub struct SpaceSpec {
    /// Space dimensions: 1, 2 or 3.
    pub dimension: usize,
    /// Plane stress or plane strain (2-D only; ignored elsewhere).
    pub plane: Plane,
    /// Thickness of a 2-D body or cross-section of a 1-D body (length, length²); 1 in 3-D.
    pub section: f64,
    /// Periodic axes; the period is the box of the lattice body or `period`.
    pub periodic: [Option<f64>; 3],
}

impl Default for SpaceSpec {
    fn default() -> SpaceSpec {
        SpaceSpec {
            dimension: 3,
            plane: Plane::Stress,
            section: 1.0,
            periodic: [None; 3],
        }
    }
}

/// What a two-dimensional body is a section of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Plane {
    #[default]
    Stress,
    Strain,
}
