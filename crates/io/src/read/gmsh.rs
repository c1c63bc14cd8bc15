//! gmsh meshes, formats 2.2 and 4.1, as text or binary; physical groups become marks and sets.

mod binary;
mod bytes;
mod partitioned;

use super::body::Sourced;
use super::cell::{Cell, Kind};
use super::error::ReadError;
use super::lines::Lines;
use super::mesh::{Group, Mesh};
use std::collections::HashMap;

/// The corners and the number of nodes of a gmsh element type.
fn element(kind: u32) -> Option<(Kind, usize)> {
    Some(match kind {
        1 => (Kind::Line, 2),
        2 => (Kind::Triangle, 3),
        3 => (Kind::Quad, 4),
        4 => (Kind::Tetra, 4),
        5 => (Kind::Hexa, 8),
        6 => (Kind::Prism, 6),
        7 => (Kind::Pyramid, 5),
        8 => (Kind::Line, 3),
        9 => (Kind::Triangle, 6),
        10 => (Kind::Quad, 9),
        11 => (Kind::Tetra, 10),
        12 => (Kind::Hexa, 27),
        13 => (Kind::Prism, 18),
        14 => (Kind::Pyramid, 14),
        15 => (Kind::Vertex, 1),
        16 => (Kind::Quad, 8),
        17 => (Kind::Hexa, 20),
        18 => (Kind::Prism, 15),
        19 => (Kind::Pyramid, 13),
        _ => return None,
    })
}

/// A mesh as it is read.
#[derive(Default)]
struct Gmsh {
    /// Format 4.1 rather than 2.2.
    new: bool,
    mesh: Mesh,
    /// Groups of `(dimension, entity)`.
    entities: HashMap<(usize, i64), Vec<usize>>,
}

impl Gmsh {
    fn node(&mut self, lines: &Lines, id: u64, x: [f64; 3]) -> Result<(), ReadError> {
        if x.iter().any(|c| !c.is_finite()) {
            return Err(lines.error(format!("node {id} is at {x:?}")));
        }
        match self.mesh.nodes.insert(id, x) {
            None => Ok(()),
            Some(_) => Err(lines.error(format!("node {id} is defined twice"))),
        }
    }

    /// An element; `groups` are physical ones.
    fn element(
        &mut self,
        lines: &Lines,
        id: u64,
        (kind, count): (Kind, usize),
        groups: Vec<usize>,
        nodes: Vec<u64>,
    ) -> Result<(), ReadError> {
        if nodes.len() != count {
            return Err(lines.error(format!(
                "element {id} of {} has {} nodes instead of {count}",
                kind.plural(),
                nodes.len()
            )));
        }
        self.mesh.second_order[kind.dimension()] += usize::from(count > kind.corners());
        self.mesh.cells.push(Cell {
            kind,
            id,
            nodes: nodes[..kind.corners()].to_vec(),
            groups,
            line: lines.place(),
            volume: None,
        });
        Ok(())
    }

    /// Groups by their numbers; a negative one is the group turned round.
    fn groups(&mut self, dimension: usize, numbers: &[i32]) -> Vec<usize> {
        let used = numbers.iter().filter(|n| **n != 0);
        let mut groups: Vec<usize> = used
            .map(|n| self.mesh.group(dimension, n.saturating_abs()))
            .collect();
        groups.dedup();
        groups
    }
}

fn unknown(lines: &Lines, kind: u32, id: u64) -> ReadError {
    lines.error(format!("unknown element type {kind} of element {id}"))
}

/// Reads a mesh of either kind.
pub(super) fn read(bytes: Vec<u8>, name: &str) -> Result<Sourced, ReadError> {
    let binary = bytes.starts_with(b"$MeshFormat")
        && String::from_utf8_lossy(&bytes[..bytes.len().min(80)])
            .lines()
            .nth(1)
            .is_some_and(|format| format.split_whitespace().nth(1) == Some("1"));
    if binary {
        return binary::parse(&bytes, name);
    }
    parse(&super::whole::text(bytes, name, 0)?, name)
}

/// Is the version new (4.1) rather than old (2.2)?
fn version(lines: &Lines, format: &str) -> Result<bool, ReadError> {
    match format.split_whitespace().next().unwrap_or("") {
        "2.2" | "2" | "2.1" => Ok(false),
        "4.1" => Ok(true),
        other => Err(lines.error(format!(
            "format {other} is not read: export 4.1 or 2.2 (gmsh -format msh41)"
        ))),
    }
}

pub(super) fn parse(text: &str, name: &str) -> Result<Sourced, ReadError> {
    let mut lines = Lines::new(text, name);
    let mut mesh = Gmsh::default();
    let header = lines.expect("$MeshFormat")?;
    if header != "$MeshFormat" {
        return Err(lines.error("expected $MeshFormat: this is not a gmsh mesh"));
    }
    let format = lines.expect("the version of the format")?;
    mesh.new = version(&lines, format)?;
    end(&mut lines, "$EndMeshFormat")?;
    while let Some(section) = lines.next() {
        match section {
            "$PhysicalNames" => physical_names(&mut lines, &mut mesh)?,
            "$Entities" => entities(&mut lines, &mut mesh)?,
            "$PartitionedEntities" => partitioned::text(&mut lines, &mut mesh)?,
            "$Nodes" => nodes(&mut lines, &mut mesh)?,
            "$Elements" => elements(&mut lines, &mut mesh)?,
            other if other.starts_with('$') => {
                let closing = format!("$End{}", &other[1..]);
                while lines.expect(&closing)? != closing {}
            }
            other => {
                return Err(lines.error(format!(
                    "expected a section such as $Nodes, found `{other}`"
                )));
            }
        }
    }
    mesh.mesh.points(&lines)
}

fn end(lines: &mut Lines, closing: &str) -> Result<(), ReadError> {
    let line = lines.expect(closing)?;
    if line == closing {
        Ok(())
    } else {
        Err(lines.error(format!("expected {closing}, found `{line}`")))
    }
}

fn physical_names(lines: &mut Lines, mesh: &mut Gmsh) -> Result<(), ReadError> {
    let count: usize = lines
        .expect("the number of names")
        .and_then(|l| lines.parse(Some(l), "the number of names"))?;
    for _ in 0..count {
        let line = lines.expect("a physical name")?;
        physical_name(lines, mesh, line)?;
    }
    end(lines, "$EndPhysicalNames")
}

fn physical_name(lines: &Lines, mesh: &mut Gmsh, line: &str) -> Result<(), ReadError> {
    let mut fields = line.split_whitespace();
    let dimension = lines.parse(fields.next(), "a dimension")?;
    let number = lines.parse(fields.next(), "the number of a group")?;
    let quoted = line.split_once('"').map(|(_, name)| name);
    let name = quoted.or(fields.next()).unwrap_or("").trim();
    let name = name.trim_end_matches('"');
    let group = mesh.mesh.group(dimension, number);
    let known: &mut Group = &mut mesh.mesh.groups[group];
    known.name = Some(name.to_string()).filter(|n| !n.is_empty());
    Ok(())
}

/// Format 4.1: the physical groups of every point, curve, surface and volume.
fn entities(lines: &mut Lines, mesh: &mut Gmsh) -> Result<(), ReadError> {
    let line = lines.expect("the numbers of entities")?;
    let counts: Vec<usize> = line
        .split_whitespace()
        .map(|f| lines.parse(Some(f), "a number of entities"))
        .collect::<Result<_, _>>()?;
    if counts.len() != 4 {
        return Err(lines.error("expected the numbers of points, curves, surfaces and volumes"));
    }
    for (dimension, count) in counts.into_iter().enumerate() {
        for _ in 0..count {
            let line = lines.expect("an entity")?;
            let mut fields = line.split_whitespace();
            let tag: i64 = lines.parse(fields.next(), "the tag of an entity")?;
            // a point has coordinates, the others a bounding box
            let mut fields = fields.skip(if dimension == 0 { 3 } else { 6 });
            let count: usize = lines.parse(fields.next(), "the number of physical groups")?;
            let numbers: Vec<i32> = (0..count.min(line.len()))
                .map(|_| lines.parse(fields.next(), "a physical group"))
                .collect::<Result<_, _>>()?;
            let groups = mesh.groups(dimension, &numbers);
            mesh.entities.insert((dimension, tag), groups);
        }
    }
    end(lines, "$EndEntities")
}

fn position<'a>(
    lines: &Lines,
    mut fields: impl Iterator<Item = &'a str>,
) -> Result<[f64; 3], ReadError> {
    Ok([
        lines.finite(fields.next(), "x")?,
        lines.finite(fields.next(), "y")?,
        lines.finite(fields.next(), "z")?,
    ])
}

fn nodes(lines: &mut Lines, mesh: &mut Gmsh) -> Result<(), ReadError> {
    let line = lines.expect("the number of nodes")?;
    let first: usize = lines.parse(line.split_whitespace().next(), "the number of nodes")?;
    if !mesh.new {
        for _ in 0..first {
            let line = lines.expect("a node")?;
            let mut fields = line.split_whitespace();
            let id = lines.parse(fields.next(), "a node number")?;
            let x = position(lines, fields)?;
            mesh.node(lines, id, x)?;
        }
        return end(lines, "$EndNodes");
    }
    for _ in 0..first {
        let line = lines.expect("a block of nodes")?;
        let mut fields = line.split_whitespace().skip(2);
        if lines.parse::<u8>(fields.next(), "0 or 1 (parametric)")? != 0 {
            return Err(lines.error("parametric nodes are not read: save without them"));
        }
        let count: usize = lines.parse(fields.next(), "the number of nodes of the block")?;
        let mut ids: Vec<u64> = Vec::new();
        for _ in 0..count {
            let line = lines.expect("a node number")?;
            ids.push(lines.parse(Some(line), "a node number")?);
        }
        for id in ids {
            let line = lines.expect("the position of a node")?;
            let x = position(lines, line.split_whitespace())?;
            mesh.node(lines, id, x)?;
        }
    }
    end(lines, "$EndNodes")
}

fn corners<'a>(
    lines: &Lines,
    fields: impl Iterator<Item = &'a str>,
) -> Result<Vec<u64>, ReadError> {
    fields
        .map(|f| lines.parse(Some(f), "a node number"))
        .collect()
}

fn elements(lines: &mut Lines, mesh: &mut Gmsh) -> Result<(), ReadError> {
    let line = lines.expect("the number of elements")?;
    let first: usize = lines.parse(line.split_whitespace().next(), "the number of elements")?;
    for _ in 0..first {
        let line = lines.expect("an element")?;
        let mut fields = line.split_whitespace();
        if !mesh.new {
            let id = lines.parse(fields.next(), "an element number")?;
            let kind = lines.parse(fields.next(), "an element type")?;
            let shape = element(kind).ok_or_else(|| unknown(lines, kind, id))?;
            let tags: usize = lines.parse(fields.next(), "the number of tags")?;
            let tags: Vec<i32> = fields
                .by_ref()
                .take(tags)
                .map(|f| lines.parse(Some(f), "a tag"))
                .collect::<Result<_, _>>()?;
            // the first is the physical group, the second the entity
            let groups = mesh.groups(shape.0.dimension(), &tags[..tags.len().min(1)]);
            let nodes = corners(lines, fields)?;
            mesh.element(lines, id, shape, groups, nodes)?;
            continue;
        }
        let dimension = lines.parse(fields.next(), "a dimension")?;
        let entity = lines.parse(fields.next(), "the tag of an entity")?;
        let kind = lines.parse(fields.next(), "an element type")?;
        let count: usize = lines.parse(fields.next(), "the number of elements of the block")?;
        let groups = mesh
            .entities
            .get(&(dimension, entity))
            .cloned()
            .unwrap_or_default();
        for _ in 0..count {
            let line = lines.expect("an element")?;
            let mut fields = line.split_whitespace();
            let id = lines.parse(fields.next(), "an element number")?;
            let shape = element(kind).ok_or_else(|| unknown(lines, kind, id))?;
            let nodes = corners(lines, fields)?;
            mesh.element(lines, id, shape, groups.clone(), nodes)?;
        }
    }
    end(lines, "$EndElements")
}
