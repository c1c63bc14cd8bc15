//! `fix`: what moves the atoms, what acts on them, and what is done after every so many steps.
//!
//! Order of a step, as in LAMMPS: carried atoms are told where they go, everything drifts, walls throw back, atoms that
//! are lost go, forces and then the fixes that change them in the script's order, the second kick, fixes of the step's end.

mod after;
pub mod average;
mod carry;
mod forces;

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;

use self::average::Average;
pub use self::carry::{Path, Start, cross};
use super::atoms::Members;
use super::error::{Problem, Result, suggestion};
use super::files::Sink;
use super::host::{Form, Push, Reaction, Wall};
use super::session::{Session, Store};

/// A number, or a variable evaluated at every step.
#[derive(Debug, Clone, PartialEq)]
pub enum Input {
    Number(f64),
    Variable(String),
}

impl Input {
    /// LAMMPS scales numbers of `units lattice` only, not what variables give.
    pub fn scaled(self, unit: f64) -> Input {
        match self {
            Input::Number(x) => Input::Number(unit * x),
            Input::Variable(name) => Input::Variable(name),
        }
    }
}

#[derive(Debug, Clone)]
pub struct Fix {
    pub id: String,
    pub members: Arc<Members>,
    pub kind: FixKind,
}

#[derive(Debug, Clone)]
pub enum FixKind {
    Nve,
    /// In box units.
    Indent {
        stiffness: f64,
        form: Form,
        push: Push,
        center: [Input; 3],
        radius: Input,
    },
    SetForce {
        force: [Option<Input>; 3],
        region: Option<String>,
    },
    AddForce {
        force: [Input; 3],
        /// Acts in every so many steps.
        every: u64,
        region: Option<String>,
    },
    /// γ of each type.
    Viscous(Vec<f64>),
    Enforce2d,
    /// Where atoms go, and where they were when the fix was made.
    Move {
        path: Path,
        start: Rc<Start>,
    },
    /// Walls that throw atoms back.
    Reflect(Vec<WallFace>),
    Momentum {
        every: u64,
        linear: [bool; 3],
        angular: bool,
        rescale: bool,
    },
    Print {
        every: u64,
        text: String,
        screen: bool,
        file: Option<Rc<RefCell<Sink>>>,
    },
    Average(Rc<RefCell<Average>>),
}

/// One wall of `fix wall/reflect`.
#[derive(Debug, Clone, PartialEq)]
pub struct WallFace {
    pub axis: usize,
    pub above: bool,
    /// A number in box units, or a variable in `unit`: LAMMPS scales variables here, too.
    pub place: Input,
    pub unit: f64,
}

pub const STYLES: [&str; 11] = [
    "nve",
    "indent",
    "setforce",
    "addforce",
    "viscous",
    "enforce2d",
    "move",
    "wall/reflect",
    "momentum",
    "print",
    "ave/time",
];

impl FixKind {
    /// Does it change forces? Then the engine knows it by its place among those that do.
    pub fn acts(&self) -> bool {
        match self {
            FixKind::Indent { .. }
            | FixKind::SetForce { .. }
            | FixKind::AddForce { .. }
            | FixKind::Viscous(_)
            | FixKind::Enforce2d => true,
            FixKind::Nve
            | FixKind::Move { .. }
            | FixKind::Reflect(_)
            | FixKind::Momentum { .. }
            | FixKind::Print { .. }
            | FixKind::Average(_) => false,
        }
    }
}

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
        let n = self.count();
        let mut moving: Option<Arc<Members>> = None;
        let moves = |f: &&Rc<Fix>| matches!(f.kind, FixKind::Nve | FixKind::Move { .. });
        for fix in self.fixes.iter().filter(moves) {
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
            .filter(|f| matches!(f.kind, FixKind::Nve | FixKind::Move { .. }))
            .collect();
        for (k, a) in all.iter().enumerate() {
            for b in &all[..k] {
                let both = |i: &usize| a.members.contains(*i) && b.members.contains(*i);
                if let Some(i) = (0..self.count()).find(both) {
                    let styles = match (&a.kind, &b.kind) {
                        (FixKind::Nve, FixKind::Nve) => "`fix nve`",
                        _ => "`fix nve` and `fix move`",
                    };
                    return Err(Problem::new(format!(
                        "{styles} with the IDs `{}` and `{}` both move the atom with id {}",
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

    /// Throws back what is behind a wall; within a step.
    ///
    /// # Errors
    /// A variable cannot be evaluated.
    pub fn reflect(&mut self) -> Result<()> {
        for k in 0..self.fixes.len() {
            let fix = self.fixes[k].clone();
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
                self.engine()?.reflect(&wall, &members);
            }
        }
        Ok(())
    }

    /// Will a fix read values at this step?
    pub fn fixes_look(&self, step: u64) -> bool {
        self.fixes.iter().any(|f| match &f.kind {
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
        let Some(fix) = self.fixes.iter().find(|f| f.id == id).cloned() else {
            return Err(Problem::new(format!("there is no fix `{id}`"))
                .help(suggestion(id, self.fixes.iter().map(|f| f.id.as_str()))));
        };
        let number = self.fixes.iter().filter(|f| f.kind.acts());
        let number = number.take_while(|f| f.id != id).count();
        let reaction = |s: &Self| match &s.store {
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
