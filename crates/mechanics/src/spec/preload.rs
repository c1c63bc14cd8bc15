//! Statics before motion: what is in equilibrium when motion begins.

use super::condition::ConditionSpec;
use super::rigid_body::RigidBodySpec;
use super::{PrecrackSpec, Statics};

/// A stage of statics that motion begins from: increments of load under conditions of its own, each of which ends in equilibrium. Its
/// last displacements are the first of the motion, and the ledger goes on.
#[derive(Debug, Clone)]
pub struct PreloadSpec {
    pub statics: Statics,
    pub increments: u64,
    /// `None`: t of its conditions is a number that goes from 0 to 1; else a time that goes from 0 to this one. t of the motion begins
    /// at 0 again.
    pub duration: Option<f64>,
    /// In place of those of the motion.
    pub conditions: Vec<ConditionSpec>,
    /// In place of those of the motion.
    pub rigid_bodies: Vec<RigidBodySpec>,
    /// Cut when motion begins.
    pub cuts: Vec<PrecrackSpec>,
}

impl PreloadSpec {
    /// What t of its conditions goes to.
    pub fn end(&self) -> f64 {
        self.duration.unwrap_or(1.0)
    }
}
