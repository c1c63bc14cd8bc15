//! Any law on any family: laws with memory, with tensors, along the bond or not ([`crate::law::material`]). Written once over groups of eight
//! points; a lattice and a cloud differ in where partners are and what of a bond is stored. What bonds are is the business of
//! [`bonds`](super::bonds), which know no law; what is compiled for every law are its [`LawSweeps`] alone.

mod break_bonds;
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
mod view;

use super::bonds::family::Family;
use super::bonds::law::LawProperties;
use super::bonds::state::{BondParts, placed};
use super::bonds::store::Store;
use super::bonds::{BondState, CloudFamily, LatticeFamily};
use crate::law::material::{Material, Numbers};
use crate::space::Point;
use law::LawSweeps;
use plain::Compiled;
use std::sync::Arc;

/// A law on a family.
pub struct MaterialInteraction<const D: usize, F> {
    bonds: BondState<D, F>,
    law: Arc<dyn LawSweeps<D, F>>,
}

/// A law that is not yet on a family.
pub trait AnyLaw<const D: usize>: Sync {
    fn properties(self: Arc<Self>) -> LawProperties<D>;
    /// [`Material::OF_FAMILY`]
    fn of_family(&self) -> bool;
    /// [`Material::OF_BONDS`]
    fn of_bonds(&self) -> bool;
    /// [`Material::ALIKE`]
    fn is_alike(&self) -> bool;
    /// Are its constants those of places?
    fn is_placed(&self) -> bool;

    /// Constants at a place, number by number.
    ///
    /// # Errors
    /// Why there are none.
    fn constants_at(&self, material: usize, place: &Point, out: &mut [f64]) -> Result<(), String>;

    fn on_lattice(self: Arc<Self>) -> Arc<dyn LawSweeps<D, LatticeFamily<D>>>;

    fn on_cloud(self: Arc<Self>) -> Arc<dyn LawSweeps<D, CloudFamily<D>>>;
}

/// What bonds need of a law.
pub fn compiled<const D: usize, M: Material<D>>(law: M) -> Arc<dyn AnyLaw<D>> {
    Arc::new(Compiled(law))
}

impl<const D: usize, M: Material<D>> AnyLaw<D> for Compiled<M> {
    fn properties(self: Arc<Self>) -> LawProperties<D> {
        LawProperties::of(&self.0, self.clone())
    }

    fn of_family(&self) -> bool {
        M::OF_FAMILY
    }

    fn of_bonds(&self) -> bool {
        M::OF_BONDS
    }

    fn is_alike(&self) -> bool {
        M::ALIKE
    }

    fn is_placed(&self) -> bool {
        M::PLACED && self.0.varies()
    }

    fn constants_at(&self, material: usize, place: &Point, out: &mut [f64]) -> Result<(), String> {
        let constants = self.0.constants_at(material, place)?;
        for (n, x) in out.iter_mut().enumerate() {
            *x = constants.get(n);
        }
        Ok(())
    }

    fn on_lattice(self: Arc<Self>) -> Arc<dyn LawSweeps<D, LatticeFamily<D>>> {
        self
    }

    fn on_cloud(self: Arc<Self>) -> Arc<dyn LawSweeps<D, CloudFamily<D>>> {
        self
    }
}

impl<const D: usize, F: Family<D>> MaterialInteraction<D, F> {
    /// The law is put on the family by `on`.
    ///
    /// # Errors
    /// As of [`placed`](crate::interaction::bonds::state::placed).
    pub fn new(
        parts: BondParts<D, F>,
        law: Arc<dyn AnyLaw<D>>,
        on: fn(Arc<dyn AnyLaw<D>>) -> Arc<dyn LawSweeps<D, F>>,
    ) -> Result<Self, Option<(usize, String)>> {
        let of = law.clone().properties();
        let placed = match law.is_placed() {
            false => Store::zeros(parts.family.layout(0)),
            true => placed(&parts.family, parts.body, of.constants, &|m, place, out| {
                law.constants_at(m, place, out)
            })?,
        };
        Ok(MaterialInteraction {
            bonds: BondState::new(parts, of, placed),
            law: on(law),
        })
    }
}
