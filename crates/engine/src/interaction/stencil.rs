//! Any law on a lattice stencil: tiles of eight points walk the offsets together; one bit per bond is all that is
//! stored.

mod assemble;
mod bonds;
mod kernel;
mod weights;

use super::bonds::family::Family;
use super::bonds::fused::Fused;
use super::bonds::{BondState, LatticeFamily};
use super::history;
use super::point_constants::pressure_factor;
use super::scale::Scale;
use super::{
    BondForce, BondStatus, BondTangent, EnergyFields, Interaction, Motion, PointConstants,
    PointEnergiesMut, Sweep, Tally,
};
use crate::body::{Body, Column, FieldView, FieldViewMut, Identity};
use crate::columns::Declaration;
use crate::error::BuildError;
use crate::execute::blocks::{Seen, Shared};
use crate::law::BondFactors;
use crate::law::Law;
use crate::spec::CrackKind;
use crate::state::Archive;
pub use assemble::StencilParts;
pub use kernel::MOST;
use kernel::{Bond, Energies, Forces, Partner, Remember, Share, View, WHOLE};

/// A law on a stencil.
pub struct StencilInteraction<const D: usize, W: Law> {
    bonds: BondState<D, LatticeFamily<D>>,
    law: W,
    /// Bonds as sweeps read them, per sublattice.
    stencil: Vec<Vec<Bond<D>>>,
    partners: Vec<Vec<Partner<D>>>,
    /// `[tiles]`: are all bonds whole, and their ends alike? See the kernel's `WHOLE` and `ALIKE`.
    state: Vec<u8>,
    /// `[tiles]`: which row of `reaches`.
    reach: Vec<u32>,
    /// `[different][words]`: a bit per offset that any point of a tile has a partner at.
    reaches: Vec<u64>,
    /// Factors of bonds.
    scale: Scale,
    /// Point fields of the law, per slot (empty where unused).
    fields: [Column; 2],
    /// Pressure factors per slot where materials differ; else the law's own.
    pressure: Column,
    point_constants: PointConstants,
    /// `[tiles][8]`: the next critical values, which sweeps write tile by tile.
    next: Vec<f64>,
    /// The lowest critical value.
    least_critical: f64,
    /// No critical stretch changes any more: none depends on the strain, and the first are known.
    settled: bool,
    /// The highest `e` at which any bond repels.
    most_contact: f64,
    /// Of a whole cell.
    volume: f64,
}

impl<const D: usize, W: Law> StencilInteraction<D, W> {
    /// For kernels that only read.
    fn view<'a>(&'a self, body: &'a Body<D>, u: FieldView<'a, D>) -> View<'a, D, W> {
        let alive = Seen(self.bonds.alive.as_ptr());
        let state = Seen(self.state.as_ptr());
        self.view_of(body, u, alive, state, &self.fields[0])
    }

    fn view_of<'a>(
        &'a self,
        body: &'a Body<D>,
        u: FieldView<'a, D>,
        alive: Seen<u8>,
        state: Seen<u8>,
        own: &'a [f64],
    ) -> View<'a, D, W> {
        let family = &self.bonds.family;
        View {
            law: self.law,
            grid: body.grid(),
            body,
            bonds: &self.stencil,
            partners: &self.partners,
            width: family.width,
            tiles: family.tiles(),
            alive,
            state,
            reach: &self.reach,
            reaches: &self.reaches,
            scale: &self.scale,
            u,
            fields: [own, &self.fields[1]],
            pressure: &self.pressure,
            repulsion: self.bonds.repulsion.as_ref(),
            most_contact: self.most_contact,
        }
    }

    fn sweep<const FULL: bool>(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        f: FieldViewMut<D>,
        motion: Option<Motion<D>>,
    ) -> Tally {
        let alive = Shared(self.bonds.alive.as_mut_ptr());
        let state = Shared(self.state.as_mut_ptr());
        let next = Shared(self.next.as_mut_ptr());
        let next = (!self.settled).then_some(next);
        let kernel = Forces::<D, W, FULL> {
            view: self.view_of(body, u, alive.seen(), state.seen(), &self.fields[0]),
            alive,
            state,
            f: crate::array::from_fn(|a| Shared(f[a].as_mut_ptr())),
            critical: &self.bonds.critical,
            next,
            toughness: &self.bonds.toughness,
            lower: self.most_contact,
            upper: self.least_critical,
            motion,
        };
        self.bonds.blocks.tally(&kernel)
    }

    /// n and 1/m at a slot.
    fn per_weight(&self, body: &Body<D>, slot: usize) -> [f64; 2] {
        let by_weight = || self.fields[1][slot];
        self.point_constants
            .per_weight(body.material_of(slot), by_weight)
    }

    /// Energies of all points, with `Σ k r0² s` in place of the dilatation and `Σ k r0²` of what is whole.
    fn sums(&self, body: &Body<D>, u: FieldView<D>, out: &mut PointEnergiesMut) {
        let kernel = Energies {
            view: self.view(body, u),
            fields: Some(EnergyFields::of(out, body.len)),
        };
        self.bonds.blocks.sum(&kernel);
    }

    /// `P / Σ k r0² s` at a slot.
    fn pressure_factor(&self, i: usize) -> f64 {
        pressure_factor(self.law, &self.pressure, i, || self.fields[1][i])
    }
}

impl<const D: usize, W: Law> Interaction<D> for StencilInteraction<D, W> {
    fn made_for(&self) -> Identity {
        self.bonds.body
    }

    fn family(&self) -> &'static str {
        self.bonds.kind
    }

    unsafe fn forces_unchecked(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        f: FieldViewMut<D>,
        sweep: Sweep<D>,
        seen: Option<&mut PointEnergiesMut>,
    ) -> Tally {
        if let Some(seen) = seen {
            self.sums(body, u, seen);
            if W::SHARES {
                for &slot in &body.slots {
                    let i = slot as usize;
                    self.fields[0][i] = self.pressure_factor(i) * seen.dilatation[i];
                }
            }
            seen.dilate::<W, D>(body, |i| self.per_weight(body, i));
        } else if W::SHARES {
            // it stays where it is: a law that panics must not leave sweeps without
            let out = Shared(self.fields[0].as_mut_ptr());
            let [alive, state] = [&self.bonds.alive, &self.state].map(|all| Seen(all.as_ptr()));
            let view = self.view_of(body, u, alive, state, &[]);
            self.bonds.blocks.run(&Share { view, out });
        }
        if W::SHARES {
            body.exchange.fill(&mut self.fields[0]);
        }
        let motion = sweep.motion();
        let total = if self.bonds.critical.is_empty() {
            self.sweep::<false>(body, u, f, motion)
        } else {
            self.sweep::<true>(body, u, f, motion)
        };
        if motion.is_some() && !self.bonds.critical.is_empty() && !self.settled {
            let mut critical = std::mem::take(&mut self.bonds.critical);
            let kernel = Remember {
                view: self.view(body, u),
                next: &self.next,
                critical: Shared(critical.as_mut_ptr()),
            };
            self.bonds.blocks.run(&kernel);
            self.bonds.critical = critical;
            body.exchange.fill(&mut self.bonds.critical);
            self.least_critical = total.least_critical;
            self.settled = self.bonds.toughness.iter().all(|t| t.alpha == 0.0);
        }
        // a point may have lost its last bond
        self.settled &= total.broken == 0;
        total
    }

    unsafe fn energy_unchecked(&mut self, body: &Body<D>, u: FieldView<D>) -> [f64; 2] {
        let kernel = Energies {
            view: self.view(body, u),
            fields: None,
        };
        self.bonds.blocks.sum(&kernel)
    }

    unsafe fn observe_unchecked(
        &self,
        body: &Body<D>,
        u: FieldView<D>,
        out: &mut PointEnergiesMut,
    ) {
        self.sums(body, u, out);
        out.dilate::<W, D>(body, |i| self.per_weight(body, i));
    }

    unsafe fn tangents_unchecked(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        visit: &mut dyn FnMut(BondTangent<D>),
    ) {
        self.each_tangent(body, u, visit);
    }

    fn each_force(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        visit: &mut dyn FnMut(BondForce<D>),
    ) -> bool {
        self.each_pull(body, u, visit);
        true
    }

    fn virial(&mut self, body: &Body<D>, u: FieldView<D>) -> Option<[f64; 6]> {
        self.check(body, &[u]);
        Some(self.virial_of_pulls(body, u))
    }

    fn gain(&self, slot: usize) -> f64 {
        if W::SHARES {
            self.pressure_factor(slot)
        } else {
            0.0
        }
    }

    fn each_bond(&self, body: &Body<D>, visit: &mut dyn FnMut(usize, usize, [f64; D], BondStatus)) {
        self.bonds.each_pair(body, visit);
    }

    fn mend(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        heals: &dyn Fn(usize, usize, f64) -> bool,
    ) -> Option<u64> {
        self.check(body, &[u]);
        let mended = self.bonds.mend(body, u, heals, &Fused);
        if mended > 0 {
            self.look();
        }
        Some(mended)
    }

    fn each_broken(&self, body: &Body<D>, visit: &mut dyn FnMut(usize, usize, [f64; D])) {
        let torn = |n: usize| self.state[n] & WHOLE == 0;
        self.bonds.each_broken_of(body, torn, visit);
    }

    fn damage(&self, body: &Body<D>, out: &mut [f64]) {
        // all points of a lattice are alike
        self.bonds.damage_of(body, |_| 1.0, out);
    }

    fn cut(
        &mut self,
        body: &Body<D>,
        kind: CrackKind,
        crosses: &(dyn Fn([f64; D], [f64; D]) -> bool + Sync),
    ) -> u64 {
        let image = |end: usize, j: usize| end != j;
        let cut = self.bonds.cut(body, kind, crosses, image, &Fused);
        self.look();
        cut
    }

    fn scale_bonds(
        &mut self,
        _: &Body<D>,
        factors: &dyn Fn(usize, usize, [i32; D]) -> BondFactors<f64>,
    ) -> Result<(), BuildError> {
        self.multiply_factors(factors);
        Ok(())
    }

    fn reached(&self, _: &Body<D>, i: usize, xi: [f64; D]) -> Option<(f64, BondFactors<f64>)> {
        self.reach(i, xi)
    }

    fn prepare(&mut self, body: &Body<D>) {
        self.check(body, &[]);
        self.weigh(body);
    }

    fn directed_bonds(&self) -> u64 {
        self.bonds.directed
    }

    fn family_size(&self, _: &Body<D>, slot: usize) -> usize {
        self.bonds.family_size(slot)
    }

    fn in_family(&self, body: &Body<D>, i: usize, j: usize) -> bool {
        self.bonds.family.joins(body, i, j)
    }

    fn columns(&self) -> Vec<Declaration> {
        self.bonds.declared()
    }

    fn read_column(&self, body: &Body<D>, _: FieldView<D>, name: &str, out: &mut Vec<f64>) -> bool {
        self.bonds.read_named(body, name, &Fused, out)
    }

    fn write_column(&mut self, body: &Body<D>, name: &str, values: &[f64]) -> bool {
        if !self.bonds.write_named(body, name, values, &Fused) {
            return false;
        }
        match name {
            history::WHOLE => {
                self.settled = false;
                self.look();
            }
            _ => self.look_critical(body),
        }
        true
    }

    fn archive(&mut self, body: &Body<D>, archive: &mut Archive<'_>) {
        self.bonds.archive(body, archive, &Fused);
        if archive.loads() {
            if !self.bonds.critical.is_empty() {
                body.exchange.fill(&mut self.bonds.critical);
            }
            self.look_critical(body);
            self.look();
        }
    }

    fn each_directed(
        &self,
        body: &Body<D>,
        _: &str,
        visit: &mut dyn FnMut(usize, usize, [f64; D]),
    ) {
        self.bonds.each_directed(body, visit);
    }

    fn memory(&self) -> (&[u8], &[f64]) {
        (&self.bonds.alive, &self.bonds.critical)
    }

    fn bytes(&self) -> usize {
        let words =
            self.fields[0].len() + self.fields[1].len() + self.pressure.len() + self.next.len();
        self.bonds.bytes()
            + self.state.len()
            + self.scale.bytes()
            + 4 * self.reach.len()
            + 8 * self.reaches.len()
            + 8 * words
    }
}
