//! `compute`: values that other commands ask for.

use std::sync::Arc;

use super::atoms::Members;
use super::error::{Problem, Result, suggestion};
use super::host::{BLOCK, Quantity};
use super::particles::Field;
use super::session::Session;
use super::thermo::BUILT_IN;
use super::variable::ast::Expr;
use super::variable::tree::Tree;

#[derive(Debug, Clone)]
pub struct Compute {
    pub id: String,
    pub members: Arc<Members>,
    pub kind: ComputeKind,
}

#[derive(Debug, Clone)]
pub enum ComputeKind {
    /// One or more values for each atom; 0 outside the group.
    Atoms(Vec<Field>),
    Kinetic,
    Potential,
    Reduce {
        mode: Mode,
        inputs: Vec<Source>,
    },
}

pub const STYLES: [&str; 8] = [
    "damage/atom",
    "dilatation/atom",
    "ke/atom",
    "pe/atom",
    "property/atom",
    "ke",
    "pe",
    "reduce",
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

    fn is_mean(self) -> bool {
        matches!(self, Mode::Ave | Mode::AveSq | Mode::AveAbs)
    }
}

impl Session<'_> {
    /// The compute with this ID.
    ///
    /// # Errors
    /// There is none.
    pub fn compute(&self, id: &str) -> Result<&Compute> {
        self.computes.iter().find(|c| c.id == id).ok_or_else(|| {
            Problem::new(format!("there is no compute `{id}`"))
                .help(suggestion(id, self.computes.iter().map(|c| c.id.as_str())))
        })
    }

    /// Per-atom values of `source`.
    ///
    /// # Errors
    /// It does not exist or is one number.
    pub fn source_tree(&mut self, source: &Source) -> Result<Tree> {
        match source {
            Source::Field(f) => Ok(Tree::Field(*f)),
            Source::Variable(name) => self.variable_tree(name),
            Source::Compute(id, column) => self.compute_column(id, *column)?.ok_or_else(|| {
                Problem::new(format!(
                    "compute `{id}` gives one number, values for each atom are needed here"
                ))
            }),
        }
    }

    /// A per-atom column (from 1) of a compute; `None` if it has one value for all.
    fn compute_column(&self, id: &str, column: Option<usize>) -> Result<Option<Tree>> {
        let compute = self.compute(id)?;
        let ComputeKind::Atoms(fields) = &compute.kind else {
            return Ok(None);
        };
        let field = match (column, fields.len()) {
            (None, 1) => fields[0],
            (None, n) => {
                return Err(Problem::new(format!(
                    "compute `{id}` has {n} columns: write c_{id}[1] to c_{id}[{n}]"
                )));
            }
            (Some(_), 1) => {
                return Err(Problem::new(format!(
                    "compute `{id}` has one value for each atom: write c_{id}"
                )));
            }
            (Some(k), n) => *fields.get(k.wrapping_sub(1)).ok_or_else(|| {
                Problem::new(format!("compute `{id}` has columns 1 to {n}, not {k}"))
            })?,
        };
        let tree = Tree::Field(field);
        Ok(Some(match compute.members.as_ref() {
            Members::All => tree,
            Members::Some(_) => Tree::Masked(Box::new(tree), compute.members.clone()),
        }))
    }

    /// `c_ID` or `c_ID[i]` of a per-atom formula; `None` if it is one number.
    ///
    /// # Errors
    /// It does not exist.
    pub fn compute_tree(&mut self, id: &str, index: &[Expr]) -> Result<Option<Tree>> {
        if BUILT_IN.contains(&id) {
            return Ok(None);
        }
        if !matches!(self.compute(id)?.kind, ComputeKind::Atoms(_)) {
            return Ok(None);
        }
        let column = match index {
            [] => None,
            [i] => Some(self.scalar(i)? as usize),
            _ => return Ok(None),
        };
        self.compute_column(id, column)
    }

    /// `c_ID`, `c_ID[i]`, `c_ID[i][j]` as one number.
    ///
    /// # Errors
    /// It does not exist or has a value for each atom.
    pub fn compute_scalar(&mut self, id: &str, index: &[f64]) -> Result<f64> {
        if let Some(value) = self.built_in(id, index)? {
            return Ok(value);
        }
        let compute = self.compute(id)?.clone();
        match (&compute.kind, index) {
            (ComputeKind::Atoms(fields), [atom, rest @ ..])
                if rest.len() == usize::from(fields.len() > 1) =>
            {
                let column = rest.first().map(|c| *c as usize);
                match self.compute_column(id, column)? {
                    Some(tree) => self.tree_at(&tree, *atom),
                    None => Ok(0.0),
                }
            }
            (ComputeKind::Atoms(_), _) => Err(Problem::new(format!(
                "compute `{id}` has values for each atom, one number is needed here"
            ))
            .help(format!("reduce it: compute NAME all reduce sum c_{id}"))),
            (ComputeKind::Kinetic, []) => {
                self.reduce(Mode::Sum, &compute.members, &Tree::Field(Field::Kinetic))
            }
            (ComputeKind::Potential, []) => Ok(self.engine()?.energies()?.potential),
            (ComputeKind::Reduce { mode, inputs }, _) => {
                let input = match (index, inputs.len()) {
                    ([], 1) => &inputs[0],
                    ([k], n) if n > 1 && *k >= 1.0 && *k <= n as f64 => &inputs[*k as usize - 1],
                    (_, 1) => {
                        return Err(Problem::new(format!(
                            "compute `{id}` is one number: write c_{id}"
                        )));
                    }
                    (_, n) => {
                        return Err(Problem::new(format!(
                            "compute `{id}` has {n} numbers: write c_{id}[1] to c_{id}[{n}]"
                        )));
                    }
                };
                let tree = self.source_tree(input)?;
                self.reduce(*mode, &compute.members, &tree)
            }
            _ => Err(Problem::new(format!(
                "compute `{id}` is one number: write c_{id}"
            ))),
        }
    }

    /// One number of per-atom values, in order of id.
    ///
    /// # Errors
    /// The values do not exist (yet).
    pub fn reduce(&self, mode: Mode, members: &Members, tree: &Tree) -> Result<f64> {
        let (view, clock) = (self.view()?, self.clock());
        let n = self.count();
        let mut total = mode.start();
        let mut buffer = [0.0; BLOCK];
        for first in (0..n).step_by(BLOCK) {
            let block = &mut buffer[..BLOCK.min(n - first)];
            tree.fill(&view, &clock, first, block)?;
            for (k, x) in block.iter().enumerate() {
                if members.contains(first + k) {
                    total = mode.add(total, *x);
                }
            }
        }
        let count = members.count(n);
        Ok(if mode.is_mean() && count > 0 {
            total / count as f64
        } else {
            total
        })
    }

    /// A group function of a formula.
    ///
    /// # Errors
    /// Wrong arguments.
    pub fn group_function(&mut self, name: &str, arguments: &[String]) -> Result<f64> {
        let wrong = || {
            Problem::new(format!(
                "{name}({}) has wrong arguments",
                arguments.join(",")
            ))
        };
        let group = arguments.first().ok_or_else(wrong)?;
        let mut members = self.group(group)?;
        let plain = match name {
            "xcm" | "vcm" | "bound" => 2,
            _ => 1,
        };
        match arguments.len() - plain.min(arguments.len()) {
            0 if arguments.len() == plain => {}
            1 => {
                let region = self.region(&arguments[plain])?.clone();
                let x = self.positions()?;
                let inside =
                    Members::collect(x.len(), |i| members.contains(i) && region.contains(x[i]));
                members = Arc::new(inside);
            }
            _ => return Err(wrong()),
        }
        let axis = |text: &str| match text {
            "x" => Ok(0),
            "y" => Ok(1),
            "z" => Ok(2),
            _ => Err(wrong()),
        };
        let density = Tree::Field(Field::Raw(Quantity::Density));
        let mean = |s: &Self, q: Quantity| -> Result<f64> {
            use super::variable::ast::Op;
            let product = Tree::Binary(
                Op::Mul,
                Box::new(density.clone()),
                Box::new(Tree::Field(Field::Raw(q))),
            );
            let mass = s.reduce(Mode::Sum, &members, &density)?;
            Ok(if mass > 0.0 {
                s.reduce(Mode::Sum, &members, &product)? / mass
            } else {
                0.0
            })
        };
        match name {
            "count" => Ok(members.count(self.count()) as f64),
            "mass" => self.reduce(Mode::Sum, &members, &density),
            "ke" => self.reduce(Mode::Sum, &members, &Tree::Field(Field::Kinetic)),
            "xcm" => mean(self, Quantity::Position(axis(&arguments[1])?)),
            "vcm" => mean(self, Quantity::Velocity(axis(&arguments[1])?)),
            _ => {
                let side = &arguments[1];
                let (letter, mode) = match (side.strip_suffix("min"), side.strip_suffix("max")) {
                    (Some(l), _) => (l, Mode::Min),
                    (_, Some(l)) => (l, Mode::Max),
                    _ => return Err(wrong()),
                };
                self.reduce(mode, &members, &Tree::Field(Field::Wrapped(axis(letter)?)))
            }
        }
    }

    /// `is_defined(category,id)` of a formula.
    ///
    /// # Errors
    /// Unknown category.
    pub fn is_defined(&self, category: &str, id: &str) -> Result<bool> {
        Ok(match category {
            "compute" => self.computes.iter().any(|c| c.id == id),
            "fix" => self.fixes.iter().any(|f| f.id == id),
            "dump" => self.dumps.iter().any(|d| d.id == id),
            "group" => self.groups.iter().any(|(n, _)| n == id),
            "region" => self.regions.iter().any(|(n, _)| n == id),
            "variable" => self.variables.get(id).is_some(),
            _ => {
                let known = ["compute", "fix", "dump", "group", "region", "variable"];
                return Err(
                    Problem::new(format!("is_defined() does not know `{category}`"))
                        .help(suggestion(category, known)),
                );
            }
        })
    }
}
