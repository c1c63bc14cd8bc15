//! Abaqus input: `*NODE`, `*ELEMENT`, `*ELSET`; everything else is passed over.
//!
//! The mark of an element is the number (from 1, in the order of the file) of the smallest element set that holds it.

use super::cell::{self, Cell, Kind, Nodes};
use super::lines::Lines;
use super::{ReadError, Sourced};
use std::collections::HashMap;

/// Nodes that an element line has, and the cell of its corners.
fn element(kind: &str) -> Option<(usize, Kind)> {
    let kind = kind.to_uppercase();
    // the letters after the node count are integration rules and the like (C3D8R, CPE4I)
    let families: [(&str, &[(&str, Kind)]); 2] = [
        (
            "C3D",
            &[
                ("20", Kind::Hexa),
                ("15", Kind::Prism),
                ("10", Kind::Tetra),
                ("8", Kind::Hexa),
                ("6", Kind::Prism),
                ("5", Kind::Pyramid),
                ("4", Kind::Tetra),
            ],
        ),
        (
            "CP",
            &[
                ("3", Kind::Triangle),
                ("4", Kind::Quad),
                ("6", Kind::Triangle),
                ("8", Kind::Quad),
            ],
        ),
    ];
    for (prefix, members) in families {
        let Some(mut rest) = kind.strip_prefix(prefix) else {
            continue;
        };
        if prefix == "CP" {
            // CPS plane stress, CPE plane strain
            rest = rest.strip_prefix(['S', 'E'])?;
        }
        for (nodes, cell) in members {
            if let Some(after) = rest.strip_prefix(nodes)
                && after.chars().all(|c| c.is_ascii_alphabetic())
            {
                return nodes.parse().ok().map(|n| (n, *cell));
            }
        }
    }
    None
}

/// Value of `key` in `*KEYWORD, key=value, ...`.
fn option<'a>(line: &'a str, key: &str) -> Option<&'a str> {
    line.split(',').skip(1).find_map(|part| {
        let (name, value) = part.split_once('=')?;
        name.trim().eq_ignore_ascii_case(key).then(|| value.trim())
    })
}

#[derive(Default)]
struct Mesh {
    nodes: Nodes,
    cells: Vec<Cell>,
    /// Index into `cells` by element number.
    index: HashMap<u64, usize>,
    /// Element sets in the order of the file, by name in upper case.
    sets: Vec<(String, Vec<u64>)>,
}

impl Mesh {
    fn set(&mut self, name: &str) -> &mut Vec<u64> {
        let at = self
            .sets
            .iter()
            .position(|(known, _)| known.eq_ignore_ascii_case(name))
            .unwrap_or_else(|| {
                self.sets.push((name.to_string(), Vec::new()));
                self.sets.len() - 1
            });
        &mut self.sets[at].1
    }
}

pub(super) fn parse(text: &str, name: &str) -> Result<Sourced, ReadError> {
    let mut lines = Lines::new(text, name);
    let mut mesh = Mesh::default();
    while let Some(line) = lines.next() {
        if line.starts_with("**") {
            continue;
        }
        let keyword = line.split(',').next().unwrap_or("").trim().to_uppercase();
        match keyword.as_str() {
            "*NODE" => nodes(&mut lines, &mut mesh)?,
            "*ELEMENT" => elements(&mut lines, &mut mesh, line)?,
            "*ELSET" => element_set(&mut lines, &mut mesh, line)?,
            "*INCLUDE" => {
                return Err(lines.error("*INCLUDE is not followed: put the mesh into one file"));
            }
            _ => {}
        }
    }
    if mesh.nodes.is_empty() {
        return Err(lines.error("the file has no *NODE block"));
    }
    let mut order: Vec<usize> = (0..mesh.sets.len()).collect();
    order.sort_by_key(|s| std::cmp::Reverse(mesh.sets[*s].1.len()));
    let mut names = Vec::new();
    for s in order {
        let mark = s as i32 + 1;
        names.push((mark, mesh.sets[s].0.clone()));
        for id in &mesh.sets[s].1 {
            if let Some(at) = mesh.index.get(id) {
                mesh.cells[*at].mark = mark;
            }
        }
    }
    names.sort();
    cell::points(&lines, &mesh.nodes, &mesh.cells, names)
}

/// The next data line of a block, if there is one.
fn data<'a>(lines: &mut Lines<'a>) -> Option<&'a str> {
    loop {
        match lines.peek() {
            Some(line) if line.starts_with('*') && !line.starts_with("**") => return None,
            Some(line) if line.starts_with("**") || line.is_empty() => {
                lines.next_raw();
            }
            Some(_) => return lines.next(),
            None => return None,
        }
    }
}

fn nodes(lines: &mut Lines, mesh: &mut Mesh) -> Result<(), ReadError> {
    while let Some(line) = data(lines) {
        let mut fields = line.split(',').map(str::trim).filter(|f| !f.is_empty());
        let id: u64 = lines.parse(fields.next(), "a node number")?;
        let mut x = [0.0; 3];
        x[0] = lines.finite(fields.next(), "x")?;
        x[1] = lines.finite(fields.next(), "y")?;
        if let Some(z) = fields.next() {
            x[2] = lines.finite(Some(z), "z")?;
        }
        if mesh.nodes.insert(id, x).is_some() {
            return Err(lines.error(format!(
                "node {id} is defined twice; several parts cannot be told apart"
            )));
        }
    }
    Ok(())
}

fn elements(lines: &mut Lines, mesh: &mut Mesh, header: &str) -> Result<(), ReadError> {
    let Some(name) = option(header, "type") else {
        return Err(lines.error("*ELEMENT needs TYPE="));
    };
    let Some((count, kind)) = element(name) else {
        let message = format!(
            "unknown element type {name}; known are C3D4, C3D5, C3D6, C3D8, C3D10, C3D15, C3D20, CPS3, CPS4, CPE3, CPE4, CPS6, CPS8, CPE6, CPE8"
        );
        return Err(lines.error(message));
    };
    let set = option(header, "elset").map(str::to_string);
    while let Some(line) = data(lines) {
        let at = lines.number;
        let mut text = line.to_string();
        // a line that ends with a comma goes on
        while text.ends_with(',') {
            match data(lines) {
                Some(more) => text.push_str(more),
                None => break,
            }
        }
        let fields: Vec<&str> = text
            .split(',')
            .map(str::trim)
            .filter(|f| !f.is_empty())
            .collect();
        let id: u64 = lines.parse(fields.first().copied(), "an element number")?;
        if fields.len() != count + 1 {
            let message = format!(
                "element {id} of type {name} has {} nodes instead of {count}",
                fields.len() - 1
            );
            return Err(lines.error_at(at, message));
        }
        let mut nodes = Vec::with_capacity(kind.corners());
        for field in &fields[1..=kind.corners()] {
            nodes.push(lines.parse(Some(field), "a node number")?);
        }
        if mesh.index.insert(id, mesh.cells.len()).is_some() {
            return Err(lines.error_at(at, format!("element {id} is defined twice")));
        }
        mesh.cells.push(Cell {
            kind,
            id,
            nodes,
            mark: 0,
            line: at,
        });
        if let Some(set) = &set {
            mesh.set(set).push(id);
        }
    }
    Ok(())
}

fn element_set(lines: &mut Lines, mesh: &mut Mesh, header: &str) -> Result<(), ReadError> {
    let Some(name) = option(header, "elset").map(str::to_string) else {
        return Err(lines.error("*ELSET needs ELSET="));
    };
    let generate = header
        .split(',')
        .any(|part| part.trim().eq_ignore_ascii_case("generate"));
    let mut members: Vec<u64> = Vec::new();
    while let Some(line) = data(lines) {
        let mut fields = line.split(',').map(str::trim).filter(|f| !f.is_empty());
        if generate {
            let first: u64 = lines.parse(fields.next(), "the first element")?;
            let last: u64 = lines.parse(fields.next(), "the last element")?;
            let step: usize = fields
                .next()
                .map_or(Ok(1), |f| lines.parse(Some(f), "the step"))?;
            if step == 0 || last < first || last - first > 1 << 24 {
                return Err(lines.error("expected first, last, step with first ≤ last, a step above 0 and at most 16 million members"));
            }
            members.extend((first..=last).step_by(step));
            continue;
        }
        for field in fields {
            match mesh
                .sets
                .iter()
                .find(|(known, _)| known.eq_ignore_ascii_case(field))
            {
                Some((_, other)) => members.extend(other),
                None => members
                    .push(lines.parse(Some(field), "an element number or the name of a set")?),
            }
        }
    }
    let set = mesh.set(&name);
    set.extend(members);
    set.sort_unstable();
    set.dedup();
    Ok(())
}
