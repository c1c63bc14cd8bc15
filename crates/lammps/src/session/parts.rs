//! What commands define: pairs, fixes, what watches, formulas; and when neighbours are looked for.

use std::cell::RefCell;
use std::rc::Rc;

use crate::compute::Compute;
use crate::dump::Dump;
use crate::error::Place;
use crate::fix::Fix;
use crate::host::{Condition, Motion, Style};
use crate::random::Ranmar;
use crate::rebuild::{Rebuild, Schedule};
use crate::record::Record;
use crate::thermo::Thermo;
use crate::units::Units;
use crate::variable::Variables;

/// `pair_style` with the numbers that `pair_coeff` gave so far, `[types²]`.
#[derive(Debug, Clone, PartialEq)]
pub struct PairState {
    pub style: Style,
    pub values: Vec<Option<Vec<f64>>>,
}

/// The pair style.
#[derive(Default)]
pub struct Pairs {
    pub state: Option<PairState>,
    /// Where each pair of types got its coefficients, `[types²]`.
    pub places: Vec<Place>,
}

/// `neighbor` and `neigh_modify`.
pub struct Neighbors {
    pub skin: f64,
    pub schedule: Schedule,
    pub rebuild: Rebuild,
}

impl Default for Neighbors {
    fn default() -> Self {
        Neighbors {
            skin: Units::Lj.skin(),
            schedule: Schedule::default(),
            rebuild: Rebuild::default(),
        }
    }
}

#[derive(Default)]
pub struct Fixes {
    pub all: Vec<Rc<Fix>>,
    /// Values of the fixes at this step: kept so that a step allocates nothing.
    pub acting: Vec<Condition>,
    pub told: Vec<Motion>,
}

/// What computes, writes and prints.
#[derive(Default)]
pub struct Watch {
    pub computes: Vec<Compute>,
    pub dumps: Vec<Dump>,
    pub thermo: Thermo,
    pub record: Record,
}

/// Variables, and the random numbers of formulas.
#[derive(Default)]
pub struct Formulas {
    pub variables: Variables,
    pub random: [Option<Rc<RefCell<Ranmar>>>; 2],
}
