//! How fields are made: what is a choice, who is told, and who may end it.

use crate::FieldsError;
use crate::kernel::Kernel;
use crate::molecules::Molecules;
use crate::neighbours::Families;
use crate::partition::{PairForce, Partition};
use std::sync::Arc;

/// How fields are made.
#[derive(Debug, Clone)]
pub struct Method {
    pub kernel: Kernel,
    pub partition: Partition,
    pub pair_force: PairForce,
    /// Keep stress, churning and heat flux of the parts of the potential apart.
    pub by_part: bool,
    /// What is bonded whatever moves.
    pub molecules: Option<Arc<Molecules>>,
    /// Who can feel whom, of particles that keep the neighbours of a reference; `None`: those that are near now.
    pub families: Option<Arc<Families>>,
    /// Also the exact rates of ρ, π and e, for residuals.
    pub rates: bool,
    /// Also where what is at a point comes from: y, its flux and the angular momentum.
    pub coordinate: bool,
    /// k_B (energy / temperature); 1 in reduced units.
    pub boltzmann: f64,
    /// Is told how much of a frame is done.
    pub progress: Option<Progress>,
    /// A question that is asked all the time, by all threads: has somebody had enough? There are no fields then.
    pub stop: fn() -> bool,
}

/// Nobody has.
pub(crate) fn never() -> bool {
    false
}

/// Why there are no fields where [`Method::stop`] says so.
pub const STOPPED: &str = "ended from outside";

/// Called with the part of a frame's work that is done, about: above 0, 1 at the end, on the thread that asked for the fields.
#[derive(Clone)]
pub struct Progress(pub Arc<dyn Fn(f64) + Send + Sync>);

impl std::fmt::Debug for Progress {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Progress")
    }
}

impl Method {
    pub fn new(kernel: Kernel) -> Method {
        Method {
            kernel,
            partition: Partition::Site,
            pair_force: PairForce::Distances,
            by_part: false,
            molecules: None,
            families: None,
            rates: false,
            coordinate: false,
            boltzmann: 1.0,
            progress: None,
            stop: never,
        }
    }

    /// # Errors
    /// Somebody has had enough.
    pub(crate) fn go_on(&self) -> Result<(), FieldsError> {
        match (self.stop)() {
            true => Err(FieldsError(STOPPED.into())),
            false => Ok(()),
        }
    }
}
