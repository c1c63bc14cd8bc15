//! What happens to single points from outside, in the middle of a run: walls that throw them back, and points that are
//! taken away.

use super::Wall;
use super::system::System;
use crate::body::FAR;
use crate::spec::CrackKind;
use std::collections::HashSet;

impl<const D: usize> System<D> {
    /// Mirrors points that are behind the wall, with their velocity across it.
    pub(super) fn bounce(&mut self, wall: &Wall, ids: Option<&[u32]>) {
        let a = wall.axis;
        if a >= D {
            return;
        }
        let all = self.body.slots().len() as u32;
        let (u, v) = (&mut self.u[a], &mut self.v[a]);
        let mut mirror = |id: u32| {
            let i = self.body.slots()[id as usize] as usize;
            let reference = self.body.position(i)[a];
            let behind = wall.position - (reference + u[i]);
            if (behind < 0.0) == wall.above && behind != 0.0 {
                u[i] = wall.position + behind - reference;
                v[i] = -v[i];
            }
        };
        match ids {
            None => (0..all).for_each(&mut mirror),
            Some(ids) => ids.iter().copied().for_each(&mut mirror),
        }
    }

    /// Takes points away, by their ids among those of all ranks: like sites that were never there, they are far from everything, at rest and without bonds.
    /// Answers the new ids of those that stay, of this rank's points by their ids here.
    pub(super) fn take_away(&mut self, ids: &[u32]) -> Vec<Option<u32>> {
        let mut gone_ids = ids.to_vec();
        gone_ids.sort_unstable();
        gone_ids.dedup();
        let is_here = self.body.whose();
        let here = gone_ids.iter().filter_map(|id| is_here.place(*id));
        let gone: HashSet<u32> = here.map(|id| self.body.slots()[id]).collect();
        let own: Vec<[f64; 3]> = { gone.iter() }
            .map(|s| self.body.position(*s as usize))
            .collect();
        let places = self.body.all_of(&own).concat();
        // bonds know their ends by where they are in the reference, up to round-off
        let near = (1e-6 * self.body.spacing()).powi(2);
        let is_gone = |x: [f64; D]| {
            places
                .iter()
                .any(|p| (0..D).map(|a| (x[a] - p[a]).powi(2)).sum::<f64>() < near)
        };
        self.accounts.swept.broken +=
            self.interaction
                .cut(&self.body, CrackKind::Broken, &|from, to| {
                    is_gone(from) || is_gone(to)
                });
        for s in &gone {
            let i = *s as usize;
            for a in 0..D {
                self.u[a][i] = FAR * self.body.spacing();
                self.v[a][i] = 0.0;
                self.f[a][i] = 0.0;
            }
        }
        let keep = |s: u32| !gone.contains(&s);
        // ids of those that stay
        let mut next = 0;
        let moved: Vec<Option<u32>> = { self.body.slots().iter() }
            .map(|s| {
                let id = keep(*s).then_some(next);
                next += u32::from(id.is_some());
                id
            })
            .collect();
        self.body.remove(&gone_ids);
        self.info.points = self.body.all_points() as u64;
        self.prescribed.all_mut().for_each(|p| p.retain(&keep));
        self.applied.all().for_each(|x| x.retain(&keep));
        if let Some(friction) = self.contact.as_mut().and_then(|c| c.friction.as_mut()) {
            friction.renumber(&|id| match gone_ids.binary_search(&id) {
                Ok(_) => None,
                Err(below) => Some(id - below as u32),
            });
        }
        self.watch.forget();
        self.stressed = None;
        self.refresh_images();
        self.invalidate_neighbours();
        // what they carried is no longer asked for
        self.accounts.initial = Some(self.energy_now().base());
        moved
    }
}
