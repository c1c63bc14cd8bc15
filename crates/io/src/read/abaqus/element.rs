//! `*ELEMENT`, and elements from elements: `*ELGEN`, `*ELCOPY`.

use super::super::cell::Kind;
use super::super::error::ReadError;
use super::input::{Block, Rows};
use super::keyword::Label;
use super::model::{Element, ITEM, Model, Of, Place, Shape};
use std::rc::Rc;

/// Families of elements: the letters before the number of nodes, and cells of their corners. What is no solid has a shape in a
/// mesh of solids.
const FAMILIES: [(&str, &[(&str, Kind)]); 12] = [
    ("C3D", SOLID),
    ("DC3D", SOLID),
    ("DC2D", FLAT),
    ("SC", &[("8", Kind::Hexa), ("6", Kind::Prism)]),
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

const SOLID: &[(&str, Kind)] = &[
    ("27", Kind::Hexa),
    ("20", Kind::Hexa),
    ("15", Kind::Prism),
    ("10", Kind::Tetra),
    ("8", Kind::Hexa),
    ("6", Kind::Prism),
    ("5", Kind::Pyramid),
    ("4", Kind::Tetra),
];

const FLAT: &[(&str, Kind)] = &[
    ("3", Kind::Triangle),
    ("4", Kind::Quad),
    ("65", Kind::Triangle),
    ("6", Kind::Triangle),
    ("8", Kind::Quad),
    ("9", Kind::Quad),
];

/// Elements that are no part of a mesh of cells, by how their names begin: beams, masses, springs, connectors.
const SHAPELESS: [&str; 21] = [
    "B21", "B22", "B23", "B31", "B32", "B33", "PIPE", "ELBOW", "FRAME", "MASS", "ROTARYI",
    "HEATCAP", "SPRING", "DASHPOT", "JOINT", "CONN", "DCOUP", "RB2D2", "RB3D2", "R2D2", "GAP",
];

/// What elements of a type are made of, and from how many nodes to how many.
fn shape(name: &str) -> Option<(Shape, [usize; 2])> {
    if SHAPELESS.iter().any(|start| name.starts_with(start)) {
        return Some((Shape::Shapeless, [0, usize::MAX]));
    }
    // the letters after the number of nodes are integration rules and the like (C3D8R, CPE4I)
    FAMILIES.iter().find_map(|(prefix, members)| {
        let rest = name.strip_prefix(prefix)?;
        members.iter().find_map(|(nodes, kind)| {
            let after = rest.strip_prefix(nodes)?;
            // STRI65 has 6 nodes and 5 degrees of freedom, T3D2 has 2 nodes
            let count = match *nodes {
                "65" => 6,
                other => other.rsplit('D').next()?.parse().ok()?,
            };
            // nodes in the middles of faces may be left out of C3D27, be there in C3D15V
            let counts = match (*nodes, after) {
                ("27", _) => [21, 27],
                ("15", "V" | "VH") => [15, 18],
                _ => [count, count],
            };
            let shape = match *prefix {
                "M3D" | "SFM3D" | "R3D" | "STRI" | "S" => Shape::Surface(*kind),
                _ => Shape::Cell(*kind),
            };
            let letters = !after.starts_with(|c: char| !c.is_ascii_alphabetic());
            letters.then_some((shape, counts))
        })
    })
}

fn unknown(name: &str) -> String {
    let name = super::input::short(name);
    let why = match () {
        () if name.starts_with("CAX") || name.starts_with("CGAX") || name.starts_with("SAX") => {
            " (a mesh of a section about an axis is no body: mesh the solid)"
        }
        () if name.starts_with("COH") => {
            " (cohesive elements have no volume: leave them out, and mesh through the interface)"
        }
        () if name.starts_with('U') => " (an element of a user)",
        () => "",
    };
    format!(
        "unknown element type {name}{why}; known are C3D4, C3D5, C3D6, C3D8, C3D10, C3D15, C3D20, C3D27, SC6, SC8, CPS3, CPS4, CPS6, CPS8, CPE3, CPE4, CPE6, CPE8 and those of heat (DC3D8, DC2D4) with the letters that follow them"
    )
}

/// `*ELEMENT`: a number and its nodes, which may go on over several lines.
pub(super) fn elements(block: &Block, model: &mut Model) -> Result<(), ReadError> {
    block.only(&["TYPE", "ELSET", "INPUT"])?;
    let name = Label::new(block.needed("TYPE")?).key;
    let Some((shape, [least, most])) = shape(&name) else {
        return Err(block.error(unknown(&name)));
    };
    let name: Rc<str> = name.into();
    let mut numbers = Vec::new();
    let mut rows = block.rows();
    while rows.next() {
        // a line that ends with a comma goes on, and so does one of 16 numbers
        while rows.fields.len() <= most
            && (rows.goes_on || rows.fields.len().is_multiple_of(16) && rows.fields.len() <= least)
            && rows.more()
        {}
        let number = rows.number(0, "an element number")?;
        let count = rows.fields.len() - 1;
        if shape != Shape::Shapeless && !(least..=most).contains(&count) {
            return Err(rows.error(format!(
                "element {number} of type {name} has {count} nodes instead of {least}"
            )));
        }
        let nodes = connected(&rows, model, shape)?;
        let at = rows.at;
        let name = name.clone();
        let element = Element {
            number,
            name,
            shape,
            nodes,
            at,
            turned: false,
        };
        model.here().element(&rows, element)?;
        numbers.push(number);
    }
    if let Some(label) = block.label("ELSET") {
        model.here().add(Of::Elements, label, numbers, false);
    }
    Ok(())
}

/// The nodes of an element. Those of springs and the like may be anything.
fn connected(rows: &Rows, model: &Model, shape: Shape) -> Result<Rc<[u64]>, ReadError> {
    let corners = match shape {
        Shape::Cell(kind) | Shape::Surface(kind) => kind.corners(),
        Shape::Shapeless => 0,
    };
    let mut nodes = Vec::with_capacity(rows.fields.len());
    for k in 1..rows.fields.len() {
        let text = rows.field(k).unwrap_or("");
        let number = text
            .parse()
            .ok()
            .filter(|n| (1..=super::input::LARGEST).contains(n));
        let node = match number {
            Some(number) => Some(number),
            None if model.place == Place::Model => {
                let found = model.named(text, Of::Nodes, None).unwrap_or_default();
                Some(found).filter(|f| f.len() == 1).map(|f| f[0])
            }
            None => None,
        };
        match node {
            Some(node) => nodes.push(node),
            None if k <= corners => {
                return Err(rows.error(format!(
                    "expected a node number, found `{}`",
                    super::input::short(text)
                )));
            }
            None => {}
        }
    }
    Ok(nodes.into())
}

/// An element again, with other numbers.
fn again(
    rows: &Rows,
    model: &mut Model,
    old: &Element,
    number: Option<u64>,
    shift: i64,
) -> Result<u64, ReadError> {
    let number = rows.allowed(number.unwrap_or(0), "the number of a generated element")?;
    let mut nodes = Vec::with_capacity(old.nodes.len());
    for node in old.nodes.iter() {
        let node = node.checked_add_signed(shift).unwrap_or(0);
        nodes.push(rows.allowed(node, "a node of a generated element")?);
    }
    let element = Element {
        number,
        nodes: nodes.into(),
        at: rows.at,
        ..old.clone()
    };
    model.here().element(rows, element)?;
    Ok(number)
}

/// `*ELGEN`: rows, rows of rows and layers of an element.
pub(super) fn elgen(block: &Block, model: &mut Model) -> Result<(), ReadError> {
    block.only(&["ELSET", "ALLNODES"])?;
    let mut all = Vec::new();
    let mut rows = block.rows();
    while rows.next() {
        let master = rows.number(0, "the number of an element")?;
        let Some((_, old)) = model.element(master) else {
            return Err(rows.error(format!("element {master} is not defined before this line")));
        };
        let old = old.clone();
        // how many, with the increments of nodes and elements
        let mut ways = [(1i64, 0i64, 0i64); 3];
        for (way, at) in ways.iter_mut().zip([1, 4, 7]) {
            let whole = |k, what| rows.whole(k, what);
            *way = (
                whole(at, "a number of elements")?.unwrap_or(1),
                whole(at + 1, "an increment of node numbers")?.unwrap_or(1),
                whole(at + 2, "an increment of element numbers")?.unwrap_or(1),
            );
        }
        let counts = ways.map(|w| w.0);
        if counts.iter().any(|c| !(1..=1 << 32).contains(c)) {
            return Err(rows.error("numbers of elements, rows and layers of *ELGEN are from 1 on"));
        }
        let count = counts
            .iter()
            .fold(1u64, |all, c| all.saturating_mul(*c as u64));
        model.generate(&rows, count as usize, ITEM)?;
        all.push(master);
        for k in 1..count as i64 {
            let steps = [
                k % counts[0],
                k / counts[0] % counts[1],
                k / counts[0] / counts[1],
            ];
            let sum = |of: fn(&(i64, i64, i64)) -> i64| {
                let each = steps.iter().zip(&ways);
                each.fold(0i64, |sum, (s, w)| {
                    sum.saturating_add(s.saturating_mul(of(w)))
                })
            };
            let number = master.checked_add_signed(sum(|w| w.2));
            all.push(again(&rows, model, &old, number, sum(|w| w.1))?);
        }
    }
    if let Some(label) = block.label("ELSET") {
        model.here().add(Of::Elements, label, all, false);
    }
    Ok(())
}

/// `*ELCOPY`: the elements of a set again.
pub(super) fn elcopy(block: &Block, model: &mut Model) -> Result<(), ReadError> {
    block.only(&["ELEMENTSHIFT", "SHIFTNODES", "OLDSET", "NEWSET", "REFLECT"])?;
    let shift = |option| match block.needed(option)?.parse::<i64>() {
        Ok(shift) => Ok(shift),
        Err(_) => Err(block.error(format!("{option}= of *ELCOPY needs a whole number"))),
    };
    let (elements, nodes) = (shift("ELEMENTSHIFT")?, shift("SHIFTNODES")?);
    let old = model.named(block.needed("OLDSET")?, Of::Elements, None);
    let old = old.map_err(|message| block.error(message))?;
    let rows = block.rows();
    model.generate(&rows, old.len(), ITEM)?;
    let mut made = Vec::with_capacity(old.len());
    for number in old {
        let Some((_, element)) = model.element(number) else {
            return Err(block.error(format!("element {number} is not defined before this line")));
        };
        let mut element = element.clone();
        if block.keyword.has("REFLECT") {
            turn(&mut element);
        }
        let number = number.checked_add_signed(elements);
        made.push(again(&rows, model, &element, number, nodes)?);
    }
    if let Some(label) = block.label("NEWSET") {
        model.here().add(Of::Elements, label, made, false);
    }
    Ok(())
}

/// Corners in an order that goes round the other way; nodes between them do not count.
fn turn(element: &mut Element) {
    let (Shape::Cell(kind) | Shape::Surface(kind)) = element.shape else {
        return;
    };
    let order: &[usize] = match kind {
        Kind::Hexa => &[4, 5, 6, 7, 0, 1, 2, 3],
        Kind::Prism => &[3, 4, 5, 0, 1, 2],
        Kind::Pyramid => &[0, 3, 2, 1, 4],
        Kind::Tetra => &[0, 2, 1, 3],
        Kind::Quad => &[0, 3, 2, 1],
        Kind::Triangle => &[0, 2, 1],
        Kind::Vertex | Kind::Line | Kind::Sphere => return,
    };
    let corners = order.iter().map(|k| element.nodes[*k]);
    let others = element.nodes[order.len()..].iter().copied();
    element.nodes = corners.chain(others).collect();
    element.turned = true;
}
