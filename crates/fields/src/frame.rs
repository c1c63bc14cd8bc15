//! A state of particles: positions, velocities, masses, kinds, and the cell that holds them.

use crate::FieldsError;
use crate::kernel::dot;

/// A cell of three edges, each periodic or not. Along an axis that is not, particles and points may lie outside.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    pub origin: [f64; 3],
    /// Edges, one per row.
    pub edges: [[f64; 3]; 3],
    pub periodic: [bool; 3],
    /// Rows whose products with a vector are its fractions of the edges.
    inverse: [[f64; 3]; 3],
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}

impl Cell {
    /// # Errors
    /// The edges span no volume, or are not finite.
    pub fn new(
        origin: [f64; 3],
        edges: [[f64; 3]; 3],
        periodic: [bool; 3],
    ) -> Result<Cell, FieldsError> {
        let normals: [[f64; 3]; 3] =
            std::array::from_fn(|a| cross(edges[(a + 1) % 3], edges[(a + 2) % 3]));
        let volume = dot(edges[0], normals[0]);
        let size: f64 = edges.iter().map(|e| dot(*e, *e).sqrt()).product();
        if !(volume.abs() > 1e-9 * size) || !volume.is_finite() {
            return Err(FieldsError(format!(
                "the edges of the cell, {edges:?}, span no volume"
            )));
        }
        let inverse = normals.map(|n| n.map(|c| c / volume));
        Ok(Cell {
            origin,
            edges,
            periodic,
            inverse,
        })
    }

    /// The same cell with other periodic axes.
    pub(crate) fn with_periods(&self, periodic: [bool; 3]) -> Cell {
        Cell {
            periodic,
            ..self.clone()
        }
    }

    /// With edges along the axes.
    ///
    /// # Errors
    /// As [`Cell::new`].
    pub fn orthogonal(
        low: [f64; 3],
        high: [f64; 3],
        periodic: [bool; 3],
    ) -> Result<Cell, FieldsError> {
        let edges = std::array::from_fn(|a| {
            std::array::from_fn(|b| if a == b { high[a] - low[a] } else { 0.0 })
        });
        Self::new(low, edges, periodic)
    }

    /// A cube about the origin in free space: nothing is periodic.
    pub fn free(half: f64) -> Cell {
        let diagonal =
            |x: f64| std::array::from_fn(|a| std::array::from_fn(|b| if a == b { x } else { 0.0 }));
        Cell {
            origin: [-half; 3],
            edges: diagonal(2.0 * half),
            periodic: [false; 3],
            inverse: diagonal(0.5 / half),
        }
    }

    pub fn volume(&self) -> f64 {
        dot(self.edges[0], cross(self.edges[1], self.edges[2])).abs()
    }

    /// Distance between the two faces that an axis joins.
    pub fn height(&self, axis: usize) -> f64 {
        1.0 / dot(self.inverse[axis], self.inverse[axis]).sqrt()
    }

    /// Fractions of the edges, from the origin.
    pub fn fraction(&self, x: [f64; 3]) -> [f64; 3] {
        let d = std::array::from_fn(|a| x[a] - self.origin[a]);
        self.inverse.map(|row| dot(row, d))
    }

    /// The point at these fractions.
    pub fn at(&self, s: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|c| {
            self.origin[c]
                + s[0] * self.edges[0][c]
                + s[1] * self.edges[1][c]
                + s[2] * self.edges[2][c]
        })
    }

    /// So many edges.
    pub fn shift(&self, n: [i32; 3]) -> [f64; 3] {
        std::array::from_fn(|c| (0..3).map(|a| f64::from(n[a]) * self.edges[a][c]).sum())
    }

    /// The image of b that is nearest to a along each edge, in periods from b, and from a to it.
    pub(crate) fn nearest(&self, a: [f64; 3], b: [f64; 3]) -> ([i32; 3], [f64; 3]) {
        let d: [f64; 3] = std::array::from_fn(|c| b[c] - a[c]);
        let image: [i32; 3] = std::array::from_fn(|e| match self.periodic[e] {
            true => -dot(self.inverse[e], d).round() as i32,
            false => 0,
        });
        let shift = self.shift(image);
        (image, std::array::from_fn(|c| d[c] + shift[c]))
    }

    /// The image inside the cell, along periodic axes.
    pub fn wrap(&self, x: [f64; 3]) -> [f64; 3] {
        let s = self.fraction(x);
        let n: [i32; 3] = std::array::from_fn(|a| match self.periodic[a] {
            true => -s[a].floor() as i32,
            false => 0,
        });
        let shift = self.shift(n);
        std::array::from_fn(|a| x[a] + shift[a])
    }

    /// Is every edge along its own axis?
    pub fn is_orthogonal(&self) -> bool {
        (0..3).all(|a| (0..3).all(|b| a == b || self.edges[a][b] == 0.0))
    }

    /// Extents for averages over axes: the edge along each, if the cell's periods do not tilt out of it.
    ///
    /// # Errors
    /// An axis along which averages over the cell make no sense.
    pub fn extents(&self, axes: [bool; 3]) -> Result<[Option<f64>; 3], FieldsError> {
        for a in (0..3).filter(|a| axes[*a]) {
            if (0..3).any(|b| !axes[b] && self.edges[a][b] != 0.0) {
                let name = ["x", "y", "z"][a];
                return Err(FieldsError(format!(
                    "averages over {name} need an edge of the cell along it: this cell is tilted"
                )));
            }
        }
        Ok(std::array::from_fn(|a| {
            axes[a].then(|| self.edges[a][a].abs())
        }))
    }
}

/// Periods from the cell at which a place keeps ten digits of it.
const FARTHEST: f64 = 1e6;

/// Particles at a time.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    pub cell: Cell,
    pub position: Vec<[f64; 3]>,
    pub velocity: Option<Vec<[f64; 3]>>,
    pub mass: Vec<f64>,
    /// As the potential counts them.
    pub kind: Vec<u32>,
    pub time: Option<f64>,
}

impl Frame {
    pub fn len(&self) -> usize {
        self.position.len()
    }

    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }

    /// # Errors
    /// No particles, columns of unequal lengths, what is not finite, a mass that is not positive.
    pub fn check(&self) -> Result<(), FieldsError> {
        let wrong = |m: String| Err(FieldsError(m));
        let n = self.len();
        if n == 0 {
            return wrong("the frame has no particles".into());
        }
        if n > 1 << 31 {
            return wrong(format!("{n} particles, of which 2147483648 are taken"));
        }
        let velocities = self.velocity.as_ref().map_or(n, Vec::len);
        if self.mass.len() != n || self.kind.len() != n || velocities != n {
            return wrong(format!(
                "{n} positions, {} masses, {} kinds, {velocities} velocities: one of each per particle",
                self.mass.len(),
                self.kind.len()
            ));
        }
        let finite = |x: &[f64; 3]| x.iter().all(|c| c.is_finite());
        if let Some(i) = self.position.iter().position(|x| !finite(x)) {
            return wrong(format!("the position of particle {} is not finite", i + 1));
        }
        let far = |x: &[f64; 3]| {
            let s = self.cell.fraction(*x);
            (0..3).any(|a| self.cell.periodic[a] && !(s[a].abs() < FARTHEST))
        };
        if let Some(i) = self.position.iter().position(far) {
            return wrong(format!(
                "particle {} is at {:?}, more than {FARTHEST} periods from the cell: its place in it has lost its digits",
                i + 1,
                self.position[i]
            ));
        }
        let velocities = self.velocity.iter().flatten();
        if let Some(i) = velocities.clone().position(|v| !finite(v)) {
            return wrong(format!("the velocity of particle {} is not finite", i + 1));
        }
        if let Some(i) = self.mass.iter().position(|m| !(*m > 0.0 && m.is_finite())) {
            return wrong(format!(
                "the mass of particle {} is {}: it must be positive",
                i + 1,
                self.mass[i]
            ));
        }
        Ok(())
    }

    /// Velocities less this one; empty where there are none.
    pub(crate) fn velocities_beside(&self, drift: [f64; 3]) -> Vec<[f64; 3]> {
        let all = self.velocity.iter().flatten();
        all.map(|v| std::array::from_fn(|a| v[a] - drift[a]))
            .collect()
    }

    /// Velocity of the centre of mass.
    pub fn drift(&self) -> [f64; 3] {
        let mut sum = [0.0; 3];
        let mut mass = 0.0;
        for (v, m) in self.velocity.iter().flatten().zip(&self.mass) {
            (0..3).for_each(|a| sum[a] += m * v[a]);
            mass += m;
        }
        if mass > 0.0 {
            sum.map(|s| s / mass)
        } else {
            sum
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fractions_and_points_are_inverse_in_a_tilted_cell() {
        let cell = Cell::new(
            [1.0, -2.0, 0.5],
            [[3.0, 0.0, 0.0], [1.0, 4.0, 0.0], [-0.5, 0.7, 5.0]],
            [true, true, false],
        )
        .unwrap();
        assert!((cell.volume() - 60.0).abs() < 1e-12);
        let x = [17.0, -9.0, 21.0];
        let back = cell.at(cell.fraction(x));
        assert!((0..3).all(|a| (back[a] - x[a]).abs() < 1e-12));
        let inside = cell.fraction(cell.wrap(x));
        assert!(
            (0..2).all(|a| (0.0..1.0).contains(&inside[a])),
            "{inside:?}"
        );
        assert!((inside[2] - cell.fraction(x)[2]).abs() < 1e-12);
        assert!((cell.height(2) - 5.0).abs() < 1e-12);
        assert!(cell.extents([true, false, false]).is_ok());
        assert!(cell.extents([false, false, true]).is_err());
        assert!(Cell::new([0.0; 3], [[1.0, 0.0, 0.0]; 3], [true; 3]).is_err());
    }

    #[test]
    fn particles_far_beyond_the_cell_have_no_place_in_it() {
        let frame = |x: f64, periodic: bool| Frame {
            cell: Cell::orthogonal([0.0; 3], [6.0; 3], [periodic; 3]).unwrap(),
            position: vec![[1.0; 3], [x, 1.0, 1.0]],
            velocity: None,
            mass: vec![1.0; 2],
            kind: vec![0; 2],
            time: None,
        };
        frame(6e4, true).check().unwrap();
        frame(1e12, false).check().unwrap();
        for x in [1e12, -1e12, 1.8e19, 1e308] {
            let FieldsError(text) = frame(x, true).check().unwrap_err();
            assert!(text.contains("particle 2"), "{x}: {text}");
        }
    }
}
