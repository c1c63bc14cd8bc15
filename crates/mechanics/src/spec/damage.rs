//! Which bonds break, when, and which become whole again.

use super::Breakage;
use crate::expression::Expression;
use crate::space::triangles::Triangles;

/// What decides which bonds break besides the materials' own criteria; the default: nothing.
#[derive(Debug, Clone, Default)]
pub struct DamageSpec {
    pub precracks: Vec<PrecrackSpec>,
    /// Factors of the toughness of points.
    pub toughness: Vec<ToughnessSpec>,
    /// Which broken bonds become whole again; `None`: none.
    pub healing: Option<HealingSpec>,
    /// When a bond past its critical stretch lets go.
    pub breakage: Breakage,
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
    /// The bonds are excluded from the families: not counted in damage.
    Excluded,
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
