//! The named arrays of a snapshot, as every format of points writes them.

use std::io::{self, Write};

use peridyne::observe::{Column, Snapshot, Values};

/// The components of symmetric tensors in VTK's order, XX YY ZZ XY YZ XZ.
pub(super) const SYMMETRIC: [usize; 6] = [0, 1, 2, 3, 5, 4];

/// The column that files of points always have: how large points are, without which nobody can draw them.
pub const SIZE: &str = "volume";

/// All columns that a snapshot carries beside the reference positions. An empty one was not asked for and is left out.
///
/// # Errors
/// `InvalidInput` when a column has another length than the reference positions, displacements are missing, or a bond names a
/// point that is not there.
pub fn fields(s: &Snapshot) -> io::Result<Vec<&Column>> {
    let n = s.reference.len();
    // without displacements there are no current positions
    if s.displacement().len() != n {
        let m = s.displacement().len();
        return Err(invalid(format!(
            "the snapshot has {n} points, but {m} values of displacement"
        )));
    }
    let there = |c: &&Column| !c.values.is_empty();
    let all: Vec<&Column> = s.columns.iter().filter(there).collect();
    for column in &all {
        if column.values.len() != n {
            return Err(invalid(format!(
                "the snapshot has {n} points, but {} values of {}",
                column.values.len(),
                column.name()
            )));
        }
    }
    let bonds = s.bonds.as_deref().unwrap_or_default();
    if let Some((i, j)) = bonds.iter().find(|(i, j)| *i.max(j) as usize >= n) {
        return Err(invalid(format!(
            "the snapshot has {n} points, but a bond ({i}, {j})"
        )));
    }
    Ok(all)
}

pub(super) fn invalid(message: String) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, message)
}

/// Current positions: reference + displacement.
pub fn positions(s: &Snapshot) -> impl Iterator<Item = [f64; 3]> + Clone + '_ {
    s.reference
        .iter()
        .zip(s.displacement())
        .map(|(x, u)| std::array::from_fn(|a| x[a] + u[a]))
}

/// Writes current positions, as VTK's files have them.
///
/// # Errors
/// Those of `w`.
pub(super) fn write_positions<W: Write>(w: &mut W, s: &Snapshot) -> io::Result<()> {
    rows(w, positions(s))
}

/// Writes the numbers of a column, as VTK's files have them: least byte first, symmetric tensors in VTK's order.
///
/// # Errors
/// Those of `w`.
pub(super) fn write_values<W: Write>(w: &mut W, values: &Values) -> io::Result<()> {
    match values {
        Values::Scalars(v) => rows(w, v.iter().map(|x| [*x])),
        Values::Vectors(v) => rows(w, v.iter().copied()),
        Values::Symmetric(v) => rows(w, v.iter().map(|t| SYMMETRIC.map(|c| t[c]))),
        Values::Tensors(v) => rows(w, v.iter().copied()),
        Values::Integers(v) => v.iter().try_for_each(|x| w.write_all(&x.to_le_bytes())),
        Values::Counts(v) => v.iter().try_for_each(|x| w.write_all(&x.to_le_bytes())),
    }
}

/// Writes rows of numbers.
pub(super) fn rows<W: Write, const N: usize>(
    w: &mut W,
    values: impl Iterator<Item = [f64; N]>,
) -> io::Result<()> {
    for v in values {
        for c in v {
            w.write_all(&c.to_le_bytes())?;
        }
    }
    Ok(())
}

/// Writes whole numbers.
pub(super) fn integers<W: Write>(w: &mut W, values: impl Iterator<Item = i64>) -> io::Result<()> {
    for v in values {
        w.write_all(&v.to_le_bytes())?;
    }
    Ok(())
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    use peridyne::columns::{Declaration, Dimension};
    use peridyne::observe::Values;

    /// A snapshot of these columns.
    pub fn of_columns(reference: Vec<[f64; 3]>, columns: Vec<(&'static str, Values)>) -> Snapshot {
        let mut s = Snapshot {
            dimension: 3,
            reference,
            ..Snapshot::default()
        };
        for (name, values) in columns {
            put(&mut s, name, values);
        }
        s
    }

    /// Replaces the values of a column, or adds it.
    pub fn put(s: &mut Snapshot, name: &'static str, values: Values) {
        s.columns.retain(|c| c.name() != name);
        let declaration = Declaration::of_points(name, values.shape(), Dimension::NUMBER, "");
        s.columns.push(Column {
            declaration,
            values,
        });
    }

    /// The same with other values of a column, in its place.
    pub fn with(mut s: Snapshot, name: &str, values: Values) -> Snapshot {
        s.columns
            .iter_mut()
            .find(|c| c.name() == name)
            .unwrap()
            .values = values;
        s
    }

    /// Three points with distinct values everywhere and two bonds.
    pub fn small() -> Snapshot {
        let displacement = vec![[0.1, 0.0, -0.1], [0.0, 1.0 / 3.0, 0.0], [0.0, 0.0, 1e-17]];
        let velocity = vec![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [-7.0, 8e300, 9e-300]];
        let columns = vec![
            ("displacement", Values::Vectors(displacement)),
            ("velocity", Values::Vectors(velocity)),
            ("damage", Values::Scalars(vec![0.0, 0.25, 1.0])),
            ("energy_density", Values::Scalars(vec![10.0, 20.0, 30.0])),
            ("dilatation", Values::Scalars(vec![0.01, -0.02, 0.03])),
            ("block", Values::Integers(vec![-1, 0, 4])),
            ("body", Values::Counts(vec![0, 1, 1])),
            ("fragment", Values::Counts(vec![0, 0, 1])),
        ];
        let reference = vec![[0.0, 0.0, 0.0], [0.5, 0.0, 0.0], [0.0, 0.5, 0.25]];
        Snapshot {
            step: 7,
            time: 1.5e-7,
            spacing: 0.5,
            bonds: Some(vec![(0, 1), (1, 2)]),
            ..of_columns(reference, columns)
        }
    }

    #[test]
    fn a_field_of_wrong_length_is_named() {
        let s = with(small(), "damage", Values::Scalars(vec![0.0; 2]));
        let text = fields(&s).unwrap_err().to_string();
        assert_eq!(text, "the snapshot has 3 points, but 2 values of damage");
        let s = with(s, "damage", Values::Scalars(vec![]));
        assert!(fields(&s).unwrap().iter().all(|c| c.name() != "damage"));
        let s = with(s, "displacement", Values::Vectors(vec![]));
        assert!(fields(&s).is_err());
    }

    #[test]
    fn a_bond_to_nowhere_is_refused() {
        let s = Snapshot {
            bonds: Some(vec![(1, 3)]),
            ..small()
        };
        assert!(fields(&s).unwrap_err().to_string().contains("(1, 3)"));
    }
}
