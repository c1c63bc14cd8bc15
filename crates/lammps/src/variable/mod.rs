//! `variable`: named texts, numbers and formulas.

pub mod ast;
pub mod eval;
pub mod functions;
pub mod parse;
pub mod tree;

use std::rc::Rc;

use self::ast::Expr;
use super::printf::{Format, fifteen, round_to_fifteen};

/// A formula and its text.
#[derive(Debug, Clone, PartialEq)]
pub struct Formula {
    pub text: String,
    pub expr: Expr,
}

#[derive(Debug, Clone, PartialEq)]
pub enum Kind {
    /// `index`: texts that `next` steps through; also what the command line sets.
    Index { values: Vec<String>, at: usize },
    /// `loop`: numbers from `first` to `last`, padded with zeros to `width`.
    Loop {
        first: i64,
        last: i64,
        at: i64,
        width: usize,
    },
    /// `string`
    Text(String),
    /// `equal`: a number, evaluated when used.
    Equal(Rc<Formula>),
    /// `atom`: a number for each atom.
    Atom(Rc<Formula>),
    /// `internal`: a number set once.
    Internal(f64),
    /// `file`: the lines of a file that `next` steps through.
    File { values: Rc<[String]>, at: usize },
    /// `getenv`: a variable of the environment.
    Environment(String),
    /// `format`: another variable, printed with this format.
    Format { of: String, format: Format },
}

impl Kind {
    /// Name of the style in scripts.
    pub fn style(&self) -> &'static str {
        match self {
            Kind::Index { .. } => "index",
            Kind::Loop { .. } => "loop",
            Kind::Text(_) => "string",
            Kind::Equal(_) => "equal",
            Kind::Atom(_) => "atom",
            Kind::Internal(_) => "internal",
            Kind::File { .. } => "file",
            Kind::Environment(_) => "getenv",
            Kind::Format { .. } => "format",
        }
    }

    /// Text of kinds that need no evaluation.
    pub fn text(&self) -> Option<String> {
        Some(match self {
            Kind::Index { values, at } => values.get(*at)?.clone(),
            Kind::File { values, at } => values.get(*at)?.clone(),
            Kind::Environment(name) => std::env::var(name).unwrap_or_default(),
            Kind::Loop { at, width, .. } => format!("{at:0>width$}"),
            Kind::Text(t) => t.clone(),
            Kind::Internal(x) => fifteen(*x),
            Kind::Equal(_) | Kind::Atom(_) | Kind::Format { .. } => return None,
        })
    }

    /// Number that the text of a kind without formula stands for; nothing is allocated.
    pub fn number(&self) -> Option<f64> {
        let read = |text: &str| text.trim().parse().ok();
        match self {
            Kind::Index { values, at } => read(values.get(*at)?),
            Kind::File { values, at } => read(values.get(*at)?),
            Kind::Environment(_) => read(&self.text()?),
            Kind::Loop { at, .. } => Some(*at as f64),
            Kind::Text(text) => read(text),
            Kind::Internal(x) => Some(round_to_fifteen(*x)),
            Kind::Equal(_) | Kind::Atom(_) | Kind::Format { .. } => None,
        }
    }

    /// One value on; false when there is none left.
    pub fn advance(&mut self) -> bool {
        match self {
            Kind::Index { values, at } => {
                *at += 1;
                *at < values.len()
            }
            Kind::File { values, at } => {
                *at += 1;
                *at < values.len()
            }
            Kind::Loop { last, at, .. } => {
                *at += 1;
                *at <= *last
            }
            Kind::Text(_)
            | Kind::Equal(_)
            | Kind::Atom(_)
            | Kind::Internal(_)
            | Kind::Environment(_)
            | Kind::Format { .. } => true,
        }
    }
}

/// All variables, in order of definition.
#[derive(Debug, Default)]
pub struct Variables {
    list: Vec<(String, Kind)>,
    /// Places in the list of the formulas being evaluated: a variable must not need itself.
    pub evaluating: Vec<usize>,
}

impl Variables {
    /// Place in the list.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.list.iter().position(|(n, _)| n == name)
    }
    pub fn get(&self, name: &str) -> Option<&Kind> {
        self.list.iter().find(|(n, _)| n == name).map(|(_, k)| k)
    }
    pub fn get_mut(&mut self, name: &str) -> Option<&mut Kind> {
        self.list
            .iter_mut()
            .find(|(n, _)| n == name)
            .map(|(_, k)| k)
    }
    pub fn set(&mut self, name: &str, kind: Kind) {
        match self.get_mut(name) {
            Some(k) => *k = kind,
            None => self.list.push((name.to_string(), kind)),
        }
    }
    pub fn delete(&mut self, name: &str) {
        self.list.retain(|(n, _)| n != name);
    }
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.list.iter().map(|(n, _)| n.as_str())
    }
}

/// Letters, digits and underscores.
pub fn is_name(name: &str) -> bool {
    !name.is_empty() && name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_')
}
