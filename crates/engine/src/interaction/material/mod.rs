//! Any law on any family: laws with memory, with tensors, along the bond or not ([`crate::law::material`]). Written once over groups of eight
//! points; a lattice and a cloud differ in where partners are and what of a bond is stored.

mod breaking;
mod cloud;
mod columns;
mod contract;
mod family;
mod lattice;
mod measured;
mod plain;
mod repulsion;
mod store;
mod sweeps;
mod tangents;
mod view;
mod warmth;

pub use cloud::CloudFamily;
pub use lattice::LatticeFamily;

use super::criterion::{Criteria, Measure};
use super::{EnergyFields, Motion, PointEnergiesMut, Repulsion, Tally, Toughness};
use crate::body::{Body, Column, FieldView, FieldViewMut, Identity, field, view, view_mut};
use crate::execute::blocks::{PerBlock, Seen, Shared, run_blocks};
use crate::execute::lane::TILE;
use crate::execute::simd::Simd;
use crate::law::material::fibres::Fibres;
use crate::law::material::{Material, Numbers};
use crate::spec::Release;
use breaking::{Tear, Test};
use family::{Family, Moved, Slots};
use measured::Before;
use repulsion::Pushed;
use std::ops::AddAssign;
use store::Store;
use sweeps::{Energies, Forces, Remember, Sums};
use view::{BLOCK, View};

/// The column of laws that flow.
pub(crate) const PLASTIC_STRAIN: &str = "plastic_strain";

/// A law on a family.
pub struct MaterialInteraction<const D: usize, F, M> {
    body: Identity,
    law: M,
    family: F,
    simd: Simd,
    kind: &'static str,
    /// Bits of whole bonds, and of those that damage counts.
    alive: Vec<u8>,
    counted: Vec<u8>,
    directed: u64,
    near_horizon: u64,
    materials: usize,
    /// Material per slot; empty: one.
    material: Vec<u8>,
    /// Constants of every point of a law that [varies](Material::varies); else empty.
    placed: Store,
    form: Store,
    point: Store,
    past: Store,
    memory: Vec<f64>,
    toughness: Vec<Toughness>,
    criteria: Criteria,
    /// [`Material::fibres`]
    fibres: Vec<Fibres<D>>,
    repulsion: Option<Repulsion>,
    /// Critical `e` per slot, or critical work, now and next; empty: nothing breaks.
    critical: Column,
    next: Column,
    /// Damage per slot of a law that fails by it ([`Material::failure`]), or a measure over its limit; empty: none does.
    damage: Column,
    /// Work done on each directed bond (energy / volume²), and where the step began; empty: nobody asks.
    work: Vec<f64>,
    before: Option<Before<D>>,
    /// What is left of the life of each directed bond; empty: none wears.
    life: Vec<f64>,
    /// Strain by temperature or swelling per slot; empty: none.
    expansion: Column,
    /// What is left of each slot's energy and force states; empty: of laws whose forms are of whole families, or nothing breaks.
    integrity: Column,
    /// Is any of them below 1?
    degraded: bool,
    /// How stiff torn points are beside the body as it was prepared: per slot, then and now, and the most; empty: they are no stiffer.
    stiffness: [Vec<f64>; 2],
    stiffened: f64,
    /// In plane strain, per material: ν and 2G of the linear isotropic solid of its moduli, if it is isotropic; else empty.
    held: Vec<Option<[f64; 2]>>,
    /// Bits of bonds that break in a sweep, and marks of their groups.
    breaks: Vec<u8>,
    torn: Vec<u8>,
    /// Length of the step that equilibrium is sought for; 0: memory stands still.
    step: f64,
    prepared: bool,
    room: Room,
    tallies: PerBlock<Tally>,
    sums: PerBlock<[f64; 2]>,
}

/// What sweeps fill anew, kept so that a step allocates nothing.
#[derive(Debug, Default)]
struct Room {
    /// Displacements `[slots][4]`, where the family gathers.
    records: Vec<f64>,
    /// `[materials][numbers]` for a step of some length.
    constants: Vec<f64>,
    /// The same for a step of no length.
    still: Vec<f64>,
}

/// Everything such an interaction is made of.
pub struct MaterialParts<'a, const D: usize, F, M> {
    pub body: &'a Body<D>,
    pub family: F,
    pub law: M,
    pub kind: &'static str,
    pub near_horizon: u64,
    /// One per material.
    pub toughness: Vec<Toughness>,
    pub criteria: Criteria,
    pub repulsion: Option<Repulsion>,
    /// In plane strain ν and 2G of each material that is isotropic; else empty.
    pub held: Vec<Option<[f64; 2]>>,
    pub simd: Simd,
}

/// Constants of every point; empty where those of the materials say it all.
fn placed<const D: usize, F: Family<D>, M: Material<D>>(
    law: &M,
    family: &F,
    body: &Body<D>,
) -> Result<Store, (usize, String)> {
    let count = <M::Constants<f64> as Numbers<f64>>::COUNT;
    if !(M::PLACED && law.varies()) {
        return Ok(Store::zeros(family.layout(0)));
    }
    let mut all = Store::zeros(family.layout(count));
    for &s in &body.slots {
        let slot = s as usize;
        let of = law
            .constants_at(body.material_of(slot), &body.position(slot))
            .map_err(|why| (slot, why))?;
        (0..count).for_each(|n| all.set(n, slot, of.get(n)));
    }
    all.fill_images(&body.images);
    Ok(all)
}

impl<const D: usize, F: Family<D>, M: Material<D>> MaterialInteraction<D, F, M> {
    /// # Errors
    /// The slot whose place has no constants, and why.
    pub fn new(parts: MaterialParts<D, F, M>) -> Result<Self, (usize, String)> {
        let MaterialParts {
            body,
            family,
            law,
            kind,
            near_horizon,
            toughness,
            criteria,
            repulsion,
            held,
            simd,
        } = parts;
        let mut alive = vec![0u8; family.bytes_of_bits()];
        let mut directed = 0;
        for group in 0..family.groups() {
            for l in (0..TILE).filter(|l| family.is_point(group, *l)) {
                for k in 0..family.bonds(group) {
                    if family.is_bond(group, k, l) {
                        alive[family.byte(group, k)] |= 1 << l;
                        directed += 1;
                    }
                }
            }
        }
        let measured = matches!(
            criteria.measure,
            Measure::VonMises(_) | Measure::PlasticStrain(_)
        );
        let fails = measured || law.failure().is_some();
        let works = matches!(criteria.measure, Measure::Work(_));
        let wears = !criteria.fatigue.is_empty();
        let breaks = fails || works || wears || toughness.iter().any(|t| t.s00.is_finite());
        let bonds = |is: bool, x: f64| vec![x; if is { family.memory() } else { 0 }];
        let column = |is: bool, x: f64| match is {
            true => Column::new(body.len, x, field::line(3)),
            false => Column::default(),
        };
        let critical = || {
            let mut critical = column(breaks, f64::INFINITY);
            if let Measure::Work(limit) = &criteria.measure {
                for (slot, x) in critical.iter_mut().enumerate() {
                    *x = limit[body.material_of(slot)];
                }
            }
            critical
        };
        let several = toughness.len() > 1;
        let store = |numbers| Store::zeros(family.layout(numbers));
        let blocks = family.groups().div_ceil(BLOCK);
        let gathers = family.layout(1).records;
        let placed = placed(&law, &family, body)?;
        Ok(MaterialInteraction {
            body: body.identity,
            counted: alive.clone(),
            alive,
            directed,
            near_horizon,
            materials: toughness.len(),
            material: match several {
                true => (0..body.len).map(|s| body.material_of(s) as u8).collect(),
                false => vec![],
            },
            placed,
            form: store(<M::Form<f64> as Numbers<f64>>::COUNT),
            point: store(<M::Point<f64> as Numbers<f64>>::COUNT),
            past: store(<M::Past<f64> as Numbers<f64>>::COUNT),
            memory: vec![0.0; family.memory() * <M::Memory<f64> as Numbers<f64>>::COUNT],
            critical: critical(),
            next: critical(),
            damage: column(fails, 0.0),
            work: bonds(works, 0.0),
            before: works.then(|| Before {
                u: crate::body::zeros(body.len),
                records: vec![0.0; if gathers { 4 * body.len } else { 0 }],
                expansion: Column::default(),
            }),
            life: bonds(wears, 1.0),
            expansion: Column::default(),
            integrity: column(breaks && M::FORM_OF_WHOLE, 1.0),
            degraded: false,
            stiffness: [const { vec![] }; 2],
            stiffened: 1.0,
            held,
            breaks: vec![0; if breaks { family.bytes_of_bits() } else { 0 }],
            torn: vec![0; if breaks { family.groups() } else { 0 }],
            step: 0.0,
            prepared: false,
            room: Room {
                records: vec![0.0; if gathers { 4 * body.len } else { 0 }],
                ..Room::default()
            },
            tallies: PerBlock::new(blocks, Tally::default()),
            sums: PerBlock::sums(blocks),
            fibres: law.fibres(),
            law,
            family,
            simd,
            kind,
            toughness,
            criteria,
            repulsion,
        })
    }

    /// `[materials][numbers]` for a step of this length.
    fn fill_constants(&self, dt: f64, all: &mut Vec<f64>) {
        let count = <M::Constants<f64> as Numbers<f64>>::COUNT;
        all.clear();
        for m in 0..self.materials {
            let of = self.law.constants(m, dt);
            all.extend((0..count).map(|n| of.get(n)));
        }
    }

    fn constants(&self, dt: f64) -> Vec<f64> {
        let mut all = vec![];
        self.fill_constants(dt, &mut all);
        all
    }

    /// The room, filled for these displacements and a step of this length; give it back.
    fn take_room(&mut self, u: FieldView<D>, dt: f64) -> Room {
        let mut room = std::mem::take(&mut self.room);
        self.pack(u, &mut room.records);
        self.fill_constants(dt, &mut room.constants);
        self.fill_constants(0.0, &mut room.still);
        room
    }

    /// The same for those who only look.
    fn look_room(&self, u: FieldView<D>) -> Room {
        let mut records = vec![0.0; self.room.records.len()];
        self.pack(u, &mut records);
        Room {
            records,
            constants: self.constants(self.step),
            still: vec![],
        }
    }

    fn view<'a>(&'a self, u: FieldView<'a, D>, room: &'a Room) -> View<'a, D, F, M> {
        View {
            law: &self.law,
            family: &self.family,
            moved: Moved {
                columns: u,
                records: &room.records,
            },
            alive: Seen(self.alive.as_ptr()),
            constants: &room.constants,
            material: &self.material,
            placed: self.placed.view(),
            alike: self.material.is_empty() && self.placed.data.is_empty(),
            form: self.form.view(),
            point: self.point.view(),
            past: self.past.view(),
            memory: Seen(self.memory.as_ptr()),
            expansion: &self.expansion,
            held: !self.held.is_empty(),
            integrity: if self.degraded { &self.integrity } else { &[] },
        }
    }

    /// What is left of a slot's energy and force states.
    fn integrity_at(&self, slot: usize) -> f64 {
        self.integrity.get(slot).copied().unwrap_or(1.0)
    }

    /// Displacements as gathers want them.
    fn pack(&self, u: FieldView<D>, records: &mut [f64]) {
        for (slot, record) in records.chunks_mut(4).enumerate() {
            for a in 0..D {
                record[a] = u[a][slot];
            }
        }
    }

    /// All passes: points as the bonds see them.
    fn settle(&mut self, body: &Body<D>, u: FieldView<D>, room: &Room) {
        self.settle_only(body, u, room, &[]);
    }

    /// Of the groups that are marked; no marks: of all.
    fn settle_only(&mut self, body: &Body<D>, u: FieldView<D>, room: &Room, only: &[u8]) {
        let mut point = std::mem::replace(&mut self.point, Store::zeros(self.family.layout(0)));
        for pass in 0..M::PASSES {
            let out = point.shared();
            let mut view = self.view(u, room);
            view.point = out.seen();
            let kernel = Sums {
                view,
                pass,
                out,
                only,
            };
            run_blocks(self.simd, &kernel, self.sums.blocks());
            point.fill_images(&body.images);
        }
        self.point = point;
    }

    /// Forces on points that have settled.
    fn pull(&self, body: &Body<D>, u: FieldView<D>, room: &Room, f: FieldViewMut<D>) {
        let kernel = Forces {
            view: self.view(u, room),
            f: std::array::from_fn(|a| Shared(f[a].as_mut_ptr())),
            pushed: self.pushed(body),
        };
        run_blocks(self.simd, &kernel, self.sums.blocks());
    }

    /// A step of a law of rates whose bonds may break. What a break changes of the gradient of a family it changes at once: it is a step of no length
    /// after that of the motion, and no viscosity or rate sees it.
    fn step_of_rates(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        mut f: FieldViewMut<D>,
        (motion, room): (Motion<D>, &mut Room),
        seen: Option<&mut PointEnergiesMut>,
    ) -> Tally {
        let after = motion.release == Release::AfterForce;
        self.work_before(body, u, room);
        self.settle(body, u, room);
        if after {
            self.pull(body, u, room, view_mut(&mut f));
        }
        if after || self.measures() {
            self.measure(body, u, room);
        }
        let mut total = self.remember(body, u, room);
        self.step = 0.0;
        room.constants.clone_from(&room.still);
        if let Some(seen) = seen {
            self.seen(body, u, room, seen);
        }
        let drift = match after {
            true => motion.steps[1],
            false => -motion.steps[0],
        };
        let tear = self.tear(body, u, room, motion.v, drift);
        if tear.broken > 0 {
            let torn = std::mem::take(&mut self.torn);
            self.settle_only(body, u, room, &torn);
            total += self.remember_only(body, u, room, &torn);
            self.torn = torn;
        }
        total += tear;
        if !after {
            self.pull(body, u, room, f);
        }
        self.keep(u, room);
        self.next_critical(body);
        total
    }

    fn next_critical(&mut self, body: &Body<D>) {
        std::mem::swap(&mut self.critical, &mut self.next);
        body.fill_images(&mut self.critical);
    }

    fn pushed<'a>(&'a self, body: &'a Body<D>) -> Option<Pushed<'a, D>> {
        let repulsion = self.repulsion.as_ref()?;
        Some(Pushed { repulsion, body })
    }

    fn energies(
        &self,
        body: &Body<D>,
        u: FieldView<D>,
        room: &Room,
        out: Option<&mut PointEnergiesMut>,
    ) -> [f64; 2] {
        let fields = out.map(|out| EnergyFields::of(out, body.len));
        let held = self.held_energies();
        let kernel = Energies {
            view: self.view(u, room),
            held: &held,
            pushed: self.pushed(body),
            volume: &body.volume,
            fields,
        };
        self.sums.sum(self.simd, &kernel)
    }

    /// `½ E ε²` of a section that is held against the strain ε is `G/(1 + ν)` times the square of what bonds expand by: energy that laws without
    /// a section leave out. Per material; empty: the law has it, or nothing is held.
    fn held_energies(&self) -> Vec<f64> {
        let of = |held: &Option<[f64; 2]>| {
            held.map_or(0.0, |[poisson, twice_shear]| {
                0.5 * twice_shear / (1.0 + poisson)
            })
        };
        match M::SECTION || self.expansion.is_empty() {
            true => vec![],
            false => self.held.iter().map(of).collect(),
        }
    }

    fn seen(&self, body: &Body<D>, u: FieldView<D>, room: &Room, out: &mut PointEnergiesMut) {
        self.energies(body, u, room, Some(&mut *out));
        self.dilate(out);
    }

    /// Test and break, and what points lose.
    fn tear(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        room: &Room,
        v: FieldView<D>,
        drift: f64,
    ) -> Tally {
        self.look_damage(body);
        let next = Shared(self.next.as_mut_ptr());
        let breaks = Shared(self.breaks.as_mut_ptr());
        let torn = Shared(self.torn.as_mut_ptr());
        let test = Test {
            family: &self.family,
            moved: Moved {
                columns: u,
                records: &room.records,
            },
            body,
            alive: &self.alive,
            critical: &self.critical,
            damage: &self.damage,
            expansion: &self.expansion,
            next,
            toughness: &self.toughness,
            criteria: &self.criteria,
            fibres: &self.fibres,
            plain: self.criteria.rate.is_empty() && self.fibres.is_empty(),
            work: &self.work,
            life: &self.life,
            v,
            keeps: M::PASSES > 0,
            breaks,
            torn,
        };
        run_blocks(self.simd, &test, self.sums.blocks());
        if self.torn.iter().all(|t| *t == 0) {
            return Tally::default();
        }
        let form = self.form.shared();
        let alive = Shared(self.alive.as_mut_ptr());
        let integrity = Shared(self.integrity.as_mut_ptr());
        let mut view = self.view(u, room);
        (view.form, view.alive) = (form.seen(), alive.seen());
        let kernel = Tear {
            view,
            // a step of equilibrium is at its end already, with its relaxed forces
            still: if self.step > 0.0 {
                &room.constants
            } else {
                &room.still
            },
            body,
            torn: &self.torn,
            breaks,
            alive,
            form,
            integrity: (!self.integrity.is_empty()).then_some(integrity),
            v,
            drift,
        };
        let tally = self.tallies.fold(self.simd, &kernel, Tally::add_assign);
        self.look_integrity(body);
        self.look_stiffness(body, u, |torn, group| torn[group] != 0);
        tally
    }

    /// After integrities have changed.
    fn look_integrity(&mut self, body: &Body<D>) {
        if self.integrity.is_empty() {
            return;
        }
        body.fill_images(&mut self.integrity);
        self.degraded = self.integrity.iter().any(|x| *x < 1.0);
    }

    /// How stiff the points of some groups are now, and the most of all.
    fn look_stiffness(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        of: impl Fn(&[u8], usize) -> bool,
    ) {
        let [whole, mut now] = std::mem::take(&mut self.stiffness);
        if now.is_empty() {
            return;
        }
        for group in (0..self.family.groups()).filter(|g| of(&self.torn, *g)) {
            for l in (0..TILE).filter(|l| self.family.is_point(group, *l)) {
                let slot = self.family.rows(group).slot(l);
                now[slot] = self.integrity_at(slot) * self.stiffness_of(body, u, group, l);
            }
        }
        let stiffened = |(whole, now): (&f64, &f64)| if *whole > 0.0 { now / whole } else { 1.0 };
        self.stiffened = whole.iter().zip(&now).map(stiffened).fold(1.0, f64::max);
        self.stiffness = [whole, now];
    }

    /// [`Material::stiffness`] of a point with its whole bonds.
    fn stiffness_of(&self, body: &Body<D>, u: FieldView<D>, group: usize, l: usize) -> f64 {
        let room = Room::default();
        let view = self.view(u, &room);
        // SAFETY: a group of the family, whose bits nobody writes
        let bits = unsafe { view.bits(group) };
        let material = body.material_of(self.family.rows(group).slot(l));
        view.of_family(group, bits, l, |kin| self.law.stiffness(material, kin))
    }

    /// What [`MaterialInteraction::look_stiffness`] compares with.
    fn begin_stiffness(&mut self, body: &Body<D>) {
        if !M::STIFFENS_TORN || self.critical.is_empty() {
            return;
        }
        self.stiffness = [vec![0.0; body.len], vec![0.0; body.len]];
        self.look_stiffness(body, view(&crate::body::zeros(0)), |_, _| true);
        self.stiffness[0] = self.stiffness[1].clone();
        self.stiffened = 1.0;
    }

    /// Damage as the points remember it.
    fn look_damage(&mut self, body: &Body<D>) {
        if let Measure::PlasticStrain(limit) = &self.criteria.measure {
            let Some(n) = self.past_of(PLASTIC_STRAIN) else {
                return;
            };
            for &slot in &body.slots {
                let of = limit[body.material_of(slot as usize)];
                self.damage[slot as usize] = self.past.get(n, slot as usize) / of;
            }
        } else if let Some(n) = self.law.failure() {
            for &slot in &body.slots {
                self.damage[slot as usize] = self.past.get(n, slot as usize);
            }
        } else {
            return;
        }
        body.fill_images(&mut self.damage);
    }

    /// Memory at the end of a step.
    fn remember(&mut self, body: &Body<D>, u: FieldView<D>, room: &Room) -> Tally {
        self.remember_only(body, u, room, &[])
    }

    /// Of the groups that are marked; no marks: of all.
    fn remember_only(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        room: &Room,
        only: &[u8],
    ) -> Tally {
        if self.memory.is_empty() && self.past.data.is_empty() {
            return Tally::default();
        }
        let past = self.past.shared();
        let memory = Shared(self.memory.as_mut_ptr());
        let mut view = self.view(u, room);
        (view.past, view.memory) = (past.seen(), memory.seen());
        let kernel = Remember {
            view,
            past,
            memory,
            volume: &body.volume,
            only,
        };
        let tally = self.tallies.fold(self.simd, &kernel, Tally::add_assign);
        let count = <M::Memory<f64> as Numbers<f64>>::COUNT;
        if count > 0 && !body.images.is_empty() {
            self.family
                .fill_images(&body.images, &mut self.memory, count);
        }
        tally
    }

    fn swap_bonds(&mut self, (alive, form, integrity): &mut (Vec<u8>, Store, Column)) {
        std::mem::swap(&mut self.alive, alive);
        std::mem::swap(&mut self.form, form);
        std::mem::swap(&mut self.integrity, integrity);
    }

    /// What points know of their families, from the bonds that are whole now.
    fn look(&mut self, body: &Body<D>) {
        self.look_stiffness(body, view(&crate::body::zeros(0)), |_, _| true);
        self.look_forms(body);
    }

    /// Forms by the bonds that are whole.
    fn look_forms(&mut self, body: &Body<D>) {
        let count = <M::Form<f64> as Numbers<f64>>::COUNT;
        if count == 0 {
            return;
        }
        let u = crate::body::zeros(0);
        let bits = match M::FORM_OF_WHOLE {
            true => &self.alive,
            false => &self.counted,
        };
        let mut form = self.form.clone();
        let room = Room::default();
        let view = self.view(view(&u), &room);
        for group in 0..self.family.groups() {
            let first = self.family.byte(group, 0);
            let bits = match self.family.bonds(group) {
                0 => &[],
                bonds => &bits[first..first + bonds],
            };
            for l in (0..TILE).filter(|l| self.family.is_point(group, *l)) {
                let made = view.form_of(group, bits, l, body);
                let slot = self.family.rows(group).slot(l);
                for n in 0..count {
                    form.set(n, slot, made.get(n));
                }
            }
        }
        self.form = form;
    }

    /// Every directed bond of the family that damage counts: group, bond, place.
    fn each_counted(&self, mut visit: impl FnMut(usize, usize, usize)) {
        for group in 0..self.family.groups() {
            for l in (0..TILE).filter(|l| self.family.is_point(group, *l)) {
                for k in 0..self.family.bonds(group) {
                    if self.counted[self.family.byte(group, k)] >> l & 1 == 1 {
                        visit(group, k, l);
                    }
                }
            }
        }
    }

    fn is_whole(&self, group: usize, k: usize, l: usize) -> bool {
        self.alive[self.family.byte(group, k)] >> l & 1 == 1
    }
}
