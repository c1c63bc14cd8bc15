//! What holds a body in equilibrium, and what nothing holds.

use super::problem::Problem;
use super::whole::{told, whole_support};
use crate::boundary_condition::prescribed_motion::PrescribedMotion;
use crate::error::{Loose, SolveError};
use crate::fracture::fragments::Fragments;
use crate::run::system::System;
use crate::spec::Statics;
use crate::statics::Support;

/// What is free where bonds have broken.
pub(super) struct Held<const D: usize> {
    pub support: Support<D>,
    /// Points (of those here, by id) of parts that rest where they are.
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

    /// The first rigid motion of a part whose bonds hold together that meets no resistance, with a place in that part; on the first rank.
    pub(super) fn loose_part(&self, support: &Support<D>) -> Option<(Loose, [f64; D])> {
        let all = Everyone::of(self, support)?;
        let loose = all.loose().into_iter().next()?;
        let place = all.places[loose.point];
        Some((loose, place))
    }
}

/// How all points lie, are held, and hang together.
struct Everyone<const D: usize> {
    support: Support<D>,
    places: Vec<[f64; D]>,
    /// Label of each point's part.
    parts: Vec<u32>,
    period: [Option<f64>; D],
}

/// What rests of a body, with its support.
type Resting<const D: usize> = (Support<D>, Vec<usize>);

impl<const D: usize> Everyone<D> {
    /// The points of all ranks, on the first.
    fn of(system: &System<D>, support: &Support<D>) -> Option<Everyone<D>> {
        let support = whole_support(&system.body, support);
        let places = system.body.whole(D, system.body.places().into_flattened());
        let parts = Fragments::of(&system.body, system.interaction.as_ref());
        let parts = system.body.whole(1, parts.label);
        Some(Everyone {
            support: support?,
            places: places?.as_chunks().0.to_vec(),
            parts: parts?,
            period: system.body.period(),
        })
    }

    /// Rigid motions that meet no resistance.
    fn loose(&self) -> Vec<Loose> {
        self.support.loose(&self.places, &self.parts, &self.period)
    }

    /// With parts that nothing holds and nothing loads held where they are; `None`: all are held.
    fn at_rest(
        &self,
        loads: &[[f64; D]],
        options: Statics,
    ) -> Result<Option<Resting<D>>, SolveError> {
        let mut loose = self.loose();
        // one of each part
        loose.dedup_by_key(|l| l.point);
        if loose.is_empty() {
            return Ok(None);
        }
        let mut members = vec![vec![]; self.parts.len()];
        for (i, part) in self.parts.iter().enumerate() {
            members[*part as usize].push(i);
        }
        let (mut now, mut resting) = (self.support.clone(), vec![]);
        for part in loose {
            let own = &members[self.parts[part.point] as usize];
            let free = &self.support.free;
            let pulled = |i: &usize| (0..D).any(|a| free[*i][a] && loads[*i][a] != 0.0);
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
            let places: Vec<[f64; D]> = own.iter().map(|i| self.places[*i]).collect();
            let given = Support {
                free: own.iter().map(|i| free[*i]).collect(),
            };
            let enough = given.completed(&places, &vec![0; own.len()], &self.period);
            for (i, free) in own.iter().zip(enough.free) {
                now.free[*i] = free;
            }
            resting.extend(own);
        }
        Ok(Some((now, resting)))
    }
}

impl<const D: usize> Problem<'_, D> {
    /// Which components are free where bonds have broken: a part that nothing holds and nothing loads rests where it is, by as few components as hold
    /// it, which bear nothing.
    ///
    /// # Errors
    /// A load acts on it: there is no equilibrium.
    pub(super) fn support_now(&mut self, options: Statics) -> Result<Held<D>, SolveError> {
        let system = &mut *self.system;
        let support = system.held();
        let resting = vec![];
        // what touches may hold, too
        if system.body.count(system.accounts.swept.broken) == 0
            || system.contact.is_some()
            || !system.applied.rigid.is_empty()
        {
            return Ok(Held { support, resting });
        }
        let external = system.external();
        let loads = { system.body.per_point(&external) }.into_flattened();
        let loads = system.body.whole(D, loads);
        let all = Everyone::of(system, &support).zip(loads);
        let found = all.map(|(all, loads)| all.at_rest(loads.as_chunks().0, options));
        let found = told(&system.body, found.transpose())?.flatten();
        let body = &system.body;
        let rests = body.is_first().then_some(u8::from(found.is_some()));
        if body.told(rests) == 0 {
            return Ok(Held { support, resting });
        }
        // of each point which components are free, and whether it rests
        let flags = found.map(|(support, resting)| {
            let mut flags = vec![0u8; (D + 1) * support.free.len()];
            for (flags, free) in flags.chunks_exact_mut(D + 1).zip(&support.free) {
                (0..D).for_each(|a| flags[a] = u8::from(free[a]));
            }
            resting.iter().for_each(|i| flags[(D + 1) * i + D] = 1);
            flags
        });
        let flags = body.part_of(D + 1, flags);
        let flags = || flags.chunks_exact(D + 1);
        let rests = flags().enumerate().filter(|(_, flags)| flags[D] == 1);
        let free = flags().map(|flags| crate::array::from_fn(|a| flags[a] == 1));
        Ok(Held {
            resting: rests.map(|(i, _)| i).collect(),
            support: Support {
                free: free.collect(),
            },
        })
    }
}
