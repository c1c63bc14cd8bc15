//! Atoms of a cell, and those that are near to them.

use super::error::{CrystalError, positive};

use super::cells;

/// An atom of the cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Atom<const D: usize> {
    /// Length.
    pub place: [f64; D],
    /// As the potential counts kinds.
    pub kind: usize,
    pub mass: f64,
}

/// An atom of the cell and one near to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Near<const D: usize> {
    pub from: usize,
    pub to: usize,
    pub xi: [f64; D],
    pub r: f64,
}

impl<const D: usize> Near<D> {
    /// Where both ends are carried along.
    pub fn moved(self, by: impl Fn([f64; D]) -> [f64; D]) -> Self {
        let xi = by(self.xi);
        let r = xi.iter().map(|c| c * c).sum::<f64>().sqrt();
        Near { xi, r, ..self }
    }
}

/// A cell of atoms, and who feels whom.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cell<'a, const D: usize> {
    /// Rows: lattice vectors (length).
    pub rows: [[f64; D]; D],
    pub atoms: &'a [Atom<D>],
    /// Those that were near in the reference, as they are now; `None`: those that are near now.
    pub fixed: Option<&'a [Near<D>]>,
}

/// All pairs of an atom of the cell with another, or an image of one, within the cut-off of their kinds, which is at most `reach`.
pub(crate) fn neighbours<const D: usize>(
    cell: &[[f64; D]; D],
    atoms: &[Atom<D>],
    reach: f64,
    cutoff: impl Fn(usize, usize) -> f64,
) -> Result<Vec<Near<D>>, CrystalError> {
    positive("the volume of the cell", cells::determinant(cell).abs())?;
    for atom in atoms {
        positive("the mass", atom.mass)?;
    }
    if !reach.is_finite() {
        return Err(CrystalError::NoCutoff);
    }
    // planes of the lattice are 2π/|b| apart; atoms may lie anywhere in the cell or out of it
    let reciprocal = cells::reciprocal(cell);
    let norm = |x: &[f64; D]| x.iter().map(|c| c * c).sum::<f64>().sqrt();
    let along = |b: &[f64; D], x: &[f64; D]| -> f64 {
        (0..D).map(|a| b[a] * x[a]).sum::<f64>() / std::f64::consts::TAU
    };
    let most: [i64; D] = std::array::from_fn(|a| {
        let b = &reciprocal[a];
        let places = atoms.iter().map(|x| along(b, &x.place));
        let (low, high) = places.fold((0.0f64, 0.0f64), |(l, h), x| (l.min(x), h.max(x)));
        (reach * norm(b) / std::f64::consts::TAU + high - low).ceil() as i64
    });
    let count: i64 = most.iter().map(|m| 2 * m + 1).product();
    let mut found = vec![];
    for (from, here) in atoms.iter().enumerate() {
        for n in 0..count {
            let mut rest = n;
            let image: [i64; D] = std::array::from_fn(|a| {
                let wide = 2 * most[a] + 1;
                let i = rest % wide - most[a];
                rest /= wide;
                i
            });
            let shift: [f64; D] =
                std::array::from_fn(|a| (0..D).map(|r| image[r] as f64 * cell[r][a]).sum());
            for (to, there) in atoms.iter().enumerate() {
                let xi: [f64; D] =
                    std::array::from_fn(|a| there.place[a] + shift[a] - here.place[a]);
                let r = norm(&xi);
                let same = from == to && image.iter().all(|i| *i == 0);
                if !same && r < cutoff(here.kind, there.kind) {
                    found.push(Near { from, to, xi, r });
                }
            }
        }
    }
    match found.is_empty() {
        false => Ok(found),
        true => Err(CrystalError::NoNeighbours {
            reach,
            nearest: f64::INFINITY,
        }),
    }
}
