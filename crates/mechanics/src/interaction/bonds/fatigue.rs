//! Fatigue damage of bonds in cycles of load.

use super::family::{Family, Slots};
use super::state::BondState;
use crate::body::{Body, FieldView};
use crate::interaction::bond::relative_square_stretch;
use crate::interaction::criterion::{BondFatigue, SPENT};
use crate::interaction::history;
use crate::spec::Cycles;

impl<const D: usize, F: Family<D>> BondState<D, F> {
    /// Points in whose reference family is a crack, with the least damage that is one to each material, and their copies: 1.
    fn near_cracks(&self, body: &Body<D>) -> Vec<u8> {
        let mut of = vec![[0.0f64; 2]; body.len];
        for (group, k, l) in self.pairs() {
            let i = self.family.rows(group).slot(l);
            let j = body.exchange.original(self.family.ends(group, k).slot(l));
            let volume = body.volume.at(j);
            of[i][0] += volume;
            if !self.is_whole(group, k, l) {
                of[i][1] += volume;
            }
        }
        let cracked = |i: usize| {
            let fatigue = self.criteria.fatigue[self.material_at(i)];
            let [all, lost] = of[i];
            u8::from(fatigue.is_some_and(|f| all > 0.0 && lost >= f.crack * all))
        };
        let mut near: Vec<u8> = (0..body.len).map(cracked).collect();
        body.exchange.fill(&mut near);
        let cracked = near.clone();
        for (group, k, l) in self.pairs() {
            let i = self.family.rows(group).slot(l);
            let j = body.exchange.original(self.family.ends(group, k).slot(l));
            near[i] |= cracked[j];
        }
        body.exchange.fill(&mut near);
        near
    }

    /// [`fatigue_of_bonds`](crate::interaction::Interaction::fatigue_of_bonds)
    pub fn fatigue_of_bonds(
        &self,
        body: &Body<D>,
        u: FieldView<D>,
        load: &Cycles,
    ) -> Option<Vec<BondFatigue>> {
        if self.life.is_empty() {
            return None;
        }
        let mut all = vec![];
        let near = self.near_cracks(body);
        for (group, k, l) in self.pairs().filter(|b| self.is_whole(b.0, b.1, b.2)) {
            let [i, end] = [self.family.rows(group), self.family.ends(group, k)].map(|s| s.slot(l));
            let j = body.exchange.original(end);
            let r = self.family.plain(group, k, l);
            let eta = self.plain_eta(u, [i, end], &r.xi);
            let stretch = history::stretch(relative_square_stretch(eta, r.xi, r.two_by_square));
            let range = (1.0 - load.load_ratio) * stretch.abs();
            let of = |slot: usize| {
                let fatigue = self.criteria.fatigue[self.material_at(slot)];
                fatigue.map_or(0.0, |f| {
                    BondFatigue::rate(&f, range, near[i] | near[j] == 1)
                })
            };
            all.push(BondFatigue {
                life: self.life[self.family.own(group, k, 0, 1) + l],
                rate: 0.5 * (of(i) + of(j)),
                counts: true,
            });
        }
        Some(all)
    }

    /// So many cycles of fatigue damage to intact bonds, of which these are the first.
    pub fn accumulate_fatigue(
        &mut self,
        bonds: &mut dyn Iterator<Item = BondFatigue>,
        cycles: f64,
    ) {
        if self.life.is_empty() {
            return;
        }
        let whole = self.pairs().filter(|b| self.is_whole(b.0, b.1, b.2));
        let places = whole.map(|(group, k, l)| self.family.own(group, k, 0, 1) + l);
        let places: Vec<usize> = places.collect();
        for (place, bond) in places.into_iter().zip(bonds) {
            let left = bond.life - cycles * bond.rate;
            self.life[place] = if left < SPENT { 0.0 } else { left };
        }
    }
}
