//! The model as a mesh: cells of all instances, sets under their names.

use super::super::cell::Cell;
use super::super::error::ReadError;
use super::super::mesh::{Group, Mesh};
use super::input::Deck;
use super::model::{Element, Model, Of, Place, Scope, Set, Shape, Surface, of_scope, split_number};
use std::collections::{HashMap, HashSet};

/// The mesh, and the names with their instance of sets that need none.
pub(super) struct Made {
    pub mesh: Mesh,
    pub aliases: Vec<(String, String)>,
    /// A type of shells or membranes.
    pub shells: Option<String>,
    /// Cells by numbers of elements.
    index: HashMap<u64, usize>,
    /// Elements whose faces have other numbers than those of the manual.
    turned: HashSet<u64>,
}

pub(super) fn mesh(deck: &Deck, model: &mut Model) -> Result<Made, ReadError> {
    let mut made = Made {
        mesh: Mesh::default(),
        aliases: Vec::new(),
        shells: None,
        index: HashMap::new(),
        turned: HashSet::new(),
    };
    made.mesh.nodes = std::mem::take(&mut model.scopes[0].nodes);
    for (s, scope) in model.scopes.iter_mut().enumerate() {
        let each = std::mem::take(&mut scope.nodes).into_iter();
        let each = each.map(|(n, x)| (of_scope(s, n), x));
        made.mesh.nodes.extend(each);
    }
    for (s, scope) in model.scopes.iter_mut().enumerate() {
        let elements = std::mem::take(&mut scope.elements);
        scope.index = HashMap::new();
        made.cells(deck, s, scope, elements)?;
    }
    made.element_sets(model);
    for (name, s, set) in made.named(model, Of::Nodes) {
        let nodes = set.members.iter().map(|n| of_scope(s, *n)).collect();
        made.mesh.node_sets.push((name, nodes));
    }
    made.surfaces(deck, model)?;
    Ok(made)
}

/// The name of a set of a scope, alone where no other has it, and with its instance.
fn names(scope: &Scope, shown: &str, alone: bool) -> (String, Option<String>) {
    match &scope.label {
        None => (shown.to_string(), None),
        Some(label) => {
            let whole = format!("{}.{shown}", label.shown);
            match alone {
                true => (shown.to_string(), Some(whole)),
                false => (whole, None),
            }
        }
    }
}

/// Instances in their order, then the model around them.
fn order(model: &Model) -> impl Iterator<Item = usize> + use<> {
    (1..model.scopes.len()).chain([0])
}

impl Made {
    fn cells(
        &mut self,
        deck: &Deck,
        s: usize,
        scope: &Scope,
        elements: Vec<Element>,
    ) -> Result<(), ReadError> {
        for element in elements {
            let number = element.number;
            let kind = match element.shape {
                Shape::Cell(kind) => kind,
                Shape::Surface(kind) => {
                    self.shells.get_or_insert_with(|| element.name.to_string());
                    kind
                }
                Shape::Shapeless => {
                    *self
                        .mesh
                        .shapeless
                        .entry(element.name.to_string())
                        .or_default() += 1;
                    continue;
                }
            };
            let more = element.nodes.len() > kind.corners();
            self.mesh.second_order[kind.dimension()] += usize::from(more);
            let nodes: Vec<u64> = element.nodes[..kind.corners()]
                .iter()
                .map(|n| of_scope(s, *n))
                .collect();
            for (node, own) in nodes.iter().zip(&*element.nodes) {
                if !self.mesh.nodes.contains_key(node) {
                    let instance = scope.label.as_ref();
                    let of = instance.map_or(String::new(), |l| format!(" in {}", l.shown));
                    return Err(deck.error(
                        element.at,
                        format!("element {number} refers to node {own}, which does not exist{of}"),
                    ));
                }
            }
            self.index
                .insert(of_scope(s, number), self.mesh.cells.len());
            if element.turned {
                self.turned.insert(of_scope(s, number));
            }
            self.mesh.cells.push(Cell {
                kind,
                id: number,
                nodes,
                groups: vec![],
                line: Some(element.at + 1),
                volume: None,
            });
        }
        Ok(())
    }

    /// Sets of all scopes under their names.
    fn named<'m>(&mut self, model: &'m Model, of: Of) -> Vec<(String, usize, &'m Set)> {
        let mut count: HashMap<&str, usize> = HashMap::new();
        for set in model.scopes.iter().flat_map(|s| s.sets(of)) {
            *count.entry(&set.label.key).or_default() += 1;
        }
        let mut all = Vec::new();
        for s in order(model) {
            for set in model.scopes[s].sets(of) {
                let alone = count[&*set.label.key] == 1;
                let (name, whole) = names(&model.scopes[s], &set.label.shown, alone);
                self.aliases
                    .extend(whole.map(|whole| (name.clone(), whole)));
                all.push((name, s, set));
            }
        }
        all
    }

    fn element_sets(&mut self, model: &Model) {
        let sets = self.named(model, Of::Elements);
        // the smallest set that holds an element comes first: it is its mark
        let mut order: Vec<usize> = (0..sets.len()).collect();
        order.sort_by_key(|k| {
            let set = sets[*k].2;
            (set.internal, set.members.len(), std::cmp::Reverse(*k))
        });
        for (k, (name, ..)) in sets.iter().enumerate() {
            // the dimension is that of the cells; a set of several has a group of each
            self.mesh.groups.extend((0..4).map(|dimension| Group {
                number: k as i32 + 1,
                dimension,
                name: Some(name.clone()),
            }));
        }
        let mut used = vec![false; self.mesh.groups.len()];
        for k in order {
            let (_, s, set) = &sets[k];
            for number in &set.members {
                if let Some(at) = self.index.get(&of_scope(*s, *number)) {
                    let cell = &mut self.mesh.cells[*at];
                    let group = 4 * k + cell.kind.dimension();
                    cell.groups.push(group);
                    used[group] = true;
                }
            }
        }
        for (group, used) in self.mesh.groups.iter_mut().zip(used) {
            if !used {
                group.name = None;
            }
        }
    }

    fn surfaces(&mut self, deck: &Deck, model: &mut Model) -> Result<(), ReadError> {
        let mut count: HashMap<String, usize> = HashMap::new();
        for surface in model.scopes.iter().flat_map(|s| &s.surfaces) {
            *count.entry(surface.label.key.clone()).or_default() += 1;
        }
        let mut outer = None;
        for s in order(model) {
            model.place = if s == 0 {
                Place::Model
            } else {
                Place::Instance(s)
            };
            for surface in std::mem::take(&mut model.scopes[s].surfaces) {
                let alone = count[&surface.label.key] == 1;
                let (name, whole) = names(&model.scopes[s], &surface.label.shown, alone);
                let unread = match &surface.unread {
                    Some(option) => Some(option.clone()),
                    None => self.surface(deck, model, s, &surface, &name, &mut outer)?,
                };
                match unread {
                    Some(why) => model.notes.push(format!(
                        "the surface {name} makes no set: {why} is not read"
                    )),
                    None => self.aliases.extend(whole.map(|whole| (name, whole))),
                }
            }
        }
        model.place = Place::Model;
        Ok(())
    }

    /// A surface as a set of sides or nodes; else what of it is not read.
    fn surface(
        &mut self,
        deck: &Deck,
        model: &Model,
        s: usize,
        surface: &Surface,
        name: &str,
        outer: &mut Option<HashMap<[u64; 4], usize>>,
    ) -> Result<Option<String>, ReadError> {
        let (mut nodes, mut sides) = (Vec::new(), Vec::new());
        let dimension = self.mesh.cells.iter().map(|c| c.kind.dimension()).max();
        let dimension = dimension.unwrap_or(0);
        for (text, face, at) in &surface.rows {
            let found = model.named(text, surface.of, None);
            let found = found.map_err(|message| deck.error(*at, message))?;
            let found: Vec<u64> = found.into_iter().map(|m| of_scope(s, m)).collect();
            if surface.of == Of::Nodes {
                nodes.extend(found);
                continue;
            }
            for number in found {
                let Some(cell) = self.index.get(&number).copied() else {
                    continue;
                };
                let kind = self.mesh.cells[cell].kind;
                let digit = face.strip_prefix('S').and_then(|k| k.parse::<usize>().ok());
                // a shell, or a face of solids that was meshed besides
                let lower = kind.dimension() < dimension;
                match (&**face, digit) {
                    ("" | "SPOS" | "SNEG", _) if lower => sides.push((cell, None)),
                    _ if lower => return Ok(Some(format!("the face {face} of a shell"))),
                    ("", _) => {
                        let outer = outer.get_or_insert_with(|| count_sides(&self.mesh));
                        let free = kind.sides().iter().filter(|side| {
                            let side = corners(&self.mesh.cells[cell], side);
                            outer.get(&side) == Some(&1)
                        });
                        sides.extend(free.map(|side| (cell, Some(side.to_vec()))));
                    }
                    (_, Some(_)) if self.turned.contains(&number) => {
                        return Ok(Some(format!(
                            "the face {face} of what *ELCOPY, REFLECT made"
                        )));
                    }
                    (_, Some(k)) => match kind.sides().get(k.wrapping_sub(1)) {
                        Some(side) => sides.push((cell, Some(side.to_vec()))),
                        None => {
                            let own = split_number(number).1;
                            let message = format!("element {own} has no face {face}");
                            return Err(deck.error(*at, message));
                        }
                    },
                    _ => return Ok(Some(format!("the face {face}"))),
                }
            }
        }
        match surface.of {
            Of::Nodes => self.mesh.node_sets.push((name.to_string(), nodes)),
            Of::Elements => self.mesh.side_sets.push((name.to_string(), sides)),
        }
        Ok(None)
    }
}

/// Corners of a side, rising; of an edge and a triangle with 0 before them.
fn corners(cell: &Cell, side: &[usize]) -> [u64; 4] {
    let mut corners = [0; 4];
    for (to, c) in corners.iter_mut().zip(side) {
        *to = cell.nodes[*c];
    }
    corners.sort_unstable();
    corners
}

/// How many cells have each side.
fn count_sides(mesh: &Mesh) -> HashMap<[u64; 4], usize> {
    let mut count = HashMap::new();
    for cell in &mesh.cells {
        for side in cell.kind.sides() {
            *count.entry(corners(cell, side)).or_default() += 1;
        }
    }
    count
}
