//! Fixes that change forces, with the values of this moment.

use std::sync::Arc;

use super::input::Input;

use super::{Fix, FixKind};
use crate::atoms::Members;
use crate::error::{Problem, Result};
use crate::host::{Condition, Form, Quantity};
use crate::particles::Field;
use crate::session::Session;
use crate::variable::Kind;

impl Session<'_> {
    /// The conditions with the values of this moment, in `out`.
    ///
    /// # Errors
    /// A variable cannot be evaluated.
    pub fn conditions(&mut self, out: &mut Vec<Condition>) -> Result<()> {
        out.clear();
        for k in 0..self.fixes.all.len() {
            let fix = self.fixes.all[k].clone();
            if fix.kind.acts() {
                out.push(self.condition(&fix)?);
            }
        }
        Ok(())
    }

    fn condition(&mut self, fix: &Fix) -> Result<Condition> {
        let members = fix.members.clone();
        Ok(match &fix.kind {
            FixKind::Indent {
                stiffness,
                form,
                push,
                center: [x, y, z],
                radius,
            } => {
                let center = [self.input(x)?, self.input(y)?, self.input(z)?];
                let radius = self.input(radius)?;
                if radius < 0.0 && !matches!(form, Form::Plane(_)) {
                    return Err(Problem::new(format!(
                        "the indenter of fix `{}` has the radius {radius}",
                        fix.id
                    )));
                }
                Condition::Indent {
                    members,
                    stiffness: *stiffness,
                    form: *form,
                    push: *push,
                    center,
                    radius,
                }
            }
            FixKind::SetForce { force, region } => {
                if region.is_some() || force.iter().flatten().any(|v| self.is_atom_style(v)) {
                    let force = self.each_force(&members, force, region.as_deref())?;
                    return Ok(Condition::SetForceEach { members, force });
                }
                let mut values = [None; 3];
                for (value, input) in values.iter_mut().zip(force) {
                    *value = input.as_ref().map(|v| self.input(v)).transpose()?;
                }
                Condition::SetForce {
                    members,
                    force: values,
                }
            }
            FixKind::AddForce {
                force: [x, y, z],
                every,
                region,
            } => {
                if !self.progress.step.is_multiple_of(*every) {
                    return Ok(Condition::AddForce {
                        members,
                        force: [0.0; 3],
                    });
                }
                if region.is_some() || [x, y, z].into_iter().any(|v| self.is_atom_style(v)) {
                    let inputs = [x, y, z].map(|v| Some(v.clone()));
                    let force = self.each_force(&members, &inputs, region.as_deref())?;
                    return Ok(Condition::AddForceEach { members, force });
                }
                Condition::AddForce {
                    members,
                    force: [self.input(x)?, self.input(y)?, self.input(z)?],
                }
            }
            FixKind::Viscous(gamma) => {
                let mut each = Vec::new();
                self.scan(Field::Raw(Quantity::Type), |first, block| {
                    let inside = |k: &usize| members.contains(first + *k);
                    let of = |k: usize| gamma.get(block[k] as usize - 1).copied().unwrap_or(0.0);
                    each.extend((0..block.len()).filter(inside).map(of));
                })?;
                Condition::Drag {
                    members,
                    gamma: each,
                }
            }
            FixKind::Enforce2d => Condition::Enforce2d { members },
            FixKind::Nve
            | FixKind::Move { .. }
            | FixKind::Reflect(_)
            | FixKind::Momentum { .. }
            | FixKind::Print { .. }
            | FixKind::Average(_) => {
                return Err(Problem::new(format!("fix `{}` changes no forces", fix.id)));
            }
        })
    }

    fn is_atom_style(&self, input: &Input) -> bool {
        match input {
            Input::Variable(name) => {
                matches!(self.formulas.variables.get(name), Some(Kind::Atom(_)))
            }
            Input::Number(_) => false,
        }
    }

    /// Values for each member; nothing outside the region.
    fn each_force(
        &mut self,
        members: &Arc<Members>,
        inputs: &[Option<Input>; 3],
        region: Option<&str>,
    ) -> Result<Vec<[Option<f64>; 3]>> {
        let n = self.population.count();
        let inside = match region {
            Some(name) => {
                let region = self.region(name)?;
                let x = self.positions()?;
                Members::collect(n, |i| region.contains(x[i]))
            }
            None => Members::All,
        };
        let mut columns = [None, None, None];
        for (column, input) in columns.iter_mut().zip(inputs) {
            *column = match input {
                None => None,
                Some(Input::Number(x)) => Some(vec![*x; n]),
                Some(Input::Variable(name)) => Some(self.variable_values(name)?),
            };
        }
        let at = |i: usize| [0, 1, 2].map(|a: usize| columns[a].as_ref().map(|c| c[i]));
        let of = |i: usize| if inside.contains(i) { at(i) } else { [None; 3] };
        Ok((0..n).filter(|i| members.contains(*i)).map(of).collect())
    }

    /// Values of a variable for all atoms.
    ///
    /// # Errors
    /// It cannot be evaluated.
    pub fn variable_values(&mut self, name: &str) -> Result<Vec<f64>> {
        let tree = self.variable_tree(name)?;
        self.values(&tree)
    }
}
