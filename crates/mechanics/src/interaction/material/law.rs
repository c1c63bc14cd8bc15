//! A law as bonds are swept with it that know none: compiled once per law and family.

use super::group::{GroupEnergy, GroupForces, Kept};
use super::plain::{Compiled, PlainLaw};
use super::slopes::LawSlopes;
use super::sweeps::{Forces, Remember, Sums};
use super::view::View;
use crate::body::Values;
use crate::execute::blocks::Shared;
use crate::execute::lane::TILE;
use crate::execute::simd::Simd;
use crate::interaction::Tally;
use crate::interaction::bonds::family::Family;
use crate::interaction::bonds::repulsion::Pushed;
use crate::interaction::bonds::state::Blocks;
use crate::interaction::bonds::store::OwnRows;
use crate::interaction::bonds::view::BondView;
use crate::law::material::{Material, Numbers};

/// What bonds need of a law: one call for each sweep, or for each group where sweeps are rare. Groups are those of the family of the bonds.
pub trait LawSweeps<const D: usize, F>: PlainLaw<D> + LawSlopes<D> {
    /// A pass over groups that are marked, or all if none is: sums over bonds, and what points make of them.
    fn sums(&self, blocks: &Blocks, view: BondView<D, F>, pass: usize, out: OwnRows, only: &[u8]);

    /// Forces on points that have settled.
    fn forces(
        &self,
        blocks: &Blocks,
        view: BondView<D, F>,
        f: [Shared; D],
        pushed: Option<Pushed<D>>,
    );

    /// What bonds and points of groups that are marked, or of all, remember at the end of a step.
    fn remember(
        &self,
        blocks: &Blocks,
        view: BondView<D, F>,
        written: (OwnRows, Shared),
        volume: &Values,
        only: &[u8],
    ) -> Tally;

    /// Strain energy densities of the points of a group, if they had these bonds and forms.
    fn energy(&self, simd: Simd, view: BondView<D, F>, group: usize, of: Kept<D>) -> [f64; TILE];

    /// Force states on the bonds of a group that has settled, `[bonds][D][8]`, the own ones `alone` or less those of the other ends (force / volume²); and, with
    /// the own ones, the stress across the section of laws that say it.
    fn bond_forces(
        &self,
        simd: Simd,
        view: BondView<D, F>,
        group: usize,
        alone: bool,
        out: &mut [f64],
    ) -> [f64; TILE];
}

/// Bonds, and a law that who asks does not know.
pub struct LawView<'a, const D: usize, F> {
    pub law: &'a dyn LawSweeps<D, F>,
    pub simd: Simd,
    pub bonds: BondView<'a, D, F>,
}

impl<const D: usize, F: Family<D>> LawView<'_, D, F> {
    /// [`LawSweeps::energy`]
    pub fn energy(&self, group: usize, of: Kept<D>) -> [f64; TILE] {
        self.law.energy(self.simd, self.bonds, group, of)
    }

    /// [`LawSweeps::bond_forces`], which have as much room as they take.
    pub fn bond_forces(&self, group: usize, alone: bool, out: &mut Vec<f64>) -> [f64; TILE] {
        out.resize(self.bonds.family.bonds(group) * D * TILE, 0.0);
        self.law
            .bond_forces(self.simd, self.bonds, group, alone, out)
    }
}

impl<M> Compiled<M> {
    fn sees<'a, const D: usize, F>(&'a self, bonds: BondView<'a, D, F>) -> View<'a, D, F, M> {
        View {
            law: &self.0,
            bonds,
        }
    }
}

/// Numbers that a point and a bond of the law remember.
const fn numbers<const D: usize, M: Material<D>>() -> usize {
    <M::Past<f64> as Numbers<f64>>::COUNT + <M::Memory<f64> as Numbers<f64>>::COUNT
}

impl<const D: usize, F: Family<D>, M: Material<D>> LawSweeps<D, F> for Compiled<M> {
    fn sums(&self, blocks: &Blocks, view: BondView<D, F>, pass: usize, out: OwnRows, only: &[u8]) {
        let view = self.sees(view);
        blocks.run(&Sums {
            view,
            pass,
            out,
            only,
        });
    }

    fn forces(
        &self,
        blocks: &Blocks,
        view: BondView<D, F>,
        f: [Shared; D],
        pushed: Option<Pushed<D>>,
    ) {
        let view = self.sees(view);
        blocks.run(&Forces { view, f, pushed });
    }

    fn remember(
        &self,
        blocks: &Blocks,
        view: BondView<D, F>,
        (past, memory): (OwnRows, Shared),
        volume: &Values,
        only: &[u8],
    ) -> Tally {
        let nothing = const { numbers::<D, M>() == 0 };
        if nothing {
            return Tally::default();
        }
        let kernel = Remember {
            view: self.sees(view),
            past,
            memory,
            volume,
            only,
        };
        blocks.tally(&kernel).0
    }

    fn energy(&self, simd: Simd, view: BondView<D, F>, group: usize, of: Kept<D>) -> [f64; TILE] {
        let view = self.sees(view);
        simd.run(&GroupEnergy { view, of }, group)
    }

    fn bond_forces(
        &self,
        simd: Simd,
        view: BondView<D, F>,
        group: usize,
        alone: bool,
        out: &mut [f64],
    ) -> [f64; TILE] {
        assert_eq!(
            out.len(),
            view.family.bonds(group) * D * TILE,
            "room for a group"
        );
        let kernel = GroupForces {
            view: self.sees(view),
            alone,
            out: Shared(out.as_mut_ptr()),
        };
        simd.run(&kernel, group)
    }
}
