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

#[cfg(test)]
mod tests {
    use super::*;
    use peridyne::columns::{Declaration, Shape};
    use peridyne::observe::{Column, Values};

    #[test]
    fn each_fragment_has_its_mass_place_and_velocity() {
        let column = |name: &'static str, shape, values| Column {
            declaration: Declaration::of_points(name, shape, Dimension::NUMBER, ""),
            values,
        };
        let scalars =
            |name, values: [f64; 3]| column(name, Shape::Scalar, Values::Scalars(values.to_vec()));
        let vectors =
            |name, values: Vec<[f64; 3]>| column(name, Shape::Vector, Values::Vectors(values));
        // two points of masses 2 and 6, and one of mass 5 by itself
        let state = Snapshot {
            dimension: 2,
            reference: vec![[0.0, 0.0, 0.0], [4.0, 4.0, 0.0], [1.0, 0.0, 0.0]],
            columns: vec![
                column("fragment", Shape::Scalar, Values::Counts(vec![0, 1, 0])),
                scalars("volume", [1.0, 1.0, 2.0]),
                scalars("density", [2.0, 5.0, 3.0]),
                vectors(
                    "velocity",
                    vec![[4.0, 0.0, 0.0], [7.0, 1.0, 0.0], [0.0, 8.0, 0.0]],
                ),
                vectors(
                    "displacement",
                    vec![[0.0, 4.0, 0.0], [1.0, 0.0, 0.0], [3.0, 0.0, 0.0]],
                ),
            ],
            ..Snapshot::default()
        };
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("fragments.csv");
        write(&path, &state, UnitSystem::Si).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        let rows: Vec<&str> = text.lines().collect();
        assert_eq!(
            rows[0],
            "fragment,points,mass [kg],x [m],y [m],velocity_x [m/s],velocity_y [m/s]"
        );
        let numbers =
            |row: &str| -> Vec<f64> { row.split(',').map(|x| x.parse().unwrap()).collect() };
        assert_eq!(numbers(rows[1]), [0.0, 2.0, 8.0, 3.0, 1.0, 1.0, 6.0]);
        assert_eq!(numbers(rows[2]), [1.0, 1.0, 5.0, 5.0, 4.0, 7.0, 1.0]);
        assert_eq!(rows.len(), 3);
    }
}
