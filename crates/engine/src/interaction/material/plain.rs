//! One bond after the other, in plain numbers: homogeneous strains, forces bond by bond, what a bond bears.

use super::breaking::fibre_limit;
use super::family::{Family, Slots};
use super::sweeps::{own_pull, pull};
use super::{MaterialInteraction, Room};
use crate::body::{Body, FieldView, view};
use crate::execute::lane::TILE;
use crate::interaction::{BondForce, PointEnergiesMut, along, history};
use crate::law::material::{Bond, End, Material, Numbers, Site, part_of};

impl<const D: usize, F: Family<D>, M: Material<D>> MaterialInteraction<D, F, M> {
    /// What [`Interaction::bond_limit`](crate::interaction::Interaction::bond_limit) answers where there are fibres.
    pub(super) fn limit_of(&self, ends: [usize; 2], xi: &[f64; D], critical: [f64; 2]) -> f64 {
        let of = |n: usize| {
            let material = self.material.get(ends[n]).map_or(0, |m| usize::from(*m));
            match self.fibres.get(material) {
                Some(f) => fibre_limit(&f.direction, f.critical, critical[n], xi),
                None => critical[n],
            }
        };
        history::limit(of(0), of(1))
    }

    /// ξ, ω and `ν V` of the whole bonds of a point, with their places.
    pub(super) fn bonds_of(&self, group: usize, l: usize) -> Vec<(usize, [f64; D], f64, f64)> {
        let mut all = vec![];
        for k in (0..self.family.bonds(group)).filter(|k| self.is_whole(group, *k, l)) {
            let r = self.family.plain(group, k, l);
            all.push((k, r.xi, r.omega, r.weight));
        }
        all
    }

    /// Dilatations from `Σ ω ν V |ξ|² s` over the whole bonds: over the weighted volume of those that count, broken or not, where the law
    /// takes it so, else over that of the whole ones; and what part of it is whole, or how much.
    pub(super) fn dilate(&self, out: &mut PointEnergiesMut) {
        let of_family = M::PASSES > 0 && !M::FORM_OF_WHOLE;
        let points = (0..self.family.groups()).flat_map(|g| (0..TILE).map(move |l| (g, l)));
        for (group, l) in points.filter(|(g, l)| self.family.is_point(*g, *l)) {
            let i = self.family.rows(group).slot(l);
            let whole = out.whole[i];
            let weight = if of_family {
                let gone = |k: &usize| {
                    let byte = self.family.byte(group, *k);
                    (self.counted[byte] & !self.alive[byte]) >> l & 1 == 1
                };
                let of_bond = |k: usize| {
                    let r = self.family.plain(group, k, l);
                    r.omega * r.weight * (r.length * r.length)
                };
                let bonds = 0..self.family.bonds(group);
                whole + bonds.filter(gone).map(of_bond).sum::<f64>()
            } else {
                whole
            };
            if weight > 0.0 {
                out.dilatation[i] *= D as f64 / weight;
            }
            if of_family && weight > 0.0 {
                out.whole[i] /= weight;
            }
        }
    }

    /// Energies under a homogeneous displacement gradient.
    pub(super) fn strained(
        &self,
        body: &Body<D>,
        gradient: &[[f64; D]; D],
        out: &mut PointEnergiesMut,
    ) {
        out.zeros(body.len);
        let u = crate::body::zeros(0);
        let room = Room {
            constants: self.constants(self.step),
            ..Room::default()
        };
        let view = self.view(view(&u), &room);
        for group in 0..self.family.groups() {
            for l in (0..TILE).filter(|l| self.family.is_point(group, *l)) {
                let rows = self.family.rows(group).from(l);
                let slot = rows.slot(0);
                // SAFETY: rows of the family
                let (constants, form, past) = unsafe {
                    (
                        view.constants_at::<f64>(rows),
                        rows.load::<f64, M::Form<f64>>(view.form),
                        rows.load::<f64, M::Past<f64>>(view.past),
                    )
                };
                let site = Site {
                    constants: &constants,
                    form: &form,
                    past: &past,
                    // SAFETY: rows of the family
                    around: unsafe { view.around::<f64>(rows) },
                };
                let bonds = self.bonds_of(group, l);
                let bond = |xi: &[f64; D], omega: f64| Bond::new(*xi, along(gradient, xi), omega);
                let mut point = <M::Point<f64> as Numbers<f64>>::constant(0.0);
                let mut sum = <M::Sum<f64> as Numbers<f64>>::constant(0.0);
                for pass in 0..M::PASSES {
                    sum = <M::Sum<f64> as Numbers<f64>>::constant(0.0);
                    for (k, xi, omega, weight) in &bonds {
                        // SAFETY: a bond of the family
                        let memory = unsafe { view.memory::<f64>(group, *k, l) };
                        let end = End {
                            constants: &constants,
                            point: &point,
                            memory: &memory,
                        };
                        sum = sum.plus(*weight, self.law.share(pass, &bond(xi, *omega), &end));
                    }
                    self.law.settle(pass, &site, sum, &mut point);
                }
                let mut energy = self.law.point_energy(&site, sum, &point);
                let (mut share, mut whole) = (0.0, 0.0);
                for (k, xi, omega, weight) in &bonds {
                    // SAFETY: a bond of the family
                    let memory = unsafe { view.memory::<f64>(group, *k, l) };
                    let end = End {
                        constants: &constants,
                        point: &point,
                        memory: &memory,
                    };
                    let bond = bond(xi, *omega);
                    energy += weight * self.law.energy(&bond, &end);
                    let part = weight * omega * bond.length * bond.length;
                    share += part * bond.stretch;
                    whole += part;
                }
                out.strain[slot] = part_of(self.integrity_at(slot), energy);
                out.whole[slot] = whole;
                out.dilatation[slot] = share;
            }
        }
        self.dilate(out);
    }

    /// Adds the stress across a body in plane strain to σ_xx + σ_yy of every slot, at displacements that are settled. False: it is not known.
    pub(super) fn add_across(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        trace: &mut [f64],
    ) -> bool {
        if !M::ACROSS {
            let known = self.held.iter().all(Option::is_some);
            for &s in &body.slots {
                let i = s as usize;
                let [poisson, stiff] = self.elastic_across(self.material_at(i));
                let strain = self.expansion.get(i).copied().unwrap_or(0.0);
                trace[i] += poisson * trace[i] - self.integrity_at(i) * stiff * strain;
            }
            return known;
        }
        // bonds that remember tell their point at the end of a step, and these displacements are those of no end
        if M::GATHERS {
            return false;
        }
        let room = self.take_room(u, self.step);
        self.settle(body, u, &room);
        let view = self.view(u, &room);
        for &s in &body.slots {
            let Some((group, l)) = self.family.find(s as usize) else {
                continue;
            };
            // SAFETY: a point of the family
            trace[s as usize] += unsafe {
                let at = view.group::<f64>(group, l);
                view.across::<f64>(&at, &view.point::<f64>(at.rows))
            };
        }
        self.room = room;
        true
    }

    /// Of a material in plane strain: ν, and `E` per strain by temperature or swelling, which of laws without a section is (1 + ν) times as large.
    pub(super) fn elastic_across(&self, material: usize) -> [f64; 2] {
        let [poisson, twice_shear] = self.held[material].unwrap_or_default();
        let grown = if M::SECTION { 1.0 + poisson } else { 1.0 };
        [poisson, grown * twice_shear]
    }

    /// Forces bond by bond, in order of slots.
    pub(super) fn each_pull(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        visit: &mut dyn FnMut(BondForce<D>),
    ) {
        let room = self.take_room(u, self.step);
        self.settle(body, u, &room);
        let view = self.view(u, &room);
        let original = body.originals();
        let pushed = self.pushed(body);
        for &s in &body.slots {
            let Some((group, l)) = self.family.find(s as usize) else {
                continue;
            };
            for k in 0..self.family.bonds(group) {
                if !self.family.is_bond(group, k, l) {
                    continue;
                }
                let j = self.family.ends(group, k).slot(l);
                // SAFETY: a bond of the family
                let (mut force, mut own, y) = unsafe {
                    let at = view.group::<f64>(group, l);
                    let point = view.point::<f64>(at.rows);
                    let force = pull::<f64, D, F, M>(&view, &at, &point, k, l);
                    let own = own_pull::<f64, D, F, M>(&view, &at, &point, k, l);
                    let uj =
                        F::displacement::<f64>(&view.moved, self.family.ends(group, k).from(l));
                    let (xi, _) = self.family.bond(group, k, l);
                    let y: [f64; D] = std::array::from_fn(|a| xi[a] + uj[a] - at.u[a]);
                    (force, own, y)
                };
                if let Some(push) = pushed
                    .as_ref()
                    .and_then(|p| p.of(&self.family, &view.moved, group, k, l))
                {
                    for a in 0..D {
                        force[a] += push.pull * push.y[a];
                        own[a] += 0.5 * push.pull * push.y[a];
                    }
                }
                if force != [0.0; D] {
                    visit(BondForce {
                        i: s as usize,
                        j: original(j),
                        y,
                        force,
                        own: M::POTENTIAL.then_some(own),
                    });
                }
            }
        }
        self.room = room;
    }
}
