//! The named arrays of a snapshot, as every format of points writes them.

use std::io;

use peridyne::observe::Snapshot;

/// One array over the points.
#[derive(Debug, Clone, Copy)]
pub enum Field<'a> {
    Vector(&'a [[f64; 3]]),
    Scalar(&'a [f64]),
    Integer(&'a [i32]),
    Count(&'a [u32]),
}

impl Field<'_> {
    fn len(&self) -> usize {
        match self {
            Field::Vector(v) => v.len(),
            Field::Scalar(v) => v.len(),
            Field::Integer(v) => v.len(),
            Field::Count(v) => v.len(),
        }
    }
}

/// All arrays that a snapshot carries beside the reference positions, with their names in files. An empty
/// array was not asked for and is left out.
///
/// # Errors
/// `InvalidInput` when an array has another length than the reference positions, or a bond names a point
/// that is not there.
pub fn fields(s: &Snapshot) -> io::Result<Vec<(&'static str, Field<'_>)>> {
    let n = s.reference.len();
    let mut all = vec![
        ("displacement", Field::Vector(&s.displacement)),
        ("velocity", Field::Vector(&s.velocity)),
        ("damage", Field::Scalar(&s.damage)),
        ("energy_density", Field::Scalar(&s.energy_density)),
        ("dilatation", Field::Scalar(&s.dilatation)),
        ("mark", Field::Integer(&s.mark)),
        ("body", Field::Count(&s.body)),
    ];
    if let Some(fragment) = &s.fragment {
        all.push(("fragment", Field::Count(fragment)));
    }
    // without displacements there are no current positions: never optional
    all.retain(|(name, field)| field.len() > 0 || *name == "displacement");
    for (name, field) in &all {
        if field.len() != n {
            return Err(invalid(format!(
                "the snapshot has {n} points, but {} values of {name}",
                field.len()
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
        .zip(&s.displacement)
        .map(|(x, u)| std::array::from_fn(|a| x[a] + u[a]))
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Three points with distinct values everywhere and two bonds.
    pub fn small() -> Snapshot {
        Snapshot {
            step: 7,
            time: 1.5e-7,
            dimension: 3,
            spacing: 0.5,
            reference: vec![[0.0, 0.0, 0.0], [0.5, 0.0, 0.0], [0.0, 0.5, 0.25]],
            displacement: vec![[0.1, 0.0, -0.1], [0.0, 1.0 / 3.0, 0.0], [0.0, 0.0, 1e-17]],
            velocity: vec![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [-7.0, 8e300, 9e-300]],
            damage: vec![0.0, 0.25, 1.0],
            dilatation: vec![0.01, -0.02, 0.03],
            energy_density: vec![10.0, 20.0, 30.0],
            mark: vec![-1, 0, 4],
            body: vec![0, 1, 1],
            fragment: Some(vec![0, 0, 1]),
            bonds: Some(vec![(0, 1), (1, 2)]),
        }
    }

    #[test]
    fn a_field_of_wrong_length_is_named() {
        let mut s = small();
        s.damage.pop();
        let text = fields(&s).unwrap_err().to_string();
        assert_eq!(text, "the snapshot has 3 points, but 2 values of damage");
        s.damage.clear();
        assert!(
            fields(&s)
                .unwrap()
                .iter()
                .all(|(name, _)| *name != "damage")
        );
        s.displacement.clear();
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
