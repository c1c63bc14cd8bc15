//! The sweeps of a law: sums of each pass, force states of bonds, what is remembered, energies.

use super::view::{GroupOf, View, mirrored, save};
use crate::execute::blocks::Shared;
use crate::execute::lane::Lane;
use crate::execute::simd::Kernel;
use crate::interaction::BlockTally;
use crate::interaction::bonds::family::{Family, Slots, put};
use crate::interaction::bonds::repulsion::Pushed;
use crate::interaction::bonds::store::OwnRows;
use crate::law::material::{End, ForceState, Material, Numbers, Site, part_of};

/// A pass: sums over bonds, and what the points make of them.
pub struct Sums<'a, const D: usize, F, M> {
    pub view: View<'a, D, F, M>,
    pub pass: usize,
    pub out: OwnRows,
    /// A bit for each point that is meant, of its group; empty: all. What is done again for those that lost bonds is not done for who shares a tile with them,
    /// or its last digits would tell.
    pub only: &'a [u8],
}

impl<const D: usize, F: Family<D>, M: Material<D>> Kernel for Sums<'_, D, F, M> {
    type Out = ();
    type Home = M;

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        let (v, pass) = (&self.view, self.pass);
        for group in v.block(block) {
            let selected = self.only.get(group).copied().unwrap_or(u8::MAX);
            if selected == 0 {
                continue;
            }
            // SAFETY: groups of the family; each is written by one block
            unsafe {
                let at = v.group::<L>(group);
                let mut point = <M::Point<L> as Numbers<L>>::constant(0.0);
                if pass > 0 {
                    point = v.point::<L>(at.rows);
                }
                let sum = v.sum::<L>(pass, &at, &point);
                v.point_update::<L>(pass, &at, sum, &mut point);
                if selected != u8::MAX {
                    point = kept(selected, &v.point::<L>(at.rows), &point);
                }
                save(self.out, at.rows, &point);
            }
        }
    }
}

/// What the points that are meant have now, and the others had before.
#[inline(always)]
fn kept<L: Lane, N: Numbers<L>>(selected: u8, before: &N, now: &N) -> N {
    let (others, mut all) = (L::dead(selected), N::constant(0.0));
    for n in 0..N::COUNT {
        all.set(n, L::select(others, before.get(n), now.get(n)));
    }
    all
}

/// Force pass.
pub struct Forces<'a, const D: usize, F, M> {
    pub view: View<'a, D, F, M>,
    pub f: [Shared; D],
    pub pushed: Option<Pushed<'a, D>>,
}

impl<const D: usize, F: Family<D>, M: Material<D>> Kernel for Forces<'_, D, F, M> {
    type Out = ();
    type Home = M;

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        let v = &self.view;
        for group in v.block(block) {
            // SAFETY: groups of the family; each is written by one block
            unsafe {
                let at = v.group::<L>(group);
                let point = v.point::<L>(at.rows);
                let mut acc = [L::splat(0.0); D];
                for k in 0..v.family.bonds(group) {
                    let pull = pull::<L, D, F, M>(v, &at, &point, k);
                    for a in 0..D {
                        acc[a] = acc[a] + pull[a];
                    }
                }
                if let Some(pushed) = &self.pushed {
                    pushed.add::<L, F>(v.family, &v.moved, group, &mut acc);
                }
                for a in 0..D {
                    put(acc[a], self.f[a], at.rows);
                }
            }
        }
    }
}

/// What the points of a group get from their bond `k` (force / volume).
///
/// # Safety
/// A bond of the group.
#[inline(always)]
unsafe fn pull<L: Lane, const D: usize, F: Family<D>, M: Material<D>>(
    v: &View<D, F, M>,
    at: &GroupOf<L, D, F, M>,
    point: &M::Point<L>,
    k: usize,
) -> [L; D] {
    // SAFETY: the caller's promise
    unsafe {
        let (mut pull, weight) = pull_of::<L, D, F, M>(v, at, point, k);
        for a in 0..D {
            pull[a] = weight * pull[a];
        }
        if !v.expansion.is_empty() {
            let ends = v.family.ends(at.number, k);
            let per_length = v.per_length::<L>(at, ends);
            for a in 0..D {
                pull[a] = per_length * pull[a];
            }
        }
        pull
    }
}

/// `T_i⟨ξ⟩ − T_j⟨−ξ⟩` of bond `k` of a group (force / volume²), and `ν V_j`.
///
/// # Safety
/// As of [`pull`].
#[inline(always)]
unsafe fn pull_of<L: Lane, const D: usize, F: Family<D>, M: Material<D>>(
    v: &View<D, F, M>,
    at: &GroupOf<L, D, F, M>,
    point: &M::Point<L>,
    k: usize,
) -> ([L; D], L) {
    // SAFETY: the caller's promise
    unsafe {
        let ends = v.family.ends(at.number, k);
        let dead = v.dead::<L>(at.number, k);
        let (bond, weight) = v.bond::<L>(at, k, ends, dead);
        let memory = v.memory::<L>(at.number, k);
        let constants = v.constants_to::<L>(at, ends);
        let end = End {
            constants: &constants,
            point,
            memory: &memory,
        };
        let mut own = v.law.force_state(&bond, &end);
        let mut other = if M::ALIKE && v.alike {
            own.mirrored()
        } else {
            let back = if M::ALIKE {
                memory
            } else {
                v.memory_back::<L>(at.number, k)
            };
            let partner = v.point::<L>(ends);
            let constants = if v.alike || !M::READS {
                at.constants
            } else {
                let other = v.constants_at::<L>(ends);
                v.law.between(other, &at.constants)
            };
            v.law.force_state(
                &mirrored(&bond),
                &End {
                    constants: &constants,
                    point: &partner,
                    memory: &back,
                },
            )
        };
        if M::FORM_OF_WHOLE && !v.integrity.is_empty() {
            own = own.times(v.integrity::<L>(at.rows));
            other = other.times(v.integrity::<L>(ends));
        }
        (own.pull(other, &bond), weight)
    }
}

/// What bonds and points remember at the end of a step.
pub struct Remember<'a, const D: usize, F, M> {
    pub view: View<'a, D, F, M>,
    pub past: OwnRows,
    /// What bonds remember, to be written.
    pub memory: Shared,
    /// Volume per slot.
    pub volume: &'a crate::body::Values,
    /// As of [`Sums`].
    pub only: &'a [u8],
}

impl<const D: usize, F: Family<D>, M: Material<D>> Kernel for Remember<'_, D, F, M> {
    type Out = BlockTally;
    type Home = M;

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> BlockTally {
        let v = &self.view;
        let mut tally = BlockTally::default();
        for group in v.block(block) {
            let selected = self.only.get(group).copied().unwrap_or(u8::MAX);
            if selected == 0 {
                continue;
            }
            // SAFETY: groups of the family; each is written by one block
            unsafe {
                let at = v.group::<L>(group);
                let point = v.point::<L>(at.rows);
                if !v.law.moves::<L>(&point) {
                    continue;
                }
                let form = at.rows.load::<L, M::Form<L>>(v.form);
                let before = at.rows.load::<L, M::Past<L>>(v.past);
                let (mut lost, mut past) = (L::splat(0.0), before);
                if M::GATHERS {
                    past = <M::Past<L> as Numbers<L>>::constant(0.0);
                }
                let count = <M::Memory<L> as Numbers<L>>::COUNT;
                if count > 0 {
                    for k in 0..v.family.bonds(group) {
                        let dead = v.dead::<L>(group, k);
                        let ends = v.family.ends(group, k);
                        let (bond, weight) = v.bond::<L>(&at, k, ends, dead);
                        let old = v.memory::<L>(group, k);
                        let end = End {
                            constants: &at.constants,
                            point: &point,
                            memory: &old,
                        };
                        let mut new = old;
                        lost = weight.fma(v.law.state_update(&bond, &end, &mut new), lost);
                        if M::GATHERS {
                            past = past.plus(weight, v.law.gathered(&bond, &end, &new));
                        }
                        for n in 0..count {
                            let (old, new) = (old.get(n), new.get(n));
                            // a line that did not change is not written
                            if L::any(old.lt(new)) || L::any(new.lt(old)) {
                                let x = L::select(L::or(dead, L::dead(selected)), old, new);
                                x.store(self.memory.at(v.family.own(group, k, n, count)));
                            }
                        }
                    }
                }
                let site = Site {
                    constants: &at.constants,
                    form: &form,
                    past: &before,
                    around: v.around::<L>(at.rows),
                };
                lost = lost + v.law.remember(&site, &point, &mut past);
                lost = part_of(v.integrity::<L>(at.rows), lost);
                if selected != u8::MAX {
                    past = kept(selected, &before, &past);
                }
                save(self.past, at.rows, &past);
                for (l, x) in lost.to_array().iter().enumerate() {
                    if v.family.is_point(group, l) && selected >> l & 1 == 1 {
                        tally.dissipated += x * self.volume.at(at.rows.slot(l));
                    }
                }
            }
        }
        tally
    }
}
