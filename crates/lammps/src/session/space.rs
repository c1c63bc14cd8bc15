//! Where atoms are: units, dimensions, box, lattice and regions.

use std::rc::Rc;

use crate::domain::{Face, SimBox};
use crate::error::{Problem, Result};
use crate::lattice::Lattice;
use crate::region::Definition;
use crate::units::Units;

pub struct Space {
    pub units: Units,
    pub dimension: usize,
    pub faces: [[Face; 2]; 3],
    /// Was `atom_style` given?
    pub atom_style: bool,
    pub lattice: Option<Lattice>,
    pub regions: Vec<(String, Rc<Definition>)>,
    pub domain: Option<SimBox>,
}

impl Default for Space {
    fn default() -> Self {
        Space {
            units: Units::Lj,
            dimension: 3,
            faces: [[Face::Periodic; 2]; 3],
            atom_style: false,
            lattice: None,
            regions: Vec::new(),
            domain: None,
        }
    }
}

impl Space {
    /// The box.
    ///
    /// # Errors
    /// There is none yet.
    pub fn domain(&self) -> Result<&SimBox> {
        self.domain.as_ref().ok_or_else(no_box)
    }

    /// Length of `units lattice` (true) or `units box`.
    ///
    /// # Errors
    /// Lattice units without a lattice.
    pub fn length_unit(&self, in_lattice: bool) -> Result<f64> {
        match (in_lattice, &self.lattice) {
            (false, _) => Ok(1.0),
            (true, Some(l)) => Ok(l.constant),
            (true, None) => Err(Problem::new("lattice units need a `lattice`")
                .help("write a `lattice` command before, or add `units box`")),
        }
    }
}

fn no_box() -> Box<Problem> {
    Problem::new("there is no simulation box yet").help("write `create_box` or `read_data` before")
}
