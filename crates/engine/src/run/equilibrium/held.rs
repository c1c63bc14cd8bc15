//! What holds a body in equilibrium, and what nothing holds.

use super::problem::Problem;
use crate::condition::prescribed_motion::PrescribedMotion;
use crate::error::{Loose, SolveError};
use crate::fracture::fragments::Fragments;
use crate::run::system::System;
use crate::spec::Statics;
use crate::statics::Support;

/// What is free where bonds have broken.
pub(super) struct Held<const D: usize> {
    pub support: Support<D>,
    /// Points (by id) of parts that rest where they are.
    pub resting: Vec<usize>,
}

impl<const D: usize> System<D> {
    /// Which components forces move.
    pub(in crate::run) fn held(&self) -> Support<D> {
        self.held_by(&self.prescribed)
    }

    /// The same under this motion.
    pub(in crate::run) fn held_by(&self, prescribed: &PrescribedMotion<D>) -> Support<D> {
        let id = self.body.ids_by_slot();
        let mut support = Support::none(self.body.points());
        let mut hold = |slot, a| support.free[id[slot] as usize][a] = false;
        prescribed.all().for_each(|p| p.each_held(&mut hold));
        support
    }

    /// Rigid motions of parts whose bonds hold together that meet no resistance.
    pub(super) fn loose_parts(&self, support: &Support<D>) -> Vec<Loose> {
        let parts = Fragments::of(&self.body, self.interaction.as_ref()).label;
        support.loose(&self.body.places(), &parts, &self.body.period())
    }
}

impl<const D: usize> Problem<'_, D> {
    /// Which components are free where bonds have broken: a part that nothing holds and nothing loads rests where it is, by as few components as hold
    /// it, which bear nothing.
    ///
    /// # Errors
    /// A load acts on it: there is no equilibrium.
    pub(super) fn support_now(&mut self, options: Statics) -> Result<Held<D>, SolveError> {
        let support = self.system.held();
        let resting = vec![];
        // what touches may hold, too
        if self.system.accounts.swept.broken == 0
            || self.system.contact.is_some()
            || !self.system.applied.rigid.is_empty()
        {
            return Ok(Held { support, resting });
        }
        let (places, period) = (self.system.body.places(), self.system.body.period());
        let parts = Fragments::of(&self.system.body, self.system.interaction.as_ref()).label;
        let mut loose = support.loose(&places, &parts, &period);
        // one of each part
        loose.dedup_by_key(|l| l.point);
        if loose.is_empty() {
            return Ok(Held { support, resting });
        }
        let external = self.system.external();
        let loads = self.system.body.per_point(&external);
        let mut members = vec![vec![]; parts.len()];
        for (i, part) in parts.iter().enumerate() {
            members[*part as usize].push(i);
        }
        let mut now = Held {
            support: support.clone(),
            resting,
        };
        for part in loose {
            let own = &members[parts[part.point] as usize];
            let pulled = |i: &usize| (0..D).any(|a| support.free[*i][a] && loads[*i][a] != 0.0);
            if own.iter().any(pulled) {
                return Err(SolveError::Unheld {
                    points: part.points,
                    point: part.point,
                });
            }
            // relaxation has no equations: what nothing pulls does not move
            if options.method.minimizes() {
                continue;
            }
            let places: Vec<[f64; D]> = own.iter().map(|i| places[*i]).collect();
            let given = Support {
                free: own.iter().map(|i| support.free[*i]).collect(),
            };
            let enough = given.completed(&places, &vec![0; own.len()], &period);
            for (i, free) in own.iter().zip(enough.free) {
                now.support.free[*i] = free;
            }
            now.resting.extend(own);
        }
        Ok(now)
    }
}
