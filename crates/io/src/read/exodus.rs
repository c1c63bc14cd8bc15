//! Exodus II meshes, in netCDF classic, 64-bit offset, CDF-5 or netCDF-4 (HDF5): blocks are groups of cells, node sets, side sets
//! and element sets are sets.
//!
//! Format: Schoof and Yarberry, "EXODUS II: a finite element data model", SAND92-2137; names of variables as the library writes
//! them. A block of SPHERE elements is points with volumes, the second attribute as Peridigm and Sierra have it. A side of an element
//! is the element, and knows its area. Results that a file has besides are not read.

use super::body::{Points, Sourced};
use super::cell::{Cell, Kind};
use super::error::ReadError;
use super::lines::Lines;
use super::mesh::{Group, Holds, Mesh};
use super::whole;
use crate::netcdf::Reader;

/// What an element type makes.
enum Shape {
    Cell(Kind),
    /// A shell, which makes no body.
    Surface(Kind),
}

/// Element types by their letters, and cells by how many nodes they have at least; corners come first in all of them.
fn shape(name: &str, nodes: u64) -> Option<Shape> {
    let letters = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let flat = match nodes {
        3 | 6 | 7 => Kind::Triangle,
        4 | 5 | 8 | 9 => Kind::Quad,
        _ => Kind::Vertex,
    };
    let kind = match letters.to_uppercase().as_str() {
        "SPHERE" | "CIRCLE" => Kind::Sphere,
        "TRUSS" | "BAR" | "BEAM" | "EDGE" | "ROD" => Kind::Line,
        "TRI" | "TRIANGLE" => Kind::Triangle,
        "QUAD" => Kind::Quad,
        "SHELL" | "TRISHELL" if flat != Kind::Vertex => return Some(Shape::Surface(flat)),
        "TET" | "TETRA" => Kind::Tetra,
        "PYRAMID" | "PYRA" => Kind::Pyramid,
        "WEDGE" => Kind::Prism,
        "HEX" | "HEXA" | "HEXAHEDRON" => Kind::Hexa,
        _ => return None,
    };
    (nodes >= kind.corners() as u64).then_some(Shape::Cell(kind))
}

/// Corners of a side by its number from 1 (Schoof and Yarberry, table of side numbering).
fn side(kind: Kind, number: i64) -> Option<&'static [usize]> {
    let sides: &[&[usize]] = match kind {
        Kind::Vertex | Kind::Line | Kind::Sphere => &[],
        Kind::Triangle => &[&[0, 1], &[1, 2], &[2, 0]],
        Kind::Quad => &[&[0, 1], &[1, 2], &[2, 3], &[3, 0]],
        Kind::Tetra => &[&[0, 1, 3], &[1, 2, 3], &[0, 3, 2], &[0, 2, 1]],
        Kind::Pyramid => &[
            &[0, 1, 4],
            &[1, 2, 4],
            &[2, 3, 4],
            &[3, 0, 4],
            &[0, 3, 2, 1],
        ],
        Kind::Prism => &[
            &[0, 1, 4, 3],
            &[1, 2, 5, 4],
            &[0, 3, 5, 2],
            &[0, 2, 1],
            &[3, 4, 5],
        ],
        Kind::Hexa => &[
            &[0, 1, 5, 4],
            &[1, 2, 6, 5],
            &[2, 3, 7, 6],
            &[0, 4, 7, 3],
            &[0, 3, 2, 1],
            &[4, 5, 6, 7],
        ],
    };
    let number = usize::try_from(number).ok()?.checked_sub(1)?;
    sides.get(number).copied()
}

const KNOWN: &str =
    "SPHERE, TRI, QUAD, TETRA, PYRAMID, WEDGE, HEX, with TRUSS, BEAM and SHELL beside them";

/// Points of an Exodus II mesh.
///
/// # Errors
/// The file is cut short or damaged, no mesh, has element types that make no points, cells without volume, or nodes that do not
/// exist.
pub fn parse_exodus(bytes: Vec<u8>, name: &str) -> Result<Points, ReadError> {
    parse_holding(bytes, name, Holds::Sides)
}

/// The same, with other cells in the sets of nodes.
///
/// # Errors
/// Those of [`parse_exodus`].
pub fn parse_holding(bytes: Vec<u8>, name: &str, holds: Holds) -> Result<Points, ReadError> {
    whole(read(bytes, name, holds)?, name)
}

fn read(bytes: Vec<u8>, name: &str, holds: Holds) -> Result<Sourced, ReadError> {
    let lines = Lines::binary(name);
    let error = |message: String| lines.error(message);
    let reader = Reader::new(bytes).map_err(error)?;
    let mut file = Exodus {
        reader,
        mesh: Mesh {
            distinct: true,
            holds,
            ..Mesh::default()
        },
        shells: None,
    };
    file.nodes().map_err(error)?;
    file.blocks().map_err(error)?;
    file.sets().map_err(error)?;
    let body = file.mesh.cells.iter().map(|c| c.kind.dimension()).max();
    if let (Some(block), Some(2)) = (&file.shells, body) {
        return Err(error(format!(
            "block {block} has shells: a body is made of solid, plane or SPHERE elements"
        )));
    }
    file.mesh.points(&lines)
}

struct Exodus {
    reader: Reader,
    mesh: Mesh,
    /// A block of shells.
    shells: Option<String>,
}

/// An entity of a kind (a block, a set): its number in the names of variables, its id and its name.
struct Entity {
    number: usize,
    id: i64,
    name: String,
}

impl Exodus {
    fn nodes(&mut self) -> Result<(), String> {
        let axes = ["coordx", "coordy", "coordz"];
        let mut columns: Vec<Vec<f64>> = vec![];
        match self.reader.floats("coord")? {
            // as old files have it
            Some(all) => {
                let axes = self.reader.length("num_dim").unwrap_or(3).clamp(1, 3);
                let each = all.len() / axes as usize;
                columns.extend(all.chunks_exact(each.max(1)).map(<[f64]>::to_vec));
            }
            None => {
                for axis in axes {
                    match self.reader.floats(axis)? {
                        Some(column) => columns.push(column),
                        None => break,
                    }
                }
            }
        }
        let count = columns.first().map_or(0, Vec::len);
        if count == 0 {
            return Err("it has no nodes (coordx): it is no Exodus mesh".into());
        }
        if columns.iter().any(|c| c.len() != count) {
            return Err("coordx, coordy and coordz have different lengths".into());
        }
        if let Some(nodes) = self
            .reader
            .length("num_nodes")
            .filter(|n| *n != count as u64)
        {
            return Err(format!(
                "num_nodes is {nodes}, but coordx has {count} places"
            ));
        }
        for node in 0..count {
            let mut x = [0.0; 3];
            for (c, column) in x.iter_mut().zip(&columns) {
                *c = column[node];
            }
            if x.iter().any(|c| !c.is_finite()) {
                return Err(format!("node {} is at {x:?}", node + 1));
            }
            self.mesh.nodes.insert(node as u64 + 1, x);
        }
        Ok(())
    }

    /// All of a kind: variables with ids, how many are there and names; `word` begins the name of what has none.
    fn entities(&self, prefix: &str, dimension: &str, word: &str) -> Result<Vec<Entity>, String> {
        let mut ids = self.reader.wholes(&format!("{prefix}_prop1"))?;
        if ids.is_none()
            && let Some(count) = self.reader.length(dimension)
        {
            // each has variables of its own
            let count = count.min(self.reader.count() as u64);
            ids = Some((1..=count as i64).collect());
        }
        let there = self.reader.wholes(&format!("{prefix}_status"))?;
        let names = self.reader.texts(&format!("{prefix}_names"))?;
        let names = names.unwrap_or_default();
        let mut all: Vec<Entity> = vec![];
        for (n, id) in ids.unwrap_or_default().into_iter().enumerate() {
            let there = there.as_ref().and_then(|t| t.get(n));
            let name = names.get(n).filter(|name| !name.is_empty());
            let name = name.map_or_else(|| format!("{word}_{id}"), Clone::clone);
            if there != Some(&0) {
                let number = n + 1;
                all.push(Entity { number, id, name });
            }
        }
        Ok(all)
    }

    fn blocks(&mut self) -> Result<(), String> {
        for block in self.entities("eb", "num_el_blk", "block")? {
            self.block(&block)?;
        }
        if self.mesh.cells.is_empty() {
            return Err("it has no elements: no block has any".into());
        }
        Ok(())
    }

    fn block(&mut self, block: &Entity) -> Result<(), String> {
        let Entity { number, id, name } = block;
        let variable = format!("connect{number}");
        let Some(nodes) = self.reader.wholes(&variable)? else {
            return Err(format!("block {name} has no elements ({variable})"));
        };
        let kind = self.reader.attribute(&variable, "elem_type");
        let kind = kind.unwrap_or_default();
        let shape_of = self.reader.shape(&variable).unwrap_or_default();
        let [_, each] = shape_of[..] else {
            return Err(format!("{variable} should be a table: elements, nodes"));
        };
        let shape = shape(&kind, each).ok_or_else(|| {
            format!(
                "block {name}: elements {kind:?} of {each} nodes are not read; known are {KNOWN}"
            )
        })?;
        let kind = match shape {
            Shape::Cell(kind) => kind,
            Shape::Surface(kind) => {
                self.shells.get_or_insert(name.clone());
                kind
            }
        };
        let mark = i32::try_from(*id).map_err(|_| format!("block {name} has the number {id}"))?;
        let group = self.mesh.groups.len();
        self.mesh.groups.push(Group {
            number: mark,
            dimension: kind.dimension(),
            name: Some(name.clone()),
        });
        let mut volumes = match kind {
            Kind::Sphere => self.volumes(block)?,
            _ => vec![],
        }
        .into_iter();
        for nodes in nodes.chunks_exact(each as usize) {
            let element = self.mesh.cells.len() + 1;
            let volume = volumes.next();
            if let Some(volume) = volume.filter(|v| !(*v > 0.0 && v.is_finite())) {
                return Err(format!(
                    "element {element} of block {name} has the volume {volume}"
                ));
            }
            let dimension = kind.dimension();
            self.mesh.second_order[dimension] += usize::from(nodes.len() > kind.corners());
            let corners = nodes[..kind.corners()].iter();
            // what is negative is no node, and said so where nodes are looked for
            let corners = corners.map(|n| u64::try_from(*n).unwrap_or(0));
            self.mesh.cells.push(Cell {
                kind,
                id: element as u64,
                nodes: corners.collect(),
                groups: vec![group],
                line: None,
                volume,
            });
        }
        Ok(())
    }

    /// Volumes of spheres: the attribute of that name, else the second of two.
    fn volumes(&self, block: &Entity) -> Result<Vec<f64>, String> {
        let Entity { number, name, .. } = block;
        let attributes = self.reader.floats(&format!("attrib{number}"))?;
        let names = self.reader.texts(&format!("attrib_name{number}"))?;
        let table = self.reader.shape(&format!("attrib{number}"));
        let width = table.and_then(|lengths| lengths.get(1).copied());
        let width = width.unwrap_or(1) as usize;
        let named = names.unwrap_or_default();
        let named = named.iter().position(|n| n.eq_ignore_ascii_case("volume"));
        let column = named.or((width >= 2).then_some(1)).filter(|c| *c < width);
        let elements = self.reader.shape(&format!("connect{number}"));
        let count = elements.map_or(0, |lengths| lengths[0]);
        match (attributes, column) {
            (Some(all), Some(column))
                if count.checked_mul(width as u64) == Some(all.len() as u64) =>
            {
                Ok(all.into_iter().skip(column).step_by(width).collect())
            }
            _ => Err(format!(
                "block {name} has SPHERE elements without volumes: give them the attributes radius and volume, or one called volume"
            )),
        }
    }

    fn sets(&mut self) -> Result<(), String> {
        for set in self.entities("ns", "num_node_sets", "nodelist")? {
            let nodes = self.reader.wholes(&format!("node_ns{}", set.number))?;
            let nodes = nodes.unwrap_or_default().into_iter();
            let nodes = nodes.map(|n| u64::try_from(n).unwrap_or(0)).collect();
            self.mesh.node_sets.push((set.name, nodes));
        }
        for (prefix, dimension, word, variable) in [
            ("ss", "num_side_sets", "surface", "elem_ss"),
            ("els", "num_elem_sets", "elemlist", "elem_els"),
        ] {
            for set in self.entities(prefix, dimension, word)? {
                let elements = self.reader.wholes(&format!("{variable}{}", set.number))?;
                let mut cells = vec![];
                for e in elements.unwrap_or_default() {
                    // every element is a cell
                    let place = usize::try_from(e).ok().and_then(|e| e.checked_sub(1));
                    let cell = place.filter(|c| *c < self.mesh.cells.len());
                    cells.push(cell.ok_or_else(|| {
                        format!(
                            "set {} refers to element {e}, which does not exist",
                            set.name
                        )
                    })?);
                }
                if prefix == "els" {
                    self.mesh.cell_sets.push((set.name, cells));
                    continue;
                }
                let numbers = self.reader.wholes(&format!("side_ss{}", set.number))?;
                let numbers = numbers.unwrap_or_default();
                let sides = cells.into_iter().enumerate().map(|(n, cell)| {
                    let number = numbers.get(n).copied().unwrap_or(0);
                    let corners = side(self.mesh.cells[cell].kind, number);
                    (cell, corners.map(<[usize]>::to_vec))
                });
                let sides = sides.collect();
                self.mesh.side_sets.push((set.name, sides));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
pub(crate) mod files;
#[cfg(test)]
mod tests;
