//! gmsh ASCII meshes, formats 2.2 and 4.1; physical groups become marks.

use super::cell::{self, Cell, Kind, Nodes};
use super::lines::Lines;
use super::{ReadError, Sourced};
use std::collections::HashMap;

/// What a gmsh element type is: a cell with its number of nodes, something without volume, or unknown.
enum Element {
    Cell(Kind, usize),
    /// Points and lines.
    Nothing(usize),
}

fn element(kind: u32) -> Option<Element> {
    Some(match kind {
        2 => Element::Cell(Kind::Triangle, 3),
        3 => Element::Cell(Kind::Quad, 4),
        4 => Element::Cell(Kind::Tetra, 4),
        5 => Element::Cell(Kind::Hexa, 8),
        6 => Element::Cell(Kind::Prism, 6),
        7 => Element::Cell(Kind::Pyramid, 5),
        9 => Element::Cell(Kind::Triangle, 6),
        10 => Element::Cell(Kind::Quad, 9),
        11 => Element::Cell(Kind::Tetra, 10),
        12 => Element::Cell(Kind::Hexa, 27),
        13 => Element::Cell(Kind::Prism, 18),
        16 => Element::Cell(Kind::Quad, 8),
        17 => Element::Cell(Kind::Hexa, 20),
        18 => Element::Cell(Kind::Prism, 15),
        1 => Element::Nothing(2),
        8 => Element::Nothing(3),
        15 => Element::Nothing(1),
        _ => return None,
    })
}

#[derive(Default)]
struct Mesh {
    /// Format 4.1 rather than 2.2.
    new: bool,
    nodes: Nodes,
    cells: Vec<Cell>,
    /// Physical group of `(dimension, entity)`.
    entities: HashMap<(usize, i64), i32>,
    /// `(dimension, group, name)`
    names: Vec<(usize, i32, String)>,
}

pub(super) fn parse(text: &str, name: &str) -> Result<Sourced, ReadError> {
    let mut lines = Lines::new(text, name);
    let mut mesh = Mesh::default();
    let header = lines.expect("$MeshFormat")?;
    if header != "$MeshFormat" {
        return Err(lines.error("expected $MeshFormat: this is not a gmsh mesh"));
    }
    let format = lines.expect("the version of the format")?;
    let mut fields = format.split_whitespace();
    let version = fields.next().unwrap_or("");
    mesh.new = match version {
        "2.2" | "2" | "2.1" => false,
        "4.1" => true,
        _ => {
            return Err(lines.error(format!(
                "format {version} is not read: export 4.1 or 2.2 (gmsh -format msh41)"
            )));
        }
    };
    if fields.next() != Some("0") {
        return Err(lines.error("the mesh is binary: export it as ASCII"));
    }
    end(&mut lines, "$EndMeshFormat")?;
    while let Some(section) = lines.next() {
        match section {
            "$PhysicalNames" => physical_names(&mut lines, &mut mesh)?,
            "$Entities" => entities(&mut lines, &mut mesh)?,
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
    let dimension = mesh
        .cells
        .iter()
        .map(|c| c.kind.dimension())
        .max()
        .unwrap_or(0);
    let names = mesh
        .names
        .iter()
        .filter(|n| n.0 == dimension)
        .map(|n| (n.1, n.2.clone()))
        .collect();
    cell::points(&lines, &mesh.nodes, &mesh.cells, names)
}

fn end(lines: &mut Lines, closing: &str) -> Result<(), ReadError> {
    let line = lines.expect(closing)?;
    if line == closing {
        Ok(())
    } else {
        Err(lines.error(format!("expected {closing}, found `{line}`")))
    }
}

fn physical_names(lines: &mut Lines, mesh: &mut Mesh) -> Result<(), ReadError> {
    let count: usize = lines
        .expect("the number of names")
        .and_then(|l| lines.parse(Some(l), "the number of names"))?;
    for _ in 0..count {
        let line = lines.expect("a physical name")?;
        let mut fields = line.splitn(3, char::is_whitespace);
        let dimension = lines.parse(fields.next(), "a dimension")?;
        let group = lines.parse(fields.next(), "the number of a group")?;
        mesh.names.push((
            dimension,
            group,
            fields
                .next()
                .unwrap_or("")
                .trim()
                .trim_matches('"')
                .to_string(),
        ));
    }
    end(lines, "$EndPhysicalNames")
}

/// Format 4.1: the physical group of every point, curve, surface and volume.
fn entities(lines: &mut Lines, mesh: &mut Mesh) -> Result<(), ReadError> {
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
            let groups: usize = lines.parse(fields.next(), "the number of physical groups")?;
            if groups > 0 {
                let group: i32 = lines.parse(fields.next(), "a physical group")?;
                mesh.entities
                    .insert((dimension, tag), group.saturating_abs());
            }
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

fn insert(lines: &Lines, mesh: &mut Mesh, id: u64, x: [f64; 3]) -> Result<(), ReadError> {
    match mesh.nodes.insert(id, x) {
        None => Ok(()),
        Some(_) => Err(lines.error(format!("node {id} is defined twice"))),
    }
}

fn nodes(lines: &mut Lines, mesh: &mut Mesh) -> Result<(), ReadError> {
    let line = lines.expect("the number of nodes")?;
    let first: usize = lines.parse(line.split_whitespace().next(), "the number of nodes")?;
    if !mesh.new {
        for _ in 0..first {
            let line = lines.expect("a node")?;
            let mut fields = line.split_whitespace();
            let id = lines.parse(fields.next(), "a node number")?;
            let x = position(lines, fields)?;
            insert(lines, mesh, id, x)?;
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
            insert(lines, mesh, id, x)?;
        }
    }
    end(lines, "$EndNodes")
}

fn push<'a>(
    lines: &Lines,
    mesh: &mut Mesh,
    id: u64,
    kind: u32,
    mark: i32,
    fields: impl Iterator<Item = &'a str>,
) -> Result<(), ReadError> {
    let (cell, count) = match element(kind) {
        Some(Element::Cell(cell, count)) => (Some(cell), count),
        Some(Element::Nothing(count)) => (None, count),
        None => return Err(lines.error(format!("unknown element type {kind} of element {id}"))),
    };
    let nodes: Vec<u64> = fields
        .map(|f| lines.parse(Some(f), "a node number"))
        .collect::<Result<_, _>>()?;
    if nodes.len() != count {
        return Err(lines.error(format!(
            "element {id} of type {kind} has {} nodes instead of {count}",
            nodes.len()
        )));
    }
    if let Some(kind) = cell {
        mesh.cells.push(Cell {
            kind,
            id,
            nodes: nodes[..kind.corners()].to_vec(),
            mark,
            line: lines.number,
        });
    }
    Ok(())
}

fn elements(lines: &mut Lines, mesh: &mut Mesh) -> Result<(), ReadError> {
    let line = lines.expect("the number of elements")?;
    let first: usize = lines.parse(line.split_whitespace().next(), "the number of elements")?;
    for _ in 0..first {
        let line = lines.expect("an element")?;
        let mut fields = line.split_whitespace();
        if !mesh.new {
            let id = lines.parse(fields.next(), "an element number")?;
            let kind = lines.parse(fields.next(), "an element type")?;
            let tags: usize = lines.parse(fields.next(), "the number of tags")?;
            let tags: Vec<i32> = fields
                .by_ref()
                .take(tags)
                .map(|f| lines.parse(Some(f), "a tag"))
                .collect::<Result<_, _>>()?;
            push(
                lines,
                mesh,
                id,
                kind,
                tags.first().map_or(0, |t| t.saturating_abs()),
                fields,
            )?;
            continue;
        }
        let dimension = lines.parse(fields.next(), "a dimension")?;
        let entity = lines.parse(fields.next(), "the tag of an entity")?;
        let kind = lines.parse(fields.next(), "an element type")?;
        let count: usize = lines.parse(fields.next(), "the number of elements of the block")?;
        let mark = mesh
            .entities
            .get(&(dimension, entity))
            .copied()
            .unwrap_or(0);
        for _ in 0..count {
            let line = lines.expect("an element")?;
            let mut fields = line.split_whitespace();
            let id = lines.parse(fields.next(), "an element number")?;
            push(lines, mesh, id, kind, mark, fields)?;
        }
    }
    end(lines, "$EndElements")
}
