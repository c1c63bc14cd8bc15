//! Lattices: a cubic (square, linear) cell of edge `spacing` with a few sites in it.

/// Kinds of lattices. `spacing` is the edge of the conventional cell, except for [`LatticeKind::Triangular`],
/// where it is the distance between nearest neighbours (rows are √3/2 of it apart).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LatticeKind {
    Chain,
    Square,
    Triangular,
    Cubic,
    Bcc,
    Fcc,
    Diamond,
}

impl LatticeKind {
    pub const ALL: [LatticeKind; 7] = [
        LatticeKind::Chain,
        LatticeKind::Square,
        LatticeKind::Triangular,
        LatticeKind::Cubic,
        LatticeKind::Bcc,
        LatticeKind::Fcc,
        LatticeKind::Diamond,
    ];

    /// Name in decks.
    pub fn name(self) -> &'static str {
        match self {
            LatticeKind::Chain => "chain",
            LatticeKind::Square => "square",
            LatticeKind::Triangular => "triangular",
            LatticeKind::Cubic => "cubic",
            LatticeKind::Bcc => "bcc",
            LatticeKind::Fcc => "fcc",
            LatticeKind::Diamond => "diamond",
        }
    }

    /// Number of space dimensions.
    pub fn dimension(self) -> usize {
        match self {
            LatticeKind::Chain => 1,
            LatticeKind::Square | LatticeKind::Triangular => 2,
            LatticeKind::Cubic | LatticeKind::Bcc | LatticeKind::Fcc | LatticeKind::Diamond => 3,
        }
    }

    /// Sites of the cell in quarters of the cell's edges (`[B][3]`, integers).
    ///
    /// Triangular: a rectangular cell of `spacing` × `√3 spacing` with sites at (0,0) and (½,½).
    pub fn basis(self) -> &'static [[i32; 3]] {
        match self {
            LatticeKind::Chain | LatticeKind::Square | LatticeKind::Cubic => &[[0, 0, 0]],
            LatticeKind::Triangular => &[[0, 0, 0], [2, 2, 0]],
            LatticeKind::Bcc => &[[0, 0, 0], [2, 2, 2]],
            LatticeKind::Fcc => &[[0, 0, 0], [0, 2, 2], [2, 0, 2], [2, 2, 0]],
            LatticeKind::Diamond => &[
                [0, 0, 0],
                [0, 2, 2],
                [2, 0, 2],
                [2, 2, 0],
                [1, 1, 1],
                [1, 3, 3],
                [3, 1, 3],
                [3, 3, 1],
            ],
        }
    }

    /// Squares of the cell's edges in units of `spacing²` (integers: 1, or 3 for the long edge of the
    /// triangular cell), so that squared lattice distances are exact integers over 16.
    pub fn edge_squared(self) -> [i64; 3] {
        match self {
            LatticeKind::Triangular => [1, 3, 1],
            LatticeKind::Chain
            | LatticeKind::Square
            | LatticeKind::Cubic
            | LatticeKind::Bcc
            | LatticeKind::Fcc
            | LatticeKind::Diamond => [1, 1, 1],
        }
    }

    /// Edges of the cell in units of `spacing`.
    pub fn edges(self) -> [f64; 3] {
        self.edge_squared().map(|s| (s as f64).sqrt())
    }

    /// Distance between nearest neighbours in units of `spacing`.
    pub fn nearest(self) -> f64 {
        match self {
            LatticeKind::Bcc => 0.75f64.sqrt(),
            LatticeKind::Fcc => 0.5f64.sqrt(),
            LatticeKind::Diamond => 0.1875f64.sqrt(),
            LatticeKind::Chain
            | LatticeKind::Square
            | LatticeKind::Triangular
            | LatticeKind::Cubic => 1.0,
        }
    }

    /// Planes of sites that a cell has across an axis.
    pub fn planes(self, axis: usize) -> u8 {
        let mut places: Vec<i32> = self.basis().iter().map(|s| s[axis]).collect();
        places.sort_unstable();
        places.dedup();
        places.len() as u8
    }

    /// Volume (area, length) of one site in units of `spacing^D`.
    pub fn site_volume(self) -> f64 {
        let e = self.edges();
        e.iter().take(self.dimension()).product::<f64>() / self.basis().len() as f64
    }
}

/// A lattice in space: kind, spacing (length) and the position of the first basis site of cell (0,0,0).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lattice {
    pub kind: LatticeKind,
    pub spacing: f64,
    pub origin: [f64; 3],
}

/// What of the points of a body lies at the ends of its region.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ends {
    /// Faces of the cells that points stand for.
    Cells,
    /// The outer points.
    Points,
}

impl Lattice {
    /// The origin with which a lattice fills a box: planes of sites a distance d apart stand for layers of thickness d, and as many of
    /// them as come nearest to the length of the box lie about its middle. 0 along axes without end.
    pub fn filling(
        kind: LatticeKind,
        spacing: f64,
        [low, high]: [[f64; 3]; 2],
        ends: Ends,
    ) -> [f64; 3] {
        let edges = kind.edges();
        crate::array::from_fn(|a| {
            let length = high[a] - low[a];
            if a >= kind.dimension() || !length.is_finite() {
                return 0.0;
            }
            let distance = spacing * edges[a] / f64::from(kind.planes(a));
            let layers = (length / distance).round().max(1.0);
            let first = match ends {
                Ends::Cells => 0.5 * distance,
                Ends::Points => 0.0,
            };
            // no round-off where they fill it
            match (length / distance - layers).abs() < 1e-6 {
                true => low[a] + first,
                false => low[a] + 0.5 * (length - layers * distance) + first,
            }
        })
    }

    /// Typical distance of nearest points (length): the edge of a cube of the volume of one.
    pub fn distance(&self) -> f64 {
        let root = 1.0 / self.kind.dimension() as f64;
        self.spacing * libm::pow(self.kind.site_volume(), root)
    }

    /// Coordinates of a site: `quarter` counts quarters of the cell's edges from the origin (site `b` of cell
    /// `(i,j,k)` has `quarter = 4(i,j,k) + basis[b]`).
    pub fn position(&self, quarter: [i32; 3]) -> [f64; 3] {
        let e = self.kind.edges();
        let mut x = [0.0; 3];
        for a in 0..self.kind.dimension() {
            x[a] = self.origin[a] + self.spacing * e[a] * (quarter[a] as f64 / 4.0);
        }
        x
    }

    /// The site nearest to a place, in quarters as [`Lattice::position`] takes them.
    pub fn quarter(&self, x: &[f64; 3]) -> [i32; 3] {
        let e = self.kind.edges();
        crate::array::from_fn(|a| match a < self.kind.dimension() {
            true => (4.0 * (x[a] - self.origin[a]) / (self.spacing * e[a])).round() as i32,
            false => 0,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::fill::fill;
    use crate::space::region::Region;

    /// Volume of the cells of a filled block over that of the block.
    fn filled(kind: LatticeKind, spacing: f64, high: [f64; 3]) -> f64 {
        let low = [0.3, -0.2, -0.1];
        let region = Region::Block { low, high };
        let origin = Lattice::filling(kind, spacing, [low, high], Ends::Cells);
        let lattice = Lattice {
            kind,
            spacing,
            origin,
        };
        let sites = fill(&lattice, &region).unwrap();
        let d = kind.dimension();
        let whole: f64 = (0..d).map(|a| high[a] - low[a]).product();
        sites.len() as f64 * kind.site_volume() * spacing.powi(d as i32) / whole
    }

    #[test]
    fn whole_cells_fill_a_block() {
        for kind in LatticeKind::ALL {
            let e = kind.edges().map(|e| 0.1 * e);
            let high = [0.3 + 7.0 * e[0], -0.2 + 5.0 * e[1], -0.1 + 4.0 * e[2]];
            let part = filled(kind, 0.1, high);
            assert!((part - 1.0).abs() < 1e-12, "{kind:?}: {part}");
        }
        // others as nearly as layers can
        let part = filled(LatticeKind::Square, 0.1, [0.3 + 2.04, -0.2 + 0.97, 0.0]);
        assert!((part - 2.0 / (2.04 * 0.97)).abs() < 1e-12, "{part}");
        // a layer at least, in the middle
        let ends = [[0.0; 3], [1.0, 0.02, 0.0]];
        let origin = Lattice::filling(LatticeKind::Square, 0.1, ends, Ends::Cells);
        assert!((origin[0] - 0.05).abs() < 1e-15 && (origin[1] - 0.01).abs() < 1e-15);
        let origin = Lattice::filling(LatticeKind::Square, 0.1, ends, Ends::Points);
        assert_eq!(origin[0], 0.0);
    }
}
