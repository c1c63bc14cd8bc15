//! Any law on any family: laws with memory, with tensors, along the bond or not ([`crate::law::material`]). Written once over groups of eight
//! points; a lattice and a cloud differ in where partners are and what of a bond is stored. What bonds are is the business of
//! [`bonds`](super::bonds), which know no law; what is compiled for every law are its [`LawSweeps`] alone.

mod contract;
mod energies;
mod group;
mod law;
mod measured;
mod plain;
mod slopes;
mod step;
mod sweeps;
mod tangents;
mod tear;
mod view;
mod watch;

use super::bonds::BondState;
use super::bonds::family::Family;
use super::bonds::law::LawProperties;
use super::bonds::state::{BondParts, placed};
use super::bonds::store::Store;
use crate::law::material::{Material, Numbers};
use law::LawSweeps;
use plain::Compiled;

/// A law on a family.
pub struct MaterialInteraction<const D: usize, F> {
    bonds: BondState<D, F>,
    law: Box<dyn LawSweeps<D, F>>,
}

impl<const D: usize, F: Family<D>> MaterialInteraction<D, F> {
    /// # Errors
    /// The slot whose place has no constants, and why.
    pub fn new<M: Material<D>>(parts: BondParts<D, F>, law: M) -> Result<Self, (usize, String)> {
        let of = LawProperties::of(&law);
        let placed = match M::PLACED && law.varies() {
            false => Store::zeros(parts.family.layout(0)),
            true => placed(&parts.family, parts.body, of.constants, &|m, place, out| {
                let constants = law.constants_at(m, place)?;
                for (n, x) in out.iter_mut().enumerate() {
                    *x = constants.get(n);
                }
                Ok(())
            })?,
        };
        Ok(MaterialInteraction {
            bonds: BondState::new(parts, of, placed),
            law: Box::new(Compiled(law)),
        })
    }
}
