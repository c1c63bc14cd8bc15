//! Thermodynamic output: the lines that a run prints.

pub mod columns;
pub mod keyword;
mod lines;
mod pressure;
mod values;

use self::columns::Column;
use super::printf::Format;

/// Computes that exist without being defined.
pub const BUILT_IN: [&str; 3] = ["thermo_temp", "thermo_press", "thermo_pe"];

/// What to do about atoms that leave through a fixed face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lost {
    Error,
    Warn,
    Ignore,
}

/// How values stand together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Line {
    /// A line under a heading.
    One,
    /// A block with a name beside each value.
    Multi,
    /// A list in a YAML document for each run.
    Yaml,
}

#[derive(Debug, Clone)]
pub struct Thermo {
    pub columns: Vec<Column>,
    /// `thermo_style one` and `multi` add the volume of a box that can change.
    pub add_volume: bool,
    pub every: u64,
    pub lost: Lost,
    pub normalize: Option<bool>,
    pub line: Line,
    /// `thermo_modify format`
    pub integer: Option<Format>,
    pub float: Option<Format>,
    pub single: Vec<(usize, Format)>,
}

impl Default for Thermo {
    fn default() -> Self {
        Thermo {
            columns: columns::one(),
            add_volume: true,
            every: 0,
            lost: Lost::Error,
            normalize: None,
            line: Line::One,
            integer: None,
            float: None,
            single: Vec::new(),
        }
    }
}
