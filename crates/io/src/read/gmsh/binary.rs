//! gmsh's binary formats: the sections of the text formats with whole numbers of 4 or 8 bytes and coordinates of 8.
//!
//! Format: gmsh reference manual, "MSH file format" and "MSH file format version 2 (Legacy)".

use super::{Gmsh, PARTITIONED, WHOLE, element, physical_name, unknown, version};
use crate::read::lines::Lines;
use crate::read::{ReadError, Sourced};

struct Bytes<'a> {
    rest: &'a [u8],
    /// The file has its lowest byte last.
    swapped: bool,
    lines: Lines<'a>,
}

impl<'a> Bytes<'a> {
    fn take(&mut self, count: usize, what: &str) -> Result<&'a [u8], ReadError> {
        match self.rest.split_at_checked(count) {
            Some((head, rest)) => {
                self.rest = rest;
                Ok(head)
            }
            None => Err(self
                .lines
                .error(format!("the file ends where {what} should follow"))),
        }
    }

    fn word<const N: usize>(&mut self, what: &str) -> Result<[u8; N], ReadError> {
        let mut word = [0; N];
        word.copy_from_slice(self.take(N, what)?);
        if self.swapped {
            word.reverse();
        }
        Ok(word)
    }

    fn int(&mut self, what: &str) -> Result<i32, ReadError> {
        Ok(i32::from_le_bytes(self.word(what)?))
    }

    /// A whole number that is not negative.
    fn unsigned(&mut self, what: &str) -> Result<u64, ReadError> {
        let value = self.int(what)?;
        u64::try_from(value).map_err(|_| self.lines.error(format!("{what} is {value}")))
    }

    /// gmsh's `size_t`.
    fn size(&mut self, what: &str) -> Result<u64, ReadError> {
        Ok(u64::from_le_bytes(self.word(what)?))
    }

    fn point(&mut self) -> Result<[f64; 3], ReadError> {
        let mut x = [0.0; 3];
        for c in &mut x {
            *c = f64::from_le_bytes(self.word("a coordinate")?);
        }
        Ok(x)
    }

    fn line(&mut self, what: &str) -> Result<&'a str, ReadError> {
        let end = self.rest.iter().position(|b| *b == b'\n');
        let end = end.ok_or_else(|| {
            self.lines
                .error(format!("the file ends where {what} should follow"))
        })?;
        let line = self.take(end, what)?;
        self.rest = &self.rest[1..];
        let line = std::str::from_utf8(line).map(str::trim);
        line.map_err(|_| {
            self.lines
                .error(format!("expected {what}, found bytes that are no text"))
        })
    }

    /// The next line that is not blank; `None` at the end.
    fn section(&mut self) -> Result<Option<&'a str>, ReadError> {
        while !self.rest.is_empty() {
            let line = match self.rest.contains(&b'\n') {
                true => self.line("a section")?,
                false => std::str::from_utf8(std::mem::take(&mut self.rest))
                    .unwrap_or("?")
                    .trim(),
            };
            if !line.is_empty() {
                return Ok(Some(line));
            }
        }
        Ok(None)
    }

    fn end(&mut self, closing: &str) -> Result<(), ReadError> {
        match self.section()? {
            Some(line) if line == closing => Ok(()),
            Some(line) => Err(self
                .lines
                .error(format!("expected {closing}, found `{line}`"))),
            None => Err(self
                .lines
                .error(format!("the file ends where {closing} should follow"))),
        }
    }
}

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
            "$Nodes" if mesh.new => nodes(&mut file, &mut mesh)?,
            "$Nodes" => old_nodes(&mut file, &mut mesh)?,
            "$Elements" if mesh.new => elements(&mut file, &mut mesh)?,
            "$Elements" => old_elements(&mut file, &mut mesh)?,
            PARTITIONED => return Err(file.lines.error(WHOLE)),
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
