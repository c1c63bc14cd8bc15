//! What is done to bonds before the run: factors of their stiffness, pre-cracks; and contact between points without one.

use super::CohesionSpec;
use crate::expression::Expression;
use crate::space::triangles::Triangles;

/// A factor of the stiffness of bonds: heterogeneous bodies, weak planes.
#[derive(Debug, Clone)]
pub enum BondFactorSpec {
    /// Every bond gets the mean, by [`Spec::interface`](super::Spec::interface), of the factors at its ends' reference positions.
    Field(Expression),
    /// Bonds that cross this shape.
    Crossing { shape: CrackShape, factor: f64 },
}

/// Broken bonds that become whole again.
#[derive(Debug, Clone)]
pub struct HealingSpec {
    /// Both ends are of this set.
    pub set: String,
    /// Size of the stretch below which they heal, an expression of t; 0 and less: nothing heals.
    pub below: Expression,
}

/// Toughness of some points.
#[derive(Debug, Clone)]
pub struct ToughnessSpec {
    pub set: String,
    pub factor: ToughnessFactor,
}

/// What the critical stretch s00 of points is multiplied with; all that concern a point are multiplied. A bond breaks at the lower one of its
/// ends.
#[derive(Debug, Clone)]
pub enum ToughnessFactor {
    /// An expression of place and time.
    Stretch(Expression),
    /// Of the fracture energy: its root of the critical stretch.
    Energy(Expression),
    /// Of the critical stretch by the temperature: rows `[T, factor]`, T rising; lines between them, and the outer ones beyond.
    Temperature(Vec<[f64; 2]>),
    /// Bonds of these points never break, whatever their other end says.
    NoFailure,
}

/// Bonds that a pre-crack cuts.
#[derive(Debug, Clone)]
pub struct PrecrackSpec {
    pub shape: CrackShape,
    pub kind: CrackKind,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CrackKind {
    /// The bonds were never there: not counted in damage.
    Absent,
    /// The bonds are broken at the start: counted as damage.
    Broken,
}

/// Shapes that cut bonds crossing them: flat ones, and surfaces of triangles.
#[derive(Debug, Clone)]
pub enum CrackShape {
    /// Segment between two points (2-D; in 3-D extruded along z without end).
    Segment { from: [f64; 3], to: [f64; 3] },
    /// Disk with centre, unit normal and radius (3-D).
    Disk {
        center: [f64; 3],
        normal: [f64; 3],
        radius: f64,
    },
    /// Flat polygon with three or more corners (3-D).
    Polygon { corners: Vec<[f64; 3]> },
    /// Point on a chain (1-D).
    Point { x: f64 },
    /// Surface of triangles, open or closed (3-D).
    Surface(std::sync::Arc<Triangles>),
}

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
