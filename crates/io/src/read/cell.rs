//! Kinds of mesh cells, their corners and sides.

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

    pub fn name(self) -> &'static str {
        match self {
            Kind::Vertex => "vertex",
            Kind::Line => "line",
            Kind::Triangle => "triangle",
            Kind::Quad => "quadrilateral",
            Kind::Tetra => "tetrahedron",
            Kind::Hexa => "hexahedron",
            Kind::Prism => "prism",
            Kind::Pyramid => "pyramid",
            Kind::Sphere => "sphere",
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

    /// VTK's number of it ("VTK file formats", table of cell types); its corners have the order of these kinds of cells there.
    pub fn vtk(self) -> u8 {
        match self {
            Kind::Vertex | Kind::Sphere => 1,
            Kind::Line => 3,
            Kind::Triangle => 5,
            Kind::Quad => 9,
            Kind::Tetra => 10,
            Kind::Hexa => 12,
            Kind::Prism => 13,
            Kind::Pyramid => 14,
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
