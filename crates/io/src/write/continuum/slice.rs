//! A picture of the slice through the middle of a grid: the mean of the normal stresses, and the kinetic temperature where there is one.

use super::Table;
use crate::continuum::Units;
use crate::write::atomic::WriteError;
use crate::write::plot::{ColorMap, Map};
use peridyne_fields::Quantity;
use std::path::{Path, PathBuf};

/// Writes pictures of the slice across the shortest axis of the grid; gives their paths. Nothing for points that are no grid, or a grid
/// that is no more than a line.
///
/// # Errors
/// The operating system's.
pub fn write_slice(dir: &Path, table: &Table, units: Units) -> Result<Vec<PathBuf>, WriteError> {
    let Some((n, cell)) = &table.grid else {
        return Ok(vec![]);
    };
    let across = (0..3).min_by_key(|a| n[*a]).unwrap_or(2);
    let [a, b] = match across {
        0 => [1, 2],
        1 => [0, 2],
        _ => [0, 1],
    };
    if n[a] < 2 || n[b] < 2 {
        return Ok(vec![]);
    }
    let middle = n[across] / 2;
    let place = |i: usize, j: usize| {
        let mut at = [middle; 3];
        (at[a], at[b]) = (i, j);
        at[0] + n[0] * (at[1] + n[1] * at[2])
    };
    let length = |axis: usize| {
        let e = cell.edges[axis];
        (e[0] * e[0] + e[1] * e[1] + e[2] * e[2]).sqrt()
    };
    let mut made = vec![];
    let find = |quantity: Quantity| {
        let own = table.columns.iter().find(|c| c.quantity == quantity)?;
        own.values.as_ref().ok().map(|v| (own, v))
    };
    let stress = find(Quantity::Stress).or_else(|| find(Quantity::StressPotential));
    for (name, title, found, trace) in [
        ("stress", "mean normal stress", stress, true),
        (
            "temperature",
            "kinetic temperature",
            find(Quantity::Temperature),
            false,
        ),
    ] {
        let Some((column, all)) = found else {
            continue;
        };
        let mut values = vec![];
        for j in 0..n[b] {
            for i in 0..n[a] {
                let p = place(i, j);
                values.push(match trace {
                    true => (all[9 * p] + all[9 * p + 4] + all[9 * p + 8]) / 3.0,
                    false => all[p],
                });
            }
        }
        if !values.iter().any(|v| v.is_finite()) {
            continue;
        }
        let axes = ["x", "y", "z"];
        let of = |axis: usize| [cell.origin[axis], cell.origin[axis] + length(axis)];
        let mut map = Map::new(format!("{title}, slice across {}", axes[across]))
            .x(axes[a], units.length(), of(a))
            .y(axes[b], units.length(), of(b))
            .value(title, &column.unit)
            .equal()
            .grid(n[a], &values);
        if trace {
            let most = values
                .iter()
                .filter(|v| v.is_finite())
                .fold(0.0f64, |m, v| m.max(v.abs()));
            if most > 0.0 {
                map = map.colors(ColorMap::Diverging).between(-most, most);
            }
        }
        made.extend(map.save(dir, name)?);
    }
    Ok(made)
}
