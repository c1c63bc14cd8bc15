//! Any law on a horizon list: bonds of an arbitrary cloud. A bond is a partner and a bit; its geometry and constant
//! are computed anew from two records whenever it is met, so that nothing else is stored.

mod assemble;
mod images;
mod kernel;
mod weights;

use super::bonds::{AnyBonds, BondState, CloudFamily};
use super::history;
use super::pairs::BondTable;
use super::point_constants::pressure_factor;
use super::{
    BondForce, BondTangent, EachForce, EachTangent, EnergyFields, FactorsOf, Gradient, Interaction,
    Motion, PointConstants, PointEnergiesMut, Sweep, Tally, along,
};
use crate::body::{Body, FieldView, FieldViewMut, Identity, view_mut, zeros};
use crate::error::BuildError;
use crate::execute::blocks::{Seen, Shared};
use crate::law::{BondFactors, Law};
pub use assemble::ListParts;
use images::Images;
use kernel::{Energies, Forces, Share, View};
use std::sync::Arc;

/// A law on a horizon list.
pub struct ListInteraction<const D: usize, W: Law> {
    /// Its records of displacements have the critical `e` as their fourth number, and materials are known where repulsion or the law depends on them.
    bonds: BondState<D, CloudFamily<D>>,
    law: W,
    /// `[lines][8]`: factors of bonds; empty: all are 1.
    scale: Vec<f64>,
    /// `[slots][2]`: point fields of the law (empty where unused).
    fields: Vec<f64>,
    /// Pressure factors per slot where materials differ; else the law's own.
    pressure: Vec<f64>,
    point_constants: PointConstants,
    /// Constants of bonds of pairs of materials, if the law is that of unit constants; else empty.
    pairs: Arc<BondTable>,
    /// Are there points whose bonds never break?
    spares: bool,
}

impl<const D: usize, W: Law> ListInteraction<D, W> {
    /// For kernels that only read.
    fn view<'a>(&'a self, moved: &'a [f64]) -> View<'a, D, W> {
        let alive = Seen(self.bonds.alive.as_ptr());
        let fields = Seen(self.fields.as_ptr());
        self.view_of(moved, alive, fields)
    }

    fn view_of<'a>(&'a self, moved: &'a [f64], alive: Seen<u8>, fields: Seen) -> View<'a, D, W> {
        let family = &self.bonds.family;
        View {
            law: self.law,
            weight: family.weight,
            list: &family.list,
            alive,
            scale: &self.scale,
            reference: &family.reference,
            moved,
            fields,
            pressure: &self.pressure,
            period: family.period,
            inv_period: family.inv_period,
            repulsion: self.bonds.repulsion.as_ref(),
            materials: &self.bonds.material,
            periodic: family.is_periodic(),
            paired: self.pairs.materials() > 0,
            pairs: &self.pairs,
        }
    }

    /// Write displacements and critical stretches into the records.
    fn pack_now(&mut self, u: FieldView<D>) {
        let mut moved = std::mem::take(&mut self.bonds.workspace.records);
        self.bonds.pack(u, &mut moved);
        self.bonds.workspace.records = moved;
    }

    fn moved(&self) -> &[f64] {
        &self.bonds.workspace.records
    }

    /// Pressures of this state.
    fn share(&mut self, body: &Body<D>) {
        let alive = Seen(self.bonds.alive.as_ptr());
        let fields = Shared(self.fields.as_mut_ptr());
        let kernel = Share::<D, W> {
            view: self.view_of(self.moved(), alive, fields.seen()),
            fields,
        };
        self.bonds.blocks.run(&kernel);
        self.tell_pressures(body);
    }

    /// Those of points, to their copies.
    fn tell_pressures(&mut self, body: &Body<D>) {
        let pressures = &mut self.fields;
        body.exchange.fill_numbers(pressures, 1, |slot, _| 2 * slot);
    }

    fn sweep<const FULL: bool>(
        &mut self,
        body: &Body<D>,
        f: FieldViewMut<D>,
        motion: Option<Motion<D>>,
    ) -> Tally {
        let alive = Shared(self.bonds.alive.as_mut_ptr());
        let fields = Seen(self.fields.as_ptr());
        let next = Shared(self.bonds.next.as_mut_ptr());
        let kernel = Forces::<D, W, FULL> {
            view: self.view_of(self.moved(), alive.seen(), fields),
            alive,
            f: crate::array::from_fn(|a| Shared(f[a].as_mut_ptr())),
            next,
            toughness: &self.bonds.toughness,
            spares: self.spares,
            material: &body.material,
            motion,
        };
        self.bonds.blocks.tally(&kernel).0
    }

    /// n and 1/m at a slot.
    fn per_weight(&self, body: &Body<D>, slot: usize) -> [f64; 2] {
        let by_weight = || self.fields[2 * slot + 1];
        self.point_constants
            .per_weight(body.material_of(slot), by_weight)
    }

    /// Energies of all points, with `Σ k r0² s` in place of the dilatation and `Σ k r0²` of what is whole.
    fn sums(&self, body: &Body<D>, u: FieldView<D>, out: &mut PointEnergiesMut) {
        let mut moved = vec![0.0; 4 * body.len];
        self.bonds.pack(u, &mut moved);
        self.sums_of(body, self.view(&moved), out);
    }

    /// The same of what a view shows.
    fn sums_of(&self, body: &Body<D>, view: View<D, W>, out: &mut PointEnergiesMut) {
        let kernel = Energies {
            view,
            fields: Some(EnergyFields::of(out, body.len)),
        };
        self.bonds.blocks.sum(&kernel);
    }

    /// `P / Σ k r0² s` at a slot.
    fn pressure_factor(&self, i: usize) -> f64 {
        pressure_factor(self.law, &self.pressure, i, || self.fields[2 * i + 1])
    }
}

impl<const D: usize, W: Law> Interaction<D> for ListInteraction<D, W> {
    fn made_for(&self) -> Identity {
        self.bonds.body
    }

    fn bonds(&self) -> Option<&dyn AnyBonds<D>> {
        Some(&self.bonds)
    }

    fn bonds_mut(&mut self) -> Option<&mut dyn AnyBonds<D>> {
        Some(&mut self.bonds)
    }

    fn look_critical(&mut self, _: &Body<D>) {
        self.spares = self.bonds.critical.contains(&history::NEVER);
    }

    unsafe fn forces_unchecked(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        f: FieldViewMut<D>,
        sweep: Sweep<D>,
        seen: Option<&mut PointEnergiesMut>,
    ) -> Tally {
        self.pack_now(u);
        if let Some(seen) = seen {
            self.sums(body, u, seen);
            if W::SHARES {
                for &slot in &body.slots {
                    let i = slot as usize;
                    self.fields[2 * i] = self.pressure_factor(i) * seen.dilatation[i];
                }
                self.tell_pressures(body);
            }
            seen.dilate::<W, D>(body, |i| self.per_weight(body, i));
        } else if W::SHARES {
            self.share(body);
        }
        let motion = sweep.motion();
        let total = if self.bonds.critical.is_empty() {
            self.sweep::<false>(body, f, motion)
        } else {
            self.sweep::<true>(body, f, motion)
        };
        if motion.is_some() && !self.bonds.critical.is_empty() {
            self.bonds.next_critical(body);
        }
        total
    }

    unsafe fn energy_unchecked(&mut self, _: &Body<D>, u: FieldView<D>) -> [f64; 2] {
        self.pack_now(u);
        let kernel = Energies {
            view: self.view(self.moved()),
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

    fn observe_gradient(&self, body: &Body<D>, gradient: &Gradient<D>, out: &mut PointEnergiesMut) {
        self.check(body, &[]);
        let images = Images::new(self);
        let mut moved = vec![0.0; images.reference.len()];
        for (u, x) in moved.chunks_mut(4).zip(images.reference.chunks(4)) {
            u[..D].copy_from_slice(&along(gradient, x));
        }
        self.sums_of(body, images.view(self, &moved), out);
        out.dilate::<W, D>(body, |i| self.per_weight(body, i));
    }

    unsafe fn tangents_unchecked(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        visit: &mut EachTangent<D>,
    ) {
        if W::SHARES {
            // the pressures of this state
            self.forces(body, u, view_mut(&mut zeros(body.len)), Sweep::Hold, None);
        }
        let view = self.view(self.moved());
        self.each_line(|place, whole, [i, j]| {
            if !whole {
                return;
            }
            let (xi, share) = view.constant(i, j);
            let mut k = share / xi.iter().map(|x| x * x).sum::<f64>();
            let mut fields = [i, j].map(|s| self.field(s));
            let length = xi.iter().map(|x| x * x).sum::<f64>().sqrt();
            k = self.law.between_ends(k, &xi, length, fields[0], fields[1]);
            k *= self.factor(place);
            if view.paired {
                let pair = self.pairs.get(body.material_of(i), body.material_of(j));
                k *= pair.stiffness;
                fields.iter_mut().for_each(|f| f[0] *= pair.ratio());
            }
            let mut tangent = BondTangent::of_law(
                self.law,
                [i, j],
                k,
                BondFactors::ONE,
                xi,
                crate::array::from_fn(|a| u[a][j] - u[a][i]),
                fields,
            );
            if view.paired && W::SHARES {
                // the scalar is that of unit constants
                let pair = self.pairs.get(body.material_of(i), body.material_of(j));
                tangent.share = tangent.share.map(|x| x / pair.stiffness);
                tangent.pull = tangent.pull.map(|p| p.map(|x| x * pair.ratio()));
            }
            visit(tangent);
        });
    }

    fn gain(&self, slot: usize) -> f64 {
        if W::SHARES {
            self.pressure_factor(slot)
        } else {
            0.0
        }
    }

    fn each_force(&mut self, body: &Body<D>, u: FieldView<D>, visit: &mut EachForce<D>) -> bool {
        self.check(body, &[u]);
        self.pack_now(u);
        if W::SHARES {
            self.share(body);
        }
        let view = self.view(self.moved());
        self.each_line(|place, whole, [i, j]| {
            let (pull, y) = view.pull_of(i, j, whole.then(|| self.factor(place)));
            if pull[0] != 0.0 {
                visit(BondForce::central([i, j], y, pull));
            }
        });
        true
    }

    fn scale_bonds(&mut self, body: &Body<D>, factors: &FactorsOf<D>) -> Result<(), BuildError> {
        self.check(body, &[]);
        match W::SHARES {
            true => Err(BuildError::unsupported(
                "bonds",
                "in a state-based law a bond also acts through the pressure of its ends, and the factors of a list are those of its own force",
            )
            .help("take pmb, or leave the factors out")),
            false => {
                self.multiply_factors(factors);
                Ok(())
            }
        }
    }

    fn prepare(&mut self, body: &Body<D>) {
        self.check(body, &[]);
        self.weigh(body);
    }

    fn bytes(&self) -> usize {
        let words = self.fields.len() + self.pressure.len() + self.scale.len();
        self.bonds.bytes() + self.pairs.bytes() + 8 * words
    }
}
