//! What bonds are measured by that break by more than their stretch: work, stress or strain of their points, cycles of load.

use super::MaterialInteraction;
use super::Room;
use super::family::{Family, Slots, put};
use super::sweeps::{answers, pull_of};
use super::view::View;
use crate::body::{Body, Column, Field, FieldView, view, zeros};
use crate::execute::blocks::{Shared, run_blocks};
use crate::execute::lane::{Lane, TILE};
use crate::execute::simd::Kernel;
use crate::interaction::bond::relative_square_stretch;
use crate::interaction::criterion::{Measure, SPENT, Wearing};
use crate::interaction::history;
use crate::law::material::{ForceState, Material};
use crate::spec::Cycles;

/// The end of the step before, from which the work of a step is counted.
pub struct Before<const D: usize> {
    pub u: Field<D>,
    pub records: Vec<f64>,
    pub expansion: Column,
}

/// Half of the work of a step on bonds, by the forces at one of its ends: `½ (T_i − T_j)·Δη`.
pub struct Work<'a, const D: usize, F, M> {
    /// Where the forces are.
    pub view: View<'a, D, F, M>,
    /// The other end of the step.
    pub other: View<'a, D, F, M>,
    /// ½ towards the other end, −½ away from it.
    pub part: f64,
    /// A number for every directed bond.
    pub work: Shared,
}

impl<const D: usize, F: Family<D>, M: Material<D>> Kernel for Work<'_, D, F, M> {
    type Out = ();
    const SELDOM: bool = true;

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        let v = &self.view;
        for group in v.block(block) {
            // SAFETY: groups of the family; each is written by one block
            unsafe {
                let at = v.group::<L>(group, 0);
                let there = self.other.group::<L>(group, 0);
                let point = v.point::<L>(at.rows);
                for k in 0..v.family.bonds(group) {
                    let ends = v.family.ends(group, k);
                    let dead = v.dead(&at, k);
                    let (pull, bond, _) = pull_of::<L, D, F, M>(v, &at, &point, k, 0);
                    let (other, _) = self.other.bond::<L>(&there, k, ends, dead);
                    let mut done = pull[0] * (other.eta[0] - bond.eta[0]);
                    for a in 1..D {
                        done = pull[a].fma(other.eta[a] - bond.eta[a], done);
                    }
                    let place = self.work.at(v.family.own(group, k, 0, 1));
                    let sum = L::splat(self.part).fma(done, L::load(place));
                    L::select(dead, L::load(place), sum).store(place);
                }
            }
        }
    }
}

/// Von Mises stress of points over its limit, of the stress `Σ ν V_j T⟨ξ⟩⊗(ξ+η)` (per reference volume), whose mean over both orders of
/// indices is taken.
pub struct VonMises<'a, const D: usize, F, M> {
    pub view: View<'a, D, F, M>,
    pub body: &'a Body<D>,
    pub limit: &'a [f64],
    /// Per material in plane strain, and empty else: σ_zz over σ_xx + σ_yy, and what it is less by the strain that temperature gives.
    pub across: &'a [[f64; 2]],
    pub out: Shared,
}

impl<const D: usize, F: Family<D>, M: Material<D>> Kernel for VonMises<'_, D, F, M> {
    type Out = ();
    const SELDOM: bool = true;

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        let v = &self.view;
        for group in v.block(block) {
            // SAFETY: groups of the family; each is written by one block
            unsafe {
                let at = v.group::<L>(group, 0);
                let point = v.point::<L>(at.rows);
                let mut stress = [[L::splat(0.0); D]; D];
                for k in 0..v.family.bonds(group) {
                    let ends = v.family.ends(group, k);
                    let (bond, weight) = v.bond::<L>(&at, k, ends, v.dead(&at, k));
                    let own = answers::<L, D, F, M>(v, &at, &point, k, 0, &bond).alone(&bond);
                    for r in 0..D {
                        let force = weight * own[r];
                        for c in 0..D {
                            stress[r][c] = force.fma(bond.xi[c] + bond.eta[c], stress[r][c]);
                        }
                    }
                }
                let half = L::splat(0.5);
                let (mut trace, mut square) = (L::splat(0.0), L::splat(0.0));
                for r in 0..D {
                    trace = trace + stress[r][r];
                    for c in 0..D {
                        let mean = half * (stress[r][c] + stress[c][r]);
                        square = mean.fma(mean, square);
                    }
                }
                let per = |of: &dyn Fn(usize) -> f64| -> [f64; TILE] {
                    std::array::from_fn(|l| of(self.body.material_of(at.rows.slot(l))))
                };
                if D == 2 && !self.across.is_empty() {
                    let across = if M::ACROSS {
                        v.across::<L>(&at, &point)
                    } else {
                        let poisson = per(&|m: usize| self.across[m][0]);
                        let mut across = L::load(poisson.as_ptr()) * trace;
                        if !v.expansion.is_empty() {
                            let stiff = per(&|m: usize| self.across[m][1]);
                            let grown = at.rows.one::<L>(v.expansion.as_ptr());
                            let left = v.integrity::<L>(at.rows);
                            across = across - left * L::load(stiff.as_ptr()) * grown;
                        }
                        across
                    };
                    trace = trace + across;
                    square = across.fma(across, square);
                }
                // 3/2 s:s = 3/2 σ:σ − 1/2 tr²σ
                let mises = L::splat(1.5) * square - half * trace * trace;
                let limit = L::load(per(&|m: usize| self.limit[m]).as_ptr());
                put(
                    mises.max(L::splat(0.0)).sqrt().div(limit),
                    self.out,
                    at.rows,
                );
            }
        }
    }
}

impl<const D: usize, F: Family<D>, M: Material<D>> MaterialInteraction<D, F, M> {
    /// The first half of the work of the step that ends here, by the forces at its start.
    pub(super) fn work_before(&mut self, body: &Body<D>, u: FieldView<D>, room: &Room) {
        if self.work.is_empty() {
            return;
        }
        let Some(mut before) = self.before.take() else {
            return;
        };
        let start = Room {
            records: std::mem::take(&mut before.records),
            constants: room.still.clone(),
            still: vec![],
        };
        std::mem::swap(&mut self.expansion, &mut before.expansion);
        self.settle(body, view(&before.u), &start);
        std::mem::swap(&mut self.expansion, &mut before.expansion);
        let work = Shared(self.work.as_mut_ptr());
        let mut view = self.view(view(&before.u), &start);
        view.expansion = &before.expansion;
        let other = self.view(u, room);
        let kernel = Work {
            view,
            other,
            part: 0.5,
            work,
        };
        run_blocks(self.simd, &kernel, self.sums.blocks());
        before.records = start.records;
        self.before = Some(before);
    }

    /// What bonds are measured by, at the forces of now, which are settled.
    pub(super) fn measure(&mut self, body: &Body<D>, u: FieldView<D>, room: &Room) {
        if let Some(before) = self.before.take() {
            let start = Room {
                records: before.records,
                ..Room::default()
            };
            let work = Shared(self.work.as_mut_ptr());
            let mut other = self.view(view(&before.u), &start);
            other.expansion = &before.expansion;
            other.constants = &room.constants;
            let kernel = Work {
                view: self.view(u, room),
                other,
                part: -0.5,
                work,
            };
            run_blocks(self.simd, &kernel, self.sums.blocks());
            self.before = Some(Before {
                records: start.records,
                ..before
            });
        }
        let out = Shared(self.damage.as_mut_ptr());
        if let Measure::VonMises(limit) = &self.criteria.measure {
            let materials = 0..self.held.len();
            let across: Vec<[f64; 2]> = materials.map(|m| self.elastic_across(m)).collect();
            let kernel = VonMises {
                view: self.view(u, room),
                body,
                limit,
                across: &across,
                out,
            };
            run_blocks(self.simd, &kernel, self.sums.blocks());
            body.fill_images(&mut self.damage);
        }
    }

    /// Are bonds measured by the forces of now?
    pub(super) fn measures(&self) -> bool {
        matches!(
            self.criteria.measure,
            Measure::Work(_) | Measure::VonMises(_)
        )
    }

    /// The next step begins here.
    pub(super) fn keep(&mut self, u: FieldView<D>, room: &Room) {
        if self.work.is_empty() {
            return;
        }
        let before = self.before.get_or_insert_with(|| Before {
            u: zeros(u[0].len()),
            records: vec![],
            expansion: Column::default(),
        });
        for a in 0..D {
            before.u[a].copy_from_slice(u[a]);
        }
        before.records.clone_from(&room.records);
        before.expansion = self.expansion.clone();
    }

    /// Number of the material of a slot in what is per material.
    pub(super) fn material_at(&self, slot: usize) -> usize {
        self.material.get(slot).map_or(0, |m| *m as usize)
    }

    /// Points in whose reference family is a crack, with the least damage that is one to each material.
    fn near_cracks(&self, body: &Body<D>) -> Vec<bool> {
        let mut of = vec![[0.0f64; 2]; body.len];
        let original = body.originals();
        self.each_pair(|group, k, l| {
            let i = self.family.rows(group).slot(l);
            let volume = body.volume.at(original(self.family.ends(group, k).slot(l)));
            of[i][0] += volume;
            if !self.is_whole(group, k, l) {
                of[i][1] += volume;
            }
        });
        let cracked = |i: usize| {
            let fatigue = self.criteria.fatigue[self.material_at(i)];
            let [all, lost] = of[i];
            fatigue.is_some_and(|f| all > 0.0 && lost >= f.crack * all)
        };
        let mut near: Vec<bool> = (0..body.len).map(cracked).collect();
        let cracked = near.clone();
        self.each_pair(|group, k, l| {
            let i = self.family.rows(group).slot(l);
            let j = original(self.family.ends(group, k).slot(l));
            near[i] = near[i] || cracked[j];
        });
        near
    }

    /// So many cycles of load pass with the greatest strains of now.
    pub(super) fn wear_bonds(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        load: &Cycles,
        passed: f64,
    ) {
        let mut all = vec![];
        self.each_wearing(body, u, load, |place, bond| all.push((place, bond)));
        for (place, bond) in all {
            let left = bond.life - passed * bond.rate;
            self.life[place] = if left < SPENT { 0.0 } else { left };
        }
    }

    /// Every directed bond that is whole, with its place among those that live.
    pub(super) fn each_wearing(
        &self,
        body: &Body<D>,
        u: FieldView<D>,
        load: &Cycles,
        mut visit: impl FnMut(usize, Wearing),
    ) {
        let near = self.near_cracks(body);
        let original = body.originals();
        self.each_pair(|group, k, l| {
            if !self.is_whole(group, k, l) {
                return;
            }
            let [i, end] = [self.family.rows(group), self.family.ends(group, k)].map(|s| s.slot(l));
            let j = original(end);
            let r = self.family.plain(group, k, l);
            let mut eta: [f64; D] = std::array::from_fn(|a| u[a][end] - u[a][i]);
            if !self.expansion.is_empty() {
                let strain = 0.5 * (self.expansion[i] + self.expansion[end]);
                for a in 0..D {
                    eta[a] = (eta[a] - strain * r.xi[a]) / (1.0 + strain);
                }
            }
            let stretch = history::stretch(relative_square_stretch(eta, r.xi, r.two_by_square));
            let range = (1.0 - load.load_ratio) * stretch.abs();
            let of = |slot: usize| {
                let fatigue = self.criteria.fatigue[self.material_at(slot)];
                fatigue.map_or(0.0, |f| Wearing::rate(&f, range, near[i] || near[j]))
            };
            let place = self.family.own(group, k, 0, 1) + l;
            let bond = Wearing {
                life: self.life[place],
                rate: 0.5 * (of(i) + of(j)),
            };
            visit(place, bond);
        });
    }

    /// Every directed bond that the family ever had, pre-cracks included: group, bond, place.
    fn each_pair(&self, mut visit: impl FnMut(usize, usize, usize)) {
        for group in 0..self.family.groups() {
            for l in (0..TILE).filter(|l| self.family.is_point(group, *l)) {
                for k in 0..self.family.bonds(group) {
                    if self.family.is_bond(group, k, l) {
                        visit(group, k, l);
                    }
                }
            }
        }
    }
}
