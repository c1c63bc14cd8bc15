//! Fixes of a session: their inputs and their order.

use super::input::Input;

use super::{Fix, FixKind};
use crate::atoms::Members;
use crate::error::{Problem, Result, suggestion};
use crate::host::{Reaction, Wall};
use crate::session::{Session, Store};
use std::rc::Rc;
use std::sync::Arc;

impl Session<'_> {
    /// The number of an input, now.
    ///
    /// # Errors
    /// A variable cannot be evaluated.
    pub fn input(&mut self, input: &Input) -> Result<f64> {
        match input {
            Input::Number(x) => Ok(*x),
            Input::Variable(name) => self.variable_number(name),
        }
    }

    /// Atoms that forces move: of `fix nve`, and carried ones, which they move on the axes left open.
    pub fn moving(&self) -> Option<Arc<Members>> {
        let n = self.population.count();
        let mut moving: Option<Arc<Members>> = None;
        let moves = |f: &&Rc<Fix>| matches!(f.kind, FixKind::Nve | FixKind::Move { .. });
        for fix in self.fixes.all.iter().filter(moves) {
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
            .all
            .iter()
            .filter(|f| matches!(f.kind, FixKind::Nve | FixKind::Move { .. }))
            .collect();
        for (k, a) in all.iter().enumerate() {
            for b in &all[..k] {
                let both = |i: &usize| a.members.contains(*i) && b.members.contains(*i);
                if let Some(i) = (0..self.population.count()).find(both) {
                    let styles = match (&a.kind, &b.kind) {
                        (FixKind::Nve, FixKind::Nve) => "`fix nve`",
                        _ => "`fix nve` and `fix move`",
                    };
                    return Err(Problem::new(format!(
                        "{styles} with the IDs `{}` and `{}` both move the atom with id {}",
                        b.id,
                        a.id,
                        self.population.ids.get(i)
                    ))
                    .help("LAMMPS would move such atoms twice in every step: `unfix` one, or give each a group of its own"));
                }
            }
        }
        Ok(())
    }

    /// Throws back what is behind a wall; within a step.
    ///
    /// # Errors
    /// A variable cannot be evaluated.
    pub fn reflect(&mut self) -> Result<()> {
        for k in 0..self.fixes.all.len() {
            let fix = self.fixes.all[k].clone();
            let FixKind::Reflect(faces) = &fix.kind else {
                continue;
            };
            for face in faces {
                let position = match &face.place {
                    Input::Number(x) => *x,
                    Input::Variable(name) => face.unit * self.variable_number(name)?,
                };
                let wall = Wall {
                    axis: face.axis,
                    above: face.above,
                    position,
                };
                let members = fix.members.clone();
                self.population.engine()?.reflect(&wall, &members);
            }
        }
        Ok(())
    }

    /// Will a fix read values at this step?
    pub fn fixes_look(&self, step: u64) -> bool {
        self.fixes.all.iter().any(|f| match &f.kind {
            FixKind::Print { every, .. } => step.is_multiple_of(*every),
            FixKind::Average(a) => a.borrow().samples_at(step),
            FixKind::Momentum { every, .. } => step.is_multiple_of(*every),
            FixKind::Nve
            | FixKind::Indent { .. }
            | FixKind::SetForce { .. }
            | FixKind::AddForce { .. }
            | FixKind::Viscous(_)
            | FixKind::Enforce2d
            | FixKind::Move { .. }
            | FixKind::Reflect(_) => false,
        })
    }

    /// `f_ID`, `f_ID[i]`.
    ///
    /// # Errors
    /// No such fix, or one without values.
    pub fn fix_value(&mut self, id: &str, index: &[f64]) -> Result<f64> {
        let Some(fix) = self.fixes.all.iter().find(|f| f.id == id).cloned() else {
            return Err(Problem::new(format!("there is no fix `{id}`"))
                .help(suggestion(id, self.fixes.all.iter().map(|f| f.id.as_str()))));
        };
        let number = self.fixes.all.iter().filter(|f| f.kind.acts());
        let number = number.take_while(|f| f.id != id).count();
        let reaction = |s: &Self| match &s.population.store {
            Store::Engine(e) => e.reaction(number),
            Store::Atoms(_) => Reaction::default(),
        };
        let axis = |k: f64| [1.0, 2.0, 3.0].iter().position(|a| *a == k);
        match (&fix.kind, index) {
            (FixKind::Average(a), index) => a.borrow().value(id, index),
            (FixKind::Indent { .. }, []) => Ok(reaction(self).energy),
            (FixKind::AddForce { every, .. }, _) if *every > 1 => Err(Problem::new(format!(
                "fix `{id}` has no values: `addforce` with `every` has none"
            ))),
            (FixKind::Indent { .. } | FixKind::SetForce { .. } | FixKind::AddForce { .. }, [k])
                if axis(*k).is_some() =>
            {
                Ok(reaction(self).force[axis(*k).unwrap_or(0)])
            }
            (FixKind::Indent { .. }, _) => Err(Problem::new(format!(
                "fix `{id}` has the values f_{id}, f_{id}[1], f_{id}[2] and f_{id}[3]"
            ))),
            (FixKind::SetForce { .. } | FixKind::AddForce { .. }, _) => Err(Problem::new(format!(
                "fix `{id}` has the values f_{id}[1], f_{id}[2] and f_{id}[3]: the force on its atoms before it acts"
            ))),
            _ => Err(Problem::new(format!(
                "fix `{id}` has no values: indent, setforce, addforce and ave/time have"
            ))),
        }
    }
}
