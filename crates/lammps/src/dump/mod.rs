//! `dump`, `write_dump`: snapshots in LAMMPS's text format.

mod snapshot;

use std::sync::Arc;

use crate::atoms::Members;
use crate::compute::Source;
use crate::files::Sink;
use crate::particles::Field;
use crate::printf::Format;
use crate::variable::ast::Op;

/// A column of a snapshot.
#[derive(Debug, Clone, PartialEq)]
pub struct DumpColumn {
    pub heading: String,
    pub source: DumpSource,
}

#[derive(Debug, Clone, PartialEq)]
pub enum DumpSource {
    Values(Source),
    /// Name of the atom's type.
    Element,
}

/// What a snapshot is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DumpStyle {
    Custom,
    Atom,
    Xyz,
    /// A picture of our own.
    Image,
}

#[derive(Debug)]
pub struct Dump {
    pub id: String,
    pub members: Arc<Members>,
    pub every: u64,
    /// As written; `*` stands for the step.
    pub file: String,
    pub columns: Vec<DumpColumn>,
    pub style: DumpStyle,
    /// Of `dump atom`: columns follow from these.
    pub scale: bool,
    pub image: bool,
    pub first: bool,
    pub append: bool,
    /// A variable that says the next step, instead of `every`, and what it said.
    pub every_variable: Option<(String, Option<u64>)>,
    /// The column (from 0; `None`: the id) that rows are in the order of, and whether it falls.
    pub sort: (Option<usize>, bool),
    /// Only atoms for which all of these hold.
    pub thresholds: Vec<(Source, Op, f64)>,
    /// Digits of the step in file names.
    pub pad: usize,
    pub units: bool,
    pub time: bool,
    pub line: Option<Vec<Format>>,
    pub integer: Option<Format>,
    pub float: Option<Format>,
    pub single: Vec<(usize, Format)>,
    pub elements: Vec<String>,
    pub last_written: Option<u64>,
    pub writer: Option<Sink>,
}

impl Dump {
    pub fn new(id: &str, members: Arc<Members>, every: u64, file: &str) -> Dump {
        Dump {
            id: id.to_string(),
            members,
            every,
            file: file.to_string(),
            columns: Vec::new(),
            style: DumpStyle::Custom,
            scale: true,
            image: false,
            first: false,
            append: false,
            every_variable: None,
            sort: (None, false),
            thresholds: Vec::new(),
            pad: 0,
            units: false,
            time: false,
            line: None,
            integer: None,
            float: None,
            single: Vec::new(),
            elements: Vec::new(),
            last_written: None,
            writer: None,
        }
    }

    /// Columns of `dump atom`.
    pub fn atom_columns(&mut self) {
        let field = |heading: &str| DumpColumn {
            heading: heading.to_string(),
            source: DumpSource::Values(Source::Field(Field::parse(heading).unwrap_or(Field::Id))),
        };
        let place = if self.scale {
            ["xs", "ys", "zs"]
        } else {
            ["x", "y", "z"]
        };
        let image: &[&str] = if self.image { &["ix", "iy", "iz"] } else { &[] };
        self.columns = ["id", "type"]
            .iter()
            .chain(&place)
            .chain(image)
            .map(|h| field(h))
            .collect();
    }

    /// Columns of `dump xyz`.
    pub fn xyz_columns(&mut self) {
        self.atom_columns();
        self.columns = ["x", "y", "z"]
            .map(|name| DumpColumn {
                heading: name.to_string(),
                source: DumpSource::Values(Source::Field(Field::parse(name).unwrap_or(Field::Id))),
            })
            .to_vec();
        self.columns.insert(
            0,
            DumpColumn {
                heading: "element".to_string(),
                source: DumpSource::Element,
            },
        );
    }

    /// Is it written at this step of a run?
    fn due(&self, step: u64) -> bool {
        match &self.every_variable {
            Some((_, next)) => *next == Some(step),
            None => step.is_multiple_of(self.every),
        }
    }

    /// About what its snapshots of a run of so many steps take (bytes); of those whose steps a variable says, one.
    pub fn bytes(&self, steps: u64, atoms: usize) -> f64 {
        let snapshots = match (&self.every_variable, self.style) {
            (Some(_), _) | (_, DumpStyle::Image) => 1,
            (None, _) => steps / self.every.max(1) + 1,
        };
        // digits of `%g` and a blank
        10.0 * snapshots as f64 * atoms as f64 * self.columns.len().max(1) as f64
    }

    fn path_name(&self, step: u64) -> String {
        self.file
            .replace('*', &format!("{step:0>w$}", w = self.pad))
    }

    /// Format of column `index`.
    fn format(&self, index: usize, integer: bool, text: bool) -> Option<Format> {
        if let Some((_, f)) = self.single.iter().rev().find(|(k, _)| *k == index) {
            return Some(f.clone());
        }
        if let Some(line) = &self.line {
            return line.get(index).cloned();
        }
        let user = if integer { &self.integer } else { &self.float };
        let fallback = if text {
            "%s"
        } else if integer {
            "%d"
        } else {
            "%g"
        };
        user.clone()
            .filter(|_| !text)
            .or_else(|| Format::parse(fallback).ok())
    }
}
