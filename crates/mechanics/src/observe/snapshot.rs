//! The state of all points at one instant, for writers.

use super::{Column, Values};
use crate::space::Point;

/// Named columns in order of point id (0-based here, 1-based in files).
#[derive(Debug, Clone, Default)]
pub struct Snapshot {
    pub step: u64,
    pub time: f64,
    /// 1, 2 or 3; unused components are 0.
    pub dimension: usize,
    /// Typical distance of points (length).
    pub spacing: f64,
    /// `[N]` reference positions.
    pub reference: Vec<Point>,
    /// What was asked for; displacements always.
    pub columns: Vec<Column>,
    /// Unbroken bonds `(i, j)`, i < j, when asked for.
    pub bonds: Option<Vec<(u32, u32)>>,
}

impl Snapshot {
    pub fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|c| c.declaration.name == name)
    }

    /// Vectors of a column; `None`: there is none of this name, or it has another shape.
    pub fn vectors(&self, name: &str) -> Option<&[Point]> {
        match self.column(name).map(|c| &c.values) {
            Some(Values::Vectors(v)) => Some(v),
            _ => None,
        }
    }

    /// Numbers of a column; `None`: there is none of this name, or it has another shape.
    pub fn scalars(&self, name: &str) -> Option<&[f64]> {
        match self.column(name).map(|c| &c.values) {
            Some(Values::Scalars(v)) => Some(v),
            _ => None,
        }
    }

    /// Displacements; none if they are missing.
    pub fn displacement(&self) -> &[Point] {
        self.vectors("displacement").unwrap_or(&[])
    }

    /// Damage; none if it was not asked for.
    pub fn damage(&self) -> &[f64] {
        self.scalars("damage").unwrap_or(&[])
    }
}
