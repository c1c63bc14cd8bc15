//! Cells of meshes, by the places of the points that stand for them.

use std::collections::HashMap;

/// Shapes of cells: kinds, corners and which point each belongs to.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Cells {
    /// VTK's number of the kind of each cell.
    kinds: Vec<u8>,
    /// Where the corners of each cell end.
    ends: Vec<usize>,
    /// In the order of VTK, in the units of the points.
    corners: Vec<[f64; 3]>,
    /// Reference positions of the points of the cells (length).
    points: Vec<[f64; 3]>,
}

impl Cells {
    /// Adds a cell of one of VTK's kinds, whose point is at `point`.
    pub fn push(&mut self, kind: u8, corners: impl Iterator<Item = [f64; 3]>, point: [f64; 3]) {
        self.kinds.push(kind);
        self.corners.extend(corners);
        self.ends.push(self.corners.len());
        self.points.push(point);
    }

    pub fn is_empty(&self) -> bool {
        self.kinds.is_empty()
    }

    /// Corners of all cells.
    pub fn corners(&self) -> u64 {
        self.corners.len() as u64
    }

    /// In another unit of length.
    pub fn scale(&mut self, unit: f64) {
        let all = self.corners.iter_mut().chain(&mut self.points);
        all.flatten().for_each(|c| *c *= unit);
    }

    /// Takes in the cells of another mesh.
    pub fn append(&mut self, other: Cells) {
        let first = self.corners.len();
        self.kinds.extend(other.kinds);
        self.ends.extend(other.ends.iter().map(|e| first + e));
        self.corners.extend(other.corners);
        self.points.extend(other.points);
    }

    /// Kind and corners of a cell.
    pub fn cell(&self, n: usize) -> (u8, &[[f64; 3]]) {
        let begin = n.checked_sub(1).map_or(0, |before| self.ends[before]);
        (self.kinds[n], &self.corners[begin..self.ends[n]])
    }

    /// The cell of each point, where it has one.
    pub fn of_points(&self, reference: &[[f64; 3]]) -> Vec<Option<usize>> {
        // + 0.0 makes −0 and 0 one
        let key = |x: &[f64; 3]| x.map(|c| (c + 0.0).to_bits());
        let of: HashMap<_, _> = self.points.iter().map(key).zip(0..).collect();
        reference.iter().map(|x| of.get(&key(x)).copied()).collect()
    }
}
