//! The state of an earlier run as the initial state of another: displacements, velocities, and what bonds and points remember.

use crate::failure::Failure;
use peridyne::columns::Life;
use peridyne::run::{Options, Simulation, build};
use peridyne::space::Point;
use peridyne_io::deck::Deck;
use peridyne_io::drive::take_state;
use peridyne_io::write::checkpoint::Checkpoint;

/// What a body is in a state, whatever led there.
pub struct InitialState {
    displacement: Vec<Point>,
    velocity: Vec<Point>,
    /// Persistent columns by name.
    columns: Vec<(String, Vec<f64>)>,
    reference: Vec<Point>,
}

/// Columns that are the body's, or have a way of their own.
const OWN: [&str; 2] = ["displacement", "velocity"];

impl InitialState {
    /// Of a checkpoint, with a model of the deck that it was made by.
    pub fn of(mut from: Checkpoint) -> Result<InitialState, Failure> {
        let asked = from.asked.clone();
        let name = asked.deck.to_string_lossy();
        let deck =
            Deck::parse(&asked.text, &name, &asked.set).map_err(|e| Failure::Input(e.into()))?;
        let mut sim = build(&deck.spec, Options::default())
            .map_err(|e| Failure::Input(deck.explain(&e).into()))?;
        take_state(sim.as_mut(), &mut from).map_err(|e| Failure::input(e.to_string()))?;
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
            // what follows from the body, a model does not let itself be told
            if sim.set_column(&declared.name, &values) {
                columns.push((declared.name.to_string(), values));
            }
        }
        Ok(InitialState {
            displacement: sim.displacements(),
            velocity: sim.velocities(),
            columns,
            reference: sim.vectors("reference"),
        })
    }

    /// Gives it to a model that was not started.
    pub fn give(self, sim: &mut dyn Simulation) -> Result<(), Failure> {
        if sim.vectors("reference") != self.reference {
            return Err(Failure::input(
                "--as-initial: the state is that of another body: its points lie elsewhere in the reference",
            ));
        }
        sim.set_displacements(&self.displacement);
        sim.set_velocities(&self.velocity);
        for (name, values) in &self.columns {
            if !sim.set_column(name, values) {
                return Err(Failure::input(format!(
                    "--as-initial: the state has `{name}`, which the bonds and points of this deck do not remember; give them the law and the families of the earlier run"
                )));
            }
        }
        Ok(())
    }
}
