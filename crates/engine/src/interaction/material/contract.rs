//! What every [`Interaction`] answers.

use super::MaterialInteraction;
use super::breaking::Shortest;
use super::family::{Family, Moved, Slots};
use crate::body::{Body, Column, FieldView, FieldViewMut, Identity, field};
use crate::columns::Declaration;
use crate::error::BuildError;
use crate::execute::lane::TILE;
use crate::interaction::{
    BondForce, BondState, BondTangent, Interaction, PointEnergiesMut, Sweep, Tally, Wearing,
};
use crate::law::BondFactors;
use crate::law::material::Material;
use crate::spec::{CrackKind, Cycles, Release};
use crate::state::Archive;

impl<const D: usize, F: Family<D>, M: Material<D>> Interaction<D> for MaterialInteraction<D, F, M> {
    fn made_for(&self) -> Identity {
        self.body
    }

    fn family(&self) -> &'static str {
        self.kind
    }

    unsafe fn forces_unchecked(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        f: FieldViewMut<D>,
        sweep: Sweep<D>,
        seen: Option<&mut PointEnergiesMut>,
    ) -> Tally {
        let motion = sweep.motion();
        let dt = match motion {
            Some(m) if self.step == 0.0 => m.steps[0],
            _ => self.step,
        };
        let mut room = self.take_room(u, dt);
        let breaks = motion.filter(|_| !self.critical.is_empty());
        if let Some(m) = breaks.filter(|_| M::FORM_OF_WHOLE && !M::POTENTIAL) {
            let total = self.step_of_rates(body, u, f, (m, &mut room), seen);
            self.room = room;
            return total;
        }
        // of a watched step: the bonds before any breaks
        let mut whole = seen.as_ref().map(|_| {
            (
                self.alive.clone(),
                self.form.clone(),
                self.integrity.clone(),
            )
        });
        let mut total = Tally::default();
        if motion.is_some() {
            self.work_before(body, u, &room);
        }
        if let Some(m) = breaks.filter(|m| m.release == Release::AtOnce) {
            if self.measures() {
                self.settle(body, u, &room);
                self.measure(body, u, &room);
            }
            total += self.tear(body, u, &room, m.v, -m.steps[0]);
        }
        self.settle(body, u, &room);
        self.pull(body, u, &room, f);
        if let Some(m) = breaks.filter(|m| m.release == Release::AfterForce) {
            self.measure(body, u, &room);
            total += self.tear(body, u, &room, m.v, m.steps[1]);
        }
        if motion.is_some() {
            total += self.remember(body, u, &room);
            self.step = 0.0;
        }
        if motion.is_some() || self.before.is_none() {
            self.keep(u, &room);
        }
        if let (Some(seen), Some(whole)) = (seen, &mut whole) {
            // what the step remembers is part of this instant, what breaks in it is of the next
            self.swap_bonds(whole);
            self.seen(body, u, &self.look_room(u), seen);
            self.swap_bonds(whole);
        }
        if breaks.is_some() {
            self.next_critical(body);
        }
        self.room = room;
        total
    }

    /// How stiff its points are then.
    fn begin_steps(&mut self, body: &Body<D>) {
        self.check(body, &[]);
        self.begin_stiffness(body);
    }

    fn shortest(&mut self, body: &Body<D>, u: FieldView<D>) -> f64 {
        self.check(body, &[u]);
        // of the largest frequency, which goes with the root of the stiffness
        let torn = self.stiffened.sqrt().recip();
        if !M::STIFFENS {
            return torn;
        }
        let room = self.take_room(u, self.step);
        let kernel = Shortest {
            family: &self.family,
            moved: Moved {
                columns: u,
                records: &room.records,
            },
            alive: &self.alive,
        };
        let most = |total: &mut [f64; 2], of: [f64; 2]| total[0] = total[0].max(of[0]);
        let [shorter, _] = self.sums.fold(self.simd, &kernel, most);
        self.room = room;
        torn * (1.0 - shorter).max(0.0).sqrt()
    }

    unsafe fn energy_unchecked(&mut self, body: &Body<D>, u: FieldView<D>) -> [f64; 2] {
        let room = self.take_room(u, self.step);
        let sums = self.energies(body, u, &room, None);
        self.room = room;
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

    fn observe_gradient(
        &self,
        body: &Body<D>,
        gradient: &[[f64; D]; D],
        out: &mut PointEnergiesMut,
    ) {
        self.check(body, &[]);
        self.strained(body, gradient, out);
    }

    unsafe fn tangents_unchecked(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        visit: &mut dyn FnMut(BondTangent<D>),
    ) {
        self.each_tangent(body, u, visit);
    }

    fn each_bond(&self, body: &Body<D>, visit: &mut dyn FnMut(usize, usize, [f64; D], BondState)) {
        let original = body.originals();
        self.each_counted(|group, k, l| {
            let i = self.family.rows(group).slot(l);
            let end = self.family.ends(group, k).slot(l);
            let j = original(end);
            // a bond between a point and its own image counts from one side only
            if i < j || (i == j && end > i) {
                let state = match self.is_whole(group, k, l) {
                    true => BondState::Whole,
                    false => BondState::Broken,
                };
                visit(i, j, self.family.bond(group, k, l).0, state);
            }
        });
    }

    fn each_broken(&self, body: &Body<D>, visit: &mut dyn FnMut(usize, usize, [f64; D])) {
        let original = body.originals();
        for group in 0..self.family.groups() {
            for k in 0..self.family.bonds(group) {
                let alive = self.alive[self.family.byte(group, k)];
                for l in (0..TILE).filter(|l| alive >> l & 1 == 0) {
                    if !self.family.is_point(group, l) || !self.family.is_bond(group, k, l) {
                        continue;
                    }
                    let i = self.family.rows(group).slot(l);
                    let end = self.family.ends(group, k).slot(l);
                    let j = original(end);
                    if i < j || (i == j && end > i) {
                        visit(i, j, self.family.bond(group, k, l).0);
                    }
                }
            }
        }
    }

    fn each_gone(&self, body: &Body<D>, visit: &mut dyn FnMut(usize, usize, [f64; D])) {
        self.each_broken(body, visit);
    }

    fn bond_limit(&self, ends: [usize; 2], xi: &[f64; D], critical: [f64; 2]) -> f64 {
        self.limit_of(ends, xi, critical)
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

    fn damage(&self, body: &Body<D>, out: &mut [f64]) {
        let mut family = vec![0.0; body.len];
        let mut whole = vec![0.0; body.len];
        let original = body.originals();
        self.each_counted(|group, k, l| {
            let i = self.family.rows(group).slot(l);
            let volume = body.volume.at(original(self.family.ends(group, k).slot(l)));
            family[i] += volume;
            if self.is_whole(group, k, l) {
                whole[i] += volume;
            }
        });
        for (i, damage) in out.iter_mut().enumerate() {
            *damage = match family[i] > 0.0 {
                true => 1.0 - whole[i] / family[i],
                false => 0.0,
            };
        }
    }

    fn cut(
        &mut self,
        body: &Body<D>,
        kind: CrackKind,
        crosses: &(dyn Fn([f64; D], [f64; D]) -> bool + Sync),
    ) -> u64 {
        let original = body.originals();
        let mut cut = vec![];
        self.each_counted(|group, k, l| {
            if !self.is_whole(group, k, l) {
                return;
            }
            let (xi, _) = self.family.bond(group, k, l);
            let at = |slot: usize| -> [f64; D] {
                let x = body.position(slot);
                std::array::from_fn(|a| x[a])
            };
            let from = at(self.family.rows(group).slot(l));
            // a bond through a periodic face is in two places; either end must see the same
            let to = at(original(self.family.ends(group, k).slot(l)));
            if crosses(from, std::array::from_fn(|a| from[a] + xi[a]))
                || crosses(std::array::from_fn(|a| to[a] - xi[a]), to)
            {
                cut.push((self.family.byte(group, k), 1u8 << l));
            }
        });
        for (byte, bit) in &cut {
            self.alive[*byte] &= !bit;
            if kind == CrackKind::Absent {
                self.counted[*byte] &= !bit;
            }
        }
        if kind == CrackKind::Absent {
            self.directed -= cut.len() as u64;
        }
        if self.prepared {
            self.look(body);
        }
        cut.len() as u64
    }

    fn scale_bonds(
        &mut self,
        _: &Body<D>,
        _: &dyn Fn(usize, usize, [i32; D]) -> BondFactors<f64>,
    ) -> Result<(), BuildError> {
        Err(BuildError::unsupported(
            "bonds",
            "factors multiply what a bond pulls by its own stretch and its ends' dilatation; the bonds of this body do more: they remember (work, stress or strain that they break by, plastic flow), expand, or answer to tensors",
        )
        .help("leave the factors out, or take pmb or lps without expansion that break by critical_stretch or energy"))
    }

    fn prepare(&mut self, body: &Body<D>) {
        self.check(body, &[]);
        self.prepared = true;
        self.look(body);
    }

    fn directed_bonds(&self) -> u64 {
        self.directed
    }

    fn family_size(&self, _: &Body<D>, slot: usize) -> usize {
        let Some((group, l)) = self.family.find(slot) else {
            return 0;
        };
        (0..self.family.bonds(group))
            .filter(|k| self.counted[self.family.byte(group, *k)] >> l & 1 == 1)
            .count()
    }

    fn near_horizon(&self) -> u64 {
        self.near_horizon
    }

    fn in_family(&self, body: &Body<D>, i: usize, j: usize) -> bool {
        let Some((group, l)) = self.family.find(i) else {
            return false;
        };
        let original = body.originals();
        (0..self.family.bonds(group)).any(|k| {
            self.family.is_bond(group, k, l) && original(self.family.ends(group, k).slot(l)) == j
        })
    }

    fn expand(&mut self, body: &Body<D>, strain: &[f64]) -> bool {
        self.check(body, &[]);
        assert_eq!(strain.len(), body.len, "a strain for each slot");
        if self.expansion.is_empty() {
            self.expansion = Column::new(body.len, 0.0, field::line(4));
        }
        self.expansion.copy_from_slice(strain);
        if !M::SECTION && !self.held.is_empty() {
            for i in 0..body.len {
                let Some([poisson, _]) = self.held[self.material_at(i)] else {
                    return false;
                };
                self.expansion[i] *= 1.0 + poisson;
            }
        }
        true
    }

    fn add_stress_across(&mut self, body: &Body<D>, u: FieldView<D>, trace: &mut [f64]) -> bool {
        self.check(body, &[u]);
        assert_eq!(trace.len(), body.len, "a number for each slot");
        self.held.is_empty() || self.add_across(body, u, trace)
    }

    fn warm(&mut self, body: &Body<D>, above: &[f64]) -> bool {
        self.check(body, &[]);
        assert_eq!(above.len(), body.len, "a temperature for each slot");
        self.set_warmth(body, above)
    }

    fn read_warmth(&self, body: &Body<D>, above: &mut [f64]) {
        self.check(body, &[]);
        assert_eq!(above.len(), body.len, "a temperature for each slot");
        self.warmth(body, above);
    }

    fn last(&mut self, step: f64) {
        self.step = step;
    }

    fn wearing(&self, body: &Body<D>, u: FieldView<D>, load: &Cycles) -> Option<Vec<Wearing>> {
        self.check(body, &[u]);
        if self.life.is_empty() {
            return None;
        }
        let mut all = vec![];
        self.each_wearing(body, u, load, |_, bond| all.push(bond));
        Some(all)
    }

    fn wear(&mut self, body: &Body<D>, u: FieldView<D>, load: &Cycles, passed: f64) {
        self.check(body, &[u]);
        if !self.life.is_empty() {
            self.wear_bonds(body, u, load, passed);
        }
    }

    fn columns(&self) -> Vec<Declaration> {
        self.declared()
    }

    fn read_column(&self, body: &Body<D>, u: FieldView<D>, name: &str, out: &mut Vec<f64>) -> bool {
        self.check(body, &[u]);
        self.read_named(body, u, name, out)
    }

    fn write_column(&mut self, body: &Body<D>, name: &str, values: &[f64]) -> bool {
        self.check(body, &[]);
        self.write_named(body, name, values)
    }

    fn archive(&mut self, body: &Body<D>, archive: &mut Archive<'_>) {
        self.archive_memory(body, archive);
    }

    fn each_directed(
        &self,
        body: &Body<D>,
        _: &str,
        visit: &mut dyn FnMut(usize, usize, [f64; D]),
    ) {
        let original = body.originals();
        for (group, k, l) in self.directed() {
            let i = self.family.rows(group).slot(l);
            let j = original(self.family.ends(group, k).slot(l));
            visit(i, j, self.family.bond(group, k, l).0);
        }
    }

    fn memory(&self) -> (&[u8], &[f64]) {
        (&self.alive, &self.critical)
    }

    fn bytes(&self) -> usize {
        self.family.bytes()
            + self.alive.len()
            + self.counted.len()
            + self.breaks.len()
            + self.torn.len()
            + self.material.len()
            + self.placed.bytes()
            + self.form.bytes()
            + self.point.bytes()
            + self.past.bytes()
            + 8 * (self.memory.len() + self.room.records.len())
            + 8 * (self.critical.len() + self.next.len())
            + 8 * (self.damage.len() + self.expansion.len())
            + 8 * (self.work.len() + self.life.len())
            + 8 * (self.integrity.len() + self.stiffness.iter().map(Vec::len).sum::<usize>())
    }
}
