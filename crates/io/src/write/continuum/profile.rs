//! Pictures of a grid that is a line: profiles of density, temperature, the normal stresses and the heat flux along it.

use super::columns::Table;
use crate::continuum::Units;
use crate::write::atomic::WriteError;
use crate::write::plot::Plot;
use peridyne_fields::{Cell, Quantity};
use std::path::{Path, PathBuf};

const AXES: [&str; 3] = ["x", "y", "z"];

/// Writes profiles of a grid with more than one piece along one axis alone; gives their paths.
///
/// # Errors
/// The operating system's.
pub fn write_profiles(dir: &Path, table: &Table, units: Units) -> Result<Vec<PathBuf>, WriteError> {
    let Some((n, cell)) = &table.grid else {
        return Ok(vec![]);
    };
    let long: Vec<usize> = (0..3).filter(|a| n[*a] > 1).collect();
    let [axis] = long[..] else {
        return Ok(vec![]);
    };
    let line = Line {
        table,
        axis,
        x: places(cell, axis, n[axis]),
        unit: units.length(),
    };
    let stress = match line.column(Quantity::Stress) {
        Some(_) => Quantity::Stress,
        None => Quantity::StressPotential,
    };
    let heat = [
        Quantity::HeatKinetic,
        Quantity::HeatPotential,
        Quantity::HeatChurning,
    ];
    let normal = [(stress, 0, "xx"), (stress, 4, "yy"), (stress, 8, "zz")];
    let flux = [
        (heat[0], "kinetic"),
        (heat[1], "potential"),
        (heat[2], "churning"),
    ];
    let flux = flux.map(|(quantity, label)| (quantity, axis, label));
    let mut made = vec![];
    for (name, of) in [
        ("density", &[(Quantity::Density, 0, "")][..]),
        ("temperature", &[(Quantity::Temperature, 0, "")]),
        ("stress", &normal),
        ("heat_flux", &flux),
    ] {
        made.extend(line.draw(dir, name, of)?);
    }
    Ok(made)
}

/// Middles of the pieces along an axis.
fn places(cell: &Cell, axis: usize, count: usize) -> Vec<f64> {
    let e = cell.edges[axis];
    let length = (e[0] * e[0] + e[1] * e[1] + e[2] * e[2]).sqrt();
    let at = |k: usize| cell.origin[axis] + length * (k as f64 + 0.5) / count as f64;
    (0..count).map(at).collect()
}

struct Line<'a> {
    table: &'a Table,
    axis: usize,
    x: Vec<f64>,
    unit: &'a str,
}

impl Line<'_> {
    /// Values point by point, and their unit.
    fn column(&self, quantity: Quantity) -> Option<(&[f64], &str)> {
        let mut columns = self.table.columns.iter();
        let own = columns.find(|c| c.quantity == quantity)?;
        let values = own.values.as_ref().ok()?;
        Some((values, &own.unit))
    }

    /// A picture of components of quantities; none where all are 0 or no numbers.
    fn draw(
        &self,
        dir: &Path,
        name: &str,
        of: &[(Quantity, usize, &str)],
    ) -> Result<Vec<PathBuf>, WriteError> {
        let title = name.replace('_', " ");
        let mut plot = Plot::new(format!("{title} along {}", AXES[self.axis]));
        plot = plot.x(AXES[self.axis], self.unit);
        let mut any = false;
        for &(quantity, component, label) in of {
            let Some((values, unit)) = self.column(quantity) else {
                continue;
            };
            let values = values.chunks_exact(quantity.components());
            let found = self.x.iter().zip(values).map(|(x, v)| (*x, v[component]));
            let (x, y): (Vec<f64>, Vec<f64>) = found.filter(|(_, y)| y.is_finite()).unzip();
            if !x.is_empty() {
                any |= y.iter().any(|y| *y != 0.0);
                plot = plot.y(&title, unit).line(label, &x, &y);
            }
        }
        match any {
            true => Ok(plot.save(dir, name)?.to_vec()),
            false => Ok(vec![]),
        }
    }
}
