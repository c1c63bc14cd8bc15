//! Parameters of the same potential in other lengths and energies.

use super::descriptor::{Descriptor, Key, Value};
use crate::columns::Dimension;
use crate::spec::{Parameter, Parameters};

/// A number of some dimension.
fn power(dimension: Dimension, x: f64, length: f64, energy: f64) -> f64 {
    // an energy is a mass times a velocity squared
    let [l, m, t, k] = dimension.0;
    if (t, k) != (-2 * m, 0) {
        return x;
    }
    let (energies, lengths) = (i32::from(m), i32::from(l - 2 * m));
    let up = |x: f64, n: i32| if n > 0 { x.powi(n) } else { 1.0 };
    x * (up(energy, energies) * up(length, lengths))
        / (up(energy, -energies) * up(length, -lengths))
}

/// Rows of constants of triples of kinds, which come first.
pub fn rows(columns: &[Key], rows: &mut [Vec<f64>], length: f64, energy: f64) {
    for row in rows {
        for (x, c) in row.iter_mut().skip(3).zip(columns) {
            *x = c.dimension().map_or(*x, |d| power(d, *x, length, energy));
        }
    }
}

/// Each number to the power of energy and length that its dimension has; a dimension that has others is left alone.
pub fn by_dimension(
    descriptor: &Descriptor,
    parameters: &mut Parameters,
    length: f64,
    energy: f64,
) {
    for (name, given) in &mut parameters.0 {
        let Some(key) = descriptor.key(name) else {
            continue;
        };
        match (key.value, given) {
            (Value::Number(dimension, _), Parameter::Number(x)) => {
                *x = power(dimension, *x, length, energy)
            }
            (Value::List(_, dimension, _), Parameter::List(list)) => {
                list.iter_mut()
                    .for_each(|x| *x = power(dimension, *x, length, energy));
            }
            (Value::Rows(columns), Parameter::Rows(rows)) => {
                for row in rows {
                    let each = row.iter_mut().zip(columns);
                    each.for_each(|(x, c)| *x = power(c.1, *x, length, energy));
                }
            }
            (Value::Entries(columns), Parameter::Rows(list)) => rows(columns, list, length, energy),
            // words, tables (which say themselves how they grow), and what does not fit its key
            _ => {}
        }
    }
}
