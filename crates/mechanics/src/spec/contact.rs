//! Contact between points without a bond.

use super::CohesionSpec;
use crate::expression::Expression;

/// Short-range repulsion (`lammps-peri` item 10): force density `stiffness V_j (r − d)`,
/// `d = min(bonded r0, free h)` with `h` the spacing.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactSpec {
    /// Fraction of the reference distance below which any pair repels; 0.9 in LAMMPS.
    pub bonded: f64,
    /// Range in spacings for pairs far apart in the reference; 1.35 in LAMMPS.
    pub free: f64,
    pub stiffness: ContactStiffness,
    /// Coulomb friction between points that touch and have no whole bond; `None`: they slide freely.
    pub friction: Option<FrictionSpec>,
    /// What points of different bodies attract each other by; `None`: nothing.
    pub cohesion: Option<CohesionSpec>,
    /// Thermal contact conductance h_c (power / area / temperature) between points that touch and were never bonded; `None`: contact conducts
    /// nothing.
    pub conductance: Option<f64>,
}

/// Coefficient of friction of points that slide at a speed v: `μ = μ_k + (μ_s − μ_k) exp(−v/v_c)` (Oden & Martins 1985, section 2.4).
#[derive(Debug, Clone, PartialEq)]
pub struct FrictionSpec {
    /// μ_k of sliding (–), an expression of t.
    pub kinetic: Expression,
    /// `None`: the same at rest.
    pub at_rest: Option<AtRest>,
}

/// What friction has more at rest.
#[derive(Debug, Clone, PartialEq)]
pub struct AtRest {
    /// μ_s (–), an expression of t.
    pub coefficient: Expression,
    /// v_c, at which the difference is 1/e of that at rest (length / time).
    pub speed: f64,
}

impl FrictionSpec {
    /// The same at all speeds and times.
    pub fn constant(coefficient: f64) -> FrictionSpec {
        FrictionSpec {
            kinetic: Expression::constant(coefficient),
            at_rest: None,
        }
    }
}

/// Stiffness of repulsion (force / volume² / length).
#[derive(Debug, Clone, PartialEq)]
pub enum ContactStiffness {
    /// `15 c/δ` (PMB), `15·18K/(πδ⁵)` (LPS) of a material; between unlike ones the harmonic mean, which is that of the
    /// two in series: each gives way by its own stiffness, and it is never above twice the softer one's.
    Laws,
    /// The same for all pairs.
    Same(f64),
    /// `[materials][materials]`, symmetric: of every pair of materials.
    Pairs(Vec<Vec<f64>>),
}
