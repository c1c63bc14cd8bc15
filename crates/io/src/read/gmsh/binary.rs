//! gmsh's binary formats: the sections of the text formats with whole numbers of 4 or 8 bytes and coordinates of 8.
//!
//! Format: gmsh reference manual, "MSH file format" and "MSH file format version 2 (Legacy)".

use super::bytes::Bytes;
use super::{Gmsh, element, partitioned, physical_name, unknown, version};
use crate::read::body::Sourced;
use crate::read::error::ReadError;
use crate::read::lines::Lines;

pub(super) fn parse(bytes: &[u8], name: &str) -> Result<Sourced, ReadError> {
    let mut file = Bytes {
        rest: bytes,
        swapped: false,
        lines: Lines::binary(name),
    };
    let mut mesh = Gmsh::default();
    file.section()?;
    let format = file.line("the version of the format")?;
    mesh.new = version(&file.lines, format)?;
    if format.split_whitespace().nth(2) != Some("8") {
        return Err(file
            .lines
            .error(format!("`{format}`: only numbers of 8 bytes are read")));
    }
    match file.int("the number 1")? {
        1 => {}
        one if one.swap_bytes() == 1 => file.swapped = true,
        other => {
            return Err(file
                .lines
                .error(format!("expected the number 1 in 4 bytes, found {other}")));
        }
    }
    file.end("$EndMeshFormat")?;
    while let Some(section) = file.section()? {
        match section {
            "$PhysicalNames" => {
                let line = file.line("the number of names")?;
                let count: usize = file.lines.parse(Some(line), "the number of names")?;
                for _ in 0..count {
                    let line = file.line("a physical name")?;
                    physical_name(&file.lines, &mut mesh, line)?;
                }
            }
            "$Entities" => entities(&mut file, &mut mesh)?,
            "$PartitionedEntities" => partitioned::binary(&mut file, &mut mesh)?,
            "$Nodes" if mesh.new => nodes(&mut file, &mut mesh)?,
            "$Nodes" => old_nodes(&mut file, &mut mesh)?,
            "$Elements" if mesh.new => elements(&mut file, &mut mesh)?,
            "$Elements" => old_elements(&mut file, &mut mesh)?,
            other if other.starts_with('$') => {
                let closing = format!("$End{}", &other[1..]);
                let mark = closing.as_bytes();
                let at = file.rest.windows(mark.len()).position(|w| w == mark);
                let at = at.ok_or_else(|| file.lines.error(format!("{other} has no {closing}")))?;
                file.rest = &file.rest[at..];
            }
            other => {
                let other: String = other.chars().take(30).collect();
                return Err(file.lines.error(format!(
                    "expected a section such as $Nodes, found `{other}`"
                )));
            }
        }
        file.end(&format!("$End{}", &section[1..]))?;
    }
    mesh.mesh.points(&file.lines)
}

fn entities(file: &mut Bytes, mesh: &mut Gmsh) -> Result<(), ReadError> {
    let mut counts = [0; 4];
    for count in &mut counts {
        *count = file.size("a number of entities")?;
    }
    for (dimension, count) in counts.into_iter().enumerate() {
        for _ in 0..count {
            let tag = file.int("the tag of an entity")?;
            // a point has coordinates, the others a bounding box
            file.take(
                if dimension == 0 { 24 } else { 48 },
                "the place of an entity",
            )?;
            let mut numbers = Vec::new();
            for _ in 0..file.size("the number of physical groups")? {
                numbers.push(file.int("a physical group")?);
            }
            if dimension > 0 {
                for _ in 0..file.size("the number of bounding entities")? {
                    file.int("a bounding entity")?;
                }
            }
            let groups = mesh.groups(dimension, &numbers);
            mesh.entities.insert((dimension, i64::from(tag)), groups);
        }
    }
    Ok(())
}

fn nodes(file: &mut Bytes, mesh: &mut Gmsh) -> Result<(), ReadError> {
    let blocks = file.size("the number of blocks of nodes")?;
    file.take(24, "the number of nodes")?;
    for _ in 0..blocks {
        file.take(8, "an entity")?;
        if file.int("0 or 1 (parametric)")? != 0 {
            return Err(file
                .lines
                .error("parametric nodes are not read: save without them"));
        }
        let count = file.size("the number of nodes of a block")?;
        let mut ids = Vec::new();
        for _ in 0..count {
            ids.push(file.size("a node number")?);
        }
        for id in ids {
            let x = file.point()?;
            mesh.node(&file.lines, id, x)?;
        }
    }
    Ok(())
}

fn old_nodes(file: &mut Bytes, mesh: &mut Gmsh) -> Result<(), ReadError> {
    let line = file.line("the number of nodes")?;
    let count: u64 = file.lines.parse(Some(line), "the number of nodes")?;
    for _ in 0..count {
        let id = file.unsigned("a node number")?;
        let x = file.point()?;
        mesh.node(&file.lines, id, x)?;
    }
    Ok(())
}

fn elements(file: &mut Bytes, mesh: &mut Gmsh) -> Result<(), ReadError> {
    let blocks = file.size("the number of blocks of elements")?;
    file.take(24, "the number of elements")?;
    for _ in 0..blocks {
        let dimension = file.unsigned("a dimension")? as usize;
        let entity = i64::from(file.int("the tag of an entity")?);
        let kind = file.unsigned("an element type")? as u32;
        let groups = mesh
            .entities
            .get(&(dimension, entity))
            .cloned()
            .unwrap_or_default();
        for _ in 0..file.size("the number of elements of a block")? {
            let id = file.size("an element number")?;
            let shape = element(kind).ok_or_else(|| unknown(&file.lines, kind, id))?;
            let mut nodes = Vec::with_capacity(shape.1);
            for _ in 0..shape.1 {
                nodes.push(file.size("a node number")?);
            }
            mesh.element(&file.lines, id, shape, groups.clone(), nodes)?;
        }
    }
    Ok(())
}

fn old_elements(file: &mut Bytes, mesh: &mut Gmsh) -> Result<(), ReadError> {
    let line = file.line("the number of elements")?;
    let count: u64 = file.lines.parse(Some(line), "the number of elements")?;
    let mut done = 0;
    while done < count {
        let kind = file.unsigned("an element type")? as u32;
        let following = file.unsigned("the number of elements of a block")?;
        let tags = file.unsigned("the number of tags")?;
        if following == 0 || following > count - done {
            return Err(file
                .lines
                .error(format!("a block of {following} of {count} elements")));
        }
        for _ in 0..following {
            let id = file.unsigned("an element number")?;
            let shape = element(kind).ok_or_else(|| unknown(&file.lines, kind, id))?;
            let mut group = Vec::new();
            for tag in 0..tags {
                let number = file.int("a tag")?;
                // the first is the physical group
                if tag == 0 {
                    group.push(number);
                }
            }
            let mut nodes = Vec::with_capacity(shape.1);
            for _ in 0..shape.1 {
                nodes.push(file.unsigned("a node number")?);
            }
            let groups = mesh.groups(shape.0.dimension(), &group);
            mesh.element(&file.lines, id, shape, groups, nodes)?;
        }
        done += following;
    }
    Ok(())
}
