//! Mesh cells: centroid and volume.

use super::ReadError;
use super::lines::Lines;
use std::collections::HashMap;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Vertex,
    Line,
    Triangle,
    Quad,
    Tetra,
    Hexa,
    Prism,
    Pyramid,
    /// A point with a volume of its own.
    Sphere,
}

impl Kind {
    pub fn corners(self) -> usize {
        match self {
            Kind::Vertex | Kind::Sphere => 1,
            Kind::Line => 2,
            Kind::Triangle => 3,
            Kind::Quad | Kind::Tetra => 4,
            Kind::Pyramid => 5,
            Kind::Prism => 6,
            Kind::Hexa => 8,
        }
    }

    pub fn dimension(self) -> usize {
        match self {
            Kind::Vertex => 0,
            Kind::Line => 1,
            Kind::Triangle | Kind::Quad => 2,
            Kind::Tetra | Kind::Hexa | Kind::Prism | Kind::Pyramid | Kind::Sphere => 3,
        }
    }

    pub fn plural(self) -> &'static str {
        match self {
            Kind::Vertex => "vertices",
            Kind::Line => "lines",
            Kind::Triangle => "triangles",
            Kind::Quad => "quadrilaterals",
            Kind::Tetra => "tetrahedra",
            Kind::Hexa => "hexahedra",
            Kind::Prism => "prisms",
            Kind::Pyramid => "pyramids",
            Kind::Sphere => "spheres",
        }
    }

    /// Simplices that make the cell, by corner; none of what is no body.
    fn simplices(self) -> &'static [[usize; 4]] {
        match self {
            Kind::Vertex | Kind::Line | Kind::Sphere => &[],
            Kind::Triangle => &[[0, 1, 2, 0]],
            Kind::Quad => &[[0, 1, 2, 0], [0, 2, 3, 0]],
            Kind::Tetra => &[[0, 1, 2, 3]],
            Kind::Pyramid => &[[0, 1, 2, 4], [0, 2, 3, 4]],
            Kind::Prism => &[[0, 1, 2, 5], [0, 1, 5, 4], [0, 4, 5, 3]],
            Kind::Hexa => &[
                [0, 1, 2, 6],
                [0, 2, 3, 6],
                [0, 3, 7, 6],
                [0, 7, 4, 6],
                [0, 4, 5, 6],
                [0, 5, 1, 6],
            ],
        }
    }

    /// Sides of a cell, by corner: edges in 2-D, faces in 3-D.
    pub fn sides(self) -> &'static [&'static [usize]] {
        match self {
            Kind::Vertex | Kind::Line | Kind::Sphere => &[],
            Kind::Triangle => &[&[0, 1], &[1, 2], &[2, 0]],
            Kind::Quad => &[&[0, 1], &[1, 2], &[2, 3], &[3, 0]],
            Kind::Tetra => &[&[0, 1, 2], &[0, 1, 3], &[1, 2, 3], &[0, 2, 3]],
            Kind::Pyramid => &[
                &[0, 1, 2, 3],
                &[0, 1, 4],
                &[1, 2, 4],
                &[2, 3, 4],
                &[3, 0, 4],
            ],
            Kind::Prism => &[
                &[0, 1, 2],
                &[3, 4, 5],
                &[0, 1, 4, 3],
                &[1, 2, 5, 4],
                &[2, 0, 3, 5],
            ],
            Kind::Hexa => &[
                &[0, 1, 2, 3],
                &[4, 5, 6, 7],
                &[0, 1, 5, 4],
                &[1, 2, 6, 5],
                &[2, 3, 7, 6],
                &[3, 0, 4, 7],
            ],
        }
    }
}

pub(super) struct Cell {
    pub kind: Kind,
    pub id: u64,
    /// Corners only.
    pub nodes: Vec<u64>,
    /// Groups of the mesh that hold it; the first is its mark.
    pub groups: Vec<usize>,
    /// Line of the file, if it has lines.
    pub line: Option<usize>,
    /// Of a sphere.
    pub volume: Option<f64>,
}

/// Nodes by number.
pub(super) type Nodes = HashMap<u64, [f64; 3]>;

/// Centroid and volume of a cell (area of a flat one).
pub(super) fn measure(
    lines: &Lines,
    nodes: &Nodes,
    cell: &Cell,
) -> Result<([f64; 3], f64), ReadError> {
    let error = |message: String| lines.error_where(cell.line, message);
    let mut corners = Vec::with_capacity(8);
    for id in &cell.nodes {
        let x = nodes.get(id).ok_or_else(|| {
            let id_of = cell.id;
            error(format!(
                "element {id_of} refers to node {id}, which does not exist"
            ))
        })?;
        corners.push(*x);
    }
    if let Some(volume) = cell.volume {
        return Ok((corners[0], volume));
    }
    let flat = cell.kind.dimension() == 2;
    let (mut volume, mut moment) = (0.0, [0.0; 3]);
    for s in cell.kind.simplices() {
        let used = if flat { 3 } else { 4 };
        let p: Vec<[f64; 3]> = s[..used].iter().map(|i| corners[*i]).collect();
        let edge = |i: usize| -> [f64; 3] { std::array::from_fn(|a| p[i][a] - p[0][a]) };
        let (e, f) = (edge(1), edge(2));
        let part = if flat {
            (e[0] * f[1] - e[1] * f[0]) / 2.0
        } else {
            let g = edge(3);
            (e[0] * (f[1] * g[2] - f[2] * g[1]) - e[1] * (f[0] * g[2] - f[2] * g[0])
                + e[2] * (f[0] * g[1] - f[1] * g[0]))
                / 6.0
        };
        volume += part;
        for (a, m) in moment.iter_mut().enumerate() {
            *m += part * p.iter().map(|q| q[a]).sum::<f64>() / used as f64;
        }
    }
    let centroid = moment.map(|m| m / volume);
    // the orientation of a cell does not matter, its emptiness does
    if !(volume.abs() > 0.0 && volume.is_finite() && centroid.iter().all(|c| c.is_finite())) {
        let what = if flat {
            "area in the x-y plane"
        } else {
            "volume"
        };
        return Err(error(format!(
            "element {} has no positive {what}: {volume}",
            cell.id
        )));
    }
    Ok((centroid, volume.abs()))
}
