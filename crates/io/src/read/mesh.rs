//! A mesh: its cells of the highest dimension are the points of the body, everything else it names becomes sets of them.
//!
//! A group of cells of the body holds their points. One of surfaces, lines or vertices holds the points of the cells that have
//! one of them as a face, edge or corner. A set of nodes holds the cells with all their corners in it, and those with a whole
//! outer side in it; if there are none, those with a whole side, else with two corners, else with one corner in it.
//!
//! Sets that stand for a face know its area at each of their points: groups of surfaces (in 2-D of lines), sets of sides, and sets of
//! nodes that hold whole outer sides of all their cells, and no whole cell.

use super::body::Sourced;
use super::cell::{Cell, Kind, Nodes};
use super::cells::Cells;
use super::error::ReadError;
use super::lines::Lines;
use super::measure::measure;
use super::plane;
use peridyne::space::{cross, length};
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
    /// Sets of sides of cells by name: places in `cells`, and the corners of the side, where it is known.
    pub side_sets: Vec<(String, Vec<(usize, Option<Vec<usize>>)>)>,
    /// Every cell stands once: two with the same nodes are two.
    pub distinct: bool,
    /// Which cells a set of nodes holds.
    pub holds: Holds,
    /// Elements without shape, by type: (type, how many).
    pub shapeless: BTreeMap<String, usize>,
    /// Cells with nodes besides their corners, by their dimension.
    pub second_order: [usize; 4],
}

/// Which cells a set of nodes holds.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Holds {
    /// Those that it bounds or fills: a side or all corners.
    #[default]
    Sides,
    /// Those that have one of its nodes.
    Touching,
    /// Those that have no other nodes.
    Enclosed,
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
        let mut shapes = Cells::default();
        let body: Vec<&Cell> = self
            .cells
            .iter()
            .filter(|c| c.kind.dimension() == dimension)
            .collect();
        if dimension == 2 {
            self.flat(&body)
                .map_err(|why| lines.error_where(None, why))?;
        }
        for cell in &body {
            let (centroid, volume) = measure(lines, &self.nodes, cell)?;
            cloud.position.push(centroid);
            // a sphere has no shape beside its point
            if cell.kind != Kind::Sphere {
                let corners = cell.nodes.iter().filter_map(|n| self.nodes.get(n)).copied();
                // a plane body is one of z = 0
                let flat = |x: [f64; 3]| [x[0], x[1], if dimension == 2 { 0.0 } else { x[2] }];
                shapes.push(cell.kind.vtk(), corners.map(flat), flat(centroid));
            }
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
        let solid = body.iter().filter(|c| c.kind != Kind::Sphere);
        let nodes = solid.flat_map(|c| &c.nodes);
        let ends = plane::bounds(nodes.filter_map(|n| self.nodes.get(n)));
        let ends = Some(ends).filter(|e| e[0][0] <= e[0][1]);
        let mut notes = Vec::new();
        self.sets(dimension, &body, &mut cloud, &mut notes);
        self.note(dimension, &cloud, &mut notes);
        Ok(Sourced {
            atoms: None,
            cloud,
            // spheres are points of any dimension
            dimension: Some(dimension).filter(|_| body.iter().any(|c| c.kind != Kind::Sphere)),
            ends,
            cells: shapes,
            lines: sources,
            notes,
        })
    }

    /// A body of flat cells lies in x and y.
    fn flat(&self, body: &[&Cell]) -> Result<(), String> {
        let nodes = body.iter().flat_map(|c| &c.nodes);
        let places = nodes.filter_map(|n| self.nodes.get(n));
        plane::lies(places, 2).map_err(|why| {
            format!(
                "the mesh has triangles and quadrilaterals alone, which makes a 2-D body, and {why}"
            )
        })
    }

    /// A cell that a file has several times, once for each group, is one cell.
    fn merge(&mut self) {
        let mut first: HashMap<Vec<u64>, usize> = HashMap::new();
        let mut kept: Vec<Cell> = Vec::with_capacity(self.cells.len());
        // where each cell is then
        let mut place = Vec::with_capacity(self.cells.len());
        for cell in std::mem::take(&mut self.cells) {
            place.push(kept.len());
            if cell.groups.is_empty() {
                kept.push(cell);
                continue;
            }
            match first.get(&cell.nodes).copied() {
                Some(at) if kept[at].kind == cell.kind && kept[at].groups != cell.groups => {
                    kept[at].groups.extend(cell.groups);
                    place.pop();
                    place.push(at);
                }
                Some(_) => kept.push(cell),
                None => {
                    first.insert(cell.nodes.clone(), kept.len());
                    kept.push(cell);
                }
            }
        }
        self.cells = kept;
        for (_, cells) in &mut self.cell_sets {
            cells.iter_mut().for_each(|c| *c = place[*c]);
        }
        for (_, sides) in &mut self.side_sets {
            sides.iter_mut().for_each(|(c, _)| *c = place[*c]);
        }
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
            let mut faces = Areas::default();
            if group.dimension == dimension {
                let of = (0..body.len()).filter(|i| body[*i].groups.contains(&g));
                ids.extend(of.map(|i| i as u32));
            } else {
                for cell in self.cells.iter().filter(|c| c.groups.contains(&g)) {
                    let owners = around.with_all(&cell.nodes);
                    if group.dimension + 1 == dimension {
                        faces.add(&self.nodes, &cell.nodes, &owners);
                    }
                    ids.extend(owners);
                }
            }
            add(cloud, name, ids, faces, notes);
        }
        for (name, nodes) in &self.node_sets {
            let mut faces = Areas::default();
            let touching = || nodes.iter().flat_map(|n| around.with(*n)).copied();
            let cells = match self.holds {
                Holds::Sides => around.of_nodes(nodes, &self.nodes, &mut faces),
                Holds::Touching => touching().collect(),
                Holds::Enclosed => {
                    let set: HashSet<u64> = nodes.iter().copied().collect();
                    let inside = |i: &u32| body[*i as usize].nodes.iter().all(|n| set.contains(n));
                    touching().filter(inside).collect()
                }
            };
            add(cloud, name, cells, faces, notes);
        }
        if self.cell_sets.is_empty() && self.side_sets.is_empty() {
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
        for (name, sides) in &self.side_sets {
            let mut ids = BTreeSet::new();
            let mut faces = Areas::default();
            for (c, side) in sides {
                let nodes = &self.cells[*c].nodes;
                let (owners, corners): (Vec<u32>, Option<Vec<u64>>) = match place[*c] {
                    Some(id) => {
                        let corners = side.as_ref().map(|s| s.iter().map(|k| nodes[*k]).collect());
                        (vec![id], corners)
                    }
                    None => (around.with_all(nodes), Some(nodes.clone())),
                };
                if let Some(corners) = corners {
                    faces.add(&self.nodes, &corners, &owners);
                }
                ids.extend(owners);
            }
            add(cloud, name, ids, faces, notes);
        }
        for (name, cells) in &self.cell_sets {
            let mut ids = BTreeSet::new();
            for c in cells {
                match place[*c] {
                    Some(id) => ids.extend([id]),
                    None => ids.extend(around.with_all(&self.cells[*c].nodes)),
                }
            }
            add(cloud, name, ids, Areas::default(), notes);
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
        if self.second_order[dimension] > 0 {
            notes.push(format!(
                "{} second-order cells are taken by their corners: their sides are straight, nodes between the corners do not count",
                self.second_order[dimension]
            ));
        }
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
            "ignored {}, as the body is {dimension}-D; {sets}",
            parts.join(", ")
        ));
    }
}

/// Areas of a face, by the cells that have parts of it (lengths of edges in 2-D).
#[derive(Default)]
struct Areas(BTreeMap<u32, f64>);

impl Areas {
    /// A side with these corners, between the cells that have it.
    fn add(&mut self, nodes: &Nodes, corners: &[u64], owners: &[u32]) {
        let x: Option<Vec<[f64; 3]>> = corners.iter().map(|n| nodes.get(n).copied()).collect();
        let Some(x) = x else { return };
        let whole = size(&x);
        for id in owners {
            *self.0.entry(*id).or_default() += whole / owners.len() as f64;
        }
    }

    /// Of all these cells; `None`: some have no part of the face.
    fn of(&self, ids: &[u32]) -> Option<Vec<f64>> {
        ids.iter()
            .map(|id| self.0.get(id).copied().filter(|a| *a > 0.0))
            .collect()
    }
}

/// Length of an edge, area of a triangle or quadrilateral: half the length of the sum of cross products about a corner.
fn size(x: &[[f64; 3]]) -> f64 {
    let from = |k: usize| -> [f64; 3] { std::array::from_fn(|a| x[k][a] - x[0][a]) };
    if x.len() == 2 {
        return length(&from(1));
    }
    let mut sum = [0.0; 3];
    for k in 2..x.len() {
        let part = cross(&from(k - 1), &from(k));
        (0..3).for_each(|a| sum[a] += 0.5 * part[a]);
    }
    length(&sum)
}

fn add(cloud: &mut Cloud, name: &str, ids: BTreeSet<u32>, faces: Areas, notes: &mut Vec<String>) {
    let ids: Vec<u32> = ids.into_iter().collect();
    match cloud.sets.iter().find(|(known, _)| known == name) {
        _ if ids.is_empty() => notes.push(format!(
            "the group \"{name}\" of the mesh touches no cell: it makes no set"
        )),
        Some((_, known)) if **known == *ids => {
            let new = cloud.faces.iter().all(|(known, _)| known != name);
            if let Some(areas) = faces.of(&ids).filter(|_| new) {
                cloud.faces.push((name.to_string(), areas.into()));
            }
        }
        Some((_, known)) => notes.push(format!(
            "the mesh has several groups \"{name}\": the set is the one of {} points, not the one of {}",
            known.len(),
            ids.len()
        )),
        None => {
            if let Some(areas) = faces.of(&ids) {
                cloud.faces.push((name.to_string(), areas.into()));
            }
            cloud.sets.push((name.to_string(), ids.into()));
        }
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

    fn of_nodes(&self, nodes: &[u64], places: &Nodes, faces: &mut Areas) -> BTreeSet<u32> {
        let set: HashSet<u64> = nodes.iter().copied().collect();
        let near: BTreeSet<u32> = nodes.iter().flat_map(|n| self.with(*n)).copied().collect();
        let corners = |i: &u32| {
            let own = &self.body[*i as usize].nodes;
            own.iter().filter(|n| set.contains(n)).count()
        };
        // sides that are whole in the set, and how many cells have them
        let mut owners: HashMap<Vec<u64>, (Vec<u64>, Vec<u32>)> = HashMap::new();
        for i in &near {
            let cell = self.body[*i as usize];
            for side in cell.kind.sides() {
                let mut side: Vec<u64> = side.iter().map(|c| cell.nodes[*c]).collect();
                if side.iter().all(|n| set.contains(n)) {
                    let around = side.clone();
                    side.sort_unstable();
                    let found = owners.entry(side).or_insert((around, vec![]));
                    found.1.push(*i);
                }
            }
        }
        let whole = |i: &u32| corners(i) == self.body[*i as usize].kind.corners();
        let mut found: BTreeSet<u32> = near.iter().copied().filter(whole).collect();
        let mut outer: Vec<_> = owners.values().filter(|o| o.1.len() == 1).collect();
        outer.sort();
        // whole cells are a part of the body, not a face of it
        let part = !found.is_empty();
        for (corners, of) in outer {
            if !part {
                faces.add(places, corners, of);
            }
            found.extend(of);
        }
        if found.is_empty() {
            found.extend(owners.values().flat_map(|o| &o.1));
        }
        for least in [2, 1] {
            if found.is_empty() {
                found.extend(near.iter().copied().filter(|i| corners(i) >= least));
            }
        }
        found
    }
}
