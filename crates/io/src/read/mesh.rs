//! A mesh: its cells of the highest dimension are the points of the body, everything else it names becomes sets of them.
//!
//! A group of cells of the body holds their points. One of surfaces, lines or vertices holds the points of the cells that have
//! one of them as a face, edge or corner. A set of nodes holds the cells with all their corners in it, and those with a whole
//! outer side in it; if there are none, those with a whole side, else with two corners, else with one corner in it.

use super::cell::{Cell, Kind, Nodes, measure};
use super::lines::Lines;
use super::{ReadError, Sourced};
use peridyne::spec::Cloud;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

/// What a mesh gathers under a name or a number.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Group {
    /// As mark of its points.
    pub number: i32,
    /// Of its cells.
    pub dimension: usize,
    pub name: Option<String>,
}

#[derive(Default)]
pub(super) struct Mesh {
    pub nodes: Nodes,
    pub cells: Vec<Cell>,
    pub groups: Vec<Group>,
    /// Sets of nodes by name.
    pub node_sets: Vec<(String, Vec<u64>)>,
    /// Sets of cells by name: places in `cells`.
    pub cell_sets: Vec<(String, Vec<usize>)>,
    /// Every cell stands once: two with the same nodes are two.
    pub distinct: bool,
    /// A set of nodes holds every cell that has one of them.
    pub touching: bool,
    /// Elements without shape, by type: (type, how many).
    pub shapeless: BTreeMap<String, usize>,
}

impl Mesh {
    /// The place of a group, which is new if it was not there.
    pub fn group(&mut self, dimension: usize, number: i32) -> usize {
        let known = |g: &Group| g.dimension == dimension && g.number == number;
        self.groups.iter().position(known).unwrap_or_else(|| {
            self.groups.push(Group {
                number,
                dimension,
                name: None,
            });
            self.groups.len() - 1
        })
    }

    /// The points and their sets.
    ///
    /// # Errors
    /// No cells, cells without volume or with nodes that do not exist.
    pub fn points(mut self, lines: &Lines) -> Result<Sourced, ReadError> {
        if !self.distinct {
            self.merge();
        }
        let dimension = self.cells.iter().map(|c| c.kind.dimension()).max();
        let Some(dimension) = dimension.filter(|d| *d >= 2) else {
            return Err(lines.error(
                "the mesh has no cells (triangles, quadrilaterals, tetrahedra, prisms, hexahedra)",
            ));
        };
        let mut cloud = Cloud::default();
        let mut sources = Vec::new();
        let body: Vec<&Cell> = self
            .cells
            .iter()
            .filter(|c| c.kind.dimension() == dimension)
            .collect();
        for cell in &body {
            let (centroid, volume) = measure(lines, &self.nodes, cell)?;
            cloud.position.push(centroid);
            cloud.volume.push(volume);
            let mark = cell.groups.iter().map(|g| self.groups[*g].number).next();
            cloud.mark.push(mark.unwrap_or(0));
            sources.push(cell.line.unwrap_or(0));
        }
        for group in self.groups.iter().filter(|g| g.dimension == dimension) {
            if let Some(name) = group
                .name
                .clone()
                .filter(|_| cloud.mark.contains(&group.number))
            {
                cloud.names.push((group.number, name));
            }
        }
        let mut notes = Vec::new();
        self.sets(dimension, &body, &mut cloud, &mut notes);
        self.note(dimension, &cloud, &mut notes);
        Ok(Sourced {
            atoms: None,
            cloud,
            // spheres are points of any dimension
            dimension: Some(dimension).filter(|_| body.iter().any(|c| c.kind != Kind::Sphere)),
            lines: sources,
            notes,
        })
    }

    /// A cell that a file has several times, once for each group, is one cell.
    fn merge(&mut self) {
        let mut first: HashMap<Vec<u64>, usize> = HashMap::new();
        let mut kept: Vec<Cell> = Vec::with_capacity(self.cells.len());
        for cell in std::mem::take(&mut self.cells) {
            if cell.groups.is_empty() {
                kept.push(cell);
                continue;
            }
            match first.get(&cell.nodes).map(|at| &mut kept[*at]) {
                Some(same) if same.kind == cell.kind && same.groups != cell.groups => {
                    same.groups.extend(cell.groups);
                }
                Some(_) => kept.push(cell),
                None => {
                    first.insert(cell.nodes.clone(), kept.len());
                    kept.push(cell);
                }
            }
        }
        self.cells = kept;
    }

    fn sets(&self, dimension: usize, body: &[&Cell], cloud: &mut Cloud, notes: &mut Vec<String>) {
        // groups of the body go before those of its boundary with the same name
        let mut groups: Vec<usize> = (0..self.groups.len()).collect();
        groups.sort_by_key(|g| std::cmp::Reverse(self.groups[*g].dimension));
        let around = Around::new(body);
        for g in groups {
            let group = &self.groups[g];
            let Some(name) = &group.name else { continue };
            let mut ids = BTreeSet::new();
            if group.dimension == dimension {
                let of = (0..body.len()).filter(|i| body[*i].groups.contains(&g));
                ids.extend(of.map(|i| i as u32));
            } else {
                for cell in self.cells.iter().filter(|c| c.groups.contains(&g)) {
                    ids.extend(around.with_all(&cell.nodes));
                }
            }
            add(cloud, name, ids, notes);
        }
        for (name, nodes) in &self.node_sets {
            let cells = match self.touching {
                true => nodes
                    .iter()
                    .flat_map(|n| around.with(*n))
                    .copied()
                    .collect(),
                false => around.of_nodes(nodes),
            };
            add(cloud, name, cells, notes);
        }
        if self.cell_sets.is_empty() {
            return;
        }
        let inside = self.cells.iter().map(|c| c.kind.dimension() == dimension);
        let mut count = 0;
        let place: Vec<Option<u32>> = inside
            .map(|yes| {
                count += u32::from(yes);
                yes.then(|| count - 1)
            })
            .collect();
        for (name, cells) in &self.cell_sets {
            let mut ids = BTreeSet::new();
            for c in cells {
                match place[*c] {
                    Some(id) => ids.extend([id]),
                    None => ids.extend(around.with_all(&self.cells[*c].nodes)),
                }
            }
            add(cloud, name, ids, notes);
        }
    }

    /// What is in the file and not in the body.
    fn note(&self, dimension: usize, cloud: &Cloud, notes: &mut Vec<String>) {
        let mut skipped: BTreeMap<usize, BTreeMap<&str, usize>> = BTreeMap::new();
        for cell in self.cells.iter().filter(|c| c.kind.dimension() < dimension) {
            let kinds = skipped.entry(cell.kind.dimension()).or_default();
            *kinds.entry(cell.kind.plural()).or_default() += 1;
        }
        let mut parts: Vec<String> = skipped
            .values()
            .rev()
            .flatten()
            .map(|(kind, count)| format!("{count} {kind}"))
            .collect();
        parts.extend(
            self.shapeless
                .iter()
                .map(|(kind, count)| format!("{count} elements {kind}")),
        );
        if parts.is_empty() {
            return;
        }
        let sets: Vec<String> = cloud
            .sets
            .iter()
            .map(|(name, ids)| format!("{name} ({} points)", ids.len()))
            .collect();
        let sets = match sets.is_empty() {
            true => "no group of the mesh has a name".to_string(),
            false => format!("sets of the mesh: {}", sets.join(", ")),
        };
        notes.push(format!(
            "skipped are {}, which are no {dimension}-D cells; {sets}",
            parts.join(", ")
        ));
    }
}

fn add(cloud: &mut Cloud, name: &str, ids: BTreeSet<u32>, notes: &mut Vec<String>) {
    let ids: Vec<u32> = ids.into_iter().collect();
    match cloud.sets.iter().find(|(known, _)| known == name) {
        _ if ids.is_empty() => notes.push(format!(
            "the group \"{name}\" of the mesh touches no cell: it makes no set"
        )),
        Some((_, known)) if **known == *ids => {}
        Some((_, known)) => notes.push(format!(
            "the mesh has several groups \"{name}\": the set is the one of {} points, not the one of {}",
            known.len(),
            ids.len()
        )),
        None => cloud.sets.push((name.to_string(), ids.into())),
    }
}

/// Cells of the body by their nodes.
struct Around<'a> {
    body: &'a [&'a Cell],
    of: HashMap<u64, Vec<u32>>,
}

impl<'a> Around<'a> {
    fn new(body: &'a [&'a Cell]) -> Self {
        let mut of: HashMap<u64, Vec<u32>> = HashMap::new();
        for (i, cell) in body.iter().enumerate() {
            for node in &cell.nodes {
                of.entry(*node).or_default().push(i as u32);
            }
        }
        Around { body, of }
    }

    fn with(&self, node: u64) -> &[u32] {
        self.of.get(&node).map_or(&[], Vec::as_slice)
    }

    /// Cells that have all these corners.
    fn with_all(&self, nodes: &[u64]) -> Vec<u32> {
        let Some((first, others)) = nodes.split_first() else {
            return Vec::new();
        };
        let has = |i: &u32| {
            others
                .iter()
                .all(|n| self.body[*i as usize].nodes.contains(n))
        };
        self.with(*first).iter().copied().filter(has).collect()
    }

    fn of_nodes(&self, nodes: &[u64]) -> BTreeSet<u32> {
        let set: HashSet<u64> = nodes.iter().copied().collect();
        let near: BTreeSet<u32> = nodes.iter().flat_map(|n| self.with(*n)).copied().collect();
        let corners = |i: &u32| {
            let own = &self.body[*i as usize].nodes;
            own.iter().filter(|n| set.contains(n)).count()
        };
        // sides that are whole in the set, and how many cells have them
        let mut owners: HashMap<Vec<u64>, Vec<u32>> = HashMap::new();
        for i in &near {
            let cell = self.body[*i as usize];
            for side in cell.kind.sides() {
                let mut side: Vec<u64> = side.iter().map(|c| cell.nodes[*c]).collect();
                if side.iter().all(|n| set.contains(n)) {
                    side.sort_unstable();
                    owners.entry(side).or_default().push(*i);
                }
            }
        }
        let whole = |i: &u32| corners(i) == self.body[*i as usize].kind.corners();
        let mut found: BTreeSet<u32> = near.iter().copied().filter(whole).collect();
        found.extend(owners.values().filter(|o| o.len() == 1).flatten());
        if found.is_empty() {
            found.extend(owners.values().flatten());
        }
        for least in [2, 1] {
            if found.is_empty() {
                found.extend(near.iter().copied().filter(|i| corners(i) >= least));
            }
        }
        found
    }
}
