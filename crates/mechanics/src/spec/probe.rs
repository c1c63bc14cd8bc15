//! What is measured over time: columns of a history.

use crate::space::Point;

/// A measurement of a set of points.
#[derive(Debug, Clone, PartialEq)]
pub struct ProbeSpec {
    /// Its columns begin with it.
    pub name: String,
    /// Of which points; `"all"` always exists.
    pub set: String,
    pub measure: Measure,
}

/// What a probe measures.
#[derive(Debug, Clone, PartialEq)]
pub enum Measure {
    /// Sum of the forces that constraints exert on the set (force), per axis.
    Reaction,
    /// Their moment about a fixed point, with points where they are now (force · length), about every axis that the dimension has.
    Moment { about: Point },
    /// Kinetic energy of the set, and strain and repulsion energy with half of each bond that leaves it.
    Energy,
    /// A number of the values of a column over the set.
    Over { fold: Fold, of: String, part: Part },
    /// A column at the point of the set that is nearest to a place in the reference (of equal ones the first).
    Value { at: Point, of: String, part: Part },
    /// Of a rigid body by its name; `None`: all of it.
    RigidBody {
        rigid_body: String,
        of: Option<RigidQuantity>,
    },
    /// J-integral around a crack tip in two dimensions, and the stress intensity `K = √(J E′)`.
    JIntegral(JIntegralSpec),
    /// Where a crack ends, how long it is, and into how many branches it has split.
    CrackTip(CrackTipSpec),
    /// How far the points of the set that are nearest to two places in the reference have moved apart.
    Opening { between: [Point; 2] },
    /// Pieces that hang together by whole bonds, of so many points at least.
    Fragments { points: u32 },
}

/// A crack that is followed: the damaged points of a set that hang together with where it starts, by steps of at most a horizon in the reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CrackTipSpec {
    /// From where its length counts.
    pub from: Point,
    /// Along which it counts; a unit vector.
    pub direction: Point,
    /// Points with at least this damage are part of it.
    pub damage: f64,
}

/// A rectangle around the tip of a straight crack.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JIntegralSpec {
    pub low: [f64; 2],
    pub high: [f64; 2],
    /// Where the crack grows to; a unit vector.
    pub direction: [f64; 2],
}

/// What a rigid body has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RigidQuantity {
    /// Of points on it (force).
    Force,
    /// Of these forces about its centre (force · length).
    Torque,
    Center,
    Velocity,
    /// Axis times angle, from 0 to π.
    Turn,
    /// Angular velocity (1 / time).
    Spin,
    /// Kinetic energy, and what its friction took.
    Energy,
}

impl RigidQuantity {
    pub const ALL: [RigidQuantity; 7] = [
        RigidQuantity::Force,
        RigidQuantity::Torque,
        RigidQuantity::Center,
        RigidQuantity::Velocity,
        RigidQuantity::Turn,
        RigidQuantity::Spin,
        RigidQuantity::Energy,
    ];

    pub fn name(self) -> &'static str {
        match self {
            RigidQuantity::Force => "force",
            RigidQuantity::Torque => "torque",
            RigidQuantity::Center => "center",
            RigidQuantity::Velocity => "velocity",
            RigidQuantity::Turn => "rotation",
            RigidQuantity::Spin => "angular_velocity",
            RigidQuantity::Energy => "energy",
        }
    }

    /// Does it go around axes?
    pub fn is_turn(self) -> bool {
        match self {
            RigidQuantity::Torque | RigidQuantity::Turn | RigidQuantity::Spin => true,
            RigidQuantity::Force
            | RigidQuantity::Center
            | RigidQuantity::Velocity
            | RigidQuantity::Energy => false,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fold {
    /// Of points, each counts once.
    Mean,
    Min,
    Max,
    Sum,
}

/// Which part of a value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Part {
    /// Each component by itself.
    All,
    /// One, by name: `x`, `xy`.
    Component(String),
    /// Length of a vector, `√(T:T)` of a tensor.
    Magnitude,
}
