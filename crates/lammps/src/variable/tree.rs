//! Formulas with one value per atom, ready to be evaluated in blocks.

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;

use super::ast::{Op, Prefix};
use super::functions::{self, Clock};
use crate::atoms::Members;
use crate::error::{Problem, Result};
use crate::particles::{Field, View};
use crate::random::Ranmar;

/// A formula in which everything that is one number has been evaluated.
#[derive(Debug, Clone)]
pub enum Tree {
    Number(f64),
    Field(Field),
    /// One for each atom.
    Values(Rc<Vec<f64>>),
    /// 0 outside the group.
    Masked(Box<Tree>, Arc<Members>),
    Prefix(Prefix, Box<Tree>),
    /// A first value, and what is done with it from left to right.
    Chain(Box<Tree>, Vec<(Op, Tree)>),
    Call(&'static str, Vec<Tree>),
    Random {
        normal: bool,
        a: Box<Tree>,
        b: Box<Tree>,
        generator: Rc<RefCell<Ranmar>>,
    },
}

impl Tree {
    /// Values for atoms `first..first + out.len()`.
    ///
    /// # Errors
    /// A function outside its domain, a field that does not exist.
    pub fn fill(&self, view: &View, clock: &Clock, first: usize, out: &mut [f64]) -> Result<()> {
        let n = out.len();
        let block = |tree: &Tree| -> Result<Vec<f64>> {
            let mut values = vec![0.0; n];
            tree.fill(view, clock, first, &mut values)?;
            Ok(values)
        };
        match self {
            Tree::Number(x) => out.fill(*x),
            Tree::Field(field) => view.read(*field, first, out)?,
            Tree::Values(values) => out.copy_from_slice(&values[first..first + n]),
            Tree::Masked(inner, members) => {
                inner.fill(view, clock, first, out)?;
                for (k, slot) in out.iter_mut().enumerate() {
                    if !members.contains(first + k) {
                        *slot = 0.0;
                    }
                }
            }
            Tree::Prefix(prefix, inner) => {
                inner.fill(view, clock, first, out)?;
                out.iter_mut().for_each(|x| *x = prefix.apply(*x));
            }
            Tree::Chain(left, chain) => {
                left.fill(view, clock, first, out)?;
                for (op, right) in chain {
                    for ((k, a), b) in out.iter_mut().enumerate().zip(block(right)?) {
                        *a = op.apply(*a, b).map_err(|e| {
                            Problem::new(format!(
                                "{e} in the formula, at the atom with id {}",
                                view.id(first + k)
                            ))
                        })?;
                    }
                }
            }
            Tree::Call(name, arguments) => {
                let columns = arguments.iter().map(block).collect::<Result<Vec<_>>>()?;
                let mut row = vec![0.0; columns.len()];
                for (k, slot) in out.iter_mut().enumerate() {
                    for (r, c) in row.iter_mut().zip(&columns) {
                        *r = c[k];
                    }
                    *slot = functions::apply(name, &row, clock).map_err(|e| {
                        Problem::new(format!(
                            "{e} in the formula, at the atom with id {}",
                            view.id(first + k)
                        ))
                    })?;
                }
            }
            Tree::Random {
                normal,
                a,
                b,
                generator,
            } => {
                let (a, b) = (block(a)?, block(b)?);
                let mut generator = generator.borrow_mut();
                for (slot, (a, b)) in out.iter_mut().zip(a.into_iter().zip(b)) {
                    *slot = if *normal {
                        a + b * generator.normal()
                    } else {
                        generator.uniform() * (b - a) + a
                    };
                }
            }
        }
        Ok(())
    }
}
