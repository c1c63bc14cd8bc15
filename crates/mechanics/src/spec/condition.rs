//! Initial values, and what is done to points during the run.

use super::Parameters;
use crate::expression::Expression;

/// Initial values on a set; components are expressions of x, y, z (t = 0); `None` leaves a component.
#[derive(Debug, Clone)]
pub struct InitialSpec {
    pub set: String,
    pub displacement: [Option<Expression>; 3],
    pub velocity: [Option<Expression>; 3],
}

/// Velocities of a given temperature: normally distributed, without total momentum, scaled to the mean temperature exactly.
#[derive(Debug, Clone)]
pub struct ThermalSpec {
    /// k_B T (energy), an expression of x, y, z.
    pub energy: Expression,
    pub seed: u64,
}

/// What is done to a set during the run; expressions of reference x, y, z and t; `None` leaves a component free.
#[derive(Debug, Clone)]
pub struct ConditionSpec {
    pub set: String,
    pub kind: ConditionKind,
}

#[derive(Debug, Clone)]
pub enum ConditionKind {
    /// Prescribed displacement (length).
    Displacement([Option<Expression>; 3]),
    /// Prescribed velocity (length / time).
    Velocity([Option<Expression>; 3]),
    /// Body force density (force / volume).
    BodyForce([Option<Expression>; 3]),
    /// Traction (force / area) on the face that the set stands for, spread over its points by volume; `area` is that of the face. Left out
    /// it is what a mesh says of the set, or that of a layer of a lattice ([`face`](crate::space::face)).
    Traction {
        value: [Option<Expression>; 3],
        area: Option<f64>,
    },
    /// The force density on these components becomes this, whatever else acts (LAMMPS `fix setforce`).
    SetForce([Option<Expression>; 3]),
    /// Viscous force density −c v (mass / volume / time).
    Damping(Expression),
    /// A force of the registry that the model is built with.
    Force(ForceSpec),
}

/// A force of the registry by its name, with its constants.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ForceSpec {
    pub name: String,
    pub parameters: Parameters,
}

impl ConditionKind {
    /// A force of the registry.
    pub fn force(name: &str, parameters: Parameters) -> ConditionKind {
        ConditionKind::Force(ForceSpec {
            name: name.into(),
            parameters,
        })
    }

    /// Does any of its expressions?
    pub fn depends_on_time(&self) -> bool {
        match self {
            ConditionKind::Displacement(all)
            | ConditionKind::Velocity(all)
            | ConditionKind::BodyForce(all)
            | ConditionKind::Traction { value: all, .. }
            | ConditionKind::SetForce(all) => all.iter().flatten().any(Expression::depends_on_time),
            ConditionKind::Damping(one) => one.depends_on_time(),
            ConditionKind::Force(_) => true,
        }
    }
}
