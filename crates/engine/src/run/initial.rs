//! The state of an earlier run as the initial state of another: displacements, velocities, and what bonds and points remember.

use crate::columns::Life;
use crate::error::BuildError;
use crate::run::Simulation;
use crate::space::Point;

/// What a body is in a state, whatever led there; on ranks, their own points of it.
pub struct InitialState {
    displacement: Vec<Point>,
    velocity: Vec<Point>,
    /// Persistent columns by name.
    columns: Vec<(String, Vec<f64>)>,
    reference: Vec<Point>,
}

/// Columns that have a way of their own.
const OWN: [&str; 2] = ["displacement", "velocity"];

impl InitialState {
    /// Of a model in that state.
    pub fn of(sim: &mut dyn Simulation) -> InitialState {
        let d = sim.info().dimension;
        let mut columns = vec![];
        for declared in sim.columns() {
            if declared.life != Life::Persistent || OWN.contains(&&*declared.name) {
                continue;
            }
            let Some(column) = sim.column(&declared.name) else {
                continue;
            };
            let values = column.values.packed(declared.shape, d);
            // what follows from the body cannot be set
            if sim.set_column(&declared.name, &values) {
                columns.push((declared.name.to_string(), values));
            }
        }
        InitialState {
            displacement: sim.displacements(),
            velocity: sim.velocities(),
            columns,
            reference: sim.vectors("reference"),
        }
    }

    /// Gives it to a model that was not started.
    ///
    /// # Errors
    /// The model has another body, or does not remember something of the state.
    pub fn give(self, sim: &mut dyn Simulation) -> Result<(), BuildError> {
        if sim.vectors("reference") != self.reference {
            let why = "the initial state is that of another body: its points lie elsewhere in the reference";
            return Err(BuildError::invalid("body", why));
        }
        sim.set_displacements(&self.displacement);
        sim.set_velocities(&self.velocity);
        for (name, values) in &self.columns {
            if !sim.set_column(name, values) {
                let why = format!(
                    "the initial state has `{name}`, which the bonds and points of this deck do not remember"
                );
                return Err(BuildError::conflict("materials", why)
                    .help("give them the law and the families of the earlier run"));
            }
        }
        Ok(())
    }
}
