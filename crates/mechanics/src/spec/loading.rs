//! What acts on a body from outside, and how it moves at first.

use super::{ConditionSpec, InitialSpec, RigidBodySpec, ThermalSpec};

/// Initial and boundary conditions, and rigid bodies; the default: none, temperatures are energies.
#[derive(Debug, Clone)]
pub struct LoadingSpec {
    pub initial: Vec<InitialSpec>,
    /// Boltzmann's constant in these units (energy / temperature); 1 where temperatures are energies.
    pub boltzmann: f64,
    /// Maxwellian velocities, given before those of `initial`.
    pub thermal: Option<ThermalSpec>,
    pub conditions: Vec<ConditionSpec>,
    pub rigid_bodies: Vec<RigidBodySpec>,
}

impl Default for LoadingSpec {
    fn default() -> LoadingSpec {
        LoadingSpec {
            initial: vec![],
            boltzmann: 1.0,
            thermal: None,
            conditions: vec![],
            rigid_bodies: vec![],
        }
    }
}
