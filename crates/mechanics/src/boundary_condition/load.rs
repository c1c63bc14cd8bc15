//! Loads: body force, traction, damping, and forces replaced on a set.

use super::Program;
use super::condensed::Condensed;
use super::force_field::{ForceField, power};
use super::point_force::{PointForce, Seen, Stiffness};
use super::reaction::ReactionSums;
use crate::body::{Body, Field};
use crate::execute::exact::Exact;
use crate::interaction::Evaluation;
use crate::interaction::friction::Pressed;
use crate::space::Point;
use crate::state::Archive;
use std::sync::Arc;

#[derive(Debug, Clone)]
pub enum LoadKind<const D: usize> {
    /// Force density (force / volume).
    Body(Program<D>),
    /// Force density −c v at the end of the step, all other loads added; `c`, component 0, in mass / volume / time.
    Damping(Program<D>),
    /// The force density becomes this, whatever else acts.
    Replace(Program<D>),
    /// Force density −γ v, v as it is when forces are evaluated; γ per point of the list (mass / volume / time).
    Drag(Vec<f64>),
    /// Force density of a force that the registry has.
    Named(Arc<dyn PointForce>),
}

impl<const D: usize> LoadKind<D> {
    /// Does its list have a value for point `k`?
    fn counts(&self, k: usize) -> bool {
        match self {
            LoadKind::Body(p) | LoadKind::Replace(p) => !p.leaves(k),
            LoadKind::Damping(_) | LoadKind::Drag(_) | LoadKind::Named(_) => true,
        }
    }
}

/// In what order loads act.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rank {
    /// Forces of their own.
    Load,
    /// What looks at all that was added.
    Resistance,
    /// What replaces it, whatever it is.
    Override,
}

/// A load on a set of points.
#[derive(Debug, Clone)]
pub struct Load<const D: usize> {
    pub kind: LoadKind<D>,
    slots: Vec<u32>,
    points: Vec<Point>,
    /// Of a condensed body: where this load acts.
    condensed: Option<Condensed<D>>,
    /// Which of the conditions it is, and the area that it acts on, if on one.
    pub of: Option<(usize, Option<f64>)>,
    /// Force density added last time, for the work of the next step.
    last: Vec<[f64; D]>,
    /// The same where an implicit step departed.
    departed: Vec<[f64; D]>,
    /// Of a force that the registry has: which of its points each of these is, what it remembers of them now and where the step began, and its
    /// stiffness in the last trial (force / volume / length).
    named: Named<D>,
    /// Of what is driven from outside: the force densities on the points before this load acted, without those that a list leaves alone.
    pub before: Option<Box<ReactionSums>>,
    /// Work done on the points of this rank (energy).
    pub work: Exact,
}

/// What is kept of a force that the registry has.
#[derive(Debug, Clone, Default)]
struct Named<const D: usize> {
    point: Vec<u32>,
    memory: Vec<f64>,
    began: Vec<f64>,
    stiffness: Vec<[[f64; D]; D]>,
}

impl<const D: usize> Named<D> {
    fn of(force: &dyn PointForce, points: usize) -> Self {
        let memory = vec![0.0; points * force.memory()];
        let tangents = match force.stiffness() {
            Stiffness::Known => points,
            Stiffness::None | Stiffness::Unknown => 0,
        };
        Named {
            point: (0..points as u32).collect(),
            began: memory.clone(),
            memory,
            stiffness: vec![[[0.0; D]; D]; tangents],
        }
    }

    /// A step begins.
    fn begin(&mut self) {
        self.began.copy_from_slice(&self.memory);
    }

    /// Force on point `k` of those that are left.
    fn force(&mut self, force: &dyn PointForce, k: usize, seen: &Seen, at: Evaluation) -> Point {
        let each = force.memory();
        let own = k * each..(k + 1) * each;
        match at {
            Evaluation::Start { .. } => {}
            Evaluation::StepEnd { .. } | Evaluation::Trial { .. } => {
                self.memory[own.clone()].copy_from_slice(&self.began[own.clone()]);
            }
        }
        let force = force.force(self.point[k] as usize, seen, &mut self.memory[own]);
        if let Some(block) = self.stiffness.get_mut(k) {
            let k = &force.stiffness;
            *block =
                crate::array::from_fn(|a| crate::array::from_fn(|b| 0.5 * (k[a][b] + k[b][a])));
        }
        force.force
    }

    fn retain(&mut self, kept: &[usize]) {
        let each = self.memory.len() / self.point.len().max(1);
        let of = |all: &[f64]| {
            kept.iter()
                .flat_map(|k| &all[k * each..(k + 1) * each])
                .copied()
                .collect()
        };
        (self.memory, self.began) = (of(&self.memory), of(&self.began));
        if !self.stiffness.is_empty() {
            self.stiffness = kept.iter().map(|k| self.stiffness[*k]).collect();
        }
        self.point = kept.iter().map(|k| self.point[*k]).collect();
    }
}

impl<const D: usize> Load<D> {
    /// Passes what it remembers through an archive.
    pub fn archive(&mut self, body: &Body<D>, archive: &mut Archive<'_>) {
        body.archive_list(archive, "force", &self.slots, &mut self.last);
        let each = self.named.memory.len() / self.slots.len().max(1);
        let each = body.most(each as f64) as usize;
        // loads are asked for before the next increment begins
        let both = [&mut self.named.memory, &mut self.named.began];
        for (name, memory) in ["memory", "memory_before"].into_iter().zip(both) {
            for n in 0..each {
                let mut own: Vec<f64> = memory.iter().skip(n).step_by(each).copied().collect();
                body.archive_list(archive, name, &self.slots, &mut own);
                { memory.iter_mut().skip(n).step_by(each).zip(own) }.for_each(|(m, x)| *m = x);
            }
        }
        archive.part("work", &mut self.work);
    }

    /// The slots that it acts on.
    pub fn slots(&self) -> &[u32] {
        &self.slots
    }

    pub fn new(kind: LoadKind<D>, slots: Vec<u32>, points: Vec<Point>) -> Self {
        let last = vec![[0.0; D]; slots.len()];
        let named = match &kind {
            LoadKind::Named(force) => Named::of(force.as_ref(), slots.len()),
            LoadKind::Body(_) | LoadKind::Damping(_) | LoadKind::Replace(_) | LoadKind::Drag(_) => {
                Named::default()
            }
        };
        Load {
            kind,
            named,
            slots,
            points,
            condensed: None,
            of: None,
            last,
            departed: vec![],
            before: None,
            work: Exact::ZERO,
        }
    }

    /// Which of the points that a force of the registry was made for each of these is.
    pub fn which(mut self, point: &[u32]) -> Self {
        if let LoadKind::Named(_) = self.kind {
            self.named.point = point.to_vec();
        }
        self
    }

    /// A force density on points of a finer body, which reaches these slots.
    pub fn condensed(density: Program<D>, slots: Vec<u32>, condensed: Condensed<D>) -> Self {
        Load {
            condensed: Some(condensed),
            ..Load::new(LoadKind::Body(density), slots, vec![])
        }
    }

    /// The whole force at a time, of one that adds force densities (force). All ranks ask at once.
    pub fn total(&mut self, body: &Body<D>, t: f64) -> Option<[f64; 3]> {
        let LoadKind::Body(density) = &self.kind else {
            return None;
        };
        if let Some(condensed) = &mut self.condensed {
            condensed.evaluate(density, t);
        }
        let mut total = [const { Exact::ZERO }; 3];
        for (k, &s) in self.slots.iter().enumerate() {
            for (a, total) in total.iter_mut().enumerate().take(D) {
                total.add(match &self.condensed {
                    Some(condensed) => condensed.reaching(k, a),
                    None => body.volume.at(s as usize) * density.at(a, k, &self.points[k], t),
                });
            }
        }
        Some(body.sums(total))
    }

    /// Force density on each slot at the one of some times up to `end` at which it is largest, of a load that adds them.
    pub fn largest(&self, end: f64, times: u32) -> Vec<(usize, [f64; D])> {
        let (LoadKind::Body(density), None) = (&self.kind, &self.condensed) else {
            return vec![];
        };
        let size = |f: &[f64; D]| f.iter().map(|c| c * c).sum::<f64>();
        let each = self.slots.iter().enumerate().filter_map(|(k, slot)| {
            let at = |t: f64| crate::array::from_fn(|a| density.at(a, k, &self.points[k], t));
            let all = (0..=times).map(|n| at(end * f64::from(n) / f64::from(times)));
            let most = all.max_by(|a, b| size(a).total_cmp(&size(b)))?;
            Some((*slot as usize, most))
        });
        each.collect()
    }

    /// Visits the slots of a load that resists velocities, with the viscosity there at time `t` (mass / volume / time).
    pub fn each_viscosity(&self, t: f64, mut visit: impl FnMut(usize, f64)) {
        for (k, &s) in self.slots.iter().enumerate() {
            match &self.kind {
                LoadKind::Damping(c) => visit(s as usize, c.at(0, k, &self.points[k], t)),
                LoadKind::Drag(gamma) => visit(s as usize, gamma[k]),
                LoadKind::Body(_) | LoadKind::Replace(_) | LoadKind::Named(_) => {}
            }
        }
    }

    /// Visits the slots of a load that depends on displacements, with its stiffness `−∂f/∂u` in the last trial (force / volume / length).
    pub fn each_stiffness(&self, mut visit: impl FnMut(usize, &[[f64; D]; D])) {
        for (&s, block) in self.slots.iter().zip(&self.named.stiffness) {
            visit(s as usize, block);
        }
    }

    /// Does it change with displacements, in a way that it tells?
    pub fn has_stiffness(&self) -> bool {
        matches!(&self.kind, LoadKind::Named(force) if force.stiffness() == Stiffness::Known)
    }

    /// Does it, or may it?
    pub fn changes_with_place(&self) -> bool {
        match &self.kind {
            LoadKind::Named(force) => force.stiffness() != Stiffness::None,
            LoadKind::Body(_) | LoadKind::Damping(_) | LoadKind::Replace(_) | LoadKind::Drag(_) => {
                false
            }
        }
    }

    /// What it is, if it has no tangent.
    pub fn without_tangent(&self) -> Option<&'static str> {
        match &self.kind {
            LoadKind::Body(_) | LoadKind::Damping(_) | LoadKind::Drag(_) => None,
            LoadKind::Replace(_) => Some("a force that replaces all others"),
            LoadKind::Named(force) => match force.stiffness() {
                Stiffness::None | Stiffness::Known => None,
                Stiffness::Unknown => Some("a force of the program"),
            },
        }
    }

    pub fn is_damping(&self) -> bool {
        matches!(self.kind, LoadKind::Damping(_))
    }
    pub fn rank(&self) -> Rank {
        match self.kind {
            LoadKind::Body(_) | LoadKind::Named(_) => Rank::Load,
            LoadKind::Damping(_) | LoadKind::Drag(_) => Rank::Resistance,
            LoadKind::Replace(_) => Rank::Override,
        }
    }
}

impl<const D: usize> ForceField<D> for Load<D> {
    fn begin_step(&mut self, body: &Body<D>, v: &Field<D>, [_, dt]: [f64; 2], _: f64) {
        self.named.begin();
        for (f, &s) in self.last.iter().zip(&self.slots) {
            let i = s as usize;
            self.work.add(0.5 * dt * power(f, v, i) * body.volume.at(i));
        }
    }

    fn add(
        &mut self,
        body: &Body<D>,
        [u, v]: [&Field<D>; 2],
        f: &mut Field<D>,
        t: f64,
        at: Evaluation,
        push: Option<&Field<D>>,
    ) {
        let dt = at.ended();
        if let (LoadKind::Body(density), Some(condensed)) = (&self.kind, &mut self.condensed) {
            condensed.evaluate(density, t);
        }
        if let Some(before) = &mut self.before {
            **before = ReactionSums::default();
            for (k, &s) in self.slots.iter().enumerate() {
                if self.kind.counts(k) {
                    before.add_force::<D>(crate::array::from_fn(|a| f[a][s as usize]));
                }
            }
        }
        let points = &self.points;
        let seen = |k: usize, i: usize| {
            let point = |c: &Field<D>| crate::array::from_fn(|a| c.get(a).map_or(0.0, |c| c[i]));
            Seen {
                reference: points[k],
                displacement: point(u),
                velocity: point(v),
                time: t,
                step: at.led_here(),
                density: body.density.at(i),
            }
        };
        if let LoadKind::Named(force) = &self.kind
            && force.looks()
        {
            let each = self.slots.iter().enumerate();
            let all: Vec<Seen> = each.map(|(k, s)| seen(k, *s as usize)).collect();
            force.look(&all);
        }
        for (k, &s) in self.slots.iter().enumerate() {
            let i = s as usize;
            let mut power = 0.0;
            let own = match &self.kind {
                LoadKind::Named(force) => {
                    let seen = seen(k, i);
                    self.named.force(force.as_ref(), k, &seen, at)
                }
                LoadKind::Body(_)
                | LoadKind::Damping(_)
                | LoadKind::Replace(_)
                | LoadKind::Drag(_) => [0.0; 3],
            };
            for a in 0..D {
                let added = match &self.kind {
                    LoadKind::Body(p) => match &self.condensed {
                        None => p.at(a, k, &self.points[k], t),
                        Some(condensed) => condensed.reaching(k, a) / body.volume.at(i),
                    },
                    // v at the whole step: the middle's and half a kick, of which this force is a part
                    LoadKind::Damping(c) => {
                        let half = 0.5 * dt / body.density.at(i);
                        let c = c.at(0, k, &self.points[k], t);
                        let others = match push {
                            None => f[a][i],
                            // without this force's own part in it
                            Some(push) => push[a][i] - self.last[k][a],
                        };
                        -c * (v[a][i] + half * others) / (1.0 + half * c)
                    }
                    LoadKind::Replace(p) if p.acts_on(a, k) => {
                        p.at(a, k, &self.points[k], t) - f[a][i]
                    }
                    LoadKind::Replace(_) => 0.0,
                    LoadKind::Drag(gamma) => -gamma[k] * v[a][i],
                    LoadKind::Named(_) => own[a],
                };
                f[a][i] += added;
                self.last[k][a] = added;
                power += added * v[a][i];
            }
            // of a trial none, though its force is no number
            if dt != 0.0 {
                self.work.add(0.5 * dt * power * body.volume.at(i));
            }
        }
    }

    fn depart(&mut self, _: &Field<D>, pressed: Pressed) {
        self.named.begin();
        match pressed {
            Pressed::Now => self.departed.clone_from(&self.last),
            // whoever makes increments counts the work of all loads
            Pressed::Held => self.departed.clear(),
        }
    }

    fn arrive(&mut self, body: &Body<D>, [then, now]: [&Field<D>; 2]) {
        let both = self.departed.iter().zip(&self.last);
        for ((f, g), &s) in both.zip(&self.slots) {
            let i = s as usize;
            let along = (0..D).map(|a| (f[a] + g[a]) * (now[a][i] - then[a][i]));
            let along: f64 = along.sum();
            self.work.add(0.5 * body.volume.at(i) * along);
        }
    }

    /// The next evaluation finds its force anew.
    fn retreat(&mut self) {
        self.named.memory.copy_from_slice(&self.named.began);
    }

    /// It acts wherever its points are.
    fn moved(&mut self, _: f64) {}

    fn retain(&mut self, keep: &dyn Fn(u32) -> bool) {
        let kept: Vec<usize> = (0..self.slots.len())
            .filter(|k| keep(self.slots[*k]))
            .collect();
        self.slots = kept.iter().map(|k| self.slots[*k]).collect();
        self.last = kept.iter().map(|k| self.last[*k]).collect();
        if let Some(condensed) = &mut self.condensed {
            return condensed.pick(&kept);
        }
        self.points = kept.iter().map(|k| self.points[*k]).collect();
        if let LoadKind::Named(_) = &self.kind {
            self.named.retain(&kept);
        }
        if let LoadKind::Drag(gamma) = &mut self.kind {
            *gamma = kept.iter().map(|k| gamma[*k]).collect();
        }
        if let LoadKind::Body(p) | LoadKind::Replace(p) | LoadKind::Damping(p) = &mut self.kind {
            p.pick(&kept);
        }
    }
}
