//! What points exchange besides what the law of one material says.

use super::{
    ActingSpec, BondMixing, BondedSpec, ContactSpec, DiffusionSpec, InterfaceSpec, Mixing, PairSpec,
};
use std::sync::Arc;

/// Interactions between unlike materials, bodies and atoms, and what spreads through bonds; the default: none, bonds
/// between unlike materials in series.
#[derive(Debug, Clone, Default)]
pub struct InteractionsSpec {
    /// How bonds between unlike materials get their stiffness.
    pub interface: BondMixing,
    /// Bonds between bodies, where there are several; the others meet by contact alone.
    pub interfaces: Vec<InterfaceSpec>,
    /// What pairs of materials have instead of what follows from the two, `[of][with]`; empty: nothing. Their bonds
    /// are in lists.
    pub pairs: Vec<PairSpec>,
    /// Potentials of atoms besides those that are the laws of materials.
    pub potentials: Vec<ActingSpec>,
    /// How constants of pairs of unlike atoms follow, where no potential is given for them; `None`: they must be given.
    pub mixing: Option<Mixing>,
    /// What points say that are bonded to each other whatever moves, beside their potential.
    pub bonded: Option<Arc<BondedSpec>>,
    pub contact: Option<ContactSpec>,
    /// What spreads through the bonds of the reference, each quantity once.
    pub diffusions: Vec<DiffusionSpec>,
}
