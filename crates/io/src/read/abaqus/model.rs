//! What a file says of its mesh: nodes, elements and sets of the model, of its parts and of their instances.

use super::super::cell::{Kind, Nodes};
use super::super::error::ReadError;
use super::input::{LARGEST, Rows};
use super::keyword::{Label, split};
use peridyne::execute::memory::afford;
use peridyne::space::rotation::{Axes, times};
use std::collections::{HashMap, HashSet};
use std::rc::Rc;

/// What an element is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Shape {
    Cell(Kind),
    /// A shell or membrane: a surface, which makes no body.
    Surface(Kind),
    Shapeless,
}

#[derive(Clone)]
pub(super) struct Element {
    pub number: u64,
    /// As the file calls its type.
    pub name: Rc<str>,
    pub shape: Shape,
    pub nodes: Rc<[u64]>,
    /// Its line among all.
    pub at: usize,
    /// Its corners were put into another order: its faces are not those of the manual.
    pub turned: bool,
}

/// A set of nodes or elements by their numbers.
#[derive(Clone)]
pub(super) struct Set {
    pub label: Label,
    pub members: Vec<u64>,
    pub sorted: bool,
    /// Made by a program for its own ends.
    pub internal: bool,
}

#[derive(Clone, Copy, PartialEq)]
pub(super) enum Of {
    Nodes,
    Elements,
}

#[derive(Clone)]
pub(super) struct Surface {
    pub label: Label,
    pub of: Of,
    /// Nodes, elements or a set of them; the face; the line among all.
    pub rows: Vec<(String, String, usize)>,
    /// Why it is no set.
    pub unread: Option<String>,
}

/// From coordinates of a part, or those that a `*SYSTEM` gives, to those outside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Frame {
    pub axes: Axes,
    pub origin: [f64; 3],
}

impl Frame {
    pub const NONE: Frame = Frame {
        axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        origin: [0.0; 3],
    };

    pub fn apply(&self, x: &[f64; 3]) -> [f64; 3] {
        let turned = times(&self.axes, x);
        std::array::from_fn(|a| turned[a] + self.origin[a])
    }
}

/// A part, an instance of one, or the model around them.
#[derive(Clone, Default)]
pub(super) struct Scope {
    pub label: Option<Label>,
    pub nodes: Nodes,
    pub elements: Vec<Element>,
    pub index: HashMap<u64, usize>,
    pub node_sets: Vec<Set>,
    pub element_sets: Vec<Set>,
    pub surfaces: Vec<Surface>,
    /// In which nodes are given.
    pub system: Option<Frame>,
}

impl Scope {
    pub fn sets(&self, of: Of) -> &[Set] {
        match of {
            Of::Nodes => &self.node_sets,
            Of::Elements => &self.element_sets,
        }
    }

    pub fn set(&self, of: Of, key: &str) -> Option<&Set> {
        self.sets(of).iter().find(|s| s.label.key == key)
    }

    /// Adds to a set, which is new if it was not there.
    pub fn add(&mut self, of: Of, label: Label, members: Vec<u64>, unsorted: bool) -> &mut Set {
        let sets = match of {
            Of::Nodes => &mut self.node_sets,
            Of::Elements => &mut self.element_sets,
        };
        let known = sets.iter().position(|s| s.label.key == label.key);
        let at = known.unwrap_or_else(|| {
            sets.push(Set {
                label,
                members: Vec::new(),
                sorted: !unsorted,
                internal: false,
            });
            sets.len() - 1
        });
        let set = &mut sets[at];
        set.members.extend(members);
        if set.sorted {
            set.members.sort_unstable();
            set.members.dedup();
        } else {
            let mut seen = HashSet::new();
            set.members.retain(|m| seen.insert(*m));
        }
        set
    }

    /// A node, which may be there already at the same place.
    pub fn node(&mut self, rows: &Rows, number: u64, x: [f64; 3]) -> Result<(), ReadError> {
        let Some(old) = self.nodes.insert(number, x) else {
            return Ok(());
        };
        let size = |x: &[f64; 3]| x.iter().fold(0.0, |s: f64, c| s.max(c.abs()));
        let apart: [f64; 3] = std::array::from_fn(|a| x[a] - old[a]);
        if size(&apart) <= 1e-9 * size(&old) {
            return Ok(());
        }
        Err(rows.error(format!(
            "node {number} is defined twice, at {old:?} and at {x:?}"
        )))
    }

    pub fn place(&self, rows: &Rows, number: u64) -> Result<[f64; 3], ReadError> {
        let x = self.nodes.get(&number).copied();
        x.ok_or_else(|| rows.error(format!("node {number} is not defined before this line")))
    }

    pub fn element(&mut self, rows: &Rows, element: Element) -> Result<(), ReadError> {
        let number = element.number;
        if self.index.insert(number, self.elements.len()).is_some() {
            return Err(rows.error(format!("element {number} is defined twice")));
        }
        self.elements.push(element);
        Ok(())
    }
}

/// Where blocks belong.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Place {
    Model,
    Part(usize),
    /// Among the scopes.
    Instance(usize),
}

/// Bytes of a member of a set, and of a node or an element with all that is made of them.
pub(super) const MEMBER: u64 = 16;
pub(super) const ITEM: u64 = 320;
/// Bytes that are made before memory is looked at again.
const STEP: u64 = 1 << 26;

pub(super) struct Model {
    /// The model around the parts, then instances. Numbers of its own are as they stand; those of an instance have its
    /// place in their upper half.
    pub scopes: Vec<Scope>,
    pub parts: Vec<Scope>,
    pub place: Place,
    pub assembly: Option<Label>,
    /// Where the instance at hand goes.
    pub frame: Option<Frame>,
    /// Parts that have instances.
    pub used: HashSet<usize>,
    pub notes: Vec<String>,
    /// Bytes since memory was looked at.
    generated: u64,
}

/// A number of the scope with this place.
pub(super) fn of_scope(scope: usize, number: u64) -> u64 {
    (scope as u64) << 32 | number
}

/// The scope and the number.
pub(super) fn split_number(number: u64) -> (usize, u64) {
    ((number >> 32) as usize, number & u64::from(u32::MAX))
}

impl Model {
    pub fn new() -> Model {
        Model {
            scopes: vec![Scope::default()],
            parts: Vec::new(),
            place: Place::Model,
            assembly: None,
            frame: None,
            used: HashSet::new(),
            notes: Vec::new(),
            generated: 0,
        }
    }

    pub fn here(&mut self) -> &mut Scope {
        match self.place {
            Place::Model => &mut self.scopes[0],
            Place::Part(p) => &mut self.parts[p],
            Place::Instance(s) => &mut self.scopes[s],
        }
    }

    fn at(&self) -> &Scope {
        match self.place {
            Place::Model => &self.scopes[0],
            Place::Part(p) => &self.parts[p],
            Place::Instance(s) => &self.scopes[s],
        }
    }

    pub fn instance(&self, key: &str) -> Option<usize> {
        let named = |s: &Scope| s.label.as_ref().is_some_and(|l| l.key == key);
        (1..self.scopes.len()).find(|s| named(&self.scopes[*s]))
    }

    /// Weighs what is generated, whose lines do not say how much it is: so many of so many bytes each.
    pub fn generate(&mut self, rows: &Rows, count: usize, each: u64) -> Result<(), ReadError> {
        let bytes = each.saturating_mul(count as u64);
        self.generated = self.generated.saturating_add(bytes);
        if self.generated < STEP {
            return Ok(());
        }
        self.generated = 0;
        let what = "what this line makes";
        let room = afford("memory", what, bytes.max(STEP) as f64, "");
        room.map_err(|error| rows.error(error.message.to_string()))
    }

    /// The node or element that a field names, or the members of a set; `instance` is where they are looked for first.
    pub fn named(&self, text: &str, of: Of, instance: Option<usize>) -> Result<Vec<u64>, String> {
        let number = |text: &str| text.parse().ok().filter(|n| (1..=LARGEST).contains(n));
        if let Some(number) = number(text) {
            return Ok(vec![of_scope(instance.unwrap_or(0), number)]);
        }
        let within = |scope: usize, text: &str| -> Option<Vec<u64>> {
            let set = self.scopes[scope].set(of, &Label::new(text).key)?;
            Some(set.members.iter().map(|m| of_scope(scope, *m)).collect())
        };
        if let Some(found) = instance.and_then(|scope| within(scope, text)) {
            return Ok(found);
        }
        if let Some(set) = self.at().set(of, &Label::new(text).key) {
            return Ok(set.members.clone());
        }
        let mut path = Vec::new();
        split(text, '.', &mut path);
        let key = |k: usize| path.get(k).map(|p| Label::new(p).key);
        let of_assembly =
            path.len() == 3 && key(0) == self.assembly.as_ref().map(|l| l.key.clone());
        let path = &path[usize::from(of_assembly)..];
        if self.place == Place::Model
            && let [name, rest] = path
            && let Some(scope) = self.instance(&Label::new(name).key)
        {
            if let Some(number) = number(rest) {
                return Ok(vec![of_scope(scope, number)]);
            }
            if let Some(found) = within(scope, rest) {
                return Ok(found);
            }
        }
        Err(self.unknown(text, of))
    }

    fn unknown(&self, text: &str, of: Of) -> String {
        let what = match of {
            Of::Nodes => "a node",
            Of::Elements => "an element",
        };
        let shown = super::input::short(text);
        let key = Label::new(text).key;
        let owners = self.scopes[1..]
            .iter()
            .filter(|s| s.set(of, &key).is_some());
        let owners: Vec<String> = owners
            .filter_map(|s| Some(format!("{}.{shown}", s.label.as_ref()?.shown)))
            .collect();
        match (self.place, owners.is_empty()) {
            (Place::Model, false) => format!(
                "`{shown}` is a set of an instance, not of the assembly: write {}",
                owners.join(" or ")
            ),
            _ => format!(
                "expected the number of {what} or the name of a set that is defined before, found `{shown}`"
            ),
        }
    }

    /// The element with this number, of the scope at hand or of an instance.
    pub fn element(&self, number: u64) -> Option<(usize, &Element)> {
        let (scope, own) = split_number(number);
        let owner = match scope {
            0 => self.at(),
            scope => self.scopes.get(scope)?,
        };
        Some((scope, &owner.elements[*owner.index.get(&own)?]))
    }
}
