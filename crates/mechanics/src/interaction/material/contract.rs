//! What every [`Interaction`] answers.

use super::MaterialInteraction;
use super::tangents::Tangents;
use crate::body::{Body, FieldView, FieldViewMut, Identity};
use crate::error::BuildError;
use crate::execute::lane::TILE;
use crate::interaction::bonds::AnyBonds;
use crate::interaction::bonds::family::{Family, Slots};
use crate::interaction::bonds::view::{BondView, grown};
use crate::interaction::{
    BondFatigue, BondForce, EachForce, EachTangent, FactorsOf, Gradient, Interaction,
    PointEnergiesMut, Sweep, Tally,
};
use crate::law::material::part_of;
use crate::spec::Cycles;
use std::collections::HashMap;

impl<const D: usize, F: Family<D>> Interaction<D> for MaterialInteraction<D, F> {
    fn made_for(&self) -> Identity {
        self.bonds.body
    }

    fn bonds(&self) -> Option<&dyn AnyBonds<D>> {
        Some(&self.bonds)
    }

    fn bonds_mut(&mut self) -> Option<&mut dyn AnyBonds<D>> {
        Some(&mut self.bonds)
    }

    unsafe fn forces_unchecked(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        f: FieldViewMut<D>,
        sweep: Sweep<D>,
        seen: Option<&mut PointEnergiesMut>,
    ) -> Tally {
        self.evolve(body, u, f, sweep.motion(), seen)
    }

    /// How stiff its points are then.
    fn begin_steps(&mut self, body: &Body<D>) {
        self.check(body, &[]);
        self.bonds.begin_stiffness(body);
    }

    fn shortest(&mut self, body: &Body<D>, u: FieldView<D>) -> f64 {
        self.check(body, &[u]);
        // of the largest frequency, which goes with the root of the stiffness
        let damaged = self.bonds.stiffened.sqrt().recip();
        match self.bonds.law.stiffens {
            true => damaged * (1.0 - self.bonds.shortest(u)).max(0.0).sqrt(),
            false => damaged,
        }
    }

    unsafe fn energy_unchecked(&mut self, body: &Body<D>, u: FieldView<D>) -> [f64; 2] {
        let workspace = self.take_workspace(u, self.bonds.step);
        let sums = self.energies(body, u, &workspace, None);
        self.bonds.workspace = workspace;
        sums
    }

    unsafe fn observe_unchecked(
        &self,
        body: &Body<D>,
        u: FieldView<D>,
        out: &mut PointEnergiesMut,
    ) {
        self.seen(body, u, &self.look_room(u), out);
    }

    fn observe_gradient(&self, body: &Body<D>, gradient: &Gradient<D>, out: &mut PointEnergiesMut) {
        self.check(body, &[]);
        out.zeros(body.len);
        let constants = self.constants().constants;
        let bonds = &self.bonds;
        for (group, l, slot) in bonds.family.points() {
            let at = bonds.plain_point(&constants, slot);
            let whole = bonds.bonds_of(group, l).into_iter();
            let whole = whole.map(|b| {
                let end = bonds.family.ends(group, b.0).slot(l);
                let others = bonds.plain_constants(&constants, end);
                (b, [bonds.memory_at(group, b.0, l), others])
            });
            let found = (self.law).strained(&at, &whole.collect::<Vec<_>>(), gradient);
            out.strain[slot] = part_of(bonds.integrity_at(slot), found[0]);
            out.dilatation[slot] = found[1];
            out.whole[slot] = found[2];
        }
        bonds.dilate(out);
    }

    unsafe fn tangents_unchecked(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        visit: &mut EachTangent<D>,
    ) {
        let tangents = Tangents {
            law: &*self.law,
            bonds: &self.bonds,
            constants: &self.constants().constants,
            u,
        };
        tangents.each(body, visit);
    }

    fn stress_borne(&mut self, body: &Body<D>, u: FieldView<D>) -> Option<Vec<f64>> {
        self.check(body, &[u]);
        self.stress(body, u)
    }

    fn work_borne(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        visit: &mut dyn FnMut(usize, usize, [f64; D], f64),
    ) -> bool {
        self.check(body, &[u]);
        self.works(body, u, visit)
    }

    fn bond_limit(&self, ends: [usize; 2], xi: &[f64; D], critical: [f64; 2]) -> f64 {
        self.bonds.bond_limit(ends, xi, critical)
    }

    fn each_force(&mut self, body: &Body<D>, u: FieldView<D>, visit: &mut EachForce<D>) -> bool {
        self.check(body, &[u]);
        let workspace = self.take_workspace(u, self.bonds.step);
        self.point_update(body, u, &workspace);
        let law = self.asked(self.bonds.view(u, &workspace));
        let family = &self.bonds.family;
        // force states of both ends, and the own ones where they are told, of groups some of whose points are still to come: ids need not be in their order
        let mut open: HashMap<usize, ([Vec<f64>; 2], usize)> = HashMap::new();
        let mut free: Vec<[Vec<f64>; 2]> = vec![];
        for &s in &body.slots {
            let Some((group, l)) = family.find(s as usize) else {
                continue;
            };
            let (all, left) = open.entry(group).or_insert_with(|| {
                let mut all = free.pop().unwrap_or_default();
                law.bond_forces(group, false, &mut all[0]);
                if self.bonds.law.potential {
                    law.bond_forces(group, true, &mut all[1]);
                }
                (all, family.points_of(group..group + 1).count())
            });
            for k in (0..family.bonds(group)).filter(|k| family.is_bond(group, *k, l)) {
                let of = |all: &[f64], a: usize| all.get((k * D + a) * TILE + l).copied();
                let states = [&all[0], &all[1]]
                    .map(|all| crate::array::from_fn(|a| of(all, a).unwrap_or(0.0)));
                let bond = self.pull_of(&law.bonds, body, [group, k, l], states);
                if bond.force != [0.0; D] {
                    visit(BondForce {
                        i: s as usize,
                        j: body.exchange.original(bond.j),
                        ..bond
                    });
                }
            }
            *left -= 1;
            if *left == 0 {
                free.extend(open.remove(&group).map(|(all, _)| all));
            }
        }
        self.bonds.workspace = workspace;
        true
    }

    fn scale_bonds(&mut self, _: &Body<D>, _: &FactorsOf<D>) -> Result<(), BuildError> {
        Err(BuildError::unsupported(
            "bonds",
            "bond stiffness scaling and surface corrections multiply forces that follow from the stretch of a bond and the dilatation of its ends; the bonds of this body depend on more: history (work, stress or strain that they break by, plastic flow), expansion, or tensors",
        )
        .help("leave both out, or take a law with fused kernels (pmb, lps, lps_3d, eam_like) without expansion, which breaks by critical_stretch or energy"))
    }

    fn prepare(&mut self, body: &Body<D>) {
        self.check(body, &[]);
        self.bonds.prepared = true;
        self.bonds.look(body);
    }

    fn expand(&mut self, body: &Body<D>, strain: &[f64]) -> bool {
        self.check(body, &[]);
        assert_eq!(strain.len(), body.len, "a strain for each slot");
        self.bonds.expand(strain)
    }

    fn add_stress_across(&mut self, body: &Body<D>, u: FieldView<D>, trace: &mut [f64]) -> bool {
        self.check(body, &[u]);
        assert_eq!(trace.len(), body.len, "a number for each slot");
        if self.bonds.held.is_empty() {
            return true;
        }
        if !self.bonds.law.across {
            let known = self.bonds.held.iter().all(Option::is_some);
            for &s in &body.slots {
                let i = s as usize;
                let [poisson, stiff] = self.bonds.elastic_across(self.bonds.material_at(i));
                let strain = self.bonds.expansion.get(i).copied().unwrap_or(0.0);
                trace[i] += poisson * trace[i] - self.bonds.integrity_at(i) * stiff * strain;
            }
            return known;
        }
        // bonds that remember tell their point at the end of a step, and these displacements are those of no end
        if self.bonds.law.gathers {
            return false;
        }
        let workspace = self.take_workspace(u, self.bonds.step);
        self.point_update(body, u, &workspace);
        for slot in body.slots.iter().map(|s| *s as usize) {
            if self.bonds.family.find(slot).is_some() {
                let at = self.bonds.plain_point(&workspace.constants, slot);
                let across = self.law.across(&at, &self.bonds.point.numbers(slot));
                trace[slot] += part_of(self.bonds.integrity_at(slot), across);
            }
        }
        self.bonds.workspace = workspace;
        true
    }

    fn warm(&mut self, body: &Body<D>, above: &[f64]) -> bool {
        self.check(body, &[]);
        assert_eq!(above.len(), body.len, "a temperature for each slot");
        self.bonds.warm(body, above)
    }

    fn read_warmth(&self, body: &Body<D>, above: &mut [f64]) {
        self.check(body, &[]);
        assert_eq!(above.len(), body.len, "a temperature for each slot");
        self.bonds.read_warmth(body, above);
    }

    fn last(&mut self, step: f64) {
        self.bonds.step = step;
    }

    fn fatigue_of_bonds(
        &self,
        body: &Body<D>,
        u: FieldView<D>,
        load: &Cycles,
    ) -> Option<Vec<BondFatigue>> {
        self.check(body, &[u]);
        self.bonds.fatigue_of_bonds(body, u, load)
    }

    fn accumulate_fatigue(&mut self, bonds: &mut dyn Iterator<Item = BondFatigue>, cycles: f64) {
        self.bonds.accumulate_fatigue(bonds, cycles);
    }

    fn bytes(&self) -> usize {
        self.bonds.bytes()
    }
}

impl<const D: usize, F: Family<D>> MaterialInteraction<D, F> {
    /// A bond with what its force states do, repulsion among it; slots are those of the family.
    fn pull_of(
        &self,
        seen: &BondView<D, F>,
        body: &Body<D>,
        [group, k, l]: [usize; 3],
        [mut force, mut own]: [[f64; D]; 2],
    ) -> BondForce<D> {
        let family = &self.bonds.family;
        let [rows, ends] = [family.rows(group), family.ends(group, k)].map(|s| s.from(l));
        let r = family.plain(group, k, l);
        let whole = self.bonds.is_whole(group, k, l);
        let weight = if whole { r.weight } else { 0.0 };
        let mut per_length = 1.0;
        if !seen.expansion.is_empty() {
            // SAFETY: slots of the family
            [_, per_length] = unsafe { grown(seen.expansion, rows, ends) };
        }
        for a in 0..D {
            force[a] = per_length * (weight * force[a]);
            own[a] *= weight * per_length;
        }
        let pushed = self.bonds.pushed(body);
        if let Some(push) = { pushed }.and_then(|p| p.of(family, &seen.moved, group, k, l)) {
            for a in 0..D {
                force[a] += push.pull * push.y[a];
                own[a] += 0.5 * push.pull * push.y[a];
            }
        }
        // SAFETY: slots of the family
        let [ui, uj] = [rows, ends].map(|s| unsafe { F::displacement::<f64>(&seen.moved, s) });
        BondForce {
            i: rows.slot(0),
            j: ends.slot(0),
            y: crate::array::from_fn(|a| r.xi[a] + uj[a] - ui[a]),
            force,
            own: self.bonds.law.potential.then_some(own),
        }
    }
}
