//! Rigid bodies that push points.

use super::FrictionSpec;
use super::cohesion::CohesionSpec;
use crate::expression::Expression;
use crate::space::Point;
use crate::space::rigid::RigidShape;

/// A rigid body that pushes points out with force density `K g²` at a depth g below its surface (of a sphere `lammps-peri` item 13).
#[derive(Debug, Clone, PartialEq)]
pub struct RigidBodySpec {
    /// For probes; empty: it has none.
    pub name: String,
    /// Stiffness K (force density / length²).
    pub stiffness: f64,
    pub shape: RigidShape,
    pub motion: RigidBodyMotion,
    /// How it is turned: of a driven one always, of a free one at the start.
    pub turn: Option<TurnSpec>,
    /// Coulomb friction on its surface; `None`: points slide freely.
    pub friction: Option<FrictionSpec>,
    /// What pulls points that are near; `None`: nothing.
    pub cohesion: Option<CohesionSpec>,
}

/// A rotation about an axis through the centre.
#[derive(Debug, Clone, PartialEq)]
pub struct TurnSpec {
    /// Of length 1.
    pub axis: Point,
    /// Radians, an expression of t.
    pub angle: Expression,
}

#[expect(clippy::large_enum_variant, reason = "a spec has few of them")]
#[derive(Debug, Clone, PartialEq)]
pub enum RigidBodyMotion {
    /// Centre as a function of t (x, y, z in the expressions are 0).
    Kinematic([Expression; 3]),
    /// A body with mass.
    Free(FreeSpec),
}

/// A rigid body that moves by the forces on it.
#[derive(Debug, Clone, PartialEq)]
pub struct FreeSpec {
    pub mass: f64,
    /// Moments of inertia about its centre along the axes of the shape (mass · length²); `None`: those of the shape with the same density
    /// everywhere.
    pub inertia: Option<[Point; 3]>,
    /// Where the centre of mass begins, its velocity, and the angular velocity (1 / time).
    pub center: Point,
    pub velocity: Point,
    pub spin: Point,
    /// On its centre (force) and about it (force · length), expressions of t.
    pub force: [Expression; 3],
    pub torque: [Expression; 3],
    /// Length / time², an expression of t.
    pub gravity: [Expression; 3],
}

impl RigidBodySpec {
    /// Without a name, friction or turn.
    pub fn new(stiffness: f64, shape: RigidShape, motion: RigidBodyMotion) -> RigidBodySpec {
        RigidBodySpec {
            name: String::new(),
            stiffness,
            shape,
            motion,
            turn: None,
            friction: None,
            cohesion: None,
        }
    }

    pub fn sphere(stiffness: f64, radius: f64, motion: RigidBodyMotion) -> RigidBodySpec {
        RigidBodySpec::new(stiffness, RigidShape::Sphere { radius }, motion)
    }
}

impl FreeSpec {
    /// A mass that nothing but points pushes.
    pub fn new(mass: f64, center: Point, velocity: Point) -> FreeSpec {
        let zero = || crate::array::from_fn(|_| Expression::constant(0.0));
        FreeSpec {
            mass,
            inertia: None,
            center,
            velocity,
            spin: [0.0; 3],
            force: zero(),
            torque: zero(),
            gravity: zero(),
        }
    }
}
