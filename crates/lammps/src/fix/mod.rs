//! `fix`: what moves the atoms, what acts on them, and what is done after every so many steps.
//!
//! Order of a step, as in LAMMPS: carried atoms are told where they go, everything drifts, walls throw back, atoms that
//! are lost go, forces and then the fixes that change them in the script's order, the second kick, fixes of the step's end.

mod after;
mod apply;
pub mod average;
mod carry;
mod forces;
mod input;
mod path;
mod samples;

pub use self::path::{Path, Start};
use super::atoms::Members;
use super::files::Sink;
use super::host::{Form, Push};
use average::Average;
pub use input::Input;
use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;

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
