//! `fragments.csv`: the pieces into which a body has broken, the one with the most points first.

use super::atomic::WriteError;
use super::table::Table;
use crate::deck::UnitSystem;
use peridyne::observe::Snapshot;
use peridyne::quantity::Dimension;
use std::path::Path;

/// Columns of points that it is made of.
pub const COLUMNS: [&str; 4] = ["fragment", "volume", "density", "velocity"];

/// What a fragment is: number of points, mass, and of its centre of mass the place and the velocity.
#[derive(Debug, Clone, Default, PartialEq)]
struct Fragment {
    points: u64,
    mass: f64,
    /// Both times the mass.
    place: [f64; 3],
    velocity: [f64; 3],
}

fn all(state: &Snapshot) -> Vec<Fragment> {
    let columns = COLUMNS.map(|name| state.column(name).expect("was asked for"));
    let [label, volume, density, velocity] = columns.map(|c| &c.values);
    let u = state.displacement();
    let mut fragments: Vec<Fragment> = vec![];
    for (n, x) in state.reference.iter().enumerate() {
        let label = label.at(n, 0) as usize;
        if label >= fragments.len() {
            fragments.resize(label + 1, Fragment::default());
        }
        let fragment = &mut fragments[label];
        let mass = volume.at(n, 0) * density.at(n, 0);
        fragment.points += 1;
        fragment.mass += mass;
        for a in 0..state.dimension {
            fragment.place[a] += mass * (x[a] + u[n][a]);
            fragment.velocity[a] += mass * velocity.at(n, a);
        }
    }
    fragments
}

/// Writes the table of a state that has [`COLUMNS`].
///
/// # Errors
/// The operating system's.
///
/// # Panics
/// A column is missing.
pub fn write(path: &Path, state: &Snapshot, units: UnitSystem) -> Result<(), WriteError> {
    let fragments = all(state);
    let each = |of: &dyn Fn(&Fragment) -> f64| fragments.iter().map(of).collect::<Vec<f64>>();
    let mut table = Table::new()
        .column("fragment", "", (0..fragments.len()).map(|n| n as f64))
        .column("points", "", each(&|f| f.points as f64))
        .column("mass", &units.unit(Dimension::MASS), each(&|f| f.mass));
    let axes = &["x", "y", "z"][..state.dimension];
    for (a, axis) in axes.iter().enumerate() {
        let place = each(&|f| f.place[a] / f.mass);
        table = table.column(axis, &units.unit(Dimension::LENGTH), place);
    }
    for (a, axis) in axes.iter().enumerate() {
        let velocity = each(&|f| f.velocity[a] / f.mass);
        let name = format!("velocity_{axis}");
        table = table.column(&name, &units.unit(Dimension::VELOCITY), velocity);
    }
    table.save(path)
}
