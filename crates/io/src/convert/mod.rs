//! Decks of Peridigm (YAML, XML) and PeriLab (YAML) as decks of peridyne: what has a counterpart is written, everything else is named
//! with its line.
//!
//! Points, blocks and node sets become an Exodus mesh beside the deck, whatever they came from: what the numbers of a node set mean
//! depends on the program. Numbers stay as they are: such decks have no units, and neither has the new one (`units = "none"`).

mod clock;
mod conditions;
mod family;
mod filters;
mod increments;
mod laws;
mod points;
mod probes;
mod program;
mod solver;
mod syntax;
#[cfg(test)]
mod tests;
mod tree;

use crate::read::ReadError;
use crate::write::WriteError;
use crate::write::exodus::write_mesh;
use family::Search;
use points::Points;
use program::Program;
use std::path::{Path, PathBuf};
pub use tree::Unmapped;
use tree::{Entry, Value};

/// A deck that was converted.
#[derive(Debug)]
pub struct Converted {
    /// The new deck.
    pub text: String,
    /// What was not mapped, in the order of the file.
    pub unmapped: Vec<Unmapped>,
    /// What was mapped and is not quite the same.
    pub remarks: Vec<String>,
    points: Points,
    title: String,
}

impl Converted {
    /// Writes the mesh that the deck names.
    ///
    /// # Errors
    /// The operating system's.
    pub fn write_mesh(&self, path: &Path) -> Result<(), WriteError> {
        write_mesh(
            path,
            &self.points.layout(&self.title),
            &self.points.position,
        )
    }

    pub fn points(&self) -> usize {
        self.points.position.len()
    }
}

/// A text of TOML.
fn quoted(text: &str) -> String {
    toml::Value::String(text.into()).to_string()
}

/// A key of TOML.
fn key(name: &str) -> String {
    let bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    match !name.is_empty() && name.chars().all(bare) {
        true => name.into(),
        false => quoted(name),
    }
}

/// A deck at `path` as one that will lie beside its mesh `mesh`.
///
/// # Errors
/// The deck or its mesh cannot be read, is no deck of these programs, or has nothing a body could be made of.
pub fn convert(path: &Path, mesh: &str) -> Result<Converted, ReadError> {
    let whole = |message: String| ReadError::file(path, message);
    let (text, name) = crate::read::text_of(path)?;
    let root = syntax::tree(&text).map_err(|(line, message)| ReadError {
        file: name.clone(),
        line: Some(line),
        message,
    })?;
    let program = match root.key.as_str() {
        "PeriLab" => Program::PeriLab,
        _ => Program::Peridigm,
    };
    let discretization = root.list("Discretization").ok_or_else(|| {
        whole("it has no list Discretization: it is no deck of Peridigm or PeriLab".into())
    })?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let points = points::points(discretization, folder, program).map_err(whole)?;
    let title = path
        .file_stem()
        .map_or("deck".into(), |s| s.to_string_lossy());
    let mut converter = Converter {
        program,
        root: &root,
        folder: folder.to_path_buf(),
        remarks: vec![],
        points,
    };
    let body = converter.deck(&title, mesh).map_err(whole)?;
    let unmapped = root.unmapped();
    let mut text = format!(
        "# {} of {}, by peridyne convert\n",
        path.file_name()
            .map_or(title.clone(), |n| n.to_string_lossy()),
        match program {
            Program::Peridigm => "Peridigm",
            Program::PeriLab => "PeriLab",
        }
    );
    if !unmapped.is_empty() {
        text += "# Not mapped:\n";
    }
    for u in &unmapped {
        text += &format!(
            "#   line {}: {}: {}\n",
            u.line,
            one_line(&u.entry),
            one_line(&u.why)
        );
    }
    for remark in &converter.remarks {
        text += &format!("# Note: {}\n", one_line(remark));
    }
    Ok(Converted {
        text: text + &body,
        unmapped,
        remarks: converter.remarks,
        title: title.into_owned(),
        points: converter.points,
    })
}

/// For comments: a line break would end them.
fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

struct Converter<'a> {
    program: Program,
    root: &'a Entry,
    folder: PathBuf,
    points: Points,
    remarks: Vec<String>,
}

/// The influence function; there 1, or an expression of the length zeta.
fn influence(discretization: &Entry) -> &'static str {
    let given = discretization.text("Influence Function").unwrap_or("One");
    match &*given.to_lowercase().replace(' ', "") {
        "one" | "1" | "1.0" => "constant",
        "1/zeta" | "1.0/zeta" | "1/xi" | "1.0/xi" => "inverse",
        _ => {
            discretization.refuse_entry(
                "Influence Function",
                "it is none of constant, inverse, conical, gaussian, cubic_spline as they are here: constant in place of it",
            );
            "constant"
        }
    }
}

/// Tables of the materials of all blocks.
#[derive(Default)]
struct Materials {
    text: String,
    /// The plane they are in, and its thickness, where volumes have it.
    plane: Option<&'static str>,
    height: Option<f64>,
    /// Can any break?
    breaks: bool,
    /// Sets and densities of the blocks.
    densities: Vec<(String, f64)>,
    /// Are there several of bonds that act directly?
    bonds: bool,
}

/// A block of the deck: its set, and the list that describes it.
struct Block<'a> {
    name: String,
    entry: &'a Entry,
}

/// Names what of families has no counterpart.
fn refuse_families(discretization: &Entry) {
    discretization.idle(&["Distribution Type", "Store Exodus Mesh"]);
    discretization.refuse_entry(
        "Omit Bonds Between Blocks",
        "give blocks bodies of their own: [[body]]",
    );
    let ball = discretization.text("NeighborhoodType");
    if ball.is_some_and(|t| !t.eq_ignore_ascii_case("Spherical")) {
        discretization.refuse_entry("NeighborhoodType", "families are balls");
    }
}

/// Why no material was made.
fn unmapped_materials(root: &Entry) -> String {
    let mut whys: Vec<String> = root.unmapped().into_iter().map(|u| u.why).collect();
    // what nobody asked for yet says nothing
    whys.retain(|why| !why.contains("counterpart"));
    whys.dedup();
    format!(
        "no block has a material that can be mapped: {}",
        whys.join("; ")
    )
}

/// Keys of the whole deck: its plane, its family, and what bonds do.
fn head(
    materials: &Materials,
    dimension: usize,
    horizon: f64,
    discretization: Option<&Entry>,
) -> String {
    let mut out = String::new();
    if dimension == 2 {
        out += "dimension = 2\n";
        out += &format!("plane = \"{}\"\n", materials.plane.unwrap_or("strain"));
    }
    if let Some(height) = materials.height {
        out += &format!("thickness = {height:?}\n");
    }
    out += &format!("horizon = {horizon:?}\n");
    let influence = discretization.map_or("constant", influence);
    out += &format!("influence = \"{influence}\"\n");
    out += "partial_volume_correction = false\ncalibration = \"continuum\"\n";
    if materials.bonds {
        // each end gives half of its own constant
        out += "bond_mixing = \"arithmetic\"\n";
    }
    if materials.breaks {
        out += "contact = false\n";
    }
    out
}

/// Conditions that take a part of the velocity, for blocks with their densities.
fn damped(densities: &[(String, f64)], damping: f64) -> String {
    let each = densities.iter().map(|(set, density)| {
        format!(
            "\n[[boundary_condition]]\nset = {}\ndamping = {:?}\n",
            quoted(if densities.len() == 1 { "all" } else { set }),
            density * damping
        )
    });
    each.collect()
}

impl<'a> Converter<'a> {
    fn deck(&mut self, title: &str, mesh: &str) -> Result<String, String> {
        self.root.idle(&["Verbose"]);
        let root = self.root;
        let discretization = root.list("Discretization");
        let given = root.list("Boundary Conditions");
        self.point_sets(discretization, given)?;
        self.remarks.append(&mut self.points.notes);
        if let Some(d) = discretization {
            refuse_families(d);
        }
        let blocks = self.blocks()?;
        let given_horizon = self.horizon(&blocks)?;
        let horizon = self.family(&blocks, given_horizon);
        let solver = solver::solver(root, self.program, &mut self.remarks)?;
        let materials = self.materials(&blocks, given_horizon, solver.damage);
        if materials.text.is_empty() {
            return Err(unmapped_materials(root));
        }
        let dimension = match materials.plane {
            Some(_) => 2,
            None => self.points.dimension,
        };
        if let Some(height) = materials.height {
            // of a plane they are areas
            self.points.volume.iter_mut().for_each(|v| *v /= height);
        }
        let mut out = format!("title = {}\nunits = \"none\"\n", quoted(title));
        out += &head(&materials, dimension, horizon, discretization);
        out += &format!("body = {{ file = {} }}\n", quoted(mesh));
        out += &materials.text;
        if let Some(filters) = discretization.and_then(|d| d.list("Bond Filters")) {
            let target = filters::Target {
                program: self.program,
                dimension,
                position: &self.points.position,
                horizon: given_horizon,
            };
            out += &filters::filters(filters, &target, &mut self.remarks);
        }
        let mut names: Vec<String> = self.points.names.values().cloned().collect();
        let sets = self
            .points
            .sets
            .iter()
            .filter(|(_, points)| !points.is_empty());
        names.extend(sets.map(|(name, _)| name.clone()));
        if let Some(given) = given {
            let stage = increments::Stage {
                program: self.program,
                points: &self.points,
                names: &names,
                solver: &solver,
                dimension,
            };
            out += &conditions::conditions(given, &stage, &mut self.remarks);
        }
        if solver.damping > 0.0 {
            out += &damped(&materials.densities, solver.damping);
        }
        let mut labels = vec![];
        if let Some(all) = root.list("Compute Class Parameters") {
            let (probes, named) = probes::probes(all, &names, &mut self.remarks);
            out += &probes;
            labels = named;
        }
        out += &solver.text;
        out += &solver::output(root, &solver, &labels, &mut self.remarks);
        if let Some(contact) = root.list("Contact") {
            contact.refuse("contact acts between bodies and where bonds broke, with a stiffness of its own: `contact`, `[[body]]`");
        }
        Ok(out)
    }

    /// Sets of points that the mesh and the conditions name.
    fn point_sets(
        &mut self,
        discretization: Option<&Entry>,
        given: Option<&Entry>,
    ) -> Result<(), String> {
        let sets = discretization.and_then(|d| d.list("Node Sets"));
        for list in given.into_iter().chain(sets) {
            for entry in list.all() {
                if tree::same(&entry.key, "Create Node Set For Rank Deficient Nodes") {
                    match list.is_true(&entry.key) {
                        true => entry.refuse("points that lose all bonds are not held here"),
                        false => list.idle(&[&entry.key]),
                    }
                    continue;
                }
                if let (Value::Text(_), Some(text)) = (&entry.value, entry.own()) {
                    self.points.add_set(&entry.key, text, &self.folder)?;
                }
            }
        }
        for entry in given.into_iter().flat_map(Entry::lists) {
            if self.program == Program::PeriLab
                && let Some(sets) = entry.text("Node Set")
            {
                self.points.add_union(sets);
            }
        }
        Ok(())
    }

    /// Blocks of the mesh with their lists.
    fn blocks(&self) -> Result<Vec<Block<'a>>, String> {
        let lists = self.root.list("Blocks").ok_or("it has no list Blocks")?;
        let mut blocks: Vec<Block> = vec![];
        let mut default = None;
        for entry in lists.lists() {
            match self.program {
                Program::Peridigm => {
                    for name in entry.text("Block Names").unwrap_or("").split_whitespace() {
                        match name.eq_ignore_ascii_case("default") {
                            true => default = Some(entry),
                            false => blocks.push(Block {
                                name: name.into(),
                                entry,
                            }),
                        }
                    }
                }
                Program::PeriLab => {
                    let id = entry.number("Block ID").map(|id| id as i32);
                    let named = id.and_then(|id| self.points.names.get(&id));
                    blocks.push(Block {
                        name: named.unwrap_or(&entry.key).clone(),
                        entry,
                    });
                }
            }
        }
        if let Some(entry) = default {
            for name in self.points.names.values() {
                if blocks.iter().all(|b| b.name != *name) {
                    blocks.push(Block {
                        name: name.clone(),
                        entry,
                    });
                }
            }
        }
        blocks.retain(|b| {
            let there = self.points.names.values().any(|n| *n == b.name);
            if !there {
                b.entry.refuse(&format!("the mesh has no block {}", b.name));
            }
            there
        });
        let without = self.points.names.values();
        let without: Vec<&str> = { without.map(String::as_str) }
            .filter(|n| blocks.iter().all(|b| b.name != **n))
            .collect();
        match without.is_empty() {
            true => Ok(blocks),
            false => Err(format!(
                "blocks {} of the mesh are in no list of Blocks",
                without.join(", ")
            )),
        }
    }

    /// The horizon of all blocks.
    fn horizon(&mut self, blocks: &[Block]) -> Result<f64, String> {
        let given = self
            .root
            .list("Discretization")
            .and_then(|d| d.number("Horizon"));
        let mut horizon = given;
        for block in blocks {
            let Some(own) = block.entry.number("Horizon") else {
                continue;
            };
            match horizon {
                None => horizon = Some(own),
                Some(first) if first == own => {}
                Some(first) => block.entry.refuse_entry(
                    "Horizon",
                    &format!("a body has one horizon, that of the first block, {first:?}: give blocks bodies of their own, [[body]]"),
                ),
            }
        }
        horizon.ok_or_else(|| "no block has a Horizon that is a number".into())
    }

    /// The horizon whose ball is the family of the other program; where there is none, that of the deck, which is then named.
    fn family(&mut self, blocks: &[Block], given: f64) -> f64 {
        let kind = { self.root.list("Discretization") }.and_then(|d| d.text("NeighborhoodType"));
        let ball = kind.is_some_and(|t| t.eq_ignore_ascii_case("Spherical"));
        let search = Search::of(self.program, self.points.grid.is_some(), ball);
        match family::horizon(&self.points, given, search) {
            Ok((horizon, told)) => {
                self.remarks.extend(told);
                horizon
            }
            Err(why) => {
                for block in blocks {
                    block.entry.refuse_entry("Horizon", &why);
                }
                given
            }
        }
    }

    /// Materials of all blocks.
    fn materials(&mut self, blocks: &[Block], horizon: f64, damage: bool) -> Materials {
        let models = self.root.list("Models");
        let root = self.root;
        let named = |list: &str| {
            models
                .and_then(|m| m.list(list))
                .or_else(|| root.list(list))
        };
        let [materials, fractures] = match self.program {
            Program::Peridigm => ["Materials", "Damage Models"].map(named),
            Program::PeriLab => ["Material Models", "Damage Models"].map(named),
        };
        let key_of = match self.program {
            Program::Peridigm => "Material",
            Program::PeriLab => "Material Model",
        };
        let of = |block: &Block| {
            let name = block.entry.text(key_of).unwrap_or("");
            materials.and_then(|all| all.list(name))
        };
        let setting = laws::Setting {
            program: self.program,
            dimension: self.points.dimension,
            flat: self.points.flat(),
            horizon,
            yields: blocks.iter().filter_map(of).any(laws::yields),
        };
        let mut made = Materials::default();
        let mut first = true;
        for block in blocks {
            let Some(material) = of(block) else {
                let name = block.entry.text(key_of).unwrap_or("");
                block
                    .entry
                    .refuse(&format!("there is no material \"{name}\""));
                continue;
            };
            let Some(law) = laws::law(material, &setting) else {
                continue;
            };
            if std::mem::take(&mut first) {
                (made.plane, made.height) = (law.plane, law.height);
            } else if (law.plane, law.height) != (made.plane, made.height) {
                material.refuse("a body is in one plane, that of the first block");
                continue;
            }
            let density = material
                .number("Density")
                .or_else(|| block.entry.number("Density"));
            let Some(density) = density else {
                material.refuse("it has no Density");
                continue;
            };
            made.densities.push((block.name.clone(), density));
            made.bonds |= blocks.len() > 1 && law.text.starts_with("{ pmb");
            made.text += &match blocks.len() {
                1 => "\n[material]\n".to_string(),
                _ => format!(
                    "\n[material.{}]\nset = {}\n",
                    key(&block.name),
                    quoted(&block.name)
                ),
            };
            made.text += &format!("density = {density:?}\nlaw = {}\n", law.text);
            let Some(model) = block.entry.text("Damage Model") else {
                continue;
            };
            let list = fractures.and_then(|all| all.list(model));
            match list {
                Some(list) if !damage => {
                    list.refuse("the solver has no Damage Models: true, so nothing breaks");
                }
                Some(list) => {
                    if let Some(fracture) = laws::fracture(list, &mut self.remarks) {
                        made.breaks = true;
                        made.text += &format!("fracture = {fracture}\n");
                    }
                }
                None => block
                    .entry
                    .refuse_entry("Damage Model", "there is no such damage model"),
            }
        }
        // one remark for a model of several blocks
        let mut seen = std::collections::BTreeSet::new();
        self.remarks.retain(|r| seen.insert(r.clone()));
        made
    }
}
