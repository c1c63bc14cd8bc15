//! Abaqus input: `*NODE`, `*ELEMENT`, `*ELSET`, `*NSET`; everything else is passed over.
//!
//! The mark of an element is the number (from 1, in the order of the file) of the smallest element set that holds it.

use super::cell::{Cell, Kind};
use super::lines::Lines;
use super::mesh::{Group, Mesh};
use super::{ReadError, Sourced};
use std::collections::HashMap;

/// Families of elements: the letters before the number of nodes, and cells of their corners. What is no solid has a shape in a
/// mesh of solids.
const FAMILIES: [(&str, &[(&str, Kind)]); 9] = [
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
    ("CPS", FLAT),
    ("CPE", FLAT),
    ("M3D", FLAT),
    ("SFM3D", FLAT),
    ("R3D", FLAT),
    ("STRI", FLAT),
    (
        "T",
        &[
            ("2D2", Kind::Line),
            ("2D3", Kind::Line),
            ("3D2", Kind::Line),
            ("3D3", Kind::Line),
        ],
    ),
    ("S", FLAT),
];

const FLAT: &[(&str, Kind)] = &[
    ("3", Kind::Triangle),
    ("4", Kind::Quad),
    ("65", Kind::Triangle),
    ("6", Kind::Triangle),
    ("8", Kind::Quad),
];

/// Elements that are no part of a mesh of cells, by how their names begin: beams, masses, springs, connectors.
const SHAPELESS: [&str; 10] = [
    "B2", "B3", "MASS", "ROTARYI", "SPRING", "DASHPOT", "CONN", "RB", "R2D2", "GAP",
];

/// What an element is made of.
#[derive(Clone, Copy, PartialEq)]
enum Element {
    /// Nodes that its line has, and the cell of its corners.
    Cell(usize, Kind),
    /// A shell or membrane: a surface, which makes no body.
    Surface(usize, Kind),
    Shapeless,
}

fn element(name: &str) -> Option<Element> {
    let name = name.to_uppercase();
    if SHAPELESS.iter().any(|start| name.starts_with(start)) {
        return Some(Element::Shapeless);
    }
    // the letters after the number of nodes are integration rules and the like (C3D8R, CPE4I)
    let cell = FAMILIES.iter().find_map(|(prefix, members)| {
        let rest = name.strip_prefix(prefix)?;
        members.iter().find_map(|(nodes, kind)| {
            let after = rest.strip_prefix(nodes)?;
            // STRI65 has 6 nodes and 5 degrees of freedom, T3D2 has 2 nodes
            let count = match *nodes {
                "65" => 6,
                other => other.rsplit('D').next()?.parse().ok()?,
            };
            let letters = !after.starts_with(|c: char| !c.is_ascii_alphabetic());
            letters.then_some((prefix, count, *kind))
        })
    })?;
    let (prefix, count, kind) = cell;
    Some(match *prefix {
        "M3D" | "SFM3D" | "R3D" | "STRI" | "S" => Element::Surface(count, kind),
        _ => Element::Cell(count, kind),
    })
}

/// Value of `key` in `*KEYWORD, key=value, ...`.
fn option<'a>(line: &'a str, key: &str) -> Option<&'a str> {
    line.split(',').skip(1).find_map(|part| {
        let (name, value) = part.split_once('=')?;
        name.trim().eq_ignore_ascii_case(key).then(|| value.trim())
    })
}

#[derive(Default)]
struct Abaqus {
    mesh: Mesh,
    /// Index into the cells by element number; `None` of elements without shape.
    index: HashMap<u64, Option<usize>>,
    /// Element sets in the order of the file.
    sets: Vec<(String, Vec<u64>)>,
    /// Shells and membranes are no bodies.
    shells: Option<String>,
}

/// The set of this name, whatever its case.
fn set<'s>(sets: &'s mut Vec<(String, Vec<u64>)>, name: &str) -> &'s mut Vec<u64> {
    let known = |(known, _): &(String, Vec<u64>)| known.eq_ignore_ascii_case(name);
    let at = sets.iter().position(known).unwrap_or_else(|| {
        sets.push((name.to_string(), Vec::new()));
        sets.len() - 1
    });
    &mut sets[at].1
}

pub(super) fn parse(text: &str, name: &str) -> Result<Sourced, ReadError> {
    let mut lines = Lines::new(text, name);
    let mut file = Abaqus::default();
    while let Some(line) = lines.next() {
        if line.starts_with("**") {
            continue;
        }
        let keyword = line.split(',').next().unwrap_or("").trim().to_uppercase();
        match keyword.as_str() {
            "*NODE" => nodes(&mut lines, &mut file, line)?,
            "*ELEMENT" => elements(&mut lines, &mut file, line)?,
            "*ELSET" => members(&mut lines, &mut file.sets, line, "elset")?,
            "*NSET" => members(&mut lines, &mut file.mesh.node_sets, line, "nset")?,
            "*INCLUDE" => {
                return Err(lines.error("*INCLUDE is not followed: put the mesh into one file"));
            }
            _ => {}
        }
    }
    let Abaqus {
        mut mesh,
        index,
        sets,
        shells,
    } = file;
    if mesh.nodes.is_empty() {
        return Err(lines.error("the file has no *NODE block"));
    }
    let dimension = mesh.cells.iter().map(|c| c.kind.dimension()).max();
    if let (Some(kind), Some(2)) = (shells, dimension) {
        return Err(lines.error(format!(
            "the elements {kind} are shells or membranes: a body is made of C3D, CPS or CPE elements"
        )));
    }
    // the smallest set that holds an element comes first: it is its mark
    let mut order: Vec<usize> = (0..sets.len()).collect();
    order.sort_by_key(|s| (sets[*s].1.len(), std::cmp::Reverse(*s)));
    for s in 0..sets.len() {
        // the dimension is that of the cells; a set of several has a group of each
        mesh.groups.extend((0..4).map(|dimension| Group {
            number: s as i32 + 1,
            dimension,
            name: Some(sets[s].0.clone()),
        }));
    }
    for s in order {
        for id in &sets[s].1 {
            if let Some(Some(at)) = index.get(id) {
                let cell = &mut mesh.cells[*at];
                cell.groups.push(4 * s + cell.kind.dimension());
            }
        }
    }
    let used: std::collections::HashSet<usize> =
        mesh.cells.iter().flat_map(|c| &c.groups).copied().collect();
    for (g, group) in mesh.groups.iter_mut().enumerate() {
        if !used.contains(&g) {
            group.name = None;
        }
    }
    mesh.points(&lines)
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

fn nodes(lines: &mut Lines, file: &mut Abaqus, header: &str) -> Result<(), ReadError> {
    let mut ids = Vec::new();
    while let Some(line) = data(lines) {
        let mut fields = line.split(',').map(str::trim).filter(|f| !f.is_empty());
        let id: u64 = lines.parse(fields.next(), "a node number")?;
        let mut x = [0.0; 3];
        x[0] = lines.finite(fields.next(), "x")?;
        x[1] = lines.finite(fields.next(), "y")?;
        if let Some(z) = fields.next() {
            x[2] = lines.finite(Some(z), "z")?;
        }
        if file.mesh.nodes.insert(id, x).is_some() {
            return Err(lines.error(format!(
                "node {id} is defined twice; several parts cannot be told apart"
            )));
        }
        ids.push(id);
    }
    if let Some(name) = option(header, "nset") {
        set(&mut file.mesh.node_sets, name).extend(ids);
    }
    Ok(())
}

fn elements(lines: &mut Lines, file: &mut Abaqus, header: &str) -> Result<(), ReadError> {
    let Some(name) = option(header, "type") else {
        return Err(lines.error("*ELEMENT needs TYPE="));
    };
    let Some(shape) = element(name) else {
        let message = format!(
            "unknown element type {name}; known are C3D4, C3D5, C3D6, C3D8, C3D10, C3D15, C3D20, CPS3, CPS4, CPE3, CPE4, CPS6, CPS8, CPE6, CPE8"
        );
        return Err(lines.error(message));
    };
    if matches!(shape, Element::Surface(..)) {
        file.shells.get_or_insert(name.to_uppercase());
    }
    let in_set = option(header, "elset").map(str::to_string);
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
        if file.index.insert(id, None).is_some() {
            return Err(lines.error_at(at, format!("element {id} is defined twice")));
        }
        if let Some(name) = &in_set {
            set(&mut file.sets, name).push(id);
        }
        let (Element::Cell(count, kind) | Element::Surface(count, kind)) = shape else {
            *file.mesh.shapeless.entry(name.to_uppercase()).or_default() += 1;
            continue;
        };
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
        file.index.insert(id, Some(file.mesh.cells.len()));
        file.mesh.cells.push(Cell {
            kind,
            id,
            nodes,
            groups: vec![],
            line: Some(at),
            volume: None,
        });
    }
    Ok(())
}

/// `*ELSET` and `*NSET`: numbers, names of other sets, or ranges.
fn members(
    lines: &mut Lines,
    sets: &mut Vec<(String, Vec<u64>)>,
    header: &str,
    key: &str,
) -> Result<(), ReadError> {
    let what = if key == "nset" { "node" } else { "element" };
    let Some(name) = option(header, key).map(str::to_string) else {
        let key = key.to_uppercase();
        return Err(lines.error(format!("*{key} needs {key}=")));
    };
    let generate = header
        .split(',')
        .any(|part| part.trim().eq_ignore_ascii_case("generate"));
    let mut members: Vec<u64> = Vec::new();
    while let Some(line) = data(lines) {
        let mut fields = line.split(',').map(str::trim).filter(|f| !f.is_empty());
        if generate {
            let first: u64 = lines.parse(fields.next(), &format!("the first {what}"))?;
            let last: u64 = lines.parse(fields.next(), &format!("the last {what}"))?;
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
            match sets
                .iter()
                .find(|(known, _)| known.eq_ignore_ascii_case(field))
            {
                Some((_, other)) => members.extend(other),
                None => {
                    let expected = format!("the number of a {what} or the name of a set");
                    members.push(lines.parse(Some(field), &expected)?);
                }
            }
        }
    }
    let set = set(sets, &name);
    set.extend(members);
    set.sort_unstable();
    set.dedup();
    Ok(())
}
