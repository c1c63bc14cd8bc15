//! What happens to single points from outside, in the middle of a run: walls that throw them back, and points that are
//! taken away.

use super::Wall;
use super::system::System;
use crate::body::FAR;
use crate::spec::CrackKind;

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

    /// Takes points away, between steps: like sites that were never there, they are far from everything, at rest and without bonds.
    /// Answers the new ids of those that stay.
    pub(super) fn take_away(&mut self, ids: &[u32]) -> Vec<Option<u32>> {
        let gone: std::collections::HashSet<u32> = ids
            .iter()
            .map(|id| self.body.slots()[*id as usize])
            .collect();
        let places: Vec<[f64; D]> = gone
            .iter()
            .map(|s| {
                let x = self.body.position(*s as usize);
                crate::array::from_fn(|a| x[a])
            })
            .collect();
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
        let moved: Vec<Option<u32>> = self
            .body
            .slots()
            .iter()
            .map(|s| {
                let id = keep(*s).then_some(next);
                next += u32::from(id.is_some());
                id
            })
            .collect();
        self.body.retain(keep);
        self.info.points = self.body.slots().len() as u64;
        self.prescribed.all_mut().for_each(|p| p.retain(&keep));
        self.applied.all().for_each(|x| x.retain(&keep));
        if let Some(friction) = self.contact.as_mut().and_then(|c| c.friction.as_mut()) {
            friction.renumber(&moved);
        }
        self.watch.forget();
        self.stressed = None;
        self.refresh_images();
        self.look_again();
        // what they carried is no longer asked for
        self.accounts.initial = Some(self.energy_now().base());
        moved
    }
}
