//! The points of a deck of Peridigm or PeriLab: text files, Exodus meshes, grids; blocks and node sets.

use std::collections::BTreeMap;
use std::path::Path;

use super::program::Program;
use super::tree::Entry;
use crate::read::Holds;
use crate::read::exodus::parse_holding;
use crate::read::number::number as read_number;
use crate::read::source;
use crate::write::exodus::Layout;
use peridyne::expression::Expression;

/// Points with their blocks and sets.
#[derive(Debug, Default)]
pub struct Points {
    /// 2 where a text file has no z.
    pub dimension: usize,
    pub position: Vec<[f64; 3]>,
    pub volume: Vec<f64>,
    pub block: Vec<i32>,
    /// Names of blocks by their number.
    pub names: BTreeMap<i32, String>,
    /// Points of named sets, rising.
    pub sets: BTreeMap<String, Vec<u32>>,
    /// What should be known of them.
    pub notes: Vec<String>,
    pub grid: Option<Grid>,
}

/// Cells of a grid of Peridigm: lengths of their edges, and how many there are along each axis.
#[derive(Debug, Clone, Copy)]
pub struct Grid {
    pub edge: [f64; 3],
    pub count: [usize; 3],
}

/// Text of a file that a deck names.
fn read(path: &Path) -> Result<Vec<u8>, String> {
    source::bytes(path).map_err(|e| format!("{}: cannot read it: {e}", path.display()))
}

fn text(path: &Path) -> Result<String, String> {
    let read = crate::read::text_of(path);
    read.map(|(text, _)| text).map_err(|e| e.to_string())
}

/// Lines with their numbers, without comments.
fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let all = text.lines().enumerate();
    let all = all.map(|(n, line)| (n + 1, line.split('#').next().unwrap_or("").trim()));
    all.filter(|(_, line)| !line.is_empty())
}

/// `discretization` in the folder of its deck.
pub fn points(discretization: &Entry, folder: &Path, program: Program) -> Result<Points, String> {
    let kind = discretization.text("Type").unwrap_or("").to_lowercase();
    let file = discretization.text("Input Mesh File");
    let mut points = match (&*kind, file) {
        ("text file", Some(file)) => of_text(&folder.join(file))?,
        ("exodus" | "exodus mesh", Some(file)) => of_mesh(&folder.join(file), program)?,
        (of @ ("abaqus" | "gmsh"), Some(file)) => {
            let read = crate::read::points(&folder.join(file), crate::read::Frame::Last);
            let mut points = of_cloud(read.map_err(|e| e.to_string())?);
            points.without_groups(of == "gmsh");
            points
        }
        ("pdquickgrid", _) => of_grid(discretization)?,
        (_, None) => return Err("Discretization has no Input Mesh File".into()),
        (other, Some(_)) => {
            return Err(format!(
                "Discretization of type \"{other}\" is not read; known are Text File, Exodus, Abaqus, Gmsh, PdQuickGrid"
            ));
        }
    };
    if points.position.is_empty() {
        return Err("the mesh has no points".into());
    }
    for block in &points.block {
        let name = || format!("block_{block}");
        points.names.entry(*block).or_insert_with(name);
    }
    Ok(points)
}

/// `x y z block_id volume`, or as a line `header:` says.
fn of_text(path: &Path) -> Result<Points, String> {
    let text = text(path)?;
    let mut points = Points {
        dimension: 3,
        ..Points::default()
    };
    let name = path.display();
    let mut columns: Vec<&str> = vec!["x", "y", "z", "block_id", "volume"];
    for (n, line) in lines(&text) {
        if let Some(header) = line.strip_prefix("header:") {
            columns = header.split_whitespace().collect();
            let unknown = columns.iter().filter(|c| {
                !["x", "y", "z", "block_id", "volume"].contains(&c.to_lowercase().as_str())
            });
            let unknown: Vec<&str> = unknown.copied().collect();
            if !unknown.is_empty() {
                let message = format!("{name}:{n}: columns {} are left out", unknown.join(", "));
                points.notes.push(message);
            }
            continue;
        }
        let words: Vec<&str> = line
            .split(|c: char| c.is_whitespace() || c == ',')
            .filter(|w| !w.is_empty())
            .collect();
        if words.len() != columns.len() {
            return Err(format!(
                "{name}:{n}: {} columns, expected {}",
                words.len(),
                columns.join(" ")
            ));
        }
        let number = |column: &str| -> Result<Option<f64>, String> {
            let Some(at) = columns.iter().position(|c| c.eq_ignore_ascii_case(column)) else {
                return Ok(None);
            };
            match read_number(words[at]) {
                Some(x) if x.is_finite() => Ok(Some(x)),
                _ => Err(format!(
                    "{name}:{n}: {column} is `{}`, expected a number",
                    words[at]
                )),
            }
        };
        let missing = |column: &str| format!("{name}: there is no column {column}");
        let x = number("x")?.ok_or_else(|| missing("x"))?;
        let y = number("y")?.ok_or_else(|| missing("y"))?;
        let z = number("z")?;
        if z.is_none() {
            points.dimension = 2;
        }
        points.position.push([x, y, z.unwrap_or(0.0)]);
        let volume = number("volume")?.ok_or_else(|| missing("volume"))?;
        if volume <= 0.0 {
            return Err(format!("{name}:{n}: the volume is {volume}"));
        }
        points.volume.push(volume);
        let block = number("block_id")?.ok_or_else(|| missing("block_id"))?;
        if block.fract() != 0.0 || block.abs() > f64::from(i32::MAX) {
            return Err(format!(
                "{name}:{n}: block_id is {block}, expected a whole number: the columns are {}, in another order a line `header:` names them",
                columns.join(" ")
            ));
        }
        points.block.push(block as i32);
    }
    Ok(points)
}

/// Cells as points; a node set holds the cells that have one of its nodes in Peridigm, those that have no others in PeriLab.
fn of_mesh(path: &Path, program: Program) -> Result<Points, String> {
    let name = path.display().to_string();
    let holds = match program {
        Program::Peridigm => Holds::Touching,
        Program::PeriLab => Holds::Enclosed,
    };
    let read = parse_holding(read(path)?, &name, holds).map_err(|e| e.to_string())?;
    Ok(of_cloud(read))
}

fn of_cloud(read: crate::read::Points) -> Points {
    let cloud = read.cloud;
    Points {
        dimension: read.dimension.unwrap_or(3),
        position: cloud.position,
        volume: cloud.volume,
        block: cloud.mark,
        names: cloud.names.into_iter().collect(),
        sets: { cloud.sets.into_iter() }
            .map(|(name, ids)| (name, ids.to_vec()))
            .collect(),
        notes: read.notes,
        grid: None,
    }
}

/// Centres of the cells of a box; x runs fastest.
fn of_grid(discretization: &Entry) -> Result<Points, String> {
    let grid = discretization.list("TensorProduct3DMeshGenerator");
    let grid = grid.ok_or("only TensorProduct3DMeshGenerator of PdQuickGrid is read")?;
    grid.text("Type");
    let axes = ["X", "Y", "Z"];
    let number = |key: String| {
        let missing = format!("TensorProduct3DMeshGenerator has no number {key}");
        grid.number(&key).ok_or(missing)
    };
    let (mut origin, mut edge, mut count) = ([0.0; 3], [0.0; 3], [0usize; 3]);
    for (a, axis) in axes.into_iter().enumerate() {
        origin[a] = number(format!("{axis} Origin"))?;
        let points = number(format!("Number Points {axis}"))?;
        if !(1.0..=1e6).contains(&points) {
            return Err(format!("Number Points {axis} is {points}"));
        }
        count[a] = points as usize;
        edge[a] = number(format!("{axis} Length"))? / points;
    }
    let mut points = Points {
        dimension: 3,
        ..Points::default()
    };
    let total = count.iter().try_fold(1usize, |n, c| n.checked_mul(*c));
    if total.is_none_or(|n| n > 100_000_000) {
        return Err("the grid has more than a hundred million points".into());
    }
    // added up, as there: round-off decides about bonds of the length of the horizon
    let places: [Vec<f64>; 3] = std::array::from_fn(|a| {
        let first = origin[a] + edge[a] / 2.0;
        let next = |x: &f64| Some(x + edge[a]);
        std::iter::successors(Some(first), next)
            .take(count[a])
            .collect()
    });
    for z in 0..count[2] {
        for y in 0..count[1] {
            for x in 0..count[0] {
                let cell = [x, y, z];
                let place = |a: usize| places[a][cell[a]];
                points.position.push(std::array::from_fn(place));
                points.volume.push(edge.iter().product());
                points.block.push(1);
            }
        }
    }
    points.grid = Some(Grid { edge, count });
    Ok(points)
}

/// Numbers with blanks or commas between them, and ranges `first:last` or `first:by:last`; `None`: it is something else.
fn numbers(text: &str) -> Option<Vec<u32>> {
    let mut all = vec![];
    for word in text
        .split(|c: char| c.is_whitespace() || c == ',')
        .filter(|w| !w.is_empty())
    {
        match word.split_once(':') {
            None => all.push(word.parse().ok()?),
            Some((first, rest)) => {
                let (by, last) = rest.split_once(':').unwrap_or(("1", rest));
                let (first, last): (u32, u32) = (first.parse().ok()?, last.parse().ok()?);
                let by: usize = by.parse().ok().filter(|by| *by > 0)?;
                // no mesh here has more
                let few = last.saturating_sub(first) < 1 << 27;
                few.then(|| all.extend((first..=last).step_by(by)))?;
            }
        }
    }
    Some(all)
}

impl Points {
    /// PeriLab's blocks of meshes without groups: all cells are block 1. It looks for groups of solids alone, so that all plane
    /// cells of gmsh are, too.
    fn without_groups(&mut self, gmsh: bool) {
        let flat = gmsh && self.dimension == 2;
        if flat && self.block.iter().any(|b| *b > 1) {
            let note = "PeriLab has no groups of a plane gmsh mesh: all cells are block 1";
            self.notes.push(note.into());
        }
        if flat || self.block.iter().all(|b| *b == 0) {
            self.block.fill(1);
            self.names.clear();
        }
    }

    /// Points of a set or a block, rising.
    pub fn of(&self, name: &str) -> Vec<u32> {
        let block = self.names.iter().find(|(_, n)| *n == name);
        let with =
            |b: i32| (0..self.block.len() as u32).filter(move |i| self.block[*i as usize] == b);
        match (self.sets.get(name), block) {
            (Some(set), _) => set.clone(),
            (None, Some((block, _))) => with(*block).collect(),
            (None, None) => vec![],
        }
    }

    /// Do all have the same z?
    pub fn flat(&self) -> bool {
        let z = self.position.iter().map(|x| x[2]);
        let (low, high) = z.fold((f64::MAX, f64::MIN), |(l, h), z| (l.min(z), h.max(z)));
        let reach = |k: usize| {
            { self.position.iter() }
                .map(|x| x[k].abs())
                .fold(0.0, f64::max)
        };
        high - low <= 1e-9 * reach(0).max(reach(1))
    }

    /// The volume that all points of a set have.
    pub fn volume_of(&self, name: &str) -> Option<f64> {
        let set = self.of(name);
        let mut all = set.iter().map(|i| self.volume[*i as usize]);
        let first = all.next()?;
        let same = |v: f64| (v - first).abs() <= 1e-12 * first;
        all.all(same).then_some(first)
    }

    /// Adds the union of sets whose names stand with + between them, as PeriLab has it.
    pub fn add_union(&mut self, given: &str) {
        let parts = given.split('+').map(str::trim);
        let found: Option<Vec<&Vec<u32>>> = parts.map(|part| self.sets.get(part)).collect();
        if let Some(found) = found.filter(|f| f.len() > 1) {
            let mut union: Vec<u32> = found.into_iter().flatten().copied().collect();
            union.sort_unstable();
            union.dedup();
            self.sets.insert(given.to_string(), union);
        }
    }

    /// Adds a set: numbers of points from 1 on (`7`, `1:27`), the name of a file with them, or an expression that holds at its points
    /// (`x < 0.1`). Numbers that no point has are left out, with a note.
    ///
    /// # Errors
    /// It is none of these.
    pub fn add_set(&mut self, name: &str, given: &str, folder: &Path) -> Result<(), String> {
        let path = folder.join(given);
        let mut set: Vec<u32> = match numbers(given) {
            Some(numbers) => self.places(name, &numbers),
            None if given.eq_ignore_ascii_case("all") => (0..self.position.len() as u32).collect(),
            None if path.is_file() => {
                let numbers = self.numbers_of(&path)?;
                self.places(name, &numbers)
            }
            None => {
                let text = given.replace("&&", "&").replace('&', "&&");
                let holds = Expression::parse(&text, &[])
                    .ok()
                    .filter(|_| text.contains(['<', '>', '=']));
                let holds = holds.ok_or_else(|| {
                    format!(
                        "node set {name}: {given:?} is neither numbers of points nor a condition, and there is no file {}",
                        path.display()
                    )
                })?;
                let all = self.position.iter().enumerate();
                let inside = all.filter(|(_, x)| holds.eval(x, 0.0) != 0.0);
                inside.map(|(i, _)| i as u32).collect()
            }
        };
        set.sort_unstable();
        set.dedup();
        self.sets.insert(name.to_string(), set);
        Ok(())
    }

    /// Points of these numbers.
    fn places(&mut self, name: &str, numbers: &[u32]) -> Vec<u32> {
        let count = self.position.len();
        let place = |n: &u32| n.checked_sub(1).filter(|i| (*i as usize) < count);
        let none: Vec<String> = { numbers.iter() }
            .filter(|n| place(n).is_none())
            .map(u32::to_string)
            .collect();
        if !none.is_empty() {
            self.notes.push(format!(
                "node set {name}: there is no point {}, the mesh has {count}: left out",
                none.join(", ")
            ));
        }
        numbers.iter().filter_map(place).collect()
    }

    fn numbers_of(&self, path: &Path) -> Result<Vec<u32>, String> {
        let text = text(path)?;
        let mut numbers = vec![];
        for (n, line) in lines(&text) {
            if line.starts_with("header:") {
                continue;
            }
            for word in line.split([' ', ',', '\t']).filter(|w| !w.is_empty()) {
                numbers.extend(self::numbers(word).ok_or_else(|| {
                    let name = path.display();
                    format!("{name}:{n}: `{word}`, expected the number of a point")
                })?);
            }
        }
        Ok(numbers)
    }

    /// As an Exodus mesh has them: blocks of SPHERE elements, and node sets.
    pub fn layout(&self, title: &str) -> Layout {
        let mut blocks: BTreeMap<i32, Vec<u32>> = BTreeMap::new();
        for (i, block) in self.block.iter().enumerate() {
            blocks.entry(*block).or_default().push(i as u32);
        }
        let blocks: Vec<(String, Vec<u32>)> = { blocks.into_iter() }
            .map(|(block, points)| (self.names[&block].clone(), points))
            .collect();
        let sets = self.sets.iter().filter(|(name, points)| {
            // blocks are sets by themselves
            !points.is_empty() && blocks.iter().all(|b| b.0 != **name)
        });
        Layout {
            title: title.into(),
            sets: sets.map(|(n, p)| (n.clone(), p.clone())).collect(),
            blocks,
            volume: self.volume.clone(),
            ..Layout::default()
        }
    }
}
