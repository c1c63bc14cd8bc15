//! Constants of a law by name.

use super::TableSpec;
use crate::expression::Expression;
use std::sync::Arc;

/// Constants of a law by their keys.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Parameters(pub Vec<(String, Parameter)>);

#[derive(Debug, Clone, PartialEq)]
pub enum Parameter {
    Number(f64),
    List(Vec<f64>),
    Rows(Vec<Vec<f64>>),
    Word(String),
    /// An expression of the variables that the law's key names.
    Formula(Expression),
    /// Components of a direction, expressions of x, y, z; one that is the same everywhere is a list of three numbers.
    Direction([Expression; 3]),
    /// The tables of an embedded-atom model.
    Table(Arc<TableSpec>),
}

impl Parameters {
    /// All numbers.
    pub fn numbers(of: &[(&str, f64)]) -> Parameters {
        let number = |(key, x): &(&str, f64)| (key.to_string(), Parameter::Number(*x));
        Parameters(of.iter().map(number).collect())
    }

    /// And one more.
    pub fn with(mut self, key: &str, value: Parameter) -> Parameters {
        self.set(key, value);
        self
    }

    /// In place of what the key had.
    pub fn set(&mut self, key: &str, value: Parameter) {
        match self.0.iter_mut().find(|(k, _)| k == key) {
            Some((_, old)) => *old = value,
            None => self.0.push((key.into(), value)),
        }
    }

    pub fn get(&self, key: &str) -> Option<&Parameter> {
        self.0.iter().find(|(k, _)| k == key).map(|(_, p)| p)
    }

    pub fn number(&self, key: &str) -> Option<f64> {
        let Parameter::Number(x) = self.get(key)? else {
            return None;
        };
        Some(*x)
    }

    /// Numbers of the keys in order.
    ///
    /// # Errors
    /// The first key that has none, in words.
    pub fn all<const N: usize>(&self, keys: [&str; N]) -> Result<[f64; N], String> {
        let mut found = [0.0; N];
        for (x, key) in found.iter_mut().zip(keys) {
            *x = self
                .number(key)
                .ok_or_else(|| format!("the number `{key}` is missing"))?;
        }
        Ok(found)
    }

    pub fn list(&self, key: &str) -> Option<&[f64]> {
        let Parameter::List(list) = self.get(key)? else {
            return None;
        };
        Some(list)
    }

    pub fn rows(&self, key: &str) -> Option<&[Vec<f64>]> {
        let Parameter::Rows(rows) = self.get(key)? else {
            return None;
        };
        Some(rows)
    }

    pub fn word(&self, key: &str) -> Option<&str> {
        let Parameter::Word(word) = self.get(key)? else {
            return None;
        };
        Some(word)
    }

    pub fn formula(&self, key: &str) -> Option<&Expression> {
        let Parameter::Formula(formula) = self.get(key)? else {
            return None;
        };
        Some(formula)
    }

    /// Of a direction that differs from place to place.
    pub fn direction(&self, key: &str) -> Option<&[Expression; 3]> {
        let Parameter::Direction(components) = self.get(key)? else {
            return None;
        };
        Some(components)
    }

    pub fn table(&self, key: &str) -> Option<&Arc<TableSpec>> {
        let Parameter::Table(table) = self.get(key)? else {
            return None;
        };
        Some(table)
    }
}
