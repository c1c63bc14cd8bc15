//! A step of bonds: they are settled, tear, pull and remember, in the order that their law asks for.

use super::MaterialInteraction;
use super::break_bonds::{BreakBonds, Breaking};
use super::energies::Energies;
use super::law::LawView;
use super::measured::{Limits, VonMises, Work};
use super::view::Drift;
use crate::body::{Body, Column, FieldView, FieldViewMut, view, view_mut};
use crate::execute::blocks::Shared;
use crate::interaction::bonds::family::Family;
use crate::interaction::bonds::state::{Before, Workspace};
use crate::interaction::bonds::store::Store;
use crate::interaction::bonds::view::BondView;
use crate::interaction::criterion::Measure;
use crate::interaction::{EnergyFields, Motion, PointEnergiesMut, Tally, history};
use crate::spec::Breakage;

impl<const D: usize, F: Family<D>> MaterialInteraction<D, F> {
    /// Constants of materials for a step of this length.
    fn fill_constants(&self, dt: f64, all: &mut Vec<f64>) {
        self.law.constants(self.bonds.toughness.len(), dt, all);
    }

    /// Workspace with constants, and without displacements.
    pub(super) fn constants(&self) -> Workspace {
        let mut workspace = Workspace::default();
        self.fill_constants(self.bonds.step, &mut workspace.constants);
        workspace
    }

    /// The room, filled for these displacements and a step of this length; give it back.
    pub(super) fn take_workspace(&mut self, u: FieldView<D>, dt: f64) -> Workspace {
        let mut workspace = self.bonds.take_workspace(u);
        self.fill_constants(dt, &mut workspace.constants);
        self.fill_constants(0.0, &mut workspace.still);
        workspace
    }

    /// The same for those who only look.
    pub(super) fn look_room(&self, u: FieldView<D>) -> Workspace {
        let mut workspace = self.constants();
        workspace
            .records
            .resize(self.bonds.workspace.records.len(), 0.0);
        self.bonds.pack(u, &mut workspace.records);
        workspace
    }

    /// [`forces`](crate::interaction::Interaction::forces)
    pub(super) fn evolve(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        f: FieldViewMut<D>,
        motion: Option<Motion<D>>,
        seen: Option<&mut PointEnergiesMut>,
    ) -> Tally {
        let dt = match motion {
            Some(m) if self.bonds.step == 0.0 => m.steps[0],
            _ => self.bonds.step,
        };
        let mut workspace = self.take_workspace(u, dt);
        let breaks = motion.filter(|_| !self.bonds.critical.is_empty());
        if let Some(m) =
            breaks.filter(|_| self.bonds.law.form_of_whole && !self.bonds.law.potential)
        {
            let total = self.step_of_rates(body, u, f, (m, &mut workspace), seen);
            self.bonds.workspace = workspace;
            return total;
        }
        // of a watched step: the bonds before any breaks
        let mut whole = seen.as_ref().map(|_| {
            (
                self.bonds.alive.clone(),
                self.bonds.form.clone(),
                self.bonds.integrity.clone(),
            )
        });
        let mut total = Tally::default();
        if motion.is_some() {
            self.work_before(body, u, &workspace);
        }
        if let Some(m) = breaks.filter(|m| m.breakage == Breakage::BeforeForce) {
            if self.measures() {
                self.point_update(body, u, &workspace);
                self.measure(body, u, &workspace);
            }
            total += self
                .break_bonds(body, u, &workspace, away(&m, -m.steps[0]))
                .unwrap_or_default();
        }
        self.point_update(body, u, &workspace);
        self.pull(body, u, &workspace, f);
        if let Some(m) = breaks.filter(|m| m.breakage == Breakage::AfterForce) {
            self.measure(body, u, &workspace);
            total += self
                .break_bonds(body, u, &workspace, away(&m, m.steps[1]))
                .unwrap_or_default();
        }
        if motion.is_some() {
            total += self.remember(body, u, &workspace);
            self.bonds.step = 0.0;
        }
        if motion.is_some() || self.bonds.before.is_none() {
            self.keep(u, &workspace);
        }
        if let (Some(seen), Some(whole)) = (seen, &mut whole) {
            // what the step remembers is part of this instant, what breaks in it is of the next
            self.swap_bonds(whole);
            self.seen(body, u, &self.look_room(u), seen);
            self.swap_bonds(whole);
        }
        if breaks.is_some() {
            self.bonds.next_critical(body);
        }
        self.bonds.workspace = workspace;
        total
    }

    /// All passes: points as the bonds see them.
    pub(super) fn point_update(&mut self, body: &Body<D>, u: FieldView<D>, workspace: &Workspace) {
        self.settle_only(body, u, workspace, &[]);
    }

    /// Of the points that are marked; no marks: of all.
    fn settle_only(&mut self, body: &Body<D>, u: FieldView<D>, workspace: &Workspace, only: &[u8]) {
        for pass in 0..self.bonds.law.passes {
            let out = self.bonds.point.shared();
            let mut view = self.bonds.view(u, workspace);
            view.point = out.seen();
            self.law.sums(&self.bonds.blocks, view, pass, out, only);
            self.bonds.point.fill(&body.exchange);
        }
    }

    /// Forces on points that have settled.
    fn pull(&self, body: &Body<D>, u: FieldView<D>, workspace: &Workspace, f: FieldViewMut<D>) {
        let view = self.bonds.view(u, workspace);
        let f = f.map(|column| Shared(column.as_mut_ptr()));
        self.law
            .forces(&self.bonds.blocks, view, f, self.bonds.pushed(body));
    }

    /// A step of a law of rates whose bonds may break. What a break changes of the gradient of a family it changes at once: it is a step of no length
    /// after that of the motion, and no viscosity or rate sees it.
    fn step_of_rates(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        mut f: FieldViewMut<D>,
        (motion, workspace): (Motion<D>, &mut Workspace),
        seen: Option<&mut PointEnergiesMut>,
    ) -> Tally {
        let after = motion.breakage == Breakage::AfterForce;
        self.work_before(body, u, workspace);
        self.point_update(body, u, workspace);
        if after {
            self.pull(body, u, workspace, view_mut(&mut f));
        }
        if after || self.measures() {
            self.measure(body, u, workspace);
        }
        let mut total = self.remember(body, u, workspace);
        self.bonds.step = 0.0;
        workspace.constants.clone_from(&workspace.still);
        if let Some(seen) = seen {
            self.seen(body, u, workspace, seen);
        }
        let drift = match after {
            true => motion.steps[1],
            false => -motion.steps[0],
        };
        if let Some(break_bonds) = self.break_bonds(body, u, workspace, away(&motion, drift)) {
            let damaged = std::mem::take(&mut self.bonds.damaged);
            self.settle_only(body, u, workspace, &damaged);
            total += self.remember_only(body, u, workspace, &damaged);
            self.bonds.damaged = damaged;
            total += break_bonds;
        }
        if !after {
            self.pull(body, u, workspace, f);
        }
        self.keep(u, workspace);
        self.bonds.next_critical(body);
        total
    }

    pub(super) fn energies(
        &self,
        body: &Body<D>,
        u: FieldView<D>,
        workspace: &Workspace,
        out: Option<&mut PointEnergiesMut>,
    ) -> [f64; 2] {
        let fields = out.map(|out| EnergyFields::of(out, body.len));
        let held = self.bonds.held_energies();
        self.bonds.blocks.sum(&Energies {
            law: self.asked(self.bonds.view(u, workspace)),
            stretches: self.bonds.law.stretches,
            held: &held,
            pushed: self.bonds.pushed(body),
            volume: &body.volume,
            fields,
        })
    }

    /// Bonds with their law, for those that do not know it.
    pub(super) fn asked<'a>(&'a self, bonds: BondView<'a, D, F>) -> LawView<'a, D, F> {
        LawView {
            law: &*self.law,
            simd: self.bonds.blocks.simd,
            bonds,
        }
    }

    pub(super) fn seen(
        &self,
        body: &Body<D>,
        u: FieldView<D>,
        workspace: &Workspace,
        out: &mut PointEnergiesMut,
    ) {
        self.energies(body, u, workspace, Some(&mut *out));
        self.bonds.dilate(out);
    }

    /// Test and break, and what points lose; `None`: nothing broke, on any rank.
    fn break_bonds(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        workspace: &Workspace,
        drift: Drift<D>,
    ) -> Option<Tally> {
        if !self.bonds.find_breaking(body, u, workspace, drift.v) {
            return None;
        }
        let form = self.bonds.form.shared();
        let breaks = Shared(self.bonds.breaks.as_mut_ptr());
        let alive = Shared(self.bonds.alive.as_mut_ptr());
        let integrity = Shared(self.bonds.integrity.as_mut_ptr());
        let mut view = self.bonds.view(u, workspace);
        (view.form, view.alive) = (form.seen(), alive.seen());
        let damaged = Breaking {
            // a step of equilibrium is at its end already, with its relaxed forces
            still: if self.bonds.step > 0.0 {
                &workspace.constants
            } else {
                &workspace.still
            },
            body,
            groups: &self.bonds.damaged,
            breaks,
            alive,
            form,
            integrity: (!self.bonds.integrity.is_empty()).then_some(integrity),
            drift,
        };
        let of_whole = self.bonds.law.form_of_whole;
        let (tally, _) = self.bonds.blocks.tally(&BreakBonds {
            law: self.asked(view),
            forms: if of_whole { self.bonds.law.form } else { 0 },
            damaged,
        });
        self.bonds.look_integrity(body);
        self.bonds.look_stiffness(body, false);
        Some(tally)
    }

    /// Memory at the end of a step.
    fn remember(&mut self, body: &Body<D>, u: FieldView<D>, workspace: &Workspace) -> Tally {
        self.remember_only(body, u, workspace, &[])
    }

    /// Of the points that are marked; no marks: of all.
    fn remember_only(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        workspace: &Workspace,
        only: &[u8],
    ) -> Tally {
        if self.bonds.memory.is_empty() && self.bonds.past.data.is_empty() {
            return Tally::default();
        }
        let past = self.bonds.past.shared();
        let memory = Shared(self.bonds.memory.as_mut_ptr());
        let mut view = self.bonds.view(u, workspace);
        (view.past, view.memory) = (past.seen(), memory.seen());
        let written = (past, memory);
        let blocks = &self.bonds.blocks;
        let tally = self.law.remember(blocks, view, written, &body.volume, only);
        self.bonds.fill_memory(body);
        tally
    }

    fn swap_bonds(&mut self, (alive, form, integrity): &mut (Vec<u8>, Store, Column)) {
        std::mem::swap(&mut self.bonds.alive, alive);
        std::mem::swap(&mut self.bonds.form, form);
        std::mem::swap(&mut self.bonds.integrity, integrity);
    }

    /// The first half of the work of the step that ends here, by the forces at its start.
    fn work_before(&mut self, body: &Body<D>, u: FieldView<D>, workspace: &Workspace) {
        if self.bonds.work.is_empty() {
            return;
        }
        let Some(mut before) = self.bonds.before.take() else {
            return;
        };
        let start = Workspace {
            records: std::mem::take(&mut before.records),
            constants: workspace.still.clone(),
            still: vec![],
        };
        std::mem::swap(&mut self.bonds.expansion, &mut before.expansion);
        self.point_update(body, view(&before.u), &start);
        std::mem::swap(&mut self.bonds.expansion, &mut before.expansion);
        let work = Shared(self.bonds.work.as_mut_ptr());
        let mut there = self.bonds.view(view(&before.u), &start);
        there.expansion = &before.expansion;
        let here = self.bonds.view(u, workspace);
        self.bonds.blocks.run(&Work {
            law: self.asked(there),
            other: here,
            part: 0.5,
            work,
        });
        before.records = start.records;
        self.bonds.before = Some(before);
    }

    /// What bonds are measured by, at the forces of now, which are settled.
    fn measure(&mut self, body: &Body<D>, u: FieldView<D>, workspace: &Workspace) {
        if let Some(before) = self.bonds.before.take() {
            let start = Workspace {
                records: before.records,
                ..Workspace::default()
            };
            let work = Shared(self.bonds.work.as_mut_ptr());
            let mut there = self.bonds.view(view(&before.u), &start);
            there.expansion = &before.expansion;
            there.constants = &workspace.constants;
            let here = self.bonds.view(u, workspace);
            self.bonds.blocks.run(&Work {
                law: self.asked(here),
                other: there,
                part: -0.5,
                work,
            });
            self.bonds.before = Some(Before {
                records: start.records,
                ..before
            });
        }
        let out = Shared(self.bonds.damage.as_mut_ptr());
        if self.mises(body, u, workspace, out) {
            body.exchange.fill(&mut self.bonds.damage);
        }
    }

    /// Von Mises stress of points over their limits, where bonds break by that; do they?
    fn mises(&self, body: &Body<D>, u: FieldView<D>, workspace: &Workspace, out: Shared) -> bool {
        let Measure::VonMises(limit) = &self.bonds.criteria.measure else {
            return false;
        };
        let materials = 0..self.bonds.held.len();
        let across = materials.map(|m| self.bonds.elastic_across(m));
        let limits = Limits {
            body,
            limit,
            across: &across.collect::<Vec<_>>(),
            out,
        };
        self.bonds.blocks.run(&VonMises {
            law: self.asked(self.bonds.view(u, workspace)),
            says_across: self.bonds.law.across,
            limits,
        });
        true
    }

    /// The same at any displacements.
    pub(super) fn stress(&mut self, body: &Body<D>, u: FieldView<D>) -> Option<Vec<f64>> {
        if !matches!(self.bonds.criteria.measure, Measure::VonMises(_)) {
            return None;
        }
        let mut out = self.bonds.damage.clone();
        let workspace = self.take_workspace(u, self.bonds.step);
        self.point_update(body, u, &workspace);
        self.mises(body, u, &workspace, Shared(out.as_mut_ptr()));
        self.bonds.workspace = workspace;
        body.exchange.fill(&mut out);
        Some(out.to_vec())
    }

    /// [`work_borne`](crate::interaction::Interaction::work_borne)
    pub(super) fn works(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        visit: &mut dyn FnMut(usize, usize, [f64; D], f64),
    ) -> bool {
        if self.bonds.work.is_empty() {
            return false;
        }
        let workspace = self.take_workspace(u, self.bonds.step);
        self.point_update(body, u, &workspace);
        let rest = Before::zeros(body.len, workspace.records.len());
        let at_rest = Workspace {
            records: rest.records,
            ..Workspace::default()
        };
        let mut done = vec![0.0; self.bonds.work.len()];
        self.bonds.blocks.run(&Work {
            law: self.asked(self.bonds.view(u, &workspace)),
            other: self.bonds.view(view(&rest.u), &at_rest),
            part: -0.5,
            work: Shared(done.as_mut_ptr()),
        });
        let critical = &self.bonds.critical;
        let bonds = &self.bonds;
        let whole = { bonds.pairs() }.filter(|(group, k, l)| bonds.is_whole(*group, *k, *l));
        bonds.each_half(whole, body, &mut |[group, k, l], [i, j]| {
            let limit = history::limit(critical[i], critical[j]);
            if limit.is_finite() {
                let at = bonds.family.own(group, k, 0, 1) + l;
                visit(i, j, bonds.family.bond(group, k, l).0, done[at] / limit);
            }
        });
        self.bonds.workspace = workspace;
        true
    }

    /// Are bonds measured by the forces of now?
    fn measures(&self) -> bool {
        matches!(
            self.bonds.criteria.measure,
            Measure::Work(_) | Measure::VonMises(_)
        )
    }

    /// The next step begins here.
    fn keep(&mut self, u: FieldView<D>, workspace: &Workspace) {
        if self.bonds.work.is_empty() {
            return;
        }
        let zeros = || Before::zeros(u[0].len(), 0);
        let before = self.bonds.before.get_or_insert_with(zeros);
        for a in 0..D {
            before.u[a].copy_from_slice(u[a]);
        }
        before.records.clone_from(&workspace.records);
        before.expansion = self.bonds.expansion.clone();
    }
}

/// The velocities of a motion, and a time.
fn away<'a, const D: usize>(motion: &Motion<'a, D>, time: f64) -> Drift<'a, D> {
    Drift { v: motion.v, time }
}
