//! Mesh cells: centroid and volume.

use super::lines::Lines;
use super::{ReadError, Sourced};
use peridyne::spec::Cloud;
use std::collections::HashMap;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Triangle,
    Quad,
    Tetra,
    Hexa,
    Prism,
    Pyramid,
}

impl Kind {
    pub fn corners(self) -> usize {
        match self {
            Kind::Triangle => 3,
            Kind::Quad | Kind::Tetra => 4,
            Kind::Pyramid => 5,
            Kind::Prism => 6,
            Kind::Hexa => 8,
        }
    }

    pub fn dimension(self) -> usize {
        if matches!(self, Kind::Triangle | Kind::Quad) {
            2
        } else {
            3
        }
    }

    /// Simplices that make the cell, by corner.
    fn simplices(self) -> &'static [[usize; 4]] {
        match self {
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
}

pub(super) struct Cell {
    pub kind: Kind,
    pub id: u64,
    pub nodes: Vec<u64>,
    pub mark: i32,
    /// Line of the file.
    pub line: usize,
}

/// Nodes by number.
pub(super) type Nodes = HashMap<u64, [f64; 3]>;

/// Cells of the highest dimension as points.
pub(super) fn points(
    lines: &Lines,
    nodes: &Nodes,
    cells: &[Cell],
    mut names: Vec<(i32, String)>,
) -> Result<Sourced, ReadError> {
    let Some(dimension) = cells.iter().map(|c| c.kind.dimension()).max() else {
        return Err(lines.error(
            "the mesh has no cells (triangles, quadrilaterals, tetrahedra, prisms, hexahedra)",
        ));
    };
    let mut cloud = Cloud::default();
    let mut sources = Vec::new();
    for cell in cells.iter().filter(|c| c.kind.dimension() == dimension) {
        let (centroid, volume) = measure(lines, nodes, cell)?;
        cloud.position.push(centroid);
        cloud.volume.push(volume);
        cloud.mark.push(cell.mark);
        sources.push(cell.line);
    }
    names.retain(|(mark, _)| cloud.mark.contains(mark));
    cloud.names = names;
    Ok(Sourced {
        atoms: None,
        cloud,
        dimension: Some(dimension),
        lines: sources,
    })
}

fn measure(lines: &Lines, nodes: &Nodes, cell: &Cell) -> Result<([f64; 3], f64), ReadError> {
    let mut corners = Vec::with_capacity(8);
    for id in &cell.nodes {
        let x = nodes.get(id).ok_or_else(|| {
            lines.error_at(
                cell.line,
                format!(
                    "element {} refers to node {id}, which does not exist",
                    cell.id
                ),
            )
        })?;
        corners.push(*x);
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
        return Err(lines.error_at(
            cell.line,
            format!("element {} has no positive {what}: {volume}", cell.id),
        ));
    }
    Ok((centroid, volume.abs()))
}
