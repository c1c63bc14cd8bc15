//! `compute`: values that other commands ask for.

mod evaluate;

use std::rc::Rc;
use std::sync::Arc;

use crate::atoms::Members;
use crate::fix::Start;
use crate::particles::Field;

#[derive(Debug, Clone)]
pub struct Compute {
    pub id: String,
    pub members: Arc<Members>,
    /// How many they were at the last set-up.
    pub counted: Option<usize>,
    pub kind: ComputeKind,
}

#[derive(Debug, Clone)]
pub enum ComputeKind {
    /// One or more values for each atom; 0 outside the group.
    Atoms(Vec<Field>),
    /// For each atom the way from where it was, and its length.
    Displace {
        start: Rc<Start>,
    },
    /// For each atom minus its part of the virial, xx yy zz xy xz yz, and of the flow of momentum.
    Stress {
        kinetic: bool,
        virial: bool,
    },
    Kinetic,
    Potential,
    Temperature,
    /// Centre of mass.
    Center,
    Reduce {
        mode: Mode,
        inputs: Vec<Source>,
        /// Only of atoms in it.
        region: Option<String>,
    },
}

impl ComputeKind {
    /// Columns of a compute with values for each atom.
    pub fn columns(&self) -> Option<usize> {
        match self {
            ComputeKind::Atoms(fields) => Some(fields.len()),
            ComputeKind::Displace { .. } => Some(4),
            ComputeKind::Stress { .. } => Some(6),
            ComputeKind::Kinetic
            | ComputeKind::Potential
            | ComputeKind::Temperature
            | ComputeKind::Center
            | ComputeKind::Reduce { .. } => None,
        }
    }
}

pub const STYLES: [&str; 13] = [
    "com",
    "damage/atom",
    "dilatation/atom",
    "displace/atom",
    "ke/atom",
    "pe/atom",
    "property/atom",
    "stress/atom",
    "ke",
    "pe",
    "reduce",
    "reduce/region",
    "temp",
];

/// Where per-atom values come from.
#[derive(Debug, Clone, PartialEq)]
pub enum Source {
    Field(Field),
    /// `c_ID` or `c_ID[column]`
    Compute(String, Option<usize>),
    /// `v_name`
    Variable(String),
}

impl Source {
    /// Reads `x`, `c_ID`, `c_ID[2]`, `v_name`.
    pub fn parse(text: &str) -> Option<Source> {
        if let Some(name) = text.strip_prefix("v_") {
            return Some(Source::Variable(name.to_string()));
        }
        if let Some(rest) = text.strip_prefix("c_") {
            let Some((id, column)) = rest.split_once('[') else {
                return Some(Source::Compute(rest.to_string(), None));
            };
            let column = column.strip_suffix(']')?.parse().ok()?;
            return Some(Source::Compute(id.to_string(), Some(column)));
        }
        Field::parse(text).map(Source::Field)
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    Sum,
    Min,
    Max,
    Ave,
    SumSq,
    AveSq,
    SumAbs,
    AveAbs,
    MinAbs,
    MaxAbs,
}

impl Mode {
    pub const ALL: [(&'static str, Mode); 10] = [
        ("sum", Mode::Sum),
        ("min", Mode::Min),
        ("max", Mode::Max),
        ("ave", Mode::Ave),
        ("sumsq", Mode::SumSq),
        ("avesq", Mode::AveSq),
        ("sumabs", Mode::SumAbs),
        ("aveabs", Mode::AveAbs),
        ("minabs", Mode::MinAbs),
        ("maxabs", Mode::MaxAbs),
    ];

    fn start(self) -> f64 {
        match self {
            Mode::Min | Mode::MinAbs => 1e20,
            Mode::Max => -1e20,
            Mode::Sum
            | Mode::Ave
            | Mode::SumSq
            | Mode::AveSq
            | Mode::SumAbs
            | Mode::AveAbs
            | Mode::MaxAbs => 0.0,
        }
    }

    fn add(self, a: f64, x: f64) -> f64 {
        match self {
            Mode::Sum | Mode::Ave => a + x,
            Mode::Min => a.min(x),
            Mode::Max => a.max(x),
            Mode::SumSq | Mode::AveSq => a + x * x,
            Mode::SumAbs | Mode::AveAbs => a + x.abs(),
            Mode::MinAbs => a.min(x.abs()),
            Mode::MaxAbs => a.max(x.abs()),
        }
    }

    pub(super) fn is_mean(self) -> bool {
        matches!(self, Mode::Ave | Mode::AveSq | Mode::AveAbs)
    }
}
