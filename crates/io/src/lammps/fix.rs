//! `fix`: what moves the atoms and what acts on them.

use std::sync::Arc;

use super::atoms::Members;
use super::error::{Problem, Result, suggestion};
use super::host::{Condition, Reaction};
use super::session::{Session, Store};

/// A number, or a variable evaluated at every step.
#[derive(Debug, Clone, PartialEq)]
pub enum Input {
    Number(f64),
    Variable(String),
}

#[derive(Debug, Clone, PartialEq)]
pub struct Fix {
    pub id: String,
    pub members: Arc<Members>,
    pub kind: FixKind,
}

#[derive(Debug, Clone, PartialEq)]
pub enum FixKind {
    Nve,
    /// Lengths are multiplied by `unit`.
    Indent {
        stiffness: f64,
        center: [Input; 3],
        radius: Input,
        unit: f64,
    },
    SetForce([Option<Input>; 3]),
    AddForce([Input; 3]),
    Enforce2d,
}

pub const STYLES: [&str; 5] = ["nve", "indent", "setforce", "addforce", "enforce2d"];

impl Session<'_> {
    fn input(&mut self, input: &Input) -> Result<f64> {
        match input {
            Input::Number(x) => Ok(*x),
            Input::Variable(name) => self.variable_number(name),
        }
    }

    /// The conditions with the values of this moment, in `out`.
    ///
    /// # Errors
    /// A variable cannot be evaluated.
    pub fn conditions(&mut self, out: &mut Vec<Condition>) -> Result<()> {
        out.clear();
        for k in 0..self.fixes.len() {
            let fix = self.fixes[k].clone();
            let members = fix.members.clone();
            out.push(match &fix.kind {
                FixKind::Nve => continue,
                FixKind::Indent {
                    stiffness,
                    center: [x, y, z],
                    radius,
                    unit,
                } => {
                    let center = [
                        self.input(x)? * unit,
                        self.input(y)? * unit,
                        self.input(z)? * unit,
                    ];
                    let radius = self.input(radius)? * unit;
                    if radius < 0.0 {
                        return Err(Problem::new(format!(
                            "the indenter of fix `{}` has the radius {radius}",
                            fix.id
                        )));
                    }
                    Condition::Indent {
                        members,
                        stiffness: *stiffness,
                        center,
                        radius,
                    }
                }
                FixKind::SetForce(values) => {
                    let mut force = [None; 3];
                    for (f, v) in force.iter_mut().zip(values) {
                        *f = v.as_ref().map(|v| self.input(v)).transpose()?;
                    }
                    Condition::SetForce { members, force }
                }
                FixKind::AddForce([x, y, z]) => Condition::AddForce {
                    members,
                    force: [self.input(x)?, self.input(y)?, self.input(z)?],
                },
                FixKind::Enforce2d => Condition::Enforce2d { members },
            });
        }
        Ok(())
    }

    /// Atoms that `fix nve` moves.
    pub fn moving(&self) -> Option<Arc<Members>> {
        let n = self.count();
        let mut moving: Option<Arc<Members>> = None;
        for fix in self.fixes.iter().filter(|f| f.kind == FixKind::Nve) {
            moving = Some(match moving {
                None => fix.members.clone(),
                Some(m) => Arc::new(Members::collect(n, |i| {
                    m.contains(i) || fix.members.contains(i)
                })),
            });
        }
        moving
    }

    /// LAMMPS moves the atoms of two such fixes twice in every step, and warns; nobody wants that.
    ///
    /// # Errors
    /// An atom is in two.
    pub fn nobody_twice(&self) -> Result<()> {
        let all: Vec<_> = self
            .fixes
            .iter()
            .filter(|f| f.kind == FixKind::Nve)
            .collect();
        for (k, a) in all.iter().enumerate() {
            for b in &all[..k] {
                let both = |i: &usize| a.members.contains(*i) && b.members.contains(*i);
                if let Some(i) = (0..self.count()).find(both) {
                    return Err(Problem::new(format!(
                        "`fix nve` with the IDs `{}` and `{}` both move the atom with id {}",
                        b.id,
                        a.id,
                        self.ids.get(i)
                    ))
                    .help("LAMMPS would move such atoms twice in every step: `unfix` one, or give each a group of its own"));
                }
            }
        }
        Ok(())
    }

    /// `f_ID`, `f_ID[i]` of an indenter: its energy, and the force on it.
    ///
    /// # Errors
    /// No such fix, or one without values.
    pub fn fix_value(&self, id: &str, index: &[f64]) -> Result<f64> {
        let acting = self.fixes.iter().filter(|f| f.kind != FixKind::Nve);
        let Some((number, fix)) = acting.enumerate().find(|(_, f)| f.id == id) else {
            return Err(Problem::new(format!("there is no fix `{id}` with values"))
                .help(suggestion(id, self.fixes.iter().map(|f| f.id.as_str()))));
        };
        if !matches!(fix.kind, FixKind::Indent { .. }) {
            return Err(Problem::new(format!(
                "fix `{id}` has no values: only `fix indent` has"
            )));
        }
        let reaction = match &self.store {
            Store::Engine(e) => e.reaction(number),
            Store::Atoms(_) => Reaction::default(),
        };
        match index {
            [] => Ok(reaction.energy),
            [k] if [1.0, 2.0, 3.0].contains(k) => Ok(reaction.force[*k as usize - 1]),
            _ => Err(Problem::new(format!(
                "fix `{id}` has the values f_{id}, f_{id}[1], f_{id}[2] and f_{id}[3]"
            ))),
        }
    }
}
