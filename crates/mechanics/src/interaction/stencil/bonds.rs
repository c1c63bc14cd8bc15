//! The bonds of a stencil one by one, in order of slots: for whatever is not a kernel.

use super::StencilInteraction;
use crate::body::{Body, FieldView, Subdomain, view_mut, zeros};
use crate::execute::blocks::PerBlock;
use crate::execute::lane::Lane;
use crate::execute::simd::Kernel;
use crate::interaction::bonds::family::Family;
use crate::interaction::tangent::Stretched;
use crate::interaction::{BondForce, Interaction, Sweep, add_virial};
use crate::law::Law;
use std::ops::Range;

struct Virial<'a, const D: usize, W: Law> {
    of: &'a StencilInteraction<D, W>,
    body: &'a Body<D>,
    u: FieldView<'a, D>,
}

impl<const D: usize, W: Law> Kernel for Virial<'_, D, W> {
    type Out = [f64; 6];
    type Home = W;

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> [f64; 6] {
        let tiles = self.of.bonds.family.block(block);
        let mut virial = [0.0; 6];
        self.of.pulls_of(self.body, self.u, tiles, |bond| {
            let factor = -0.5 * self.body.volume.at(bond.i);
            add_virial(&mut virial, &bond.force, &bond.y, factor);
        });
        virial
    }
}

impl<const D: usize, W: Law> StencilInteraction<D, W> {
    /// Tiles that have points.
    pub(super) fn tiles(&self) -> usize {
        self.bonds.family.groups()
    }

    pub(super) fn field(&self, slot: usize) -> [f64; 2] {
        [0, 1].map(|n| self.fields[n].get(slot).copied().unwrap_or(0.0))
    }

    /// The pressures of this state.
    pub(super) fn update_pressures(&mut self, body: &Body<D>, u: FieldView<D>) {
        if W::SHARES {
            self.forces(body, u, view_mut(&mut zeros(body.len)), Sweep::Hold, None);
        }
    }

    /// Σ of distance times force over the pairs, on threads.
    pub(super) fn virial_of_pulls(&mut self, body: &Body<D>, u: FieldView<D>) -> [f64; 6] {
        self.update_pressures(body, u);
        let kernel = Virial { of: self, body, u };
        let sums = PerBlock::sums(self.bonds.family.blocks());
        let ranks = body.subdomain().map(Subdomain::comm);
        sums.among(ranks).sum(self.bonds.blocks.simd, &kernel)
    }

    /// What points of some tiles get from their bonds, as pressures are.
    pub(super) fn pulls_of(
        &self,
        body: &Body<D>,
        u: FieldView<D>,
        tiles: Range<usize>,
        mut visit: impl FnMut(BondForce<D>),
    ) {
        let family = &self.bonds.family;
        for (n, l, i) in family.points_of(tiles) {
            for (k, b) in self.stencil[family.sublattice(n)].iter().enumerate() {
                let alive = self.bonds.is_whole(n, k, l);
                // beside the body another row of it lies in memory
                let there = || family.is_bond(n, k, l);
                if !alive && (self.bonds.repulsion.is_none() || !there()) {
                    continue;
                }
                let j = b.to(i);
                let eta: [f64; D] = crate::array::from_fn(|a| u[a][j] - u[a][i]);
                let xi = b.back.map(|x| -x);
                let ends = [i, body.exchange.original(j)];
                let mut pull = [0.0; 2];
                let bond = Stretched::new(xi, eta);
                if alive {
                    let fields = [i, j].map(|s| self.field(s));
                    let factors = self.scale.of(n, k, l);
                    pull = bond.tensions(self.law, b.k, factors, fields);
                }
                if let Some(repulsion) = &self.bonds.repulsion {
                    let materials = ends.map(|s| body.material_of(s));
                    let push = repulsion.pull(&xi, &bond.y, materials, self.volume);
                    pull = [pull[0] + push, pull[1] + 0.5 * push];
                }
                if pull[0] != 0.0 {
                    visit(BondForce::central(ends, bond.y, pull));
                }
            }
        }
    }
}
